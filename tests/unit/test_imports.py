# SPDX-License-Identifier: GPL-2.0-or-later
"""Who may import whom: the rooms of the package and the arrows between them."""

import ast
from pathlib import Path

import pytest

from support.sim_machines import ROOT

PACKAGE = ROOT / "python" / "g12"
LINUXCNC = ("interpreter", "emccanon", "linuxcnc", "hal", "gcode")
PLANNERS = (
    "g12.request", "g12.cycles", "g12.shapes", "g12.section", "g12.compensation", "g12.moves",
    "g12.polar", "g12.cylinder",
)  # fmt: skip
KINDS = ("g12.polar", "g12.cylinder")  # of sections
WINGS = ("g12.host", "g12.tools", "g12.remap")
FORBIDDEN = {  # room: what none of its files imports
    **dict.fromkeys(PLANNERS, (*WINGS, *LINUXCNC)),
    "g12.compensation": (*WINGS, *LINUXCNC, *KINDS, "g12.moves", "g12.cycles"),
    "g12.section": (*WINGS, *LINUXCNC, *KINDS, "g12.moves", "g12.compensation", "g12.cycles"),
    "g12.moves": (*WINGS, *LINUXCNC, *KINDS, "g12.cycles"),
    "g12.polar": (*WINGS, *LINUXCNC, "g12.cylinder", "g12.cycles"),
    "g12.cylinder": (*WINGS, *LINUXCNC, "g12.polar", "g12.cycles"),
    "g12.cycles": (*WINGS, *LINUXCNC, *KINDS, "g12.moves", "g12.section", "g12.compensation"),
    "g12.request": (*WINGS, *LINUXCNC, *(room for room in PLANNERS if room != "g12.request")),
    "g12.host": ("g12.tools", "g12.remap"),
    "g12.tools": ("g12.host", "g12.remap"),
    "g12.tools.verify": PLANNERS,
    "g12.geometry": (*WINGS, *LINUXCNC, *PLANNERS, "numpy"),
}
MOST_FILES = 17  # of a room, its __init__ among them
SHARED = [path.stem for path in PACKAGE.glob("*.py") if path.stem[:2] != "__"]


def name_of(path):
    """Return the dotted name of a file of the package."""
    name = ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts)
    return name.removesuffix(".__init__")


def imports_of(path):
    """Return the dotted names that a file imports, wherever in it."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: imports are written from g12 on"
            found |= {f"{node.module}.{alias.name}" for alias in node.names}
    return found


IMPORTS = {name_of(path): imports_of(path) for path in sorted(PACKAGE.rglob("*.py"))}


def inside(name, rooms):
    """Tell whether a name is one of the rooms, or in one."""
    return any(name == room or name.startswith(f"{room}.") for room in rooms)


@pytest.mark.parametrize("room", FORBIDDEN)
def test_no_file_of_a_room_imports_what_it_must_not(room):
    files = [name for name in IMPORTS if inside(name, [room])]
    assert files
    broken = {
        (name, imported)
        for name in files
        for imported in IMPORTS[name]
        if inside(imported, FORBIDDEN[room])
    }
    assert not broken


def test_few_files_import_what_linuxcnc_brings():
    rooms = ("g12.host", "g12.tools.headless", "g12.tools.preview.worker")
    assert all(inside(name, rooms) for name in IMPORTS if any_of_linuxcnc(name))
    assert any_of_linuxcnc("g12.tools.preview.worker")


def any_of_linuxcnc(name):
    """Return whether a file imports a module of LinuxCNC's."""
    return any(inside(imported, LINUXCNC) for imported in IMPORTS[name])


def test_the_files_that_both_wings_share_know_neither():
    shared = [f"g12.{stem}" for stem in SHARED if stem != "remap"]
    for name in shared:
        assert not any(inside(imported, (*WINGS, *PLANNERS)) for imported in IMPORTS[name]), name


def room_of(name):
    """Return the room of a file: its folder."""
    path = Path(*name.split("."))
    is_room = (PACKAGE.parent / path).is_dir()
    return name if is_room else name.rpartition(".")[0]


def test_the_arrows_between_rooms_make_no_circle():
    arrows = {}
    for name, imported in IMPORTS.items():
        known = {
            next((n for n in (i, i.rpartition(".")[0]) if n in IMPORTS), None) for i in imported
        }
        rooms = {room_of(n) for n in known - {None}} - {room_of(name), "g12", "g12.tools"}
        arrows.setdefault(room_of(name), set()).update(rooms)
    while arrows:
        last = {room for room, others in arrows.items() if not others & arrows.keys()}
        assert last, f"a circle: {arrows}"
        arrows = {room: others for room, others in arrows.items() if room not in last}


def test_no_room_is_too_large():
    files = [path.parent for path in PACKAGE.rglob("*.py")]
    large = {str(room.relative_to(PACKAGE)) for room in files if files.count(room) > MOST_FILES}
    assert not large
