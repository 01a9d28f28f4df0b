# SPDX-License-Identifier: GPL-2.0-or-later
"""Recorders: interpreters, each a process, that record and compare programs in parallel."""

import contextlib
import hashlib
import threading
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from g12.tools.errors import ProgramError, UsageError
from g12.tools.machine.filter import opened_program
from g12.tools.machine.ini import Ini
from g12.tools.path.part import part_of
from g12.tools.preview.moves import Move
from g12.tools.preview.tracer import TraceFailure, Tracer, linuxcnc_version, python_error
from g12.tools.progress import Report, silent
from g12.tools.regress.differences import TOLERANCE, Difference, Tolerance, differences
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
    """The tolerance and output of a check, the timeout of each program in seconds.

    ``pictures`` is a folder for pictures of changes, ``report`` is called with the progress.
    """

    tolerance: Tolerance = TOLERANCE
    timeout: float = 600.0
    jobs: int = 1
    pictures: Path | None = None
    report: Report = silent


@dataclass(frozen=True)
class Job:
    """The programs of a folder to trace on a machine and to compare with their recordings.

    ``tools`` and ``parameters`` are the tool table and var file to use. ``keep`` makes the traces
    the recordings.
    """

    baseline: Baseline
    folder: Path
    ini: Ini
    tools: Path | None
    parameters: Path | None
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


class Recorders:
    """The interpreters that make a job's recordings, one for each thread."""

    def __init__(self, job: Job) -> None:
        self._job, self._own = job, threading.local()
        self._linuxcnc = linuxcnc_version()
        self._tracers: list[Tracer] = []

    def result(self, name: str) -> Result:
        """Return the result of a program's trace; store it if the job keeps it."""
        tracer = self._tracer()
        try:
            now = self._text(name, tracer)
        except TraceFailure as failure:
            text = f"no trace: {str(failure).splitlines()[0]}"
            return Result(name, FAILED, [Difference("failed", text)])
        result = _compared(self._job, name, now)
        if self._job.keep:
            self._job.baseline.keep(name, now)
        return result

    def _text(self, name: str, tracer: Tracer) -> str:
        job, program, ini = self._job, self._job.folder / name, self._job.ini
        facts = {
            "program": f"{name} {hash_of(program.read_bytes())}",
            "machine": f"{ini.path.name} {hash_of(ini.text.encode(errors='surrogateescape'))}",
            "linuxcnc": self._linuxcnc,
            "units": name_of_unit(ini.mm),
        }
        facts = {fact: " ".join(text.split()) for fact, text in facts.items()}  # each one line
        options: dict[str, Any] = {"parameters": job.parameters, "timeout": job.terms.timeout}
        try:
            with opened_program(program, ini) as opened:
                trace = tracer.trace(opened.path, alone=True, **options).in_source(opened)
                return text_of(recording_of(trace, opened.listed, facts))
        except ProgramError as problem:
            raise TraceFailure(str(problem)) from None

    def _tracer(self) -> Tracer:
        """Return this thread's interpreter; refuse a machine whose Python modules do not load."""
        if not hasattr(self._own, "tracer"):
            self._own.tracer = Tracer(self._job.ini, tools=self._job.tools)
            self._tracers.append(self._own.tracer)
            error = python_error(self._own.tracer.printed)
            if error:
                raise UsageError(f"{self._job.ini.path}: its Python modules do not load: {error}")
        return self._own.tracer

    def kill(self) -> None:
        """End the work at programs, each a TraceFailure."""
        for tracer in self._tracers:
            tracer.kill()

    def close(self) -> None:
        for tracer in self._tracers:
            tracer.close()


def hash_of(content: bytes) -> str:
    """Return a short hash to distinguish two versions of a file."""
    return f"sha256:{hashlib.sha256(content).hexdigest()[:HASH_DIGITS]}"


def _compared(job: Job, name: str, now: str) -> Result:
    path, terms = job.baseline.trace_file(name), job.terms
    if not path.exists():
        return Result(name, NEW, summary=_summary(read_recording(now)))
    try:
        was = path.read_bytes().decode(errors="surrogateescape")
        (facts, body), (new_facts, new_body) = split_facts(was), split_facts(now)
        notes = tuple(_notes(facts, new_facts))
        if body == new_body:
            return Result(name, SAME, notes=notes)
        recordings = read_recording(was), read_recording(now)
    except TraceTextError as problem:
        if job.keep:
            return Result(name, NEW, summary=_summary(read_recording(now)))
        raise UsageError(f"{path}: not a trace, or one that was edited: {problem}") from None
    part = part_of(job.ini)
    found = differences(*recordings, terms.tolerance, part)
    picture = terms.pictures / f"{name}.png" if found and terms.pictures else None
    if picture:
        _draw(picture, *recordings, found, part)
    verdict, drawn = CHANGED if found else SAME, str(picture) if picture else None
    return Result(name, verdict, found, _summary(recordings[1]), notes, drawn)


def _notes(was: dict[str, str], now: dict[str, str]) -> Iterator[str]:
    if was["linuxcnc"] != now["linuxcnc"]:
        yield f"LinuxCNC {was['linuxcnc']} when recorded, {now['linuxcnc']} now"
    if was["machine"] != now["machine"]:
        yield f"{now['machine'].rpartition(' ')[0]} has changed since the recording"


def _summary(recording: Recording) -> str:
    moves = sum(isinstance(step, Move) for step in recording.steps)
    error = recording.error
    return f"refused at line {error.line}: {error.rule}" if error else counted_as(moves, "move")


def _draw(picture: Path, *overlay: Any) -> None:
    from g12.tools.plot.style import save  # matplotlib takes a while to load
    from g12.tools.regress.overlay import draw_overlay

    picture.parent.mkdir(parents=True, exist_ok=True)
    save(draw_overlay(*overlay), picture)


def results(job: Job, names: Sequence[str]) -> list[Result]:
    largest_first = sorted(names, key=lambda name: -(job.folder / name).stat().st_size)
    found = {}
    with (
        contextlib.closing(Recorders(job)) as recorders,
        ThreadPoolExecutor(job.terms.jobs) as pool,
    ):
        futures = [pool.submit(recorders.result, name) for name in largest_first]
        try:
            for done, future in enumerate(as_completed(futures), start=1):
                result = future.result()
                found[result.program] = result
                job.terms.report(f"{done} of {len(names)}: {result.program}")
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            while any(future.running() for future in futures):
                recorders.kill()  # again: an interpreter may just be starting
                time.sleep(KILL_PERIOD)
            raise
    return [found[name] for name in names]
