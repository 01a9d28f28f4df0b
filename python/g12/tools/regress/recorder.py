# SPDX-License-Identifier: GPL-2.0-or-later
"""Recorders: interpreters, each a process, that record and compare programs in parallel."""

import contextlib
import hashlib
import time
from collections import defaultdict
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from dataclasses import dataclass, field
from pathlib import Path
from typing import Self

from g12.tools.errors import ProgramError, UsageError
from g12.tools.machine.filter import opened_program
from g12.tools.machine.ini import Ini, read_ini
from g12.tools.path.part import part_of
from g12.tools.preview.loading import linuxcnc_version, python_error
from g12.tools.preview.moves import Move
from g12.tools.preview.source_lines import trace_in_source
from g12.tools.preview.tracer import TraceFailure, Tracer
from g12.tools.progress import Report, silent
from g12.tools.regress.differences import Difference, Tolerance, differences
from g12.tools.regress.recording_text import (
    Recording,
    TraceTextError,
    read_recording,
    recording_of,
    split_facts,
    text_of,
)
from g12.tools.regress.recordings import Baseline
from g12.tools.units import counted_as, name_of_unit

SAME, CHANGED, NEW, ADDED, MISSING, FAILED = "same", "changed", "new", "added", "missing", "failed"
HASH_DIGITS = 16
KILL_PERIOD = 0.1  # s


@dataclass(frozen=True)
class Terms:
    """Tolerances, timeout and output of a check.

    ``ends`` is the tolerance of ends in machine units and degrees, ``feeds`` that of feeds in per
    cent; ``timeout`` is in seconds a program. ``pictures`` is a folder for pictures of changes,
    ``report`` is called with the progress.
    """

    ends: float = 1e-6
    feeds: float = 0.01
    timeout: float = 600.0
    jobs: int = 1
    pictures: Path | None = None
    report: Report = silent

    def tolerance(self, unit: float) -> Tolerance:
        """Return the tolerance of a machine whose unit is ``unit`` mm long."""
        return Tolerance(self.ends * unit, self.ends, self.feeds / 100)


@dataclass(frozen=True)
class TracedMachine:
    """The machine of traces.

    ``contents`` is a hash of INI and tool table: changed files need another interpreter.
    """

    ini: Path
    tools: Path | None
    parameters: Path | None
    linuxcnc: str
    contents: str


@dataclass(frozen=True)
class Job:
    """The programs of a folder to trace on a machine and to compare with their recordings.

    ``keep`` makes the traces the recordings.
    """

    baseline: Baseline
    machine: TracedMachine
    folder: Path
    terms: Terms
    keep: bool = False


@dataclass(frozen=True)
class Result:
    """The result of one program.

    ``summary`` describes its present motion, ``notes`` the changed files and versions since the
    recording.
    """

    program: str
    verdict: str
    findings: list[Difference] = field(default_factory=list)
    summary: str = ""
    notes: tuple[str, ...] = ()
    picture: str | None = None


def machine_of(ini: Path, tools: Path | None, parameters: Path | None) -> TracedMachine:
    contents = text_bytes(read_ini(ini)) + (tools.read_bytes() if tools else b"")
    return TracedMachine(ini, tools, parameters, linuxcnc_version(), hash_of(contents))


def text_bytes(ini: Ini) -> bytes:
    return ini.text.encode(errors="surrogateescape")


class Recorder:
    """A running interpreter that makes recordings on one machine."""

    def __init__(self, machine: TracedMachine) -> None:
        self._machine = machine
        self.ini = ini = read_ini(machine.ini)
        self.part = part_of(ini)
        self._tracer = Tracer(ini, tools=machine.tools)
        self._check_python()
        self._facts = {
            "machine": f"{ini.path.name} {hash_of(text_bytes(ini))}",
            "linuxcnc": machine.linuxcnc,
            "units": name_of_unit(ini.mm),
        }

    def kill(self) -> None:
        """End the interpreter's work at a program: its text becomes a TraceFailure."""
        self._tracer.kill()

    def close(self) -> None:
        self._tracer.close()

    def _check_python(self) -> None:
        """Refuse a machine without its Python modules: it would only trace other errors."""
        error = python_error(self._tracer.printed)
        if error:
            self.close()
            raise TraceFailure(f"{self._machine.ini}: its Python modules do not load: {error}")

    def text(self, name: str, program: Path, timeout: float) -> str:
        """Return the recording of a program as text; ``timeout`` is in seconds."""
        facts = {"program": f"{name} {hash_of(program.read_bytes())}", **self._facts}
        parameters = self._machine.parameters
        try:
            with opened_program(program, self.ini) as opened:
                trace = self._tracer.trace(
                    opened.path, parameters=parameters, timeout=timeout, alone=True
                )
                return text_of(recording_of(trace_in_source(trace, opened), opened.listed, facts))
        except ProgramError as problem:
            raise TraceFailure(str(problem)) from None


