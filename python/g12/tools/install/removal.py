# SPDX-License-Identifier: GPL-2.0-or-later
"""Uninstallation: removes from a machine config exactly what `install` added."""

import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from g12.machine_ini import key_and_value, remap_from_value
from g12.tools.install import package_copy, placing
from g12.tools.install.config import features, forms, screen
from g12.tools.install.config.filters import FILTER_LINE
from g12.tools.install.config.ini_edit import (
    BEGIN_MARK,
    END_MARK,
    NEXT,
    NOW,
    WAS,
    IniLine,
    IniText,
    lines_with_ends,
    other_inis,
    to_bytes,
    without,
)
from g12.tools.install.config.loaded import codes_of, remaps_in
from g12.tools.install.lathe import kinematics_lines, spindle_c
from g12.tools.install.lathe.rules import GEOMETRY_LINE
from g12.tools.install.plan import BLOCK_NOTE, MODULE_MARK, MODULE_NOTE, PATH_NOTE, names_copy
from g12.tools.machine.files import backups_of, difference, drop_backups

OWN_ENDS = {
    "SUBROUTINE_PATH": "/ngc",
    "TOPLEVEL": "/python/toplevel.py",
    "PATH_PREPEND": "/python",
    "PATH_APPEND": "/python",
}
HEADERS = ("[PYTHON]", "[FILTER]", "[HAL]", "[G12]", "[AXIS_Y]")
OWN, HEADER, EDITED, USERS = "own", "header", "edited", "user's"  # what a line of a block is
EDITED_NOTE = "# before uninstall: "
ABORT_LINE = re.compile(rf"{features.ON_ABORT} = ({features.CALLS_ABORT_SUB}|G\S+ P)")
OWN_LINES = (
    ABORT_LINE,
    FILTER_LINE,
    GEOMETRY_LINE,
    forms.FORM_LINE,
    screen.SCREEN_LINE,
    kinematics_lines.KINEMATICS_LINE,
    spindle_c.SPINDLE_C_LINE,
)


def uninstall(text: IniText, dry_run: bool) -> Iterator[str]:
    blocks, folder = text.blocks(), text.path.parent
    copy, stopped = folder / package_copy.NAME, placing.left_beside(folder)
    if not dry_run:
        yield from placing.tidy(folder)
    package_copy.listed(copy)  # raises for a damaged list before anything is written
    notes = remove_blocks(text, blocks)
    shared = still_installed(text)
    if not blocks and not stopped and (shared or not package_copy.is_copy(copy)):
        yield f"{text.path}: nothing that install put in"
        return
    noted = [*notes_in(blocks), *(MODULE_NOTE + name for name in stopped if name.endswith(".py"))]
    modules = remove_noted(text, noted, shared)
    if package_copy.is_copy(copy):
        remove_path(text, f"{package_copy.NAME}/ngc", shared)
    files = {**dict(reversed(text.contents().items())), **modules}  # install's order, reversed
    changes = {path: content for path, content in files.items() if content != path.read_bytes()}
    for path, content in changes.items():
        yield from difference(path, content)
    yield from notes
    own = (code.line for code in codes_of(remaps_in(text)))
    needing = sorted({line.location: line for line in (*names_copy(text), *own)}.values())
    for line in needing:
        yield f"{line.location}: still needs the package: {line.text.strip()}"
    if dry_run:
        yield "dry run: nothing was written"
        return
    stays = why_stays(copy, shared, bool(needing))
    restore(files, changes, copy, bool(stays))
    for path in changes:
        backups = ", ".join(backup.name for backup in backups_of(path))
        since = f"; you changed it since, so {backups} stays" if backups else ""
        yield f"{path}: changed{since}"
    if copy.is_dir() and stays:
        yield f"{copy}: stays, {stays}"
    elif not stays:
        users = ", ".join(package_copy.files_below(copy))
        yield f"{copy}: taken away" + (f" but for what you changed: {users}" if users else "")


def restore(
    files: Mapping[Path, bytes], changes: Mapping[Path, bytes], copy: Path, stays: bool
) -> None:
    """Put the changes in place, then the user's files of a copy that does not stay."""
    with placing.folder_beside(copy.parent) as place:
        moves = [placing.stage(place, path, content, path) for path, content in changes.items()]
        if not stays:
            package_copy.build(place / copy.name, copy, {})
            moves.append((place / copy.name, copy))
        for path, content in files.items():
            drop_backups(path, content)
        placing.put_in_place(place, moves)


