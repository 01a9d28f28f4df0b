# SPDX-License-Identifier: GPL-2.0-or-later
"""Section [G12]: read once, refused by name."""

import pytest

from g12.errors import Refusal
from g12.settings import Settings, settings_from_ini, settings_from_lines


def test_without_a_section_every_default_holds(tmp_path):
    ini = tmp_path / "machine.ini"
    ini.write_text("[EMC]\nMACHINE = x\n")
    assert settings_from_ini(ini) == settings_from_ini(None) == Settings()


def test_a_section_is_read_with_what_its_file_includes(tmp_path):
    ini = tmp_path / "machine.ini"
    ini.write_text("[EMC]\n#INCLUDE more/codes.inc\nHALFILE = x.hal\n#INCLUDE missing.inc\n")
    (tmp_path / "more").mkdir()
    (tmp_path / "more" / "codes.inc").write_text("[G12]\n; a comment\n#INCLUDE deeper.inc\n[HAL]\n")
    (tmp_path / "more" / "deeper.inc").write_text("CLEARING = Spiral\n")
    assert settings_from_ini(ini).clearing == "spiral"


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


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("CLEARING", "zigzag", "[G12] CLEARING = zigzag: must be rings or spiral"),
        ("PLUNGE_FEED", "0", "[G12] PLUNGE_FEED = 0: must be a number above 0, 100 at most"),
        ("POLAR_TOLERANCE", "nan", "[G12] POLAR_TOLERANCE = nan: must be a number from 0.00001"),
        ("POLAR_TOLERANCE", "1_0", "[G12] POLAR_TOLERANCE = 1_0: must be a number from 0.00001"),
        ("C_CLAMP_SHAPES", "M1 M2", "[G12] C_CLAMP_SHAPES = M1 M2: must be an M code such as M12"),
        ("C_CLAMP", "10 11", "[G12] C_CLAMP = 10 11: must be two M codes such as M10 M11"),
        ("C_CLAMP_SHAPES", "M12", f"[G12] C_CLAMP_SHAPES {NEEDS_CLAMP}"),
        ("POLAR_G0", "feed", "[G12] POLAR_G0 = feed needs POLAR_G0_FEED, a number above 0"),
    ],
)
def test_an_illegal_value_names_key_and_legal_values(key, value, message):
    with pytest.raises(Refusal) as refused:
        settings_from_lines(["[G12]", f"{key} = {value}"])
    assert refused.value.message == message


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[g12]\nCLEARING = spiral\n", "[g12] must be written [G12]"),
        ("[G12 ]\nCLEARING = spiral\n", "[G12 ] must be written [G12]"),
        ("[G12]\n[EMC]\n[G12]\n", "[G12] occurs twice: LinuxCNC reads the first one only"),
        ("[G12]\nCLEARING = rings\nCLEARING = spiral\n", "[G12] CLEARING occurs twice"),
    ],
)
def test_a_section_that_linuxcnc_would_not_read_or_a_key_twice_is_refused(tmp_path, text, message):
    ini = tmp_path / "machine.ini"
    ini.write_text(text)
    with pytest.raises(Refusal) as refused:
        settings_from_ini(ini)
    assert refused.value.message == message


@pytest.mark.parametrize(
    ("key", "nearest"),
    [("CLEARNIG", "CLEARING"), ("polar_z", "POLAR_Z"), ("POLAR_FEED", "POLAR_G0_FEED")],
)
def test_an_unknown_key_names_the_nearest_one(key, nearest):
    with pytest.raises(Refusal) as refused:
        settings_from_lines(["[G12]", f"{key} = rings"])
    assert refused.value.message == f"[G12] {key} is not a setting; the nearest is {nearest}"
