# SPDX-License-Identifier: GPL-2.0-or-later
"""Which blocks a program executes, those in the files of subs that it calls included.

LinuxCNC is made to find copies of those files that tell of their blocks, as the copy of the
program does; see `executed_blocks`.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from pathlib import Path

from g12.tools.machine.ini import Ini
from g12.tools.preview.executed_blocks import Block, Text, blocks_in, executed, read_lines, watched
from g12.tools.preview.moves import Trace
from g12.tools.preview.tracer import Parameters, Tools, Tracer, write_program
from g12.tools.verify.codes import CALL, Codes


def executed_everywhere(
    tracer: Tracer,
    program: Path,
    trace: Trace,
    codes: Codes,
    tools: Tools,
    parameters: Parameters = None,
) -> list[Block]:
    """Return every execution of the blocks that matter, in order.

    ``trace`` is the program's. Polar sections count in the program only. Where LinuxCNC does not
    take the copies, the blocks of the program are all.
    """
    named = called_files(read_lines(program), tracer.ini)
    files = [
        file
        for file in sorted({*map(Path, trace.files), *named})
        if file.stem != CALL and any(wanted_in_sub(text, codes) for text in read_lines(file))
    ]
    if files:
        with tempfile.TemporaryDirectory(prefix="g12-verify-") as folder:
            texts = read_lines(program) + write_copies(files, Path(folder), program, codes)
            lines = watched(program, texts, codes.wanted)
            with Tracer(shadowed(tracer.ini, folder), tools=tools) as other:
                copy = other.trace_text(lines, parameters=parameters)
        if [move.end for move in copy.moves] == [move.end for move in trace.moves]:
            return blocks_in(copy, texts)
    return executed(tracer, program, trace, codes.wanted, parameters)


def called_files(texts: Sequence[Text], ini: Ini) -> set[Path]:
    """Return the files of subs that lines call by name, and of those that these call.

    They may command a D and move nothing, which no trace shows.
    """
    folders = [ini.directory / os.path.expanduser(folder) for folder in folders_of_subs(ini)]
    found: set[Path] = set()
    waiting = [texts]
    while waiting:
        for name in {text.call for text in waiting.pop() if text.call}:
            files = (folder / f"{name}.ngc" for folder in folders)
            file = next(filter(Path.is_file, files), None)
            if file and file not in found:
                found.add(file)
                waiting.append(read_lines(file))
    return found


def wanted_in_sub(text: Text, codes: Codes) -> bool:
    """Tell whether a line of a sub's own file matters."""
    return codes.wanted(text) and not codes.section(text)


def write_copies(files: Sequence[Path], folder: Path, program: Path, codes: Codes) -> list[Text]:
    """Write copies of files that tell of their blocks; return the lines of all as text."""
    skip, found = len(read_lines(program)), []
    for file in files:
        texts = [text._replace(file=file.name) for text in read_lines(file)]
        lines = watched(file, texts, lambda text: wanted_in_sub(text, codes), skip)
        write_program(lines, folder / file.name)
        skip, found = skip + len(texts), found + texts
    return found


def folders_of_subs(ini: Ini) -> list[str]:
    """Return where LinuxCNC looks for the files of subs, in that order."""
    subs = ini.get("RS274NGC", "SUBROUTINE_PATH", "").split(":")
    return list(filter(None, (ini.get("DISPLAY", "PROGRAM_PREFIX"), *subs)))


def shadowed(ini: Ini, folder: str) -> Ini:
    """Return an INI whose subs are looked for in a folder first, then where they were."""
    path = ":".join(folders_of_subs(ini))
    return ini.replaced(
        {"DISPLAY": {"PROGRAM_PREFIX": folder}, "RS274NGC": {"SUBROUTINE_PATH": path or None}}
    )
