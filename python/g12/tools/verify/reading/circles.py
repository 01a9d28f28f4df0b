# SPDX-License-Identifier: GPL-2.0-or-later
"""What circle a cycle's block asks for: its words, apart from the planners.

One reader per dialect. Lengths are millimetres in machine coordinates; a wall has axes of its
own, so that a pocket in any plane of a turned work coordinate system looks the same.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from g12.geometry.curve import Arc
from g12.tools.machine.ini import Ini
from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Move
from g12.tools.verify.expected import circle_mill, haas
from g12.tools.verify.expected.calls import LEFT_OUT
from g12.tools.verify.expected.circle_mill import EventPlace, EventWords
from g12.tools.verify.expected.haas import HaasWords
from g12.tools.verify.expected.mitsubishi import MitsubishiWords
from g12.tools.verify.expected.toolpath import Expected
from g12.tools.verify.expected.yasnac import YasnacWords
from g12.tools.verify.reading.block_words import BlockInMm
from g12.tools.verify.reading.codes import EVENT, Codes, Cycle, compensates

ENTRIES = "GXYZWORDCKJLPFV"
POCKET_HANDLER = "circle_mill_pocket"
DYNAMIC = (41.1, 42.1)  # compensation whose D is a diameter
TOUCHING = 0.01  # mm: so far over each other two rings leave nothing

Asked = HaasWords | YasnacWords | MitsubishiWords | EventWords


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

    def machine(self, point: tuple[complex, float]) -> tuple[float, ...]:
        """Return a point of the plane and a level in machine coordinates."""
        flat, level = point
        there = np.array([flat.real, flat.imag, level])
        return tuple(map(float, self.origin + there @ self.axes))

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


@dataclass(frozen=True)
class Target:
    """A circle to be cut: who asks for it, what is to be there, with what, and by which words.

    ``leaves`` is the state after the block, as ``Block.left`` has it; what the words do not
    say is not in it.
    """

    source: Source
    wall: Wall
    cutter: Cutter
    asked: Asked
    leaves: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def path(self) -> list[Expected]:
        """The expected toolpath as seen from the wall's centre."""
        return self.asked.toolpath()

    @cached_property
    def circles(self) -> list[Expected]:
        """The full circles of the toolpath about the centre."""
        return [move for move in self.path if is_full_circle(move)]

    @cached_property
    def depths(self) -> tuple[float, ...]:
        """The depths of the circles, each once, downward."""
        return tuple(sorted({move.end_level for move in self.circles}, reverse=True))

    @property
    def deepest(self) -> float:
        """Return the last depth."""
        return self.depths[-1]

    @property
    def walls(self) -> list[Expected]:
        """Return the circles that cut the wall."""
        centre = self.wall.radius + (-1 if self.wall.inside else 1) * self.cutter.radius
        return [
            move
            for move in self.circles
            if isinstance(move.curve, Arc) and abs(move.curve.radius - centre) < TOUCHING
        ]


def is_full_circle(move: Expected) -> bool:
    """Tell whether an expected move is a full circle."""
    return abs(getattr(move.curve, "sweep", 0.0)) > 2 * math.pi - 1e-9


Reading = tuple[Wall, Cutter, Asked]


