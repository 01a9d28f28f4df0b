# SPDX-License-Identifier: GPL-2.0-or-later
"""Section [G12]: read once, refused by name."""

import pytest

from g12.errors import Refusal
from g12.settings import settings_from_ini, settings_from_lines


def test_files_that_include_each_other_come_to_an_end(tmp_path):
    ini = tmp_path / "machine.ini"
    ini.write_text("#INCLUDE machine.ini\n[G12]\n")
    with pytest.raises(Refusal, match="twice"):
        settings_from_ini(ini)


def test_in_the_file_that_linuxcnc_expanded_an_include_is_a_comment(tmp_path):
    ini = tmp_path / "machine.ini.expanded"
    ini.write_text("[G12]\n#INCLUDE more.inc\n")
    (tmp_path / "more.inc").write_text("CLEARING = spiral\n")
    assert settings_from_ini(ini).clearing == "rings"


@pytest.mark.parametrize(
    ("text", "mm", "tolerance"),
    [("", 1.0, 0.005), ("", 25.4, 0.0002), ("", 10.0, 0.0005), ("POLAR_TOLERANCE = 0.01", 1, 0.01)],
)
def test_the_tolerance_is_in_machine_units(text, mm, tolerance):
    assert settings_from_lines(["[G12]", text]).tolerance(mm) == tolerance


NEEDS_CLAMP = "needs C_CLAMP, whose second code opens the clamp"
REFUSED = [  # lines below [G12], the message
    ("CLEARING = zigzag", "CLEARING = zigzag: must be rings or spiral"),
    ("PLUNGE_FEED = 0", "PLUNGE_FEED = 0: must be a number above 0, 100 at most"),
    ("POLAR_TOLERANCE = nan", "POLAR_TOLERANCE = nan: must be a number from 0.00001"),
    ("POLAR_TOLERANCE = 1_0", "POLAR_TOLERANCE = 1_0: must be a number from 0.00001"),
    ("C_CLAMP_SHAPES = M1 M2", "C_CLAMP_SHAPES = M1 M2: must be an M code such as M12"),
    ("C_CLAMP = 10 11", "C_CLAMP = 10 11: must be two M codes such as M10 M11"),
    ("C_CLAMP_SHAPES = M12", f"C_CLAMP_SHAPES {NEEDS_CLAMP}"),
    ("POLAR_G0 = feed", "POLAR_G0 = feed needs POLAR_G0_FEED, a number above 0"),
    ("CLEARING = rings\nCLEARING = spiral", "CLEARING occurs twice"),
    ("CLEARNIG = 1", "CLEARNIG is not a setting; the nearest is CLEARING"),
    ("polar_z = 1", "polar_z is not a setting; the nearest is POLAR_Z"),
    ("POLAR_FEED = 1", "POLAR_FEED is not a setting; the nearest is POLAR_G0_FEED"),
]


@pytest.mark.parametrize(("text", "message"), REFUSED)
def test_a_bad_line_names_key_and_legal_values(text, message):
    with pytest.raises(Refusal) as refused:
        settings_from_lines(["[G12]", *text.splitlines()])
    assert refused.value.message == f"[G12] {message}"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[g12]\nCLEARING = spiral\n", "[g12] must be written [G12]"),
        ("[G12 ]\nCLEARING = spiral\n", "[G12 ] must be written [G12]"),
        ("[G12]\n[EMC]\n[G12]\n", "[G12] occurs twice: LinuxCNC reads the first one only"),
    ],
)
def test_a_section_that_linuxcnc_would_not_read_is_refused(tmp_path, text, message):
    ini = tmp_path / "machine.ini"
    ini.write_text(text)
    with pytest.raises(Refusal) as refused:
        settings_from_ini(ini)
    assert refused.value.message == message