class Recorders:
    """The running interpreters, as many of a machine as work in parallel.

    All of them end with the ``with`` block.
    """

    def __init__(self) -> None:
        self._idle: defaultdict[TracedMachine, list[Recorder]] = defaultdict(list)
        self._all: list[Recorder] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_exception: object) -> None:
        for recorder in self._all:
            recorder.close()

    def kill(self) -> None:
        for recorder in self._all:
            recorder.kill()

    @contextlib.contextmanager
    def one_of(self, machine: TracedMachine) -> Iterator[Recorder]:
        try:
            recorder = self._idle[machine].pop()
        except IndexError:
            recorder = Recorder(machine)
            self._all.append(recorder)
        yield recorder
        self._idle[machine].append(recorder)


def hash_of(content: bytes) -> str:
    """Return a short hash to distinguish two versions of a file."""
    return f"sha256:{hashlib.sha256(content).hexdigest()[:HASH_DIGITS]}"


def trace_and_compare(job: Job, name: str, recorders: Recorders) -> Result:
    """Return the result of a program's trace; store it if the job keeps it."""
    with recorders.one_of(job.machine) as recorder:
        try:
            now = recorder.text(name, job.folder / name, job.terms.timeout)
        except TraceFailure as failure:
            text = f"no trace: {str(failure).splitlines()[0]}"
            return Result(name, FAILED, [Difference("failed", text)])
        result = _compared(job, name, now, recorder)
    if job.keep:
        job.baseline.keep(name, now)
    return result


def _compared(job: Job, name: str, now: str, recorder: Recorder) -> Result:
    path = job.baseline.trace_file(name)
    if not path.exists():
        return Result(name, NEW, summary=_summary(read_recording(now)))
    try:
        was = path.read_bytes().decode(errors="surrogateescape")
        facts, body = split_facts(was)
        new_facts, new_body = split_facts(now)
        notes = tuple(_notes(facts, new_facts))
        if body == new_body:
            return Result(name, SAME, notes=notes)
        recordings = read_recording(was), read_recording(now)
    except TraceTextError as problem:
        if job.keep:
            return Result(name, NEW, summary=_summary(read_recording(now)))
        raise UsageError(f"{path}: not a trace, or one that was edited: {problem}") from None
    tolerance = job.terms.tolerance(recorder.ini.mm)
    found = differences(*recordings, tolerance, recorder.part)
    picture = None
    if found and job.terms.pictures:
        picture = _picture(job.terms.pictures, name, *recordings, found, recorder)
    verdict = CHANGED if found else SAME
    return Result(name, verdict, found, _summary(recordings[1]), notes, picture)


def _notes(was: dict[str, str], now: dict[str, str]) -> Iterator[str]:
    if was["linuxcnc"] != now["linuxcnc"]:
        yield f"LinuxCNC {was['linuxcnc']} when recorded, {now['linuxcnc']} now"
    if was["machine"] != now["machine"]:
        yield f"{now['machine'].rpartition(' ')[0]} has changed since the recording"
    if was["units"] != now["units"]:
        yield f"machine units {was['units']} when recorded, {now['units']} now"


def _summary(recording: Recording) -> str:
    moves = sum(isinstance(step, Move) for step in recording.steps)
    error = recording.error
    return f"refused at line {error.line}: {error.rule}" if error else counted_as(moves, "move")


def _picture(
    folder: Path, name: str, was: Recording, now: Recording, found, recorder: Recorder
) -> str:
    """Draw the differences; matplotlib takes a while to load."""
    from g12.tools.plot.style import save
    from g12.tools.regress.overlay import draw_overlay

    path = folder / f"{name}.png"
    path.parent.mkdir(parents=True, exist_ok=True)
    save(draw_overlay(was, now, found, recorder.part), path)
    return str(path)


def results(job: Job, names: Sequence[str], recorders: Recorders) -> list[Result]:
    largest_first = sorted(names, key=lambda name: -(job.folder / name).stat().st_size)
    found = {}
    with ThreadPoolExecutor(job.terms.jobs) as pool:
        futures = [pool.submit(trace_and_compare, job, name, recorders) for name in largest_first]
        try:
            for done, future in enumerate(as_completed(futures), start=1):
                result = future.result()
                found[result.program] = result
                job.terms.report(f"{done} of {len(names)}: {result.program}")
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            _kill_running(futures, recorders)
            raise
    return [found[name] for name in names]


def _kill_running(futures: Sequence[Future], recorders: Recorders) -> None:
    """End unfinished jobs; an interpreter may just be starting."""
    while any(future.running() for future in futures):
        recorders.kill()
        time.sleep(KILL_PERIOD)
