# SPDX-License-Identifier: GPL-2.0-or-later
"""What circle a cycle's block asks for: its words, apart from the planners.

One reader per dialect. Lengths are millimetres in machine coordinates; a wall has axes of its
own, so that a pocket in any plane of a turned work coordinate system looks the same.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from g12.geometry.curve import Arc
from g12.tools.machine.ini import Ini
from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Move
from g12.tools.verify.expected.circle_mill import (
    EventWords,
    called_event,
    coded_event,
    event_of,
)
from g12.tools.verify.expected.haas import HaasWords
from g12.tools.verify.expected.mitsubishi import MitsubishiWords
from g12.tools.verify.expected.toolpath import TOUCHING, Expected
from g12.tools.verify.expected.words import BlockInMm
from g12.tools.verify.expected.yasnac import YasnacWords
from g12.tools.verify.reading.codes import EVENT, Codes, Cycle, compensates

POCKET_HANDLER = "circle_mill_pocket"
FULL = 2 * math.pi - 1e-9
DYNAMIC = (41.1, 42.1)  # compensation whose D is a diameter

Words = HaasWords | YasnacWords | MitsubishiWords | EventWords


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

    ``leaves`` is the state after the block, as ``Block.state_after`` has it; what the words do not
    say is not in it.
    """

    source: Source
    wall: Wall
    cutter: Cutter
    words: Words
    leaves: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def path(self) -> list[Expected]:
        """The expected toolpath as seen from the wall's centre."""
        return self.words.toolpath()

    @cached_property
    def circles(self) -> list[Expected]:
        """The full circles of the toolpath about the centre."""
        return [m for m in self.path if abs(getattr(m.curve, "sweep", 0.0)) > FULL]

    @property
    def arcs(self) -> list[Arc]:
        """The curves of the circles."""
        return [move.curve for move in self.circles if isinstance(move.curve, Arc)]

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
        return [
            move
            for move in self.circles
            if isinstance(move.curve, Arc) and abs(move.curve.radius - self.words.final) < TOUCHING
        ]


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
        view = BlockInMm(block, self.moves[block.at])
        name = self.codes.name_of(block.codes)
        source = Source(block.text.number, block.text.file, name, cycle.dialect)
        if cycle.dialect == EVENT:
            offset, number = self._radius(view.tool), None
            words: Words = self._event(view, cycle, offset)
        else:
            offset, number = self._offset(view, cycle.dialect)
            own = self.moves[block.at : block.end]  # of a handler of the machine's own
            turn = next((move.turns for move in own if move.kind == "arc"), 1)
            words = self._circle(view, cycle, cycle.turn or turn, offset)
        loaded, circle = self._radius(view.tool), words.final if words.word else 0.0
        named = number if offset else None
        cutter = Cutter(offset or loaded, view.tool, loaded, named, words.word, circle)
        leaves = view.leaves(words.feed, self.moves[block.end - 1])
        return Target(source, wall_of(view, words, cutter.radius), cutter, words, leaves)

    def _offset(self, view: BlockInMm, dialect: str) -> tuple[float, int | None]:
        """Return the radius by which the tool's centre stays off, and the tool that it is of."""
        if "D" in view.words:
            number = round(view.words["D"])
            found = self._radius(number), number
            if dialect == "haas":
                self.offset, self.number = found
            return found
        if dialect != "haas":
            return 0.0, None
        return self._radius(view.tool) if self.offset is None else self.offset, self.number

    def _circle(self, view: BlockInMm, cycle: Cycle, turn: int, offset: float) -> Words:
        if cycle.dialect == "haas":
            return HaasWords.of(view, turn, offset, self.ini.settings)
        if cycle.dialect == "yasnac":
            return YasnacWords.of(view, turn, offset, self.ini)
        return MitsubishiWords.of(view, turn, offset)

    def _event(self, view: BlockInMm, cycle: Cycle, cutter: float) -> EventWords:
        pocket = cycle.handler == POCKET_HANDLER
        entries = coded_event(view, pocket) if cycle.handler else called_event(view)
        self.plane = entries.get("W", self.plane)
        return event_of(entries, self.plane, view, cutter)

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


def wall_of(view: BlockInMm, words: Words, cutter: float) -> Wall:
    """Return the wall that the last circle of the tool's centre makes."""
    return Wall(
        view.centre(),
        view.axes,
        words.final + (cutter if words.inside else -cutter),
        words.cleared(cutter),
        words.inside,
        words.bore(cutter),
        view.zero()[2],
    )
