# SPDX-License-Identifier: GPL-2.0-or-later
"""Exact traces: a program and an INI in, the list of moves at full precision out.

LinuxCNC's own preview module interprets the program in a process of its own
(``worker.py``), so nothing here needs a running LinuxCNC or a screen.

The preview differs from a real machine in one respect that programs can read: when the units
change, it resets G64's tolerances (to 0.1), which the machine converts. (It resets F, too; the
worker restores F at the next line with a canonical call.)
"""

import contextlib
import os
import re
import shutil
import socket
import subprocess
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Self

from g12.cut_report import SectionCut
from g12.lengths import is_inch
from g12.machine_ini import AXIS_LETTERS, Remap, remap_lines
from g12.tools.channel import Channel
from g12.tools.machine.ini import Ini, Overrides, read_ini
from g12.tools.machine.tables import measured_tools, var_file
from g12.tools.preview.moves import Error, Event, Move, ReportedCut, ToolTable, Trace, modes
from g12.tools.preview.reports import read_report
from g12.tools.system import PYTHON

WORKER = Path(__file__).with_name("worker.py")
LAUNCH = (
    "import sys; sys.path[0] = {folder!r}; import worker; sys.path.pop(0); "
    "worker.serve({descriptor})"
)
# LinuxCNC prints such a line for a REMAP line that it does not load. What its interpreter does then
# is undefined: it dies, or goes on.
REFUSED_REMAP = re.compile(
    r"^(?!warning|unrecognized).*\d:REMAP = |^REMAP INI line:", re.MULTILINE | re.IGNORECASE
)
CLAMP_COMMENT = "g12 clamp "  # for the worker
NGC = re.compile(r"\bngc=(\S+)")
NO_BYTECODE = {"PYTHONDONTWRITEBYTECODE": "1"}  # nothing is written beside the INI

ProgramPath = str | os.PathLike
Tools = str | os.PathLike | Mapping[int, float] | None
Parameters = str | os.PathLike | Mapping[int, float] | None


class TraceFailure(RuntimeError):
    """The interpreter died, timed out or did not start: there is no result for the program."""


