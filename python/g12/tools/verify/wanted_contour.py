# SPDX-License-Identifier: GPL-2.0-or-later
"""The contour that a section's blocks describe, read once more apart from the planner.

A copy of the program is traced in which the section's motion is left out and every block tells
its words instead; expressions, loops, calls and conditions are LinuxCNC's own doing.

Lengths are millimetres, X a radius value. A polar contour's plane turns with the part, its first
axis is X where the section begins; that of a section on a cylinder is in `surface_pen`.
"""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

from g12.lengths import MM_PER_INCH
from g12.tools.path.part import X, Z
from g12.tools.preview.executed_blocks import (
    FORGOTTEN,
    Block,
    Text,
    after,
    before,
    blocks_in,
    is_number,
    lines_as_written,
    moves_otherwise,
    read_lines,
)
from g12.tools.preview.moves import Event
from g12.tools.preview.tracer import Parameters, Tools, Tracer
from g12.tools.verify.executed_subs import Copies, called_files, files_with
from g12.tools.verify.reading.codes import Codes, kept_state

SIDES = {40.0: 0, 41.0: 1, 42.0: -1}
CONTOUR = "XYCUHIJRZWK"
ACTING_M = {*map(float, (3, 4, 5, 7, 8, 9, 48, 49, 50, 51, 52, 53)), *map(float, range(100, 200))}
DWELL, EXACT_HERE = 4.0, 9.0
PATHS = {61.0: True, 61.1: True, 64.0: False}  # code: exact
SPINDLE = re.compile(r"\$\s*(#?-?[\d.]+|#<[^>]*>)")
ACTS = re.compile(
    r"(M\d|S|G10|G4[39]|G5\d|G92|dwell (?!0$)|message (?!G[0-9.]+: ))"
)  # of what a trace tells: what a section does
FEED_MODES = {94.0: False, 98.0: False, 95.0: True, 99.0: True}  # code: per revolution
SAVE, RESTORE, SAVE_FOR_SUB = 70.0, 72.0, 73.0
SAME_PLACE = 0.01  # mm
Place = tuple[str, int]
POSITION = "#<_", "#54"  # position parameters, which the copy of the program cannot follow


@dataclass(frozen=True)
class Element:
    """A line or an arc of the contour; an arc has a ``centre`` and a signed ``sweep``.

    ``side`` is +1 with the tool on the left (G41), -1 on the right, 0 without compensation;
    ``ramp`` says that compensation is switched on or off along it. ``depth`` is Z at its end,
    ``feed`` along it in mm/min, None where the words do not say. A move of Z alone has no length.
    ``exact`` says whether it ends in an exact path or stop, None as it was before the section.
    """

    line: int
    start: complex
    end: complex
    side: int
    ramp: bool
    depth: float
    centre: complex | None = None
    sweep: float = 0.0
    feed: float | None = None
    exact: bool | None = None

    @property
    def length(self) -> float:
        """Return its length."""
        if self.centre is None:
            return abs(self.end - self.start)
        return abs(self.start - self.centre) * abs(self.sweep)

    def point(self, fraction: float) -> complex:
        """Return the point after a fraction of it."""
        if self.centre is None:
            return self.start + (self.end - self.start) * fraction
        turn = complex(math.cos(self.sweep * fraction), math.sin(self.sweep * fraction))
        return self.centre + (self.start - self.centre) * turn

    def part(self, first: float, last: float) -> Element:
        """Return the stretch between two fractions of it."""
        start, end = self.point(first), self.point(last)
        return replace(self, start=start, end=end, sweep=self.sweep * (last - first))

    def normal(self, fraction: float) -> complex:
        """Return the direction to the left of its path at a fraction."""
        if self.centre is None:
            along = self.end - self.start
        else:
            along = (self.point(fraction) - self.centre) * math.copysign(1, self.sweep) * 1j
        return 1j * along / (abs(along) or 1.0)


class ZeroLine(NamedTuple):
    """What has become of C since the section before, or since the program began.

    ``commanded`` says that the program has put it where it stands. ``turned`` is by how many
    degrees the zero line is turned against that of the section before, which ended in line
    ``line``; 0 and 0 for the first.
    """

    commanded: bool
    turned: float = 0.0
    line: int = 0


BEGUN = ZeroLine(True)


