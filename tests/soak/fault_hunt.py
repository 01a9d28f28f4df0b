# SPDX-License-Identifier: GPL-2.0-or-later
"""Faults that nobody chose against verify: which of those that change the motion it does not find.

    PYTHONPATH=python:tests /usr/bin/python3 -m soak.fault_hunt --count 200 --seed 1 2>misses
    PYTHONPATH=python:tests /usr/bin/python3 -m soak.fault_hunt --again misses

Each mutant of the planners, handlers and subs is put alone into a copy of the package and tried
with programs that run it. A trace that is about the same is no difference, nor is one that goes the
same way in other pieces; one that ends in an error is refused; of any other verify should find
something. A miss is to be judged by a reader: another path may be as right as the one before. Those
that were found so stand in `right_mutants.toml`.
"""

import argparse
import contextlib
import functools
import json
import random
import resource
import shutil
import signal
import sys
import tempfile
import tomllib
import traceback
from collections import Counter, defaultdict
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

from g12.tools.errors import ProgramError, UsageError
from g12.tools.path.farthest_apart import gap_between
from g12.tools.path.part import part_of, part_of_program
from g12.tools.path.track import limits_of, track
from g12.tools.preview.tracer import TraceFailure, Tracer
from g12.tools.regress.differences import differences
from g12.tools.regress.edits import Tolerance
from g12.tools.regress.recording_text import Note, recording_of
from g12.tools.units import name_of_unit
from g12.tools.verify.proof import prove
from soak import little_mutants, mutants, ngc_mutants
from soak.mutants import Mutant
from support.fault_tables import FOLDERS, TABLES, MachinedProgram, program_of, sample_of
from support.right_programs import MACHINES, SETTINGS, right_program
from support.sim_machines import PROGRAMS, ROOT

ROOMS = ("request", "cycles", "polar", "moves", "flat", "section", "cylinder")
ROOMS += ("host", "host/handlers", "host/section", "ngc")
LEFT_OUT = ("messages", "machine", "modes", "loading", "face_by_hand", "shapes")  # of host
POCKETS, SECTIONS = ("haas", "yasnac", "mitsubishi", "mill"), ("G12.1", "G7.1")
USED_BY = {  # by what stands in a module's name, the first that does; else by its room
    "haas": ("haas",),
    "entry": ("haas",),
    "helix": ("haas",),
    "yasnac": ("yasnac",),
    "mitsubishi": ("mitsubishi",),
    "circle_mill": ("mill",),
    "skipped_over": SECTIONS,
    "cycle": POCKETS,
    "polar": ("G12.1",),
    "kinematics": ("G12.1",),
    "cylinder": ("G7.1",),
    "cycles/": POCKETS,
    "request/": POCKETS,
}
SAME = Tolerance(length=0.005, angle=0.01, feed=0.005)
SECONDS = 60.0
PIECES_IN_ONE = 4  # pockets or sections of a random program
MEMORY = 4 << 30
NOTES_LINES = """\
import sys
def note(frame, event, _, seen=set(), file=open({path!r}, "a", buffering=1)):
    place = frame.f_code.co_filename.rpartition("/python/g12/")[2], frame.f_lineno
    if event == "line" and place not in seen:
        seen.add(place)
        print(*place, file=file)
    return note
sys.settrace(lambda frame, *_: note if "/python/g12/" in frame.f_code.co_filename else None)
"""
FOUND, MISSED, REFUSED, ALIKE, RIGHT = "found", "MISSED", "refused", "no difference", "right"
PIECES, CRASHED = "other pieces", "CRASHED"
WORST = (CRASHED, MISSED, FOUND, RIGHT, PIECES, REFUSED, ALIKE)
SAME_TIME = 0.02
FEED, RAPID, PATH_CONTROL = "feed_rate", "rapid", "G6"


