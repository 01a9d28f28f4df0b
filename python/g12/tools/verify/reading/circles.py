# SPDX-License-Identifier: GPL-2.0-or-later
"""The circle that a cycle's block commands, read from its words without the planners.

Lengths are millimetres in machine coordinates. A wall has axes of its own, so that a pocket in any
plane of a rotated work coordinate system is measured alike.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from g12.tools.machine.ini import Ini
from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Move, Trace
from g12.tools.verify.expected.circle_mill import (
    EventWords,
    entries_of_call,
    entries_of_code,
    words_of_call,
)
from g12.tools.verify.expected.haas import HaasWords
from g12.tools.verify.expected.mitsubishi import MitsubishiWords
from g12.tools.verify.expected.toolpath import Expected, Point
from g12.tools.verify.expected.words import BlockInMm
from g12.tools.verify.expected.yasnac import YasnacWords
from g12.tools.verify.reading.codes import EVENT, Codes, Cycle, compensates

DECIMALS = 6  # of Z0, which each block computes for itself
POCKET_HANDLER = "circle_mill_pocket"
DYNAMIC = {41.1, 42.1}  # compensation whose D is a diameter

BlockWords = HaasWords | YasnacWords | MitsubishiWords
WORDS: Mapping[str, type[BlockWords]] = {
    "haas": HaasWords,
    "yasnac": YasnacWords,
    "mitsubishi": MitsubishiWords,
}
Words = BlockWords | EventWords


@dataclass(frozen=True)
class Wall:
    """The wall to be cut, mm; ``inside`` says that the cutter works inside it.

    ``origin`` (3,) is the centre at the tool's level before the block, the rows of ``axes`` are
    the plane's first, second and third axis. Between ``cleared`` and ``radius`` no material may
    remain. ``bore`` is the radius of the hole that was there before, ``face`` the program's Z0.
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
        """The index of the axis (0 for X) at right angles to the circle's plane."""
        return int(np.argmax(np.abs(self.axes[2])))

    @property
    def core(self) -> float:
        """The radius of the core that remains by design, 0 without one."""
        return 0.0 if self.bore or not self.inside else self.cleared

    def local(self, points: np.ndarray) -> np.ndarray:
        """Return machine points (n, 3) from the centre, along the plane's axes."""
        return (np.atleast_2d(points)[:, :3] - self.origin) @ self.axes.T

    def machine(self, point: Point) -> tuple[float, ...]:
        flat, level = point
        return tuple(map(float, self.origin + [flat.real, flat.imag, level] @ self.axes))

    def height(self, depth: float) -> float:
        """Return the machine coordinate of a depth below the tool's level before the block."""
        return depth + float(self.origin @ self.axes[2])


@dataclass(frozen=True)
class Cutter:
    """The cutter, by its radius in mm: that of D or, where no tool is ``named``, the loaded one.

    ``tool`` is the loaded tool's number, ``loaded`` its radius.
    """

    radius: float
    tool: int = 0
    loaded: float = 0.0
    named: int | None = None


@dataclass(frozen=True)
class Target:
    """A commanded circle: its block's line, the wall to be cut, the cutter and the words.

    ``file`` is the name of a sub's own, "" for the program. ``leaves`` is the expected modal state
    after the block, as ``Block.state_after`` has it, as far as the words define it.
    """

    line: int
    file: str
    code: str
    dialect: str
    wall: Wall
    cutter: Cutter
    words: Words
    leaves: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def path(self) -> list[Expected]:
        return self.words.toolpath()

    @cached_property
    def circles(self) -> list[Expected]:
        return [move for move in self.path if move.is_circle]

    @cached_property
    def depths(self) -> tuple[float, ...]:
        """The depths of the circles, each once, downward."""
        return tuple(sorted({move.end_level for move in self.circles}, reverse=True))

    @property
    def deepest(self) -> float:
        return self.depths[-1]


@dataclass
class CircleReader:
    """Reads blocks in the order of execution; remembers D and W as the control does."""

    codes: Codes
    ini: Ini
    trace: Trace
    offset: float | None = None  # radius of the D last commanded, mm
    number: int | None = None  # the tool that it named
    diameters: Mapping[int, float] = field(default_factory=dict)  # in the block
    planes: Mapping[str, float] = field(default_factory=dict)  # W and O last commanded, mm

    def targets(self, blocks: Sequence[Block]) -> Iterator[tuple[Block, Target]]:
        """Yield each block that cuts a circle, and its target."""
        for block in blocks:
            self.diameters = self.trace.table_at(block.at).diameters
            cycle = self.codes.cycle_of(block.text.call, block.codes)
            if cycle and block.end > block.at:
                yield block, self._target(block, cycle)
            elif compensates(block.codes):
                self._remember(block)

    def _target(self, block: Block, cycle: Cycle) -> Target:
        own = self.trace.moves[block.at : block.end]
        if cycle == Cycle(EVENT):
            block = replace(block, words=words_of_call(block.arguments))
        view = BlockInMm(block, own[0])
        loaded = self._radius(view.tool)
        offset, number = (loaded, None) if cycle.dialect == EVENT else self._offset(view, cycle)
        words = self._words(view, cycle, offset, own)
        cutter = Cutter(offset or loaded, view.tool, loaded, number if offset else None)
        return Target(
            view.line,
            block.text.file,
            self.codes.name_of(block.codes),
            cycle.dialect,
            wall_of(view, words, cutter.radius),
            cutter,
            words,
            view.leaves(words.feed, own[-1]),
        )

    def _words(self, view: BlockInMm, cycle: Cycle, offset: float, own: Sequence[Move]) -> Words:
        if cycle.dialect == EVENT:
            is_pocket = cycle.handler == POCKET_HANDLER
            entries = entries_of_code(view, is_pocket) if cycle.handler else entries_of_call(view)
            self.planes = {**self.planes, **{k: v for k, v in entries.items() if k in "WO"}}
            return EventWords.of(view, {**self.planes, **entries}, offset)
        actual = next((move.turns for move in own if move.kind == "arc"), 1)
        return WORDS[cycle.dialect].of(view, cycle.turn or actual, offset, self.ini)

    def _offset(self, view: BlockInMm, cycle: Cycle) -> tuple[float, int | None]:
        """Return the radius by which the tool's centre keeps off the wall, and the tool of it."""
        found = (0.0, None) if cycle.dialect != "haas" else (self.offset, self.number)
        if "D" in view.words:
            number = round(view.words["D"])
            found = self._radius(number), number
            if cycle.dialect == "haas":
                self.offset, self.number = found
        offset, number = found
        return self._radius(view.tool) if offset is None else offset, number

    def _remember(self, block: Block) -> None:
        """Remember the D of a block that switches cutter compensation on."""
        moves = self.trace.moves
        view = BlockInMm(block, moves[min(block.at, len(moves) - 1)])
        if DYNAMIC.intersection(block.codes):
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
        round(float(view.zero()[2]), DECIMALS),
    )
