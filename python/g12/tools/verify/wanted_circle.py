# SPDX-License-Identifier: GPL-2.0-or-later
"""What circle a cycle's block asks for: its words read once more, apart from the planners.

One reader per dialect. Lengths are millimetres in machine coordinates; a wall has axes of its
own, so that a pocket in any plane of a turned work coordinate system looks the same.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from g12.lengths import MM_PER_INCH
from g12.tools.path.part import plane_axes
from g12.tools.preview.executed_blocks import FORGOTTEN, Block
from g12.tools.preview.moves import Move
from g12.tools.verify.reading.codes import EVENT, Codes, Cycle, compensates, kept_state

ENTRIES = "GXYZWORDCKJLPFV"
LEFT_OUT = -9999.0
POCKET = "circle_mill_pocket"  # the handler of the event's pocket
ROUGH_FINISH = ((-1, -1), (1, 1), (-1, 1), (1, -1))  # turns of the event by D
DYNAMIC = (41.1, 42.1)  # compensation whose D is a diameter
CENTRE = (0.0, 0.0)
SAME_DEPTH = 1e-6
ROUNDING = 1e-6  # mm
TOUCHING = 0.01  # mm: so far over each other two rings leave nothing
HELIX_SHARE = 0.9  # of the cutter's radius: as large is a helix at most
NARROWER = 0.254  # mm: an event's roughing width is the cutter's diameter less this
EVENT_RETRACT = 2.54  # mm
AHEAD, OUTWARD = "ahead", "outward"  # ways from a ring to the next


class CircleFeeds(NamedTuple):
    """Feeds in mm per minute or revolution: down, on arcs, on straight moves, of the finish.

    None: the words do not say.
    """

    plunge: float | None
    arc: float | None
    straight: float | None
    finish: float | None


@dataclass(frozen=True)
class Source:
    """Where a circle is asked for; ``file`` is the name of a sub's own, "" for the program."""

    line: int
    file: str
    code: str
    dialect: str


@dataclass(frozen=True)
class Wall:
    """The wall to be cut, mm; ``inside`` says that the cutter works inside it.

    ``origin`` (3,) is the centre at the height where the block began, the rows of ``axes`` are
    the plane's first, second and third axis. Between ``cleared`` and ``radius`` nothing may be
    left. ``bore`` is the radius of the hole that was there before, ``face`` the program's Z0.
    """

    origin: np.ndarray
    axes: np.ndarray
    radius: float
    cleared: float = 0.0
    inside: bool = True
    bore: float = 0.0
    face: float = 0.0

    @property
    def plane(self) -> int:
        """Return the index of the axis (0 for X) that is square to the circle's plane."""
        return int(np.argmax(np.abs(self.axes[2])))

    @property
    def core(self) -> float:
        """Return the radius of what stands in the middle by design, 0 if nothing does."""
        return 0.0 if self.bore or not self.inside else self.cleared

    def local(self, points: np.ndarray) -> np.ndarray:
        """Return points (n, 3) as seen from the centre along the plane's axes."""
        return (np.atleast_2d(points)[:, :3] - self.origin) @ self.axes.T

    def height(self, depth: float) -> float:
        """Return the machine coordinate of a depth as seen from where the block began."""
        return depth + float(self.origin @ self.axes[2])


@dataclass(frozen=True)
class Cutter:
    """The cutter, by its radius in mm: that of D or, where no tool is ``named``, the loaded one.

    ``tool`` is the loaded tool's number, ``loaded`` its radius. Where the tool's centre goes
    round on the circle, that is ``circle``, the value of ``word``.
    """

    radius: float
    tool: int = 0
    loaded: float = 0.0
    named: int | None = None
    word: str = ""
    circle: float = 0.0


class HelixAsked(NamedTuple):
    """The helices to go down along: how often, the tool centre's radius, the greatest angle.

    ``within``: the first ring is larger.
    """

    count: int
    radius: float
    angle: float
    within: bool