class Fault(NamedTuple):
    """A mutant of a file of the package."""

    file: str
    mutant: Mutant

    @property
    def room(self):
        """Where it is: a room of the package, or ngc."""
        return self.file.split("/")[-2]

    @property
    def name(self):
        """What a list calls it."""
        return f"{self.file} {self.mutant.name}"

    @property
    def maker(self):
        """The module that makes such mutants."""
        if self.file.endswith(".ngc"):
            return ngc_mutants
        return little_mutants if self.mutant.new.startswith(little_mutants.LARGER) else mutants

    @property
    def kinds(self):
        """The kinds of programs that may use its file."""
        own = self.file.removeprefix("python/g12/")
        return next((kinds for part, kinds in USED_BY.items() if part in own), SECTIONS)


def faults(rooms=ROOMS, seed=0):
    """Return all mutants of the rooms in the order in which they are tried."""
    files = [
        path
        for room in rooms
        for path in sorted((ROOT / "python" / "g12" / room).glob("*.py"))
        if path.stem not in LEFT_OUT
    ]
    if "ngc" in rooms:
        files += [*sorted((ROOT / "ngc").glob("g12_*.ngc")), ROOT / "ngc" / "circle_mill.ngc"]
    groups = defaultdict(list)
    for path in files:
        name, source = path.relative_to(ROOT).as_posix(), path.read_text()
        makers = (ngc_mutants,) if path.suffix == ".ngc" else (mutants, little_mutants)
        found = [Fault(name, mutant) for maker in makers for mutant in maker.mutants_of(source)]
        groups[path.parent.name] += found
    chance = random.Random(seed)
    for found in groups.values():
        chance.shuffle(found)
    return [fault for row in zip_all(groups.values()) for fault in row]


def zip_all(lists):
    """Yield the first of each list, then the second of each, until all are used up."""
    for index in range(max(map(len, lists), default=0)):
        yield [some[index] for some in lists if index < len(some)]


def right():
    """Return the mutants whose other motion a reader found to be right, each with the reason."""
    table = tomllib.loads(Path(__file__).with_name("right_mutants.toml").read_text())
    return {
        f"{file} {name}": reason for file, names in table.items() for name, reason in names.items()
    }


def programs(seed):
    """Return the programs: those that are here, and random ones in which nothing is wrong."""
    every = [program_of(table, name) for table in TABLES for name in TABLES[table]["programs"]]
    for folder in FOLDERS:
        every += map(sample_of, sorted((PROGRAMS / folder).glob("*.ngc")))
    every += [drawn(kind, seed) for kind in MACHINES]
    return [program for program in every if "o<polar_" not in program.text]


def drawn(kind, seed):
    """Return a random program of a kind."""
    text = right_program(kind, random.Random(f"{seed} {kind}"), PIECES_IN_ONE)
    return MachinedProgram(f"random/{kind}", text, MACHINES[kind], SETTINGS.get(kind, {}), None)


def kinds_of(program):
    """Return which cycles and sections a program uses."""
    text, machine = program.text.replace("G07.1", "G7.1"), program.machine
    found = {kind for kind in SECTIONS if kind in text}
    if any(code in text for code in ("G12.2", "G13.2", "circle_mill")):
        found.add("mill")
    if machine.startswith("mill") and ("G12 " in text or "G13 " in text):
        found.add(next((kind for kind in ("yasnac", "mitsubishi") if kind in machine), "haas"))
    return found


