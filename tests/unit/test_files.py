# SPDX-License-Identifier: GPL-2.0-or-later
"""Writing a user's files."""

from g12.tools.machine.files import write


def test_what_a_killed_write_left_goes_with_the_next_one(tmp_path):
    for name in (".axis.ini.g12-a_b1c2d3", ".axis.ini.original", ".other.ini.g12-a_b1c2d3"):
        (tmp_path / name).touch()
    write(tmp_path / "axis.ini", b"new")
    kept = {".axis.ini.original", ".other.ini.g12-a_b1c2d3", "axis.ini"}
    assert {path.name for path in tmp_path.iterdir()} == kept
