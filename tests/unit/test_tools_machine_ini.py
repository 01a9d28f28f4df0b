# SPDX-License-Identifier: GPL-2.0-or-later
"""INI files as LinuxCNC reads them."""

import pytest

from g12.tools.machine.ini import IniError, read_ini


@pytest.fixture
def ini(tmp_path):
    def written(text, **others):
        for name, content in others.items():
            (tmp_path / f"{name}.inc").write_text(content)
        path = tmp_path / "machine.ini"
        path.write_text(text)
        return read_ini(path)

    return written


def test_an_include_goes_into_the_section_it_stands_in_and_its_own_stay_comments(ini):
    machine = ini(
        "[A]\nX = 1\n#INCLUDE one.inc\n#INCLUDE gone.inc\n[B]\n",
        one="Y = 2\n#INCLUDE two.inc\n",
        two="Z = 3\n",
    )
    assert machine.lines == ("[A]", "X = 1", "Y = 2", "# #INCLUDE two.inc", "[B]")


def test_replacing_adds_replaces_and_takes_out(ini):
    machine = ini("[A]\nX = 1\nX = 2\nY = 3\nZ = 4\n[B]\n").replaced(
        {"A": {"X": [5, 6], "Y": None, "Z": 7}, "C": {"NEW": "yes"}}
    )
    assert machine.all("A", "X") == ["5", "6"]
    assert machine.get("A", "Y") is None
    assert machine.get("A", "Z") == "7"
    assert machine.get("C", "NEW") == "yes"


def test_replacing_makes_no_line_longer_than_linuxcnc_reads(ini):
    half = "b" * 200
    machine = ini(f"[A]\nX = 1\nY = {half}\\\n{half}\n").replaced({"A": {"X": "a" * 600}})
    assert machine.get("A", "X") == "a" * 600
    assert machine.get("A", "Y") == 2 * half
    assert max(map(len, machine.lines)) <= 254


@pytest.mark.parametrize(
    ("text", "value"),
    [("-.5e1mm", -5), ("2.", 2), ("1e", 1)],
)
def test_a_number_is_read_as_far_as_it_goes_as_linuxcnc_does(ini, text, value):
    assert ini(f"[A]\nX = {text}\n").number("A", "X", 7) == value
    assert ini("[A]\nY = 1\n").number("A", "X", 7) == 7


@pytest.mark.parametrize(
    ("text", "read", "named"),
    [
        ("[A]\nX = abc\n", lambda ini: ini.number("A", "X", 7), r"\[A\] X = abc: must be a number"),
        ("[G12]\nPOLAR_TOLERANCE = 0.005 mm\n", lambda ini: ini.settings,
         r"\[G12\] POLAR_TOLERANCE = 0.005 mm: must be"),
        ("[TRAJ]\n#INCLUDE a\0b\n", None, "holds NUL bytes"),
    ],
)  # fmt: skip
def test_what_cannot_be_read_is_named(ini, text, read, named):
    with pytest.raises(IniError, match=rf"machine\.ini: {named}"):
        read(ini(text))


def test_files_are_relative_to_the_ini(ini, tmp_path):
    machine = ini("[EMCIO]\nTOOL_TABLE = tools/t.tbl\n")
    assert machine.file("EMCIO", "TOOL_TABLE") == tmp_path / "tools" / "t.tbl"
    assert machine.file("EMCIO", "NOTHING") is None


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(IniError, match=r"nothing\.ini: No such file"):
        read_ini(tmp_path / "nothing.ini")