class WordReading(NamedTuple):
    """How a machine reads a section's words: by its [G12] settings.

    ``x`` is POLAR_X, ``rapid_feed`` POLAR_G0_FEED in mm/min, ``beside`` POLAR_TOOL_OFFSET in mm:
    there the tool is where a polar section begins. ``surface`` is CYLINDER_WORD.
    """

    x: str
    rapid_feed: float | None = None
    beside: float = 0.0
    surface: str = "radius"


class Act(NamedTuple):
    """Something that a section does besides moving, as a trace tells it, and its block's line.

    ``drawn`` is how many elements of the contour come before it.
    """

    line: int
    text: str
    drawn: int


@dataclass(frozen=True)
class SectionContour:
    """One run through a section: first and last line, first move and the one after it, contour.

    ``file`` is the name of a sub's own, "" for the program.

    ``start`` in the contour's plane, ``height`` above it and ``c`` (degrees) are where it begins,
    ``left_c`` is where C stands behind it, in program coordinates; ``zero_line`` tells how C came
    there. ``doubt`` tells why the contour could not be read from the words, if it could not.
    ``diameters`` says that X words are. ``surface`` is the radius of the cylinder whose unrolled
    surface the plane is, 0 of a polar section.

    ``stopped`` says that a dwell comes between it and the move in front of it.
    ``acts`` are what it is to do besides moving, ``told`` what a trace tells of the section.
    ``leaves`` is the state behind it that the words ask for, as ``Block.left`` has it, and
    ``left`` the one that was found; ``paths`` are G61 or G64 as found and as asked, if known.
    ``path`` is G61 or G64 as in force where it begins, "" if that is not known, and ``asked_paths``
    are it and those that the words ask for on the way.
    """

    line: int
    last: int
    at: int
    end: int
    code: str
    start: complex
    elements: tuple[Element, ...]
    doubt: str = ""
    height: float = 0.0
    diameters: bool = False
    c: float = 0.0
    left_c: float = 0.0
    zero_line: ZeroLine = BEGUN
    stopped: bool = True
    acts: tuple[Act, ...] = ()
    told: tuple[Event, ...] = ()
    leaves: Mapping[str, float] = field(default_factory=dict)
    left: Mapping[str, float] = field(default_factory=dict)
    paths: tuple[str, ...] = ()
    path: str = ""
    asked_paths: tuple[str, ...] = ()
    surface: float = 0.0
    file: str = ""

    @property
    def exact(self) -> bool:
        """Tell whether G61 or G61.1 is in force where it begins."""
        return self.path.startswith("G61")

    @property
    def unit(self) -> float:
        """Return the program's unit in mm."""
        return 1.0 if self.leaves.get("_metric", True) else MM_PER_INCH

    @property
    def third(self) -> int:
        """Return the axis at right angles to the contour's plane: X of a cylinder, else Z."""
        return X if self.surface else Z


Pens = Mapping[str, Callable[[Block], "Pen"]]


def sections(
    tracer: Tracer,
    program: Path,
    codes: Codes,
    pens: Pens,
    blocks: Sequence[Block],
    tools: Tools,
    parameters: Parameters = None,
) -> list[SectionContour]:
    """Return the sections in the order they are run.

    ``blocks`` are the program's own, which say where sections begin. ``pens`` are those for each
    kind of section.
    """
    found = list(grouped(blocks, codes))
    if not found:
        return []
    files = files_with(codes.section, called_files(read_lines(program), tracer.ini))
    copies = Copies(program, files, partial(flattened_file, codes=codes))
    copy = copies.trace(tracer, tools, parameters)
    texts = copies.texts
    copied = blocks_in(copy, texts)
    groups = list(grouped(copied, codes))
    if [own[0].text for own in found] != [group[0].text for group in groups]:
        raise moves_otherwise(program)
    doubts = doubts_of(texts, codes, copies.lines)
    paths = zip(*(paths_behind(some, codes) for some in (blocks, copied)))
    return [
        replace(
            section_of(own, group, codes, pens, doubts.get(place_of(own[0].text), "")),
            paths=() if restores(group) else path,
            path=begun,
            asked_paths=(begun, *paths_told(group)),
        )
        for own, group, path, begun in zip(found, groups, paths, paths_at_start(copied, codes))
    ]