@dataclass(frozen=True)
class Schedule:
    """How a circle is to be cut: at which depths along the third axis, how often, how fast.

    ``passes`` says how often the finished circle is cut. ``turn`` is -1 for clockwise and +1 for
    counterclockwise, 0 if not checked; ``finish_turn`` that of a last circle which finishes the
    wall, 0 without one. ``smooth`` is for cycles that turn no corner. ``circles`` are the full
    circles in their order, each the depth and the radius of the tool's centre; ``pitch`` is what
    a spiral may grow by in a turn. ``rev`` says that the feed is per revolution. ``helix`` is None
    for a cycle that goes straight down.
    """

    levels: tuple[float, ...]
    passes: int
    feeds: CircleFeeds
    turn: int = 0
    finish_turn: int = 0
    smooth: bool = True
    circles: tuple[tuple[float, float], ...] = ()
    pitch: float | None = None
    rev: bool = False
    helix: HelixAsked | None = None

    @property
    def deepest(self) -> float:
        """Return the last depth."""
        return min(self.levels)


class Places(NamedTuple):
    """Where a cycle goes down, begins its circles and ends, in mm as seen from the wall's centre.

    ``plunge`` is in the plane, ``lead`` the direction of a level's first circle's beginning.
    Rapids go across at ``first`` or higher before the first cut, ``retract`` above a level (not
    above ``first``) between levels, at ``last`` behind the last cut. ``end`` has three axes.
    ``fast`` are the fast moves in the plane, each from and to a place: rapids, or moves at
    ``straight`` feed; None where they are judged by those heights alone. ``entry`` is where the
    first arc ends, None where a full circle begins there. ``link`` is AHEAD or OUTWARD, the way
    from a ring to the next, "" where the dialect's page does not tell.
    """

    plunge: tuple[float, float] = (0.0, 0.0)
    lead: tuple[float, float] = (1.0, 0.0)
    first: float = 0.0
    retract: float = 0.0
    last: float = 0.0
    end: tuple[float, float, float] = (0.0, 0.0, 0.0)
    fast: tuple[tuple[tuple[float, float], tuple[float, float]], ...] | None = ()
    straight: str = "rapid"
    entry: tuple[float, float] | None = None
    link: str = ""


@dataclass(frozen=True)
class Target:
    """A circle to be cut: who asks for it, what is to be there, with what, how, and where.

    ``leaves`` is the state behind the block, as ``Block.left`` has it; what the words do not
    say is not in it. ``places`` is None if they are not checked.
    """

    source: Source
    wall: Wall
    cutter: Cutter
    schedule: Schedule
    places: Places | None = None
    leaves: Mapping[str, float] = field(default_factory=dict)


Reading = tuple[Wall, Cutter, Schedule, Places]