class Hunt:
    """A copy of the package in which one mutant after the other is tried."""

    def __init__(self, folder, seed):
        self.folder = Path(folder)
        for part in ("configs", "ngc", "python"):
            shutil.copytree(ROOT / part, self.folder / part)
        self._of_kind = defaultdict(list)
        self._sound = {}
        self._run = {}
        for program in programs(seed):
            for kind in kinds_of(program):
                self._of_kind[kind].append(program)

    def programs_of(self, fault, count):
        """Return some of the programs that run a fault, always the same ones."""
        every = {
            program.name: program
            for kind in fault.kinds
            for program in self._of_kind[kind]
            if self.sound(program) and self.runs(program, fault)
        }
        chosen = random.Random(fault.name).sample(sorted(every), min(count, len(every)))
        return [every[name] for name in chosen]

    def tried(self, fault, count):
        """Yield for programs what comes of a fault: the program's name, a verdict, and texts."""
        chosen = self.programs_of(fault, count)
        path = self.folder / fault.file
        source = path.read_text()
        path.write_text(fault.maker.mutated(source, fault.mutant))
        try:
            for program in chosen:
                yield (program.name, *self._verdict(program))
        finally:
            path.write_text(source)

    def runs(self, program, fault):
        """Tell whether a program runs the line that a fault is in; of a sub that is not known."""
        if fault.room == "ngc":
            return True
        if program.name not in self._run:
            self._run[program.name] = self._lines_of(program)
        line = f"{fault.file.removeprefix('python/g12/')} {fault.mutant.line}"
        return line in self._run[program.name]

    def _lines_of(self, program):
        """Return the lines of the package that a program runs, each behind its file."""
        toplevel, noted = self.folder / "python" / "toplevel.py", self.folder / "lines"
        source = toplevel.read_text()
        noted.write_text("")
        toplevel.write_text(NOTES_LINES.format(path=str(noted)) + source)
        self._recorded(program)
        toplevel.write_text(source)
        return set(noted.read_text().splitlines())

    def sound(self, program):
        """Return the recording of a program without a fault, None if verify finds something."""
        if program.name not in self._sound:
            recorded = self._recorded(program)
            good = not isinstance(recorded, str) and not self._findings(program)
            self._sound[program.name] = recorded if good else None
        return self._sound[program.name]

    def _recorded(self, program):
        """Return the recording and the trace of a program, or the text of an error."""
        ini, path = program.ini(self.folder), program.written(self.folder)
        try:
            with Tracer(ini, tools=program.tools) as tracer:
                traced = tracer.trace(path, timeout=SECONDS)
        except TraceFailure as problem:
            return str(problem).splitlines()[0]
        if traced.error:
            return traced.error.rule
        facts = {"units": name_of_unit(ini.mm), "program": program.name}
        recording = recording_of(traced, path, facts)
        steps = [step for step in recording.steps if not is_message(step)]
        return recording.__class__(facts, steps, recording.blocks, end=ends(traced)), traced

    def _findings(self, program):
        """Return what verify finds in a program."""
        ini, path = program.ini(self.folder), program.written(self.folder)
        return [text for _, text in prove(path, ini, tools=program.tools).findings]

    def _verdict(self, program):
        now = self._recorded(program)
        if isinstance(now, str):
            return REFUSED, [now], []
        was = self._sound[program.name]
        told = changes(was, now, program.ini(self.folder))
        if not told:
            return ALIKE, [], []
        try:
            with at_most(SECONDS):
                found = self._findings(program)
        except (ProgramError, UsageError) as problem:
            found = [str(problem)]
        except Exception:  # of verify, whatever it is: that is what is looked for
            return CRASHED, traceback.format_exc().splitlines()[-3:], told
        pieces = not found and has_other_pieces(was[1], now[1], program.ini(self.folder))
        return (PIECES if pieces else FOUND if found else MISSED), found, told


def changes(was, now, ini):
    """Return in words how a program moves otherwise than before, nothing if it does not."""
    (before, trace), (after, other) = was, now
    told = [each.text for each in differences(before, after, SAME, part_of(ini))]
    exact = [[move.exact for move in traced.moves] for traced in (trace, other)]
    if len(exact[0]) == len(exact[1]) and exact[0] != exact[1]:
        told.append(f"{sum(a != b for a, b in zip(*exact))} moves end otherwise (exact stop)")
    return told


