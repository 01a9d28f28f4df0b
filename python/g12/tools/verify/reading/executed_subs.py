# SPDX-License-Identifier: GPL-2.0-or-later
"""Which blocks a program executes, those in the files of subs that it calls included.

LinuxCNC is made to find copies of those files that tell of their blocks, as the copy of the
program does; see `executed_blocks`.
"""

import os
import re
import tempfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path

from g12.machine_ini import remap_lines
from g12.tools.machine.ini import Ini
from g12.tools.preview.executed_blocks import (
    CLAMP,
    TAG,
    Block,
    Text,
    blocks_in,
    executed,
    lines_as_written,
    read_lines,
    watched,
)
from g12.tools.preview.moves import Trace
from g12.tools.preview.tracer import Parameters, Tools, Tracer, write_program
from g12.tools.verify.reading.codes import CALL, Codes

BEGIN = re.compile(r"\s*o\s*<[^>]*>\s*sub\b", re.IGNORECASE)


def executed_everywhere(
    tracer: Tracer,
    program: Path,
    trace: Trace,
    codes: Codes,
    tools: Tools,
    parameters: Parameters = None,
) -> tuple[list[Block], bool]:
    """Return every execution of the blocks that matter, in order; whether C's clamp is told of.

    ``trace`` is the program's. Where LinuxCNC does not take the copies, the blocks of the program
    are all, with what the subs of C's clamp tell, if it takes those.
    """
    named, clamps = called_files(read_lines(program), tracer.ini), clamp_files(tracer.ini)
    files = files_with(codes.wanted_in, {*map(Path, trace.files), *named}.difference(clamps))
    for some in filter(None, dict.fromkeys(((*files, *clamps), tuple(clamps)))):
        copies = Copies(program, some, partial(watched_file, codes=codes, clamps=clamps))
        copy = copies.trace(tracer, tools, parameters, watch_offsets=True)
        if [move.end for move in copy.moves] == [move.end for move in trace.moves]:
            return blocks_in(copy, copies.texts), bool(clamps)
    wanted = codes.wanted_in(read_lines(program))
    return executed(tracer, program, trace, wanted.__contains__, parameters), False


def watched_file(
    path: Path, texts: Sequence[Text], codes: Codes, clamps: Mapping[Path, str], skip: int
) -> list[str]:
    """Return the lines of a file and those that tell of its blocks that matter.

    The sub of a clamp's code tells that it is called.
    """
    if path in clamps:
        told = f"(DEBUG,{TAG} {CLAMP} {clamps[path]})"
        lines = lines_as_written(path)
        return [f"{line}\n{told}" if BEGIN.match(line) else line for line in lines]
    return watched(path, texts, codes.wanted_in(texts).__contains__, skip)


class Copies:
    """A program and files of subs, all of whose lines are replaced by others that tell of them.

    ``copied`` makes a file's new lines of its path, its lines as text and the number of lines in
    the files before it. ``texts`` are the lines of all, ``lines`` as they are
    written.
    """

    def __init__(
        self, program: Path, files: Sequence[Path], copied: Callable[..., Sequence[str]]
    ) -> None:
        self.texts, self.lines = read_lines(program), lines_as_written(program)
        self._program = copied(program, self.texts, skip=0)
        self._subs: dict[str, Sequence[str]] = {}
        for file in files:
            texts = [text._replace(file=file.name) for text in read_lines(file)]
            self._subs[file.name] = copied(file, texts, skip=len(self.texts))
            self.texts += texts
            self.lines += lines_as_written(file)

    def trace(self, tracer: Tracer, tools: Tools, parameters: Parameters, **options: bool) -> Trace:
        """Return the trace of the copies; where subs are, by another tracer that finds them."""
        if not self._subs:
            return tracer.trace_text(self._program, parameters=parameters, **options)
        with tempfile.TemporaryDirectory(prefix="g12-verify-") as folder:
            for name, lines in self._subs.items():
                write_program(lines, Path(folder) / name)
            with Tracer(shadowed(tracer.ini, folder), tools=tools) as other:
                return other.trace_text(self._program, parameters=parameters, **options)


def files_with(lines: Callable[[list[Text]], object], files: Iterable[Path]) -> list[Path]:
    """Return those files of subs that have ``lines`` that matter; the event's own is a cycle."""
    return [file for file in sorted(files) if file.stem != CALL and lines(read_lines(file))]


def called_files(texts: Sequence[Text], ini: Ini) -> set[Path]:
    """Return the files of subs that lines call by name, and of those that these call.

    They may command a D and move nothing, which no trace shows.
    """
    found: set[Path] = set()
    waiting = [texts]
    while waiting:
        for name in {text.call for text in waiting.pop() if text.call}:
            file = file_of_sub(name, ini)
            if file and file not in found:
                found.add(file)
                waiting.append(read_lines(file))
    return found


def clamp_files(ini: Ini) -> dict[Path, str]:
    """Return the files of the subs that execute the codes of C's clamp, each with its code.

    None where one of them is no sub: what it does is not seen.
    """
    subs = {remap.code: remap.keywords.get("ngc", "") for remap in remap_lines(ini.all)}
    codes = [f"M{number}" for number in ini.settings.c_clamp]
    found = {file_of_sub(subs.get(code, ""), ini): code for code in codes}
    return found if all(found) and len(found) == len(codes) else {}


def file_of_sub(name: str, ini: Ini) -> Path | None:
    """Return the file that LinuxCNC takes for a sub."""
    folders = (ini.directory / os.path.expanduser(folder) for folder in folders_of_subs(ini))
    return next(filter(Path.is_file, (folder / f"{name}.ngc" for folder in folders)), None)


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