class Tracer:
    """A running interpreter for one machine; each program starts from a clean interpreter.

    ``overrides`` replaces or adds INI values, ``{"G12": {"CLEARING": "spiral"}}``; a list
    gives several lines of one key, None takes the key out.  ``tools`` is a tool table file or
    ``{tool number: diameter in machine units}`` in place of the INI's table.  Settings are read
    when LinuxCNC's Python modules load, so other overrides or tools need another Tracer.
    ``folder`` is its scratch directory. With ``reports`` the package's planners report their cuts,
    for ``Trace.cuts``, and events ``clamp M10`` show the codes of C's clamp that are subs.
    ``printed`` is the output of the interpreter and the machine's modules while loading.
    ``diameters`` are those of LinuxCNC's tool table: tool number to mm.
    """

    def __init__(
        self,
        ini: ProgramPath | Ini,
        *,
        overrides: Overrides | None = None,
        tools: Tools = None,
        reports: bool = False,
    ) -> None:
        self._scratch = tempfile.TemporaryDirectory(prefix="g12-trace-")
        self.folder = Path(self._scratch.name)
        ini = ini if isinstance(ini, Ini) else read_ini(ini)
        self.ini = ini.replaced(overrides or {})
        traced = with_told_clamp(self.ini, self.folder) if reports else self.ini
        self._machine = {**_machine(traced, tools, self.folder), "reports": reports}
        self._start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_exception: object) -> None:
        self.close()

    def trace(
        self,
        program: ProgramPath,
        *,
        setup: Iterable[str] = (),
        parameters: Parameters = None,
        timeout: float = 60.0,
        alone: bool = False,
    ) -> Trace:
        """Trace the file ``program``.

        ``setup`` holds blocks executed before it whose moves are not reported.  ``parameters``
        are numbered parameters as the var file holds them (``{5221: 10.0}`` is G54 X10 in
        machine units) or a var file; without them all are 0.  ``timeout`` is in seconds.
        ``alone`` discards the state of the machine's Python modules after the program.
        """
        request = {
            "program": str(Path(program).absolute()),
            "parameter_file": str(write_parameters(parameters, self.folder / "trace.var")),
            "setup": list(setup),
            "alone": alone,
        }
        if not self._process:
            self._start()
        with contextlib.suppress(BrokenPipeError):  # it has died and cannot answer
            self._channel.send(request)
        answer = self._answer(timeout)
        return _trace(answer, self.ini.mm)

    def trace_text(self, text: str | Iterable[str], **options) -> Trace:
        """Trace a program given as text or as lines; see ``trace``.

        Here a program need not end in M2 or %; without M2 the modal state stays as it is.
        """
        program = write_program(text, self.folder / "program.ngc")
        traced = self.trace(program, **options)
        unended = traced.error and traced.error.text == self._no_end
        return replace(traced, error=None) if unended else traced

    def kill(self) -> None:
        """End the interpreter while another thread waits for its answer, a TraceFailure."""
        process = self._process
        if process:
            process.kill()
            process.wait()  # it may still send an answer

    def close(self) -> None:
        self._stop()
        self._scratch.cleanup()

    def _start(self) -> None:
        here, there = socket.socketpair()
        launch = LAUNCH.format(folder=str(WORKER.parent), descriptor=there.fileno())
        with there, open(self._machine["output"], "ab") as output:
            self._process = subprocess.Popen(
                [PYTHON, "-c", launch],
                cwd=self.ini.directory,
                env={**os.environ, "HOME": str(self.folder), "LC_ALL": "C", **NO_BYTECODE},
                pass_fds=[there.fileno()],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=output,
            )
        self._channel = Channel(here)
        self._channel.send(self._machine)
        answer = self._answer(60.0)
        error, _ = answer["error"] or ("", 0)
        if error or REFUSED_REMAP.search(answer["printed"]):
            self.close()
            raise TraceFailure(f"{self.ini.path}: {answer['printed']}{error}")
        self.printed, self._no_end = answer["printed"], answer["no_end"]
        self.diameters = _table_in_mm(answer["tool_sizes"], self.ini.mm).diameters

    def _stop(self) -> None:
        if self._process:
            self._process.kill()
            self._process.wait()
            self._channel.close()
            self._process = None

    def _answer(self, timeout: float) -> dict:
        moves: list[Move] = []
        while isinstance(answer := self._received(timeout), list):
            moves += (Move._make(map(_frozen, move)) for move in answer)
        return {**answer, "moves": moves}

    def _received(self, timeout: float) -> dict | list:
        try:
            answer = self._channel.receive() if self._channel.is_ready(timeout) else None
        except (EOFError, ConnectionError):
            answer = {"failure": "the interpreter died"}
        if answer is None:
            answer = {"failure": f"no end within {timeout:g} s"}
        if "failure" in answer:
            self._stop()
            log = Path(self._machine["output"]).read_text(encoding="utf-8", errors="replace")
            raise TraceFailure(f"{answer['failure']}\n{log}".strip())
        return answer


def trace(
    program: ProgramPath,
    ini: ProgramPath | Ini,
    *,
    overrides: Overrides | None = None,
    tools: Tools = None,
    reports: bool = False,
    **options,
) -> Trace:
    """Trace one program file in an interpreter of its own; see ``Tracer``."""
    with Tracer(ini, overrides=overrides, tools=tools, reports=reports) as tracer:
        return tracer.trace(program, **options)


def write_program(text: str | Iterable[str], path: Path) -> Path:
    """Write a program given as text or as lines to ``path``."""
    text = text if isinstance(text, str) else "\n".join(text)
    path.write_text(text if text.endswith("\n") else text + "\n", encoding="utf-8")
    return path


def write_tools(tools: Tools, ini: Ini, path: Path) -> Path:
    """Write the tool table to use to ``path``: ``tools``, or the INI's own without them."""
    source = ini.file("EMCIO", "TOOL_TABLE") if tools is None else tools
    if isinstance(source, Mapping):
        lines = (f"T{tool} P{tool} D{diameter!r}\n" for tool, diameter in source.items())
        path.write_text("".join(lines), encoding="ascii")
    elif source and Path(source).exists():
        shutil.copyfile(measured_tools(Path(source)), path)
    else:
        path.write_text("", encoding="ascii")
    return path


def write_parameters(parameters: Parameters, path: Path) -> Path:
    if isinstance(parameters, Mapping) or parameters is None:
        lines = (f"{number}\t{value!r}\n" for number, value in sorted((parameters or {}).items()))
        path.write_text("".join(lines), encoding="ascii")
    else:
        shutil.copyfile(var_file(Path(parameters)), path)
    return path