def flattened_file(path: Path, texts: Sequence[Text], codes: Codes, skip: int) -> list[str]:
    """Return the lines of a file without the sections' motion; see ``flattened``."""
    groups = flattened(texts, codes, lines_as_written(path), skip)
    return [line for group in groups for line in group]


def flattened(
    texts: Sequence[Text], codes: Codes, lines: Sequence[str], skip: int = 0
) -> Iterator[tuple[str, ...]]:
    """Yield the lines that stand for each line in the copy without the sections' motion.

    What a line does besides moving stays: LinuxCNC itself tells of it.
    """
    inside = False
    for text, line in zip(texts, lines):
        switch = codes.switch(text, inside)
        if switch or (inside and text.words and not text.control and not text.too_long):
            slash = "/" if text.deleted else ""
            acting = "" if switch else acting_words(text, line, codes)
            kept = tuple(slash + words for words in (acting, *text.assignments) if words)
            yield (*before(text, skip), *kept, *after(text, skip))
        else:
            yield (line,)
        inside = inside if not switch else switch == "on"


def acting_words(text: Text, line: str, codes: Codes) -> str:
    """Return those words of a line that act on the machine without motion, dwells included."""
    acting = [
        f"M{value}"
        for letter, value in text.words
        if letter == "M" and is_number(value) and float(value) in ACTING_M
        if not codes.remaps(f"M{value}")
    ]
    dwells = [f"G{code:g}" for code in text.codes if code == DWELL or code in PATHS]
    arguments = "PQ" if acting or dwells else ""
    words = [letter + value for letter, value in text.words if letter in "S" + arguments]
    spindle = SPINDLE.search(line)
    found = [*dwells, *acting, *words]
    return " ".join([*found, spindle[0]] if found and spindle else found)


def grouped(blocks: Sequence[Block], codes: Codes) -> Iterator[list[Block]]:
    """Yield the blocks of each section, the one that switches it on first."""
    group: list[Block] = []
    for block in blocks:
        switch = switched(block, codes, bool(group))
        if switch == "on":
            group = [block]
        elif group:
            group.append(block)
        if switch == "off" and group:
            yield group
            group = []


def switched(block: Block, codes: Codes, inside: bool) -> str:
    """Return what a block did to a section; its text cannot tell that of G7.1 C#1 where #1 is 0."""
    switch = codes.switch(block.text, inside)
    return "off" if switch == "on" and block.words.get("C") == 0.0 else switch


def doubts_of(texts: Sequence[Text], codes: Codes, lines: Sequence[str]) -> dict[Place, str]:
    """Return what the copy of the program cannot follow, by the place of a section's start."""
    doubts: dict[Place, str] = {}
    first: Place | None = None
    for text, line in zip(texts, lines):
        switch = codes.switch(text, bool(first))
        first = {"on": place_of(text), "off": None}.get(switch, first)
        if first and text.call:
            doubts[first] = f"line {text.number} calls o<{text.call}>"
        elif first and text.too_long:
            doubts[first] = f"line {text.number} is too long"
        elif first and any(name in line.replace(" ", "") for name in POSITION):
            doubts[first] = f"line {text.number} asks for a position"
    return doubts


def place_of(text: Text) -> Place:
    """Return the file of a sub, "" for the program, and the number of a line."""
    return text.file, text.number


def paths_behind(blocks: Sequence[Block], codes: Codes) -> list[str]:
    """Return G61 or G64 and its tolerances as in force behind each section."""
    return paths_at(blocks, codes, "off")


def paths_at_start(blocks: Sequence[Block], codes: Codes) -> list[str]:
    """Return G61 or G64 and its tolerances as in force where each section begins.

    ``blocks`` are those of the copy, where a section's events come behind its first block.
    """
    return paths_at(blocks, codes, "on")


def paths_at(blocks: Sequence[Block], codes: Codes, wanted: str) -> list[str]:
    """Return what is in force where each section is switched "on" or "off"."""
    path, inside, found = "", False, []
    for block in blocks:
        path = next(iter(paths_told([block])[::-1]), path)
        switch = switched(block, codes, inside)
        if switch == wanted and (inside or wanted == "on"):
            found.append(path)
        inside = switch == "on" if switch else inside
    return found


def paths_told(blocks: Sequence[Block]) -> list[str]:
    """Return each G61 or G64 that a trace tells of in some blocks."""
    return [event.text for block in blocks for event in block.events if event.text.startswith("G6")]


