# SPDX-License-Identifier: GPL-2.0-or-later
"""What an INI file says of a machine, read the way LinuxCNC reads it."""

from pathlib import Path

import pytest

from g12.errors import Refusal
from g12.lengths import is_inch
from g12.machine_ini import (
    Axis,
    axes_of,
    code_number,
    coordinates_of,
    owns_g12_1,
    ranges_of,
    refuse_owned_codes,
    remap_lines,
    spindle_c_timeout,
)
from g12.tools.machine.ini import Ini, millimetres_of

INI = """
[RS274NGC]
REMAP = G12.1 modalgroup=1 python=polar_on
REMAP=m410 modalgroup=10 argspec=P ngc=m410
[TRAJ]
LINEAR_UNITS = {units}
[AXIS_X]
MIN_LIMIT = -10 ; comment
MAX_LIMIT = 300
MAX_VELOCITY = 150
MAX_ACCELERATION = 1000
[AXIS_C]
MAX_VELOCITY = 360
"""


def ini_of(text):
    return Ini(Path("machine.ini"), tuple(text.splitlines()))


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("MAX_ACCELERATION = 0", "[AXIS_C] MAX_ACCELERATION = 0: must be above 0"),
        ("MIN_LIMIT = 5\nMAX_LIMIT = -5",
         "[AXIS_C] MIN_LIMIT = 5: must not be above MAX_LIMIT = -5"),
        ("MAX_LIMIT = far", "[AXIS_C] MAX_LIMIT = far: must be a number"),
    ],
)  # fmt: skip
def test_an_axis_that_cannot_be(lines, message):
    ini = ini_of(f"[AXIS_C]\n{lines}\n")
    for read in (axes_of, ranges_of) if "LIMIT" in lines else (axes_of,):
        with pytest.raises(Refusal) as refused:
            read(ini.get, "C")
        assert refused.value.message == message


def test_no_feed_override_and_a_time_that_cannot_be():
    face = "[KINS]\nKINEMATICS = polar_xzc\n[DISPLAY]\nMAX_FEED_OVERRIDE = 0\n"
    with pytest.raises(Refusal, match=r"\[DISPLAY\] MAX_FEED_OVERRIDE = 0: must be above 0"):
        axes_of(ini_of(face).get, "X")
    assert spindle_c_timeout(ini_of("").get) == 30
    assert spindle_c_timeout(ini_of("[SPINDLE_C]\nTIMEOUT = 5 # s\n").get) == 5
    for text in ("", "soon", "0", "-5", "1e9"):
        rule = "must be above 0, 3600 at most" if text[-1:].isdigit() else "must be a number"
        with pytest.raises(Refusal, match=r"\[SPINDLE_C\] TIMEOUT = .*: " + rule):
            spindle_c_timeout(ini_of(f"[SPINDLE_C]\nTIMEOUT = {text}\n").get)


@pytest.mark.parametrize(
    ("units", "length"),
    [("metric", 1), ("in", 25.4), ("IMPERIAL", 25.4), ("1", 1), ("0.1 # cm", 10)],
)
def test_units(units, length):
    assert millimetres_of(ini_of(INI.format(units=units)).get) == pytest.approx(length)
    assert millimetres_of(ini_of("").get) == 1
    for refused in ("furlong", "0"):
        with pytest.raises(Refusal, match=r"LINEAR_UNITS = .*: must be mm, metric, in, inch,"):
            millimetres_of(ini_of(INI.format(units=refused)).get)


def test_coordinates():
    for text, letters in (("X Z C", "XZC"), ("xzxc", "XZC")):
        assert coordinates_of(ini_of(f"[TRAJ]\nCOORDINATES = {text}\n").get) == letters
    assert coordinates_of(ini_of("").get) == "XYZ"


def test_an_inch_machine_is_told_as_linuxcnc_tells_it():
    lengths = (25.4, 1 / 0.03937, 1, 10)
    assert [is_inch(length) for length in lengths] == [True, True, False, False]


def test_the_first_of_repeated_keys_counts_and_a_backslash_continues_a_line():
    ini = ini_of("[AXIS_X]\nMAX_LIMIT = \\\n100\nMAX_LIMIT = 300\n[AXIS_X]\nMIN_LIMIT = 1\n")
    assert axes_of(ini.get, "X")["X"] == Axis(-1e99, 100, 1, 1)


def test_the_number_of_a_code_is_linuxcncs():
    assert code_number("G12.1") == ("G", 121)


def test_a_linuxcnc_with_a_g12_1_of_its_own_is_told_at_start_up():
    remaps = [remap.code for remap in remap_lines(ini_of(INI).all)]
    refuse_owned_codes(remaps, owned=False)
    refuse_owned_codes(["G12.3", "G13.3"], owned=True)
    with pytest.raises(Refusal, match=r"REMAP = G12\.1: .*polar_g12_3\.inc"):
        refuse_owned_codes(remaps, owned=True)


@pytest.mark.parametrize(("content", "owned"), [(b"\0_kins_type\0", True), (b"\0other\0", False)])
def test_the_loaded_interpreter_tells_whether_it_owns_g12_1(tmp_path, content, owned):
    library = tmp_path / "librs274.so.0"
    library.write_bytes(content)
    maps = f"7f00-7f01 r-xp 00000000 08:01 12345    {library}\n7f02-7f03 rw-p 00000000 00:00 0 \n"
    assert owns_g12_1(maps) == owned
