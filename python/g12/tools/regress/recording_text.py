# SPDX-License-Identifier: GPL-2.0-or-later
"""Traces as text to keep under version control: one move a line, below the block it comes from.

::

    g12 trace 1
    program O60121.ngc sha256:4f0e3b7f66e5f8a1
    machine mill_inch.ini sha256:0b1d6e9d5c1f2a33
    linuxcnc 2.9.4
    units inch

    14: G12 I0.75 F10. Z-1.2 D01 (Finish pocket CW);
      feed Z-1.2 F10
      arc X0.625 centre X0.3125 turns -1
      arc centre X0 turns -1
      * message G12: …

    end: G0 G17 G40 …

Positions are machine coordinates in machine units and degrees, as in ``trace``. A move names only
the axes that change, an arc's centre only the axes on which it differs from the arc's start, and a
feed holds until the next one; so a change stays on its own lines in a diff. A line with ``*`` is an
event between moves. A refused program has ``error at LINE: TEXT`` instead of ``end``. Ten decimals
are within the precision of a double after an inch conversion; more would show rounding that differs
between builds of LinuxCNC.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from operator import itemgetter
from pathlib import Path
from typing import NamedTuple

from g12.machine_ini import AXIS_LETTERS
from g12.tools.preview.moves import IS_LENGTH, Error, Move, Position, Trace
from g12.tools.units import UNITS, Unit

STILL: Position = (0.0,) * 9
HEAD = "g12 trace 1"
FACTS = ("program", "machine", "linuxcnc", "units")
FOLDERS = re.compile(r"(?<![\w.])/(?:[^\s/:'\"<>()]+/)+")
BLOCK_LINE = re.compile(r"(\d+):(?: (.*))?")
G92_OFF = "G92.2"  # recordings of earlier versions list it
ERROR_LINE = re.compile(r"error at (\d+): (.*)")
NUMBER_TEXT = r"[-\d.]{1,40}"  # longest number: above any machine, below infinite floats
AXIS_WORDS = rf"((?: [XYZABCUVW]{NUMBER_TEXT})*)"
MOVE = re.compile(
    rf"  (rapid|feed|arc|probe){AXIS_WORDS}"
    rf"(?: centre{AXIS_WORDS} turns (-?\d+)(?: G(18|19)(?: rotation ({NUMBER_TEXT}))?)?)?"
    rf"(?: F({NUMBER_TEXT}))?(?: (G9[345]))?"
)


class TraceTextError(ValueError):
    """A text that is no trace, or an edited one."""


class Note(NamedTuple):
    """An event between two moves; ``block`` is the program's line."""

    block: int
    text: str


RecordedStep = Move | Note


@dataclass(frozen=True)
class Recording:
    """A trace with the data of its program and machine.

    ``facts`` are the lines of the head by their first word, ``blocks`` the text of the program's
    effective lines, ``steps`` moves (mm, degrees) and notes in order. ``error`` is None for a
    program that ran to its end, ``end`` then its modal state there.
    """

    facts: dict[str, str]
    steps: list[RecordedStep]
    blocks: dict[int, str] = field(default_factory=dict)
    error: Error | None = None
    end: str = ""

    @property
    def unit(self) -> Unit:
        return UNITS[self.facts["units"]]


def recording_of(trace: Trace, program: Path, facts: dict[str, str]) -> Recording:
    steps = [step for _, step in sorted(_steps(trace, UNITS[facts["units"]].mm), key=itemgetter(0))]
    lines = program.read_bytes().decode(errors="replace").split("\n")
    error = trace.error and Error(without_folders(trace.error.rule), trace.error.line)
    numbers = {step.block for step in steps} | ({error.line} if error else set())
    blocks = {line: lines[line - 1].strip() for line in numbers if 0 < line <= len(lines)}
    end = "" if error else " ".join((*trace.modes.gcodes, *trace.modes.mcodes))
    return Recording(facts, steps, blocks, error, end)


def without_folders(text: str) -> str:
    """Return a text on one line, file names in it without their folders."""
    return FOLDERS.sub("", " ".join(text.split()))


def _steps(trace: Trace, unit: float) -> Iterator[tuple[int, RecordedStep]]:
    """Yield events, tool offsets and moves, each with the index of its move."""
    for event in trace.events:
        yield event.at, Note(event.line, without_folders(event.text))
    offset = STILL
    for index, move in enumerate(trace.moves):
        if move.tool_offset != offset:
            offset = move.tool_offset
            words = [word for word in position_words(offset, unit) if word[1:] != "0"]
            yield index, Note(move.block, f"tool offset {' '.join(words) or '0'}")
        yield index, move


def number_text(value: float) -> str:
    """Return a number with up to ten decimals, without trailing zeros."""
    text = f"{value:.10f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def in_machine_units(position: Sequence[float], unit: float) -> list[float]:
    """Return a position with its lengths in units of ``unit`` mm."""
    return [at / unit if linear else at for at, linear in zip(position, IS_LENGTH)]


def position_words(position: Sequence[float], unit: float) -> list[str]:
    places = zip(AXIS_LETTERS, in_machine_units(position, unit))
    return [f"{axis}{number_text(at)}" for axis, at in places]


def feed_unit(move: Move, unit: float) -> float:
    """Return the unit of a move's feed in mm, 1 for the degrees of rotary axes that move alone."""
    ends = zip(move.start, move.end, IS_LENGTH)
    is_linear = move.kind == "arc" or any(linear and a != b for a, b, linear in ends)
    return unit if is_linear else 1.0