def restores(group: Sequence[Block]) -> bool:
    """Tell whether a section gives saved modes back, of which its copy knows nothing."""
    return any(code in (RESTORE, SAVE_FOR_SUB) for block in group for code in block.m_codes)


def section_of(
    own: Sequence[Block], group: Sequence[Block], codes: Codes, pens: Pens, doubt: str
) -> SectionContour:
    """Return the section that executed blocks describe; ``own`` are the program's own of it."""
    first, last = own[0], own[-1]
    told = tuple(event for block in own[1:] for event in block.events)
    kind = codes.section(first.text)
    pen = pens[kind.dialect](first)
    start, height, diameters = pen.at, pen.depth, pen.x_unit < pen.unit
    elements: list[Element] = []
    acts: list[Act] = []
    for block in group[1:]:
        texts = (event.text for event in block.events if ACTS.match(event.text))
        acts += [Act(block.text.number, text, len(elements)) for text in texts]
        if block is not group[-1]:  # whose words are those of the code that switches off
            elements += pen.draw(block)
    return SectionContour(
        first.text.number,
        last.text.number,
        first.at,
        last.end,
        f"G{first.codes[0]:g}",
        start,
        tuple(elements),
        doubt,
        height,
        diameters,
        first.state["_c"],
        last.left.get("_c", math.nan),
        stopped=any(
            event.at == first.at and event.text.startswith("dwell")
            for event in (*first.events, *told)
        ),
        acts=tuple(acts),
        told=told,
        leaves={**pen.leaves(first.state), **kept_behind(group)},
        left=last.left,
        surface=pen.surface,
        file=first.text.file,
    )


def kept_behind(group: Sequence[Block]) -> dict[str, float]:
    """Return the modes that the blocks of a section leave as they are."""
    if restores(group):
        return {}
    return kept_state(group[0].state, [code for block in group for code in block.codes])


