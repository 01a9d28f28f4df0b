# SPDX-License-Identifier: GPL-2.0-or-later
"""Which blocks a program executes, those in the files of subs that it calls included.

LinuxCNC is made to find copies of those files that tell of their blocks, as the copy of the
program does; see `executed_blocks`.
"""

import os
import re
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from g12.machine_ini import remap_lines
from g12.tools.errors import ProgramError
from g12.tools.machine.ini import Ini
from g12.tools.preview.executed_blocks import (
    CLAMP_TOLD,
    Block,
    Text,
    blocks_in,
    clamp_events,
    lines_as_written,
    read_lines,
    reports_after,
    reports_before,
)
from g12.tools.preview.moves import Event, Trace
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
) -> tuple[list[Block], list[Event] | None, Trace]:
    """Return every execution of the blocks that matter, in order, and of the codes of C's clamp.

    The latter are None where no trace shows them. Also the trace with the tool table at each block.

    ``trace`` is the program's. Where LinuxCNC does not take the copies, the blocks of the program
    are all, with what the subs of C's clamp tell, if it takes those.
    """
    named, clamps = called_files(read_lines(program), tracer.ini), clamp_files(tracer.ini)
    subs = sorted({*map(Path, trace.files), *named}.difference(clamps))
    files = [
        each
        for each in subs
        if each.stem != CALL and codes.selected_in(read_lines(each))  # the event's own is a cycle
    ]
    for some in dict.fromkeys(((*files, *clamps), tuple(clamps), ())):
        copies = Copies(program, some)
        lines = watched_lines(copies, codes, {file.name: code for file, code in clamps.items()})
        copy = copies.trace(tracer, lines, tools, parameters, watch_offsets=True)
        ends, expected = ([move.end for move in each.moves] for each in (copy, trace))
        if ends == expected or (not some and len(ends) == len(expected)):
            blocks, clamped = blocks_in(copy, copies.texts), clamp_events(copy)
            return blocks, clamped if some and clamps else None, replace(trace, tables=copy.tables)
    raise moves_differ(program)


def moves_differ(program: Path) -> ProgramError:
    """Return the error for a program whose copy behaves differently."""
    return ProgramError(
        f"{program}: moves differently with reports between its lines:"
        " its blocks cannot be followed"
    )


class Copies:
    """A program and files of subs whose lines are to be replaced by others that tell of them.

    ``texts`` are the lines of all, those of the program first, ``lines`` as they are written.
    """

    def __init__(self, program: Path, files: Iterable[Path]) -> None:
        self.texts, self.lines = read_lines(program), lines_as_written(program)
        for file in sorted(files):
            self.texts += [text._replace(file=file.name) for text in read_lines(file)]
            self.lines += lines_as_written(file)

    def trace(
        self,
        tracer: Tracer,
        lines: Iterable[Sequence[str]],
        tools: Tools,
        parameters: Parameters,
        **options: Any,
    ) -> Trace:
        """Return the trace of copies in which ``lines`` stand for each line.

        Where there are subs, another tracer finds them.
        """
        made: dict[str, list[str]] = {"": []}
        for text, some in zip(self.texts, lines):
            made.setdefault(text.file, []).extend(some)
        program = made.pop("")
        if not made:
            return tracer.trace_text(program, parameters=parameters, **options)
        with tempfile.TemporaryDirectory(prefix="g12-verify-") as folder:
            for name, own in made.items():
                write_program(own, Path(folder) / name)
            with Tracer(shadowed(tracer.ini, folder), tools=tools) as other:
                return other.trace_text(program, parameters=parameters, **options)


def watched_lines(
    copies: Copies, codes: Codes, clamps: Mapping[str, str]
) -> Iterator[tuple[str, ...]]:
    """Yield the lines that stand for each line: those that matter tell of their blocks.

    The sub of a clamp's code, by its file's name, tells that it is called.
    """
    selected = codes.selected_in(copies.texts)
    for index, (text, line) in enumerate(zip(copies.texts, copies.lines)):
        skip = index + 1 - text.number
        if text.file in clamps:
            report = f"(DEBUG,{CLAMP_TOLD}{clamps[text.file]})"
            yield (line, report) if BEGIN.match(line) else (line,)
        elif text in selected and not text.too_long:
            yield (*reports_before(text, skip), line, *reports_after(text, skip))
        else:
            yield (line,)


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