def start_block(mm: float) -> str:
    """Return the block that task executes first, for a machine unit of ``mm``."""
    return "G20 G64 P0.001 Q0" if is_inch(mm) else "G21 G64 P0.0254 Q0"


def _machine(ini: Ini, tools: Tools, folder: Path) -> dict:
    """Return the worker's data of the machine; its files go to ``folder``."""
    expanded = folder / "machine.ini"
    expanded.write_text(ini.text, encoding="utf-8", errors="surrogateescape")
    unit, startup = ini.mm, ini.get("RS274NGC", "RS274NGC_STARTUP_CODE")
    return {
        "ini": str(expanded),
        "output": str(folder / "output.txt"),
        "tool_table": str(write_tools(tools, ini, folder / "tool.tbl")),
        "random": ini.swaps_pockets,
        "units": 1.0 / unit,
        "beside": ini.tool_beside,
        "axis_mask": sum(1 << AXIS_LETTERS.index(letter) for letter in ini.axes),
        "setup": [start_block(unit), *([startup] if startup else [])],
    }


def with_told_clamp(ini: Ini, folder: Path) -> Ini:
    """Return an INI whose preview shows the codes of C's clamp, which make no canonical call.

    The REMAP of such a code calls a sub in ``folder``: a comment, then the machine's own sub.
    """
    settings, remaps = ini.settings, remap_lines(ini.all)
    codes = {f"M{code}" for code in (*settings.c_clamp, *settings.c_clamp_shapes)}
    if not any(remap.code in codes and "ngc" in remap.keywords for remap in remaps):
        return ini
    lines = [_told(each, folder) if each.code in codes else each.text for each in remaps]
    path = ":".join(filter(None, (str(folder), ini.get("RS274NGC", "SUBROUTINE_PATH"))))
    return ini.replaced({"RS274NGC": {"REMAP": lines, "SUBROUTINE_PATH": path}})


def _told(remap: Remap, folder: Path) -> str:
    own, name = remap.keywords.get("ngc"), f"g12_told_{remap.code.lower()}"
    if not own:
        return remap.text
    text = f"o<{name}> sub\n({CLAMP_COMMENT}{remap.code})\no<{own}> call\no<{name}> endsub\n"
    (folder / f"{name}.ngc").write_text(text, encoding="utf-8")
    return NGC.sub(f"ngc={name}", remap.text)


def _table_in_mm(sizes: Sequence[Sequence], mm: float) -> ToolTable:
    """Return the tool table of the worker's sizes, which are in machine units."""
    return ToolTable(*({tool: size[at] * mm for tool, *size in sizes} for at in range(3)))


def _trace(answer: dict, mm: float) -> Trace:
    sizes = [*answer["tables"], (len(answer["moves"]), answer["tool_sizes"])]
    return Trace(
        moves=answer["moves"],
        events=[Event._make(event) for event in answer["events"]],
        error=Error._make(answer["error"]) if answer["error"] else None,
        modes=modes(answer["gcodes"], answer["mcodes"], answer["settings"]),
        position=tuple(answer["position"]),
        **{key: answer[key] for key in ("state", "printed", "globals")},
        tables=[(at, _table_in_mm(each, mm)) for at, each in sizes],
        files=tuple(answer["files"]),
        cuts=[_reported_cut(len(answer["moves"]), *cut) for cut in answer["cuts"]],
    )


def _frozen(value: Any) -> Any:
    """Return a value of JSON; a position is a tuple."""
    return tuple(value) if isinstance(value, list) else value


def _reported_cut(
    moves: int, at: int, end: int | None, line: int, last: int, c_commanded: str, texts: list[str]
) -> ReportedCut:
    """Return a cut of the worker's; without an end it is the last, in which the program failed."""
    try:
        report = read_report(*texts)
    except ValueError as error:  # of a package of another version, which the machine has
        raise TraceFailure(str(error)) from None
    own_line = line if report.file else report.line  # in a section the interpreter has read on
    last = max(last, report.line) if isinstance(report.cut, SectionCut) else report.line
    return ReportedCut(at, moves if end is None else end, own_line, last, c_commanded, report)