def why_stays(copy: Path, shared: bool, needed: bool) -> str:
    """Return why the copy of the package is not removed, "" if it is."""
    if shared:
        return "another INI of this folder uses it"
    if not package_copy.is_copy(copy):
        return f"it has no list of what install copied ({package_copy.MANIFEST})"
    needs = "lines need it that are yours; take them out and run uninstall again"
    return needs if needed else ""


def remove_blocks(text: IniText, blocks: list[list[IniLine]]) -> list[str]:
    """Remove the blocks; return notes on the user's lines between the markers, which remain.

    An entry whose value the user changed becomes a comment, because the entry before `install` is
    restored.
    """
    lines: dict[str, list[IniLine]] = {OWN: [], WAS: [], HEADER: [], EDITED: [], USERS: []}
    for block in blocks:
        for line, kind in kinds_of(block):
            lines[kind].append(line)
    removed, edited = lines[OWN], lines[EDITED]
    for header in lines[HEADER]:
        known = (*removed, *lines[HEADER], *edited)
        others = (line for line in text.section(header.text[1:-1]) if line not in known)
        if not any(key_and_value(line.text)[0] for line in others):
            removed.append(header)
    for line in lines[WAS]:
        text.replace(line, line.text[len(WAS) :])
    for line in edited:
        text.replace(line, EDITED_NOTE + line.text)
    text.remove(removed)
    changed = "you changed it, it stays as a comment"
    return [
        *(f"{line.location}: {changed}: {line.text}" for line in edited),
        *(f"{line.location}: stays, it is not by install: {line.text}" for line in lines[USERS]),
    ]


def kinds_of(block: list[IniLine]) -> Iterator[tuple[IniLine, str]]:
    """Yield the lines of a block, each with what it is."""
    texts = [line.text for line in block]
    notes = [text[len(NOW) :] for text in texts if text.startswith(NOW)]
    inserted = {text for note in notes for text in (note, *note.split(NEXT))}
    before = (text[len(WAS) :] for text in texts if text.startswith(WAS))
    replaced = {key_and_value(text)[0] for text in (*before, *inserted)}
    for line in block:
        replaces = key_and_value(line.text)[0] in replaced - {""}
        if line.text.startswith(WAS):
            yield line, WAS
        elif line.text in HEADERS:
            yield line, HEADER
        elif replaces and inserted and line.text not in inserted:
            yield line, EDITED
        else:
            yield line, OWN if replaces or is_by_install(line) else USERS


def is_by_install(line: IniLine) -> bool:
    key, value = key_and_value(line.text)
    if any(rule.fullmatch(line.text) for rule in OWN_LINES):
        return True
    if key == "REMAP":
        return features.model_of(remap_from_value(value)) is not None
    if key:
        return ":" not in value and value.endswith(OWN_ENDS.get(key, "\n"))
    return line.text.startswith((BEGIN_MARK, BLOCK_NOTE, NOW, END_MARK))


def notes_in(blocks: list[list[IniLine]]) -> list[str]:
    """Return the blocks' notes on insertions elsewhere."""
    lines = (line.text for block in blocks for line in block)
    return [text[len(BLOCK_NOTE) :] for text in lines if text.startswith(BLOCK_NOTE)]


def remove_path(text: IniText, entry: str, shared: bool) -> None:
    """Remove a folder from SUBROUTINE_PATH, unless it is alone or an include is still shared."""
    for line, _ in text.entries("RS274NGC", "SUBROUTINE_PATH")[:1]:
        if not shared or line.file == text.path:
            text.remove_from_value(line, entry)


def still_installed(text: IniText) -> bool:
    """Return whether `install` has put the package into another INI of the folder."""
    for other in other_inis(text):
        if other.blocks() or any(line.file not in text.files for line in names_copy(other)):
            return True
    return False


def without_imports(path: Path) -> bytes:
    """Return a module's content without the lines that `install` added at its end."""
    lines = lines_with_ends(path)
    ours = {index for index, line in enumerate(lines) if line.rstrip().endswith(MODULE_MARK)}
    return to_bytes(without(lines, ours))


def remove_noted(text: IniText, notes: list[str], shared: bool) -> dict[Path, bytes]:
    """Remove the noted insertions; return the user's modules that change."""
    modules = {}
    for note in notes:
        module = text.path.parent / note.removeprefix(MODULE_NOTE)
        if note.endswith(PATH_NOTE):
            remove_path(text, note.removesuffix(PATH_NOTE), shared)
        elif not shared and module.is_file():
            modules[module] = without_imports(module)
    return modules