def step_lines(steps: Sequence[RecordedStep], unit: float) -> Iterator[str]:
    """Yield steps as lines, of a move what changes; ``unit`` is the machine unit in mm."""
    at, fed = position_words(STILL, unit), ["", "G94"]
    for step in steps:
        if isinstance(step, Note):
            yield f"  * {step.text}"
            continue
        before, at = at, position_words(step.end, unit)
        words = [step.kind, *_changed(before, at)]
        if step.kind == "arc":
            centre = _changed(before, position_words(step.centre, unit))
            words += ["centre", *centre, f"turns {step.turns}"]
            turned = f" rotation {number_text(step.rotation)}" if step.rotation else ""
            words += [f"G{step.plane}{turned}"] if step.plane != 17 else []
        if step.kind != "rapid":
            feed = f"F{number_text(step.feed / feed_unit(step, unit))}"
            known, fed = fed, [feed, step.feed_mode or "G94"]
            words += _changed(known, fed)
        yield f"  {' '.join(words)}"


def _changed(before: Sequence[str], after: Sequence[str]) -> list[str]:
    return [new for old, new in zip(before, after) if old != new]


def text_of(recording: Recording) -> str:
    lines = [HEAD, *(f"{key} {recording.facts[key]}" for key in FACTS)]
    block, error = None, recording.error
    written = step_lines(recording.steps, recording.unit.mm)
    for step, line in zip(recording.steps, written):
        if step.block != block:
            block = step.block
            lines += _block_lines(recording, block)
        lines.append(line)
    if error and error.line != block and error.line in recording.blocks:
        lines += _block_lines(recording, error.line)
    last = f"error at {error.line}: {error.text}" if error else f"end: {recording.end}"
    return "\n".join([*lines, "", last, ""])


def _block_lines(recording: Recording, block: int) -> tuple[str, str]:
    return "", f"{block}: {recording.blocks.get(block, '')}".rstrip()


class RecordingReader:
    """Reads lines back; ``unit`` is the machine unit in mm.

    ``ending`` is None before the last line, then the program's error and its modal state.
    """

    def __init__(self, unit: float) -> None:
        self.steps: list[RecordedStep] = []
        self.blocks: dict[int, str] = {}
        self.ending: tuple[Error | None, str] | None = None
        self._unit = unit
        self._block = 0
        self._at = STILL
        self._feed, self._mode = 0.0, "G94"

    def take(self, line: str) -> None:
        """Read a line, or raise ValueError."""
        start = BLOCK_LINE.fullmatch(line)
        if self.ending and line:
            raise TraceTextError("something after the end")
        if start:
            self._block = int(start.group(1))
            self.blocks[self._block] = start.group(2) or ""
        elif line.startswith("  * "):
            self.steps.append(Note(self._block, line[4:]))
        elif line.startswith("  "):
            self.steps.append(self._move(line))
        elif line:
            self.ending = _ending(line)

    def _move(self, line: str) -> Move:
        words = MOVE.fullmatch(line)
        if not words or (words[1] == "arc") != (words[3] is not None):
            raise TraceTextError("neither a move nor a note")
        kind, ends, centre, turns, plane, rotation, feed, mode = words.groups()
        start, self._at = self._at, self._position(ends, self._at)
        self._feed, self._mode = float(feed or self._feed), mode or self._mode
        move = Move(
            kind,
            line=self._block,
            block=self._block,
            start=start,
            end=self._at,
            feed=0.0,
            feed_mode="" if kind == "rapid" else self._mode,
            plane=int(plane or 17),
            tool=-1,
            tool_offset=STILL,
            centre=self._position(centre, start)[:3] if centre is not None else None,
            turns=int(turns or 0),
            rotation=float(rotation or 0.0),
        )
        is_rapid = kind == "rapid"
        return move if is_rapid else move._replace(feed=self._feed * feed_unit(move, self._unit))

    def _position(self, words: str, start: Position) -> Position:
        position = list(start)
        for word in words.split():
            axis = AXIS_LETTERS.index(word[0])
            position[axis] = float(word[1:]) * (self._unit if IS_LENGTH[axis] else 1.0)
        return tuple(position)


def _ending(line: str) -> tuple[Error | None, str]:
    error = ERROR_LINE.fullmatch(line)
    if error:
        return Error(error.group(2), int(error.group(1))), ""
    if not line.startswith("end: "):
        raise TraceTextError("neither a line of the program nor its end")
    return None, " ".join(code for code in line.split()[1:] if code != G92_OFF)


def split_facts(text: str) -> tuple[dict[str, str], str]:
    head, *lines = text.split("\n", len(FACTS) + 1)
    if head != HEAD:
        raise TraceTextError(f"line 1: not {HEAD!r}")
    facts = dict(line.partition(" ")[::2] for line in lines[: len(FACTS)])
    if tuple(facts) != FACTS or facts["units"] not in UNITS:
        raise TraceTextError(f"lines 2 to {len(FACTS) + 1}: not {', '.join(FACTS)}")
    return facts, "".join(lines[len(FACTS) :])


def read_recording(text: str) -> Recording:
    """Return the recording of a text, or raise TraceTextError with the line."""
    facts, body = split_facts(text)
    reader = RecordingReader(UNITS[facts["units"]].mm)
    for number, line in enumerate(body.split("\n"), start=len(FACTS) + 2):
        try:
            reader.take(line)
        except ValueError as problem:
            raise TraceTextError(f"line {number}: {problem}") from None
    if not reader.ending:
        raise TraceTextError("the last line, end or error, is missing")
    return Recording(facts, reader.steps, reader.blocks, *reader.ending)