class Pen:
    """Follows the words of a polar section's blocks, as the mode's rules say."""

    surface = 0.0
    across = "XYCUHIJR"  # the letters of moves in the plane

    def __init__(self, first: Block, reading: WordReading) -> None:
        state = first.state
        self.unit = 1.0 if state["_metric"] else MM_PER_INCH
        diameter = {"diameter": True, "radius": False}.get(reading.x, state["_lathe_diameter_mode"])
        self.x_unit = self.unit / 2 if diameter else self.unit
        self.at = complex(state["_x"] * self.unit, 0.0)
        self.beside, self.tool = reading.beside, self.at + 1j * reading.beside
        self.depth = state["_z"] * self.unit
        self.absolute = bool(state["_absolute"])
        self.motion, self.side, self.changes = state["_motion_mode"] / 10, 0, False
        self.rapid_feed = reading.rapid_feed
        self.exact: bool | None = None
        self.feed = None if state["_feed"] == FORGOTTEN else state["_feed"] * self.unit
        self.per_revolution, self.speed = bool(state["_units_per_rev"]), state["_rpm"]
        self._saved: tuple | None = None  # by M70 and M73

    def draw(self, block: Block) -> Iterator[Element]:
        """Yield the element that a block adds, if any."""
        for code in block.m_codes:
            self._save_or_restore(code)
        for code in block.codes:
            self._switch(code)
        words = block.words
        self.speed = words.get("S", self.speed)
        self.feed = words["F"] * self.unit if "F" in words else self.feed
        if not any(letter in words for letter in CONTOUR):
            return
        depth, self.depth = self.depth, self._height(words)
        end = self._place(words)
        centre, sweep = self._turn(words, end)
        if not any(letter in words for letter in self.across):
            end = self.tool
        if end != self.tool or centre is not None:
            line = block.text.number
            ramp, self.changes = self.changes, False
            form = self.tool, end, self.side, ramp, self.depth, centre, sweep
            yield Element(line, *form, self._feed(), self._exact(block))
        elif depth != self.depth:
            still = Element(block.text.number, end, end, 0, False, self.depth)
            yield replace(still, feed=self._feed(), exact=self._exact(block))
        if end != self.tool or centre is not None:
            self.at = self.tool = end

    def leaves(self, state: Mapping[str, float]) -> dict[str, float]:
        """Return the state behind the section, of which ``state`` is the one before it.

        Not a feed that is not known.
        """
        left = {
            "_metric": state["_metric"],
            "_absolute": float(self.absolute),
            "_units_per_rev": float(self.per_revolution),
            "_motion_mode": 10 * self.motion,
            **self._position(state["_c"]),
        }
        return left if self.feed is None else {**left, "_feed": self.feed / self.unit}

    def _height(self, words: dict) -> float:
        """Return how high above the plane a block ends."""
        return self._to(words, "Z", None, self.depth, self.unit)

    def _place(self, words: dict) -> complex:
        """Return where in the plane a block ends."""
        return complex(
            self._to(words, "X", "U", self.at.real, self.x_unit),
            self._to(words, "C" if "C" in words else "Y", "H", self.at.imag, self.unit),
        )

    def _arm(self, words: dict) -> complex | None:
        """Return the way from an arc's start to its centre, if the words say it."""
        if "I" in words or "J" in words:
            return complex(words.get("I", 0.0), words.get("J", 0.0)) * self.unit
        return None

    def _position(self, c: float) -> dict[str, float]:
        """Return X, Z and C, which was ``c`` before the section; not C of a tool in the centre."""
        radius, angle = cmath.polar(self.tool)
        slide = math.sqrt(max(0.0, radius**2 - self.beside**2))
        angle -= math.atan2(self.beside, slide)
        left = {"_x": slide / self.unit, "_z": self.depth / self.unit}
        return {**left, "_c": c + math.degrees(angle)} if radius > SAME_PLACE else left

    def _feed(self) -> float | None:
        """Return the feed in mm per minute."""
        if self.motion == 0.0:
            return self.rapid_feed
        if self.feed is None:
            return None
        return self.feed * (self.speed if self.per_revolution else 1.0)

    def _exact(self, block: Block) -> bool | None:
        return True if EXACT_HERE in block.codes else self.exact

    def _save_or_restore(self, code: float) -> None:
        if code in (SAVE, SAVE_FOR_SUB):
            self._saved = self.absolute, self.motion, self.feed, self.per_revolution, self.speed
        elif code == RESTORE and self._saved:
            self.absolute, self.motion, self.feed, self.per_revolution, self.speed = self._saved

    def _switch(self, code: float) -> None:
        if code in SIDES:
            self.changes = self.changes or SIDES[code] != self.side
            self.side = SIDES[code]
        elif code in (0.0, 1.0, 2.0, 3.0):
            self.motion = code
        elif code in (90.0, 91.0):
            self.absolute = code == 90.0
        elif code in PATHS:
            self.exact = PATHS[code]
        elif code in FEED_MODES:
            changed = self.per_revolution != FEED_MODES[code]
            self.per_revolution, self.feed = FEED_MODES[code], 0.0 if changed else self.feed

    def _to(self, words: dict, letter: str, step: str | None, now: float, unit: float) -> float:
        """Return where a coordinate goes: by its word, by its incremental word, or nowhere."""
        if letter in words:
            return words[letter] * unit + (0.0 if self.absolute else now)
        return now + words.get(step, 0.0) * unit

    def _turn(self, words: dict, end: complex) -> tuple[complex | None, float]:
        """Return an arc's centre and its sweep; no centre for a line."""
        if self.motion not in (2.0, 3.0):
            return None, 0.0
        sign = 1.0 if self.motion == 3.0 else -1.0
        arm = self._arm(words)
        if "R" in words:
            centre = centre_of(self.at, end, words["R"] * self.unit, sign)
        elif arm is not None:
            centre = self.at + arm
        else:
            return None, 0.0
        return centre, sweep_of(self.at - centre, end - centre, sign)


def centre_of(start: complex, end: complex, radius: float, sign: float) -> complex:
    """Return the centre of an arc by its radius; a negative one is for the arc over 180 degrees."""
    chord = end - start
    half = abs(chord) / 2
    height = math.sqrt(max(0.0, radius * radius - half * half))
    left = 1j * chord / abs(chord)
    return (start + end) / 2 + left * height * sign * math.copysign(1.0, radius)


def sweep_of(start: complex, end: complex, sign: float) -> float:
    """Return the signed angle from one direction to another; the same point is a full turn."""
    if abs(end - start) < 1e-6:
        return sign * 2 * math.pi
    angle = math.atan2((end / start).imag, (end / start).real)
    return angle if angle * sign > 0 else angle + sign * 2 * math.pi
