# SPDX-License-Identifier: GPL-2.0-or-later
"""The entries of a shape's call, by name, and the values of those that all shapes share.

Lengths are in program units.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import atan2, degrees, hypot
from typing import NamedTuple

from g12.cut_report import LOADED, PlannedCut, ShapePasses, UsedCutter
from g12.errors import number
from g12.request import LEFT_OUT, Words, loaded_tool, steps_between
from g12.state import State

PASS_ENTRIES = ("depth_per_pass", "allowance", "feed", "plunge_feed")
CLEAR_MM = 1.0  # clearance of the tool from the face, or the stock, at the end of its rapid
WIDEST = 0.75  # of the cutter's diameter: greatest stepover
MOST_SHAPE_PASSES = 10_000  # more are a mistyped depth_per_pass
MOST_MOVES = 100_000  # takes minutes to read, during which LinuxCNC handles no abort
MOST_ANGLE = 360.0  # LinuxCNC's limit of a position on a wrapped rotary axis


class ShapeEntries(Words):
    """The entries of one call, to be taken one by one; ``code`` is the name of the sub."""

    def __init__(
        self, code: str, names: Sequence[str], values: Mapping[str, float], context: State
    ) -> None:
        # LinuxCNC makes an entry 0 if the call is too short
        call = f"a call has {len(names)} entries, {number(LEFT_OUT)} leaves one out"
        self.positive_rule = f"{self.positive_rule} ({call})"
        given = {name: values[name] for name in names if values[name] != LEFT_OUT}
        super().__init__(code, given, context)

    @staticmethod
    def written(letter: str, value: float) -> str:
        """Return an entry as messages name it: ``width 8``."""
        return f"{letter} {number(value)}"

    def from_zero(self, letter: str) -> float:
        """Return an entry that is zero or more, zero if it is left out."""
        value = self.take(letter) or 0.0
        if value < 0:
            raise self.refuse_word(letter, value, "must not be below 0")
        return value

    def angle(self, letter: str) -> float:
        value = self.take(letter) or 0.0
        if abs(value) > MOST_ANGLE:
            rule = f"must lie between -{number(MOST_ANGLE)} and {number(MOST_ANGLE)}"
            raise self.refuse_word(letter, value, rule)
        return value


class ShapeMachine(NamedTuple):
    """The machine's settings that a shape depends on.

    ``diameters``: X words are diameters in a section. ``entry_angle`` in degrees is that of a ramp
    or helix, ``plunge_share`` the share of F for the descent unless the call has a plunge feed. A
    path within ``pole`` of the spindle's centre runs through it; ``pole_refused``: none may. A tool
    beside the X line comes no nearer to that centre than ``nearest``.
    """

    diameters: bool
    entry_angle: float
    plunge_share: float
    pole: float
    pole_refused: bool
    nearest: float = 0.0


class Descent(NamedTuple):
    """The Z levels of a shape, at equal steps, and the way down to them.

    Feeds are per minute, or per revolution under G95. ``start_z`` is Z of the tool at the start and
    the end, ``near_z`` is where its rapid down ends.
    """

    levels: int
    step_down: float
    feed: float
    plunge_feed: float
    start_z: float
    near_z: float

    @property
    def extent(self) -> tuple[float, float]:
        return -self.levels * self.step_down, self.start_z


class Extent(NamedTuple):
    """The extent of the tool centre's path: X as a radius, Z, C in degrees; lowest and highest."""

    x: tuple[float, float]
    z: tuple[float, float]
    c: tuple[float, float]


class ShapePlan(NamedTuple):
    """A checked shape, or holes: the named locals of its sub beside the entries, and its extent.

    Lengths and feeds are in program units, X is a radius, angles are in degrees.
    ``cut`` returns what is reported of it.
    """

    locals: dict[str, float]
    extent: Extent
    cut: Callable[[], PlannedCut]


def descent_of(entries: ShapeEntries, machine: ShapeMachine) -> Descent:
    """Return the levels and feeds of a shape, whose tool must be above the face."""
    context = entries.context
    depth = entries.require_positive("depth", "how deep, from the face at Z0")
    most = entries.take_positive("depth_per_pass") or depth
    levels = max(1, steps_between(0.0, depth, most, context.rounding))
    if levels > MOST_SHAPE_PASSES:
        rule = f"makes {levels} passes of depth {number(depth)}, the most is {MOST_SHAPE_PASSES}"
        raise entries.refuse_word("depth_per_pass", most, rule)
    feed = feed_of(entries)
    plunge_feed = entries.take_positive("plunge_feed") or feed * machine.plunge_share
    if not context.z > 0:
        rule = "a shape begins at the tool's position, which must be above the face at Z0"
        raise entries.refuse(f"Z{number(context.z)}: {rule}")
    near_z = min(context.z, context.length(CLEAR_MM))
    return Descent(levels, depth / levels, feed, plunge_feed, context.z, near_z)


def feed_of(entries: ShapeEntries) -> float:
    """Return the entry feed, by default the active F."""
    context = entries.context
    feed = entries.take_positive("feed") or context.feed
    if not feed > 0:
        raise entries.refuse("feed is missing, and no F is active")
    if context.per_revolution and not context.speed:
        raise entries.refuse("feed per revolution (G95) needs the spindle speed S")
    return feed


def passes_of(entries: ShapeEntries, descent: Descent) -> ShapePasses:
    """Return what is reported of the passes of a shape."""
    tool = loaded_tool(entries)
    return ShapePasses(
        tuple(-descent.step_down * (level + 1) for level in range(descent.levels)),
        UsedCutter(tool.radius, LOADED, tool.number),
        descent.feed,
        descent.plunge_feed,
    )


def polar_position(entries: ShapeEntries, diameters: bool) -> tuple[float, float]:
    """Return radius and angle in degrees of the entries x, a diameter if so, and c."""
    x, c = entries.take("x") or 0.0, entries.take("c") or 0.0
    x = x / 2 if diameters else x
    return hypot(x, c), degrees(atan2(c, x))


def check_nearest(entries: ShapeEntries, extent: Extent, machine: ShapeMachine) -> None:
    """Refuse a shape nearer to the spindle's centre than a tool beside the X line can come."""
    if extent.x[0] < machine.nearest:
        raise entries.refuse(
            f"the tool's centre would come to {number(extent.x[0])} from the spindle's centre,"
            f" where [G12] POLAR_TOOL_OFFSET lets it no nearer than {number(machine.nearest)}"
        )


def check_finish(entries: ShapeEntries, allowance: float, cutter: float) -> None:
    """Refuse an allowance that one round of the cutter cannot remove."""
    most = WIDEST * 2 * cutter
    if allowance > most:
        size = entries.context.tool_size(2 * cutter)
        rule = f"must be at most {number(most)}, what one round of the cutter of {size} takes"
        raise entries.refuse_word("allowance", allowance, rule)


def check_moves(entries: ShapeEntries, moves: int, cause: str) -> None:
    """Refuse a shape of too many moves; ``cause`` names their entries."""
    if moves > MOST_MOVES:
        raise entries.refuse(f"{cause} {moves} moves, the most is {MOST_MOVES}")


def rounds_between(first: float, last: float, cutter: float, rounding: float) -> int:
    """Return the number of rounds from one radius to another, none wider than the cutter can."""
    return steps_between(first, last, WIDEST * 2 * cutter, rounding)


def locals_of(*groups: NamedTuple) -> dict[str, float]:
    return {name: value for group in groups for name, value in group._asdict().items()}