@dataclass
class CircleReader:
    """Reads blocks in the order of execution; remembers D and W as the control does.

    ``spiral`` and ``traverse`` (mm/min, 0 for rapids) are [G12] CLEARING and YASNAC_TRAVERSE;
    ``helix_angle`` (degrees) is ENTRY_ANGLE, None for ENTRY = plunge, ``plunge_share`` of F the
    feed down.
    """

    codes: Codes
    moves: Sequence[Move]
    diameters: Mapping[int, float]
    offset: float | None = None  # radius of the D last commanded, mm
    number: int | None = None  # the tool that it named
    plane: float | None = None  # W last commanded, mm in program coordinates
    spiral: bool = False
    traverse: float = 0.0
    helix_angle: float | None = None
    plunge_share: float = 1.0

    def targets(self, blocks: Sequence[Block]) -> Iterator[tuple[Block, Target]]:
        """Yield each block that cuts a circle with what it asks for."""
        for block in blocks:
            cycle = self.codes.cycle_of(block.text.call, block.codes)
            if cycle and block.end > block.at:
                yield block, self._target(block, cycle)
            elif compensates(block.codes):
                self._remember(block)

    def _target(self, block: Block, cycle: Cycle) -> Target:
        read = {
            "haas": self._haas,
            "yasnac": self._yasnac,
            "mitsubishi": self._mitsubishi,
            EVENT: self._event,
        }
        view = BlockInMm(block, self.moves[block.at])
        wall, cutter, schedule, places = read[cycle.dialect](view, cycle)
        name = self.codes.name_of(block.codes)
        source = Source(block.text.number, block.text.file, name, cycle.dialect)
        wall, schedule = replace(wall, face=view.zero()[2]), replace(schedule, rev=view.rev)
        leaves = view.leaves(schedule.feeds.arc, self.moves[block.end - 1])
        return Target(source, wall, cutter, schedule, places, leaves)

    def _haas(self, view: BlockInMm, cycle: Cycle) -> Reading:
        words = view.words
        if "D" in words:
            self.offset, self.number = self._radius(words["D"]), round(words["D"])
        offset = self._radius(view.tool) if self.offset is None else self.offset
        wall, cutter = self._inside(view, "K" if "K" in words else "I", offset, self.number)
        passes = int(words.get("L", 1))
        counts = (1,) if view.absolute or "Z" not in words else range(1, passes + 1)
        levels = tuple(view.height("Z", count) - view.start[2] for count in counts)
        feed = view.feed()
        feeds = CircleFeeds(None if feed is None else feed * self.plunge_share, feed, feed, None)
        rings = haas_rings(view, self.spiral, offset)
        circles = [(level, ring) for level in levels for ring in rings] * (passes // len(levels))
        helix, circles = self._helix(levels, rings[0], offset, circles)
        pitch = view.length("Q") if self.spiral and "Q" in words else None
        schedule = Schedule(
            levels, passes, feeds, cycle.turn, circles=tuple(circles), pitch=pitch, helix=helix
        )
        begun = helix.radius if helix and helix.within else 0.0  # else it ends in the centre
        core = core_of(cutter, wall.radius, begun)
        wall = replace(wall, origin=view.centre(), cleared=0.0 if "K" in words else core)
        begin = view.axes @ (view.start - wall.origin)
        there = (((begin[0], begin[1]), CENTRE),) if np.hypot(*begin[:2]) > ROUNDING else ()
        link = "" if self.spiral else AHEAD
        return wall, cutter, schedule, Places(end=(0.0, 0.0, levels[-1]), fast=there, link=link)

    def _helix(
        self, levels: Sequence[float], ring: float, offset: float, circles: list
    ) -> tuple[HelixAsked | None, list]:
        """Return the helices to a pocket's levels, and its circles with those that end them."""
        if self.helix_angle is None:
            return None, circles
        radius = min(ring, HELIX_SHARE * offset) if offset else ring
        down = [level for level, above in zip(levels, (0.0, *levels)) if level < above - ROUNDING]
        within = radius < ring - ROUNDING
        if within:
            first = {level: circles.index((level, ring)) for level in down}
            for level in reversed(down):
                circles.insert(first[level], (level, radius))
        return HelixAsked(len(down), radius, self.helix_angle, within), circles

    def _yasnac(self, view: BlockInMm, cycle: Cycle) -> Reading:
        words = view.words
        offset = self._radius(words["D"]) if "D" in words else 0.0
        wall, cutter = self._inside(view, "I", offset, round(words.get("D", 0)))
        bore = abs(view.length("R") or view.length("J"))
        bore += cutter.loaded if bore and cutter.word else 0.0
        # A spiral has gone all round when it has grown by Q.
        spiral = abs(view.length("I")) - abs(view.length("K")) - view.length("Q")
        inner = wall.radius - (max(0.0, spiral) if "K" in words else 0.0)
        wall = replace(wall, cleared=bore or core_of(cutter, inner), bore=bore)
        feeds = CircleFeeds(None, view.feed(), self.traverse or None, None)
        passes = int(words.get("L", 1))
        circles = ((0.0, abs(view.length("I")) - offset),) * passes
        pitch = view.length("Q") if "Q" in words else None
        schedule = Schedule((0.0,), passes, feeds, cycle.turn, circles=circles, pitch=pitch)
        side = math.copysign(1.0, words["I"])
        approach = (side * (abs(view.length("R") or view.length("J")) - offset), 0.0)
        is_fast = bore and abs(approach[0]) > ROUNDING
        fast = ((CENTRE, approach), (approach, CENTRE)) if is_fast else ()
        straight = "feed" if self.traverse else "rapid"
        entry = (side * (abs(view.length("K")) - offset), 0.0) if "K" in words else None
        places = Places(lead=(side, 0.0), fast=fast, straight=straight, entry=entry)
        return wall, cutter, schedule, places

    def _mitsubishi(self, view: BlockInMm, cycle: Cycle) -> Reading:
        number = view.words["D"]
        wall, cutter = self._inside(view, "I", self._radius(number), round(number))
        feeds = CircleFeeds(*[view.feed()] * 3, None)
        circles = ((0.0, abs(view.length("I")) - self._radius(number)),)
        schedule = Schedule((0.0,), 1, feeds, cycle.turn, circles=circles)
        return replace(wall, cleared=core_of(cutter, wall.radius)), cutter, schedule, Places()

    def _inside(
        self, view: BlockInMm, word: str, offset: float, number: int | None
    ) -> tuple[Wall, Cutter]:
        """Return a pocket; without an offset the tool's centre goes round on the circle."""
        circle, loaded = abs(view.length(word)), self._radius(view.tool)
        if not offset:
            cutter = Cutter(loaded, view.tool, loaded, word=word, circle=circle)
            return Wall(view.start, view.axes, circle + loaded), cutter
        return Wall(view.start, view.axes, circle), Cutter(offset, view.tool, loaded, number)

    def _event(self, view: BlockInMm, cycle: Cycle) -> Reading:
        event = coded_event(view, cycle) if cycle.handler else called_event(view)
        if "W" in event:
            self.plane = event["W"]
        loaded, radius = self._radius(view.tool), event["R"]
        side = side_of(event.get("D", 0.0), event["C"])
        inner = radius - abs(event.get("L", 0.0)) - 2 * loaded
        on_circle = {}
        if side == 0:
            on_circle = {"word": "R", "circle": radius}
            radius, inner = radius + loaded, radius - loaded
        cleared = 0.0 if event.get("G", 0.0) == 7.0 else max(0.0, inner)
        wall = Wall(view.centre(), view.axes, radius, cleared, inside=side <= 0)
        cutter = Cutter(loaded, view.tool, loaded, **on_circle)
        rings = event_rings(event, side, loaded)
        schedule = self._event_schedule(view, event, (rings, event["R"] + side * loaded))
        return wall, cutter, schedule, self._event_places(view, event, rings)

    def _event_places(
        self, view: BlockInMm, event: Mapping[str, float], rings: Sequence[float]
    ) -> Places:
        is_pocket = event.get("G", 0.0) == 7.0
        plane = self.plane or 0.0
        first, last = (height - view.present("z") for height in (plane, event.get("O", plane)))
        x, y, _ = view.axes @ (view.start - view.centre())
        plunge = (0.0, 0.0 if is_pocket else -rings[-1])
        end = (x, y, last)
        return Places(plunge, (0.0, -1.0), first, EVENT_RETRACT, last, end, None, link=OUTWARD)

    def _event_schedule(
        self, view: BlockInMm, event: Mapping[str, float], radii: tuple[Sequence[float], float]
    ) -> Schedule:
        """Return how an event is cut; ``radii`` are those of a level's rings and the finish."""
        heights = event_levels(event, self.plane or 0.0, view.absolute)
        turn, finish_turn = ROUGH_FINISH[int(event.get("D", 0.0))]
        rings, finish = radii
        depths = [height - view.present("z") for height in heights]
        circles = [(depth, ring) for depth in depths for ring in rings]
        circles += [(depths[-1], finish)] * ("L" in event)
        return Schedule(
            tuple(depths),
            passes=1 if "L" in event else len(heights),
            feeds=event_feeds(event, view.feed()),
            turn=turn,
            finish_turn=finish_turn if "L" in event else 0,
            smooth=False,
            circles=tuple(circles),
        )

    def _remember(self, block: Block) -> None:
        """Note the D of a block that switches cutter compensation on."""
        view = BlockInMm(block, self.moves[min(block.at, len(self.moves) - 1)])
        if any(code in DYNAMIC for code in block.codes):
            self.offset, self.number = view.length("D") / 2, None
        else:
            self.number = round(block.words.get("D", view.tool))
            self.offset = self._radius(self.number)

    def _radius(self, tool: float) -> float:
        return self.diameters.get(round(tool), 0.0) / 2


class BlockInMm:
    """A block's words in mm, and where the tool is when it begins."""

    def __init__(self, block: Block, first: Move) -> None:
        self.words = block.words
        self.arguments = block.arguments
        self.tool = first.tool
        self.start = np.array(first.start[:3])
        self.axes = plane_axes(first)
        self._state = block.state
        self._unit_before = 1.0 if block.state["_metric"] else MM_PER_INCH
        commanded = {20.0: MM_PER_INCH, 21.0: 1.0}
        changes = (commanded[code] for code in block.codes if code in commanded)
        self.unit = next(changes, self._unit_before)
        absolute = bool(block.state["_absolute"])
        self.absolute = (absolute or 90.0 in block.codes) and 91.0 not in block.codes
        self._first, self._codes = first, block.codes
        self.rev = self._per_revolution(block.codes)

    def _per_revolution(self, codes: Sequence[float]) -> bool:
        commanded = [code for code in codes if code in (93.0, 94.0, 95.0)]
        return 95.0 in commanded if commanded else bool(self._state["_units_per_rev"])

    def leaves(self, feed: float | None, last: Move) -> dict[str, float]:
        """Return the state that the block should leave behind its last move.

        ``feed`` in mm, None if it is not known. The tool may end elsewhere, which is told by
        itself: there the program's coordinates are those of its zero.
        """
        left = {
            "_metric": float(self.unit == 1.0),
            "_absolute": float(self.absolute),
            "_units_per_rev": float(self.rev),
            "_motion_mode": self._state["_motion_mode"],
        }
        left |= kept_state(self._state, self._codes)
        if not self._state["_lathe_diameter_mode"]:
            place = self._turned_back(np.array(last.end[:3]) - self.zero()) / self.unit
            left |= dict(zip(("_x", "_y", "_z"), map(float, place)))
        return left if feed is None else {**left, "_feed": feed / self.unit}

    def length(self, letter: str) -> float:
        """Return a length word in mm, 0 without it."""
        return self.words.get(letter, 0.0) * self.unit

    def feed(self) -> float | None:
        """Return the feed in mm per minute or revolution: the F word, else what is in force.

        None if the preview does not know: the block changes the units, or one before it did.
        """
        if self.unit != self._unit_before:
            return None
        if "F" not in self.words and self._state["_feed"] == FORGOTTEN:
            return None
        return self.words.get("F", self._state["_feed"]) * self.unit

    def present(self, axis: str) -> float:
        """Return where the tool stands in program coordinates, mm."""
        return self._state[f"_{axis}"] * self._unit_before

    def centre(self) -> np.ndarray:
        """Return the centre in machine coordinates: X and Y words, else where the tool stands."""
        return self.start + self._turned(self._step("x"), self._step("y"), 0.0)

    def zero(self) -> np.ndarray:
        """Return the program's zero in machine coordinates."""
        return self.start - self._turned(*map(self.present, "xyz"))

    def height(self, letter: str, times: int) -> float:
        """Return the height in machine coordinates that a Z word leads to, ``times`` over.

        Without the word it is where the tool stands.
        """
        if self.absolute and letter in self.words:
            return self.start[2] + self.length(letter) - self.present("z")
        return self.start[2] + times * self.length(letter)

    def _step(self, axis: str) -> float:
        if axis.upper() not in self.words:
            return 0.0
        word = self.length(axis.upper())
        return word - self.present(axis) if self.absolute else word

    def _turned(self, x: float, y: float, z: float) -> np.ndarray:
        """Return a direction of the program in machine coordinates."""
        return turned(np.array([x, y, z]), self._first.rotation)

    def _turned_back(self, way: np.ndarray) -> np.ndarray:
        """Return a direction of the machine in program coordinates."""
        return turned(way, -self._first.rotation)


def turned(way: np.ndarray, degrees: float) -> np.ndarray:
    """Return a direction turned about Z."""
    cos, sin = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([way[0] * cos - way[1] * sin, way[0] * sin + way[1] * cos, way[2]])


def called_event(view: BlockInMm) -> dict[str, float]:
    """Return the entries of ``o<circle_mill> call``, mm; X and Y go where the words would."""
    given = dict(zip(ENTRIES, view.arguments))
    entries = {
        letter: value * (1.0 if letter in "GDC" else view.unit)
        for letter, value in given.items()
        if value != LEFT_OUT
    }
    view.words = {letter: given[letter] for letter in "XY"}
    return entries


def coded_event(view: BlockInMm, cycle: Cycle) -> dict[str, float]:
    """Return the entries of a G12.2 or G13.2 block, mm."""
    letters = {entry: entry for entry in "RZKPJ"} | {"W": "I", "O": "E", "L": "Q"}
    entries = {entry: view.length(word) for entry, word in letters.items() if word in view.words}
    if view.words.get("L") == 0.0:
        entries["L"] = -entries["L"]
    entries["D"], entries["C"] = view.words.get("D", 0.0), view.words["H"]
    entries["G"] = 7.0 if cycle.handler == POCKET else 0.0
    return entries


def haas_rings(view: BlockInMm, spiral: bool, offset: float) -> list[float]:
    """Return the radii of the tool centre's full circles in a level, outward."""
    first, last = view.length("I"), view.length("K" if "K" in view.words else "I")
    steps = steps_to(last - first, view.length("Q"))
    between = [first + step * view.length("Q") for step in range(1 if spiral else steps)]
    return [radius - offset for radius in (*between[:steps], last)]


def event_rings(event: Mapping[str, float], side: int, cutter: float) -> list[float]:
    """Return the radii of the tool centre's circles in a rough level, outward."""
    rough = event["R"] + side * (cutter + abs(event.get("L", 0.0)))
    if event.get("G", 0.0) != 7.0:
        return [rough]
    count = max(1, steps_to(rough, event.get("J", 2 * cutter - NARROWER)))
    return [rough * (ring + 1) / count for ring in range(count)]


def steps_to(distance: float, longest: float) -> int:
    """Return how many steps that are not longer make a distance; a rest of nothing is none."""
    return math.ceil((distance - ROUNDING) / longest) if distance > ROUNDING else 0


def core_of(cutter: Cutter, wall: float, begun: float = 0.0) -> float:
    """Return the radius of what one ring along a wall leaves standing by design.

    The cutter begins in the centre, or on a circle of radius ``begun`` there: a ring that touches
    what it clears there leaves nothing.
    """
    inner = wall - 2 * cutter.radius
    return inner if inner > begun + cutter.radius - TOUCHING else 0.0


def event_levels(event: Mapping[str, float], plane: float, absolute: bool) -> list[float]:
    """Return the heights that an event cuts at, in program coordinates, downward from W."""
    final = event["Z"] if absolute else plane + event["Z"]
    rough = final + max(0.0, event.get("L", 0.0))
    peck = event.get("K", plane - rough)
    levels = [plane - peck]
    while levels[-1] > rough + SAME_DEPTH:
        levels.append(levels[-1] - peck)
    levels[-1] = rough
    return levels + [final] * (rough > final)


def event_feeds(event: Mapping[str, float], feed: float | None) -> CircleFeeds:
    """Return the feeds of an event; ``feed`` is the block's or the one in force."""
    rough = event.get("F", feed)
    finish = event.get("V", rough) if "L" in event else None
    return CircleFeeds(event.get("P", rough), rough, rough, finish)


def side_of(direction: float, compensation: float) -> int:
    """Return where the cutter works: -1 inside the wall, +1 outside, 0 on the circle."""
    left_is = 1 if int(direction) in (0, 2) else -1  # clockwise has the outside on its left
    return {0: 0, 1: left_is, 2: -left_is}[int(compensation)]
