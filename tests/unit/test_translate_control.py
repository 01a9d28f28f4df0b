# SPDX-License-Identifier: GPL-2.0-or-later
"""Controls as data: what a file may say, and where it is wrong."""

import pytest

from g12.tools.translate.blocks.control import ControlError, read_control


@pytest.fixture
def control(tmp_path):
    """Return a function: the control of a text based on haas-mill."""

    def read(text, base="haas-mill"):
        path = tmp_path / "own.toml"
        path.write_text(f'based_on = "{base}"\n{text}', encoding="utf-8")
        return read_control(str(path))

    return read


@pytest.mark.parametrize(
    ("text", "line", "rule"),
    [
        ("colour = 1\n", 2, "colour is no key of a control"),
        ("[dwell]\nsecond = 'X'\n", 3, "second is no key of [dwell]: seconds, milliseconds"),
        ("decimals = 'some'\n", 2, "decimals = 'some' must be one of least, whole"),
        ("axes = 'XYQ'\n", 2, "axes = 'XYQ' must be letters of X Y Z A B C, each once"),
        ("start = 'G17 9'\n", 2, "start = 'G17 9' must be codes such as G17"),
        ("remarks = 1\n", 2, "remarks = 1 must be true or false"),
        ("[increments]\nangle = -1\n", 3, "angle = -1 must be a number above 0"),
        ("[tools]\npatterns = ['OOT']\n", 3, "patterns = ['OOT'] must be patterns such as TTOO"),
        ("[words]\nSBX = 'S'\n", 3, "SBX = 'S' must be a word of two letters, and one of one"),
        ("[m_codes]\nM31 = 'bin'\n", 3, 'M31 = "bin" must be one of same, comment, machine'),
        ("[m_codes]\nX31 = 'same'\n", 3, "X31 is no M code such as M31, or M31-M33"),
        ("[m_codes]\nM1-M3 = 'same'\nM2 = 'comment'\n", 4, "M2 has two meanings"),
        ("[m_codes]\nM52 = 'machine'\n", 3, "M52 is LinuxCNC's own: no machine can give it"),
        ("[m_codes]\nsame = 'M31'\n", 3, "same must be a list of codes"),
        ("[g_codes]\nG12.1 = 'polar on'\n", 3, 'a code with a point is written in quotes: "G12.1"'),
        ("[variables]\n3020 = 'time'\n", 3, "3020 = 'time' must be a number, and a parameter"),
        ("[variables]\n3020 = 5\n", 3, "3020 = 5 must be a number, and a parameter of LinuxCNC"),
        ("g_codes = 5\n", 2, "g_codes is a table: [g_codes]"),
        ("extensions = 'NC'\n", 2, "extensions = 'NC' must be as nc tap, in small letters"),
        ("start = ['G17']\n", 2, "start = ['G17'] must be codes such as G17"),
        ("[variables]\n3901 = ['#500']\n", 3, "3901 = ['#500'] must be a number"),
    ],
)
def test_a_wrong_file_is_refused_with_its_line(control, tmp_path, text, line, rule):
    with pytest.raises(ControlError) as refusal:
        control(text)
    assert str(refusal.value).startswith(f"{tmp_path / 'own.toml'}:{line}: {rule}")


def test_what_is_no_toml_is_refused_with_its_line(control):
    with pytest.raises(ControlError, match="line 2"):
        control("this is no key\n")


def test_a_control_that_is_nowhere():
    with pytest.raises(ControlError, match="no control hass-mill: translate --list"):
        read_control("hass-mill")
    with pytest.raises(ControlError, match=r"nowhere\.toml"):
        read_control("nowhere.toml")


def test_a_control_that_is_based_on_itself(tmp_path):
    path = tmp_path / "own.toml"
    path.write_text('based_on = "own.toml"\n')
    with pytest.raises(ControlError, match="is based on itself"):
        read_control(str(path))


def test_a_control_on_its_own_needs_its_tables(tmp_path):
    path = tmp_path / "own.toml"
    path.write_text('machine = "mill"\naxes = "XYZ"\n')
    with pytest.raises(ControlError, match="g_codes is missing"):
        read_control(str(path))