@dataclass
class CircleReader:
    """Reads blocks in the order of execution; remembers D and W as the control does."""

    codes: Codes
    ini: Ini
    moves: Sequence[Move]
    diameters: Mapping[int, float]
    offset: float | None = None  # radius of the D last commanded, mm
    number: int | None = None  # the tool that it named
    plane: float = 0.0  # W last commanded, mm in program coordinates

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
        if not cycle.turn and cycle.dialect != EVENT:
            cycle = cycle._replace(handler=self._handler_of(block))
        wall, cutter, asked = read[cycle.dialect](view, cycle)
        name = self.codes.name_of(block.codes)
        source = Source(block.text.number, block.text.file, name, cycle.dialect)
        wall = replace(wall, face=view.zero()[2])
        leaves = view.leaves(asked.feed, self.moves[block.end - 1])
        return Target(source, wall, cutter, asked, leaves)

    def _haas(self, view: BlockInMm, cycle: Cycle) -> Reading:
        words = view.words
        if "D" in words:
            self.offset, self.number = self._radius(words["D"]), round(words["D"])
        offset = self._radius(view.tool) if self.offset is None else self.offset
        wall, cutter = self._inside(view, "K" if "K" in words else "I", offset, self.number)
        wall = replace(wall, origin=view.centre())
        asked = self._haas_pocket(view, cycle.turn, offset, view.seen_from(wall.origin))
        goes_down = min(asked.depths) < 0.0 and asked.helix < asked.rings[0]
        core = core_of(cutter, wall.radius, asked.helix if goes_down else 0.0)
        return replace(wall, cleared=0.0 if "K" in words else core), cutter, asked

    def _haas_pocket(self, view: BlockInMm, turn: int, offset: float, start: complex) -> HaasWords:
        words, step, settings = view.words, view.length("Q"), self.ini.settings
        is_spiral = settings.clearing == "spiral"
        first = view.length("I") - offset
        last = view.length("K") - offset if "K" in words else first
        rings = [first, last] if is_spiral and step else haas.rings_between(first, last, step)
        helix = 0.0
        if settings.entry == "helix":
            helix = min(first, haas.CLEARED * offset) if offset else first
        feed = view.feed()
        return HaasWords(
            start,
            rings,
            self._depths(view),
            turn,
            feed,
            None if feed is None else feed * settings.plunge_feed / 100,
            step if is_spiral else 0.0,
            helix,
            math.radians(settings.entry_angle),
            view.line,
            view.rev,
        )

    def _depths(self, view: BlockInMm) -> list[float]:
        """Return the depth of each pass of a Haas block, from where the tool stands."""
        passes = int(view.words.get("L", 1))
        repeated = view.absolute or "Z" not in view.words
        counts = [1] * passes if repeated else range(1, passes + 1)
        return [view.height("Z", count) - view.start[2] for count in counts]

    def _yasnac(self, view: BlockInMm, cycle: Cycle) -> Reading:
        words = view.words
        offset = self._radius(words["D"]) if "D" in words else 0.0
        wall, cutter = self._inside(view, "I", offset, round(words.get("D", 0)))
        hole = view.length("R") or view.length("J")
        side = math.copysign(1.0, words["I"])
        radius = view.length("I") - side * offset
        asked = YasnacWords(
            hole - side * offset if hole else 0.0,
            view.length("K") - side * offset if "K" in words else radius,
            radius,
            int(words.get("L", 1)),
            cycle.turn,
            view.feed(),
            view.length("Q"),
            self.ini.settings.yasnac_traverse * self.ini.mm,
            view.line,
            view.rev,
        )
        bore = abs(hole) + (cutter.loaded if hole and cutter.word else 0.0)
        # A spiral has gone all round when it has grown by Q.
        spiral = abs(view.length("I")) - abs(view.length("K")) - view.length("Q")
        inner = wall.radius - (max(0.0, spiral) if "K" in words else 0.0)
        return replace(wall, cleared=bore or core_of(cutter, inner), bore=bore), cutter, asked

    def _mitsubishi(self, view: BlockInMm, cycle: Cycle) -> Reading:
        number = view.words["D"]
        offset = self._radius(number)
        wall, cutter = self._inside(view, "I", offset, round(number))
        radius = abs(view.length("I")) - offset
        asked = MitsubishiWords(radius, cycle.turn, view.feed(), view.line, view.rev)
        return replace(wall, cleared=core_of(cutter, wall.radius)), cutter, asked

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
        entries = coded_event(view, cycle) if cycle.handler else called_event(view)
        self.plane = entries.get("W", self.plane)
        loaded, radius = self._radius(view.tool), entries["R"]
        centre, side = view.centre(), circle_mill.side_of(entries)
        place = EventPlace(
            view.seen_from(centre), view.present("z"), self.plane, view.absolute, view.line
        )
        asked = circle_mill.event_of(entries, place, loaded, view.feed(), view.rev)
        inner = radius - abs(entries.get("L", 0.0)) - 2 * loaded
        cutter = Cutter(loaded, view.tool, loaded)
        if side == 0:
            cutter = replace(cutter, word="R", circle=radius)
            radius, inner = radius + loaded, radius - loaded
        cleared = 0.0 if asked.pocket else max(0.0, inner)
        wall = Wall(centre, view.axes, radius, cleared, inside=side <= 0)
        return wall, cutter, asked

    def _handler_of(self, block: Block) -> str:
        """Return a handler's name that turns as the first arc does: the machine has its own."""
        own = self.moves[block.at : block.end]
        turns = next((move.turns for move in own if move.kind == "arc"), 1)
        return "g13" if turns > 0 else "g12"

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
    entries["G"] = circle_mill.POCKET if cycle.handler == POCKET_HANDLER else 0.0
    return entries


def core_of(cutter: Cutter, wall: float, begun: float = 0.0) -> float:
    """Return the radius of what one ring along a wall leaves standing by design.

    The cutter begins in the centre, or on a circle of radius ``begun`` there: a ring that touches
    what it clears there leaves nothing.
    """
    inner = wall - 2 * cutter.radius
    return inner if inner > begun + cutter.radius - TOUCHING else 0.0