def has_other_pieces(trace, other, ini):
    """Tell whether each line goes the same way in about the same time, in other pieces alone.

    It may end more exactly than before, too.
    """
    part, limits = part_of_program(ini, trace), limits_of(ini)
    tolerance = ini.settings.tolerance(ini.mm) * ini.mm + SAME.length
    runs = [lines_run(part, traced, limits) for traced in (trace, other)]
    acts = [
        [event.text for event in traced.events if not event.text.startswith(PATH_CONTROL)]
        for traced in (trace, other)
    ]
    alike = acts[0] == acts[1] and ends(trace) == ends(other)
    if not alike or [run[0] for run in runs[0]] != [run[0] for run in runs[1]]:
        return False
    for (_, moves, seconds), (_, others, now) in zip(*runs):
        gap = gap_between(part, moves, others)
        off = gap is None or gap.size > tolerance or abs(now - seconds) > SAME_TIME * seconds
        if off or moves[-1].exact > others[-1].exact:
            return False
    return True


def lines_run(part, traced, limits):
    """Return the runs of moves of a line each: what they are, the moves, and their seconds."""
    path = track(part, traced.moves, limits, traced.modes.speed)
    runs = groupby(enumerate(traced.moves), key=lambda pair: (pair[1].line, pair[1].kind == RAPID))
    found = ((key, [index for index, _ in run]) for key, run in runs)
    return [
        (key, [traced.moves[index] for index in run], sum(map(path.seconds, run)))
        for key, run in found
    ]


def is_message(step):
    """Tell whether a step only tells the operator something."""
    return isinstance(step, Note) and not step.text.startswith(("G", "M", "S", "tool", "dwell"))


def ends(traced):
    """Return the modes at a program's end."""
    modes = traced.modes
    return " ".join((*modes.gcodes, *modes.mcodes, f"F{traced.state[FEED]:.4g}"))


@contextlib.contextmanager
def at_most(seconds):
    """Raise TimeoutError in what takes longer."""

    def end(*_):
        raise TimeoutError(f"no end within {seconds:g} s")

    before = signal.signal(signal.SIGALRM, end)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def run(chosen, seed, *, count=3, tell=print, log=None):
    """Try faults with ``count`` programs each; return how many came to what, by room."""
    known, found = right(), defaultdict(Counter)
    with tempfile.TemporaryDirectory(prefix="g12-hunt-") as folder:
        hunt = Hunt(folder, seed)
        for fault in chosen:
            verdicts = set()
            for program, verdict, texts, told in hunt.tried(fault, count):
                if verdict == MISSED and fault.name in known:
                    verdict = RIGHT
                if log:
                    print(json.dumps([verdict, fault.name, program, texts, told]), file=log)
                    log.flush()
                if verdict in (MISSED, CRASHED):
                    tell(f"{verdict} {program}: {fault.name}: {'; '.join([*texts, *told])[:600]}")
                verdicts.add(verdict)
            if verdicts:
                found[fault.room][min(verdicts, key=WORST.index)] += 1
    return {room: dict(counts) for room, counts in found.items()}


def main():
    """Print what comes of faults by room, and those that verify misses."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--count", type=int, help="so many faults, in turn of each room")
    parser.add_argument("--seed", default="0")
    parser.add_argument("--rooms", nargs="+", default=ROOMS, choices=ROOMS)
    parser.add_argument("--programs", type=int, default=3, help="for each fault at most")
    parser.add_argument("--again", type=Path, help="those alone that this file names")
    parser.add_argument("--log", type=argparse.FileType("w"), help="every try, a line of JSON each")
    options = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    chosen = faults(options.rooms, options.seed)
    if options.again:
        text = options.again.read_text()
        chosen = [fault for fault in chosen if f": {fault.name}: " in text]
    tell = functools.partial(print, file=sys.stderr, flush=True)
    told = {"tell": tell, "log": options.log}
    found = run(chosen[: options.count], options.seed, count=options.programs, **told)
    print(json.dumps(found))


if __name__ == "__main__":
    main()
