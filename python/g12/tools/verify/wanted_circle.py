# SPDX-License-Identifier: GPL-2.0-or-later
"""What circle a cycle's block asks for: its words read once more, apart from the planners.

One reader per dialect. Lengths are millimetres in machine coordinates; ``Target`` has axes of its
own, so that a pocket in any plane of a turned work coordinate system looks the same.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from g12.lengths import MM_PER_INCH
from g12.machine_ini import Remap, remap_lines
from g12.tools.install.features import model_of
from g12.tools.machine.ini import Ini
from g12.tools.path.part import plane_axes
from g12.tools.preview.executed_blocks import Block, Text
from g12.tools.preview.moves import Move

CALL = "circle_mill"
ENTRIES = "GXYZWORDCKJLPFV"
LEFT_OUT = -9999.0
POCKET = "circle_mill_pocket"  # the handler of the event's pocket
COMPENSATION = (41.0, 42.0, 41.1, 42.1)
TURNS = {"G12": -1, "G13": 1}
ROUGH_FINISH = ((-1, -1), (1, 1), (-1, 1), (1, -1))  # turns of the event by D
FORGOTTEN = 1.0  # F after the preview changed its units; see ``trace``
SAME_DEPTH = 1e-6
AT_PRESENT_Z = {"deepest": 0.0, "levels": (0.0,)}


class Feeds(NamedTuple):
    """Feeds in mm per minute or revolution: down, on arcs, on straight moves, of the finish.

    None: the words do not say.
    """

    plunge: float | None
    arc: float | None
    straight: float | None
    finish: float | None


UNSAID = Feeds(None, None, None, None)


@dataclass(frozen=True)
class Target:
    """A circle to be cut. ``inside`` says that the cutter works inside its wall.

    ``origin`` (3,) is the centre at the height where the block began, the rows of ``axes`` are
    the plane's first, second and third axis. ``radius`` is that of the wall, ``cutter`` that of
    the cutter. Between ``cleared`` and ``radius`` nothing may be left. ``deepest`` is the depth
    along the third axis, ``levels`` are all depths to be cut and ``passes`` says how often the
    finished circle is, None where the block does not say. ``smooth`` is for cycles that turn
    no corner, ``turn`` is -1 for clockwise and +1 for counterclockwise, 0 if not checked;
    ``finish_turn`` that of a last circle which finishes the wall, 0 without one.
    ``file`` is the name of the file that ``line`` is in, "" for the program.
    """

    line: int
    code: str
    dialect: str
    origin: np.ndarray
    axes: np.ndarray
    radius: float
    cutter: float
    cleared: float
    inside: bool = True
    deepest: float | None = None
    smooth: bool = True
    turn: int = 0
    finish_turn: int = 0
    levels: tuple[float, ...] | None = None
    passes: int | None = None
    feeds: Feeds = UNSAID
    circle: float = 0.0
    word: str = ""
    tool: int = 0
    loaded: float = 0.0
    offset: int | None = None
    bore: float = 0.0
    face: float = 0.0
    file: str = ""

    @property
    def plane(self) -> int:
        """Return the index of the axis (0 for X) that is square to the circle's plane."""
        return int(np.argmax(np.abs(self.axes[2])))

    def local(self, points: np.ndarray) -> np.ndarray:
        """Return points (n, 3) as seen from the centre along the plane's axes."""
        return (np.atleast_2d(points)[:, :3] - self.origin) @ self.axes.T

    def height(self, depth: float) -> float:
        """Return the machine coordinate of a depth as seen from where the block began."""
        return depth + float(self.origin @ self.axes[2])


class Codes:
    """Which codes of a machine are cycles, by its REMAP lines."""

    def __init__(self, ini: Ini) -> None:
        found = ((remap, model_of(remap)) for remap in remap_lines(ini.all))
        self._known = {
            remap.number[1] / 10: (model[0], model[1]) for remap, model in found if model
        }

    def knows(self, code: str) -> bool:
        """Tell whether a remapped code, as ``Move.remap`` has it, is one of the package."""
        return code[:1] == "G" and float(code[1:]) in self._known

    def cycle_of(self, call: str, codes: Sequence[float]) -> tuple[str, Remap | None] | None:
        """Return the dialect of the cycle that a block calls and its REMAP line."""
        if call == CALL:
            return "circle-mill", None
        known = (self._known.get(code) for code in codes)
        return next((found for found in known if found and not is_polar(found[0])), None)

    def polar(self, text: Text) -> str:
        """Return ``on``, ``off`` or nothing: what a line does to polar interpolation."""
        for code in text.codes:
            feature, model = self._known.get(code, ("", None))
            if is_polar(feature):
                return model.keywords["python"].rsplit("_", 1)[1]
        return ""

    def wanted(self, text: Text) -> bool:
        """Tell whether a line's words matter for what is programmed, or may: G[12], G#1."""
        compensation = any(code in COMPENSATION for code in text.codes)
        cycle = self.cycle_of(text.call, text.codes)
        return bool(compensation or cycle or self.polar(text) or text.hides_code)


def is_polar(feature: str) -> bool:
    """Tell whether a feature is polar interpolation."""
    return feature.startswith("polar")


@dataclass
class Reader:
    """Reads blocks in the order of execution; remembers D and W as the control does."""

    codes: Codes
    moves: Sequence[Move]
    diameters: Mapping[int, float]
    offset: float | None = None  # radius of the D last commanded, mm
    number: int | None = None  # the tool that it named
    plane: float | None = None  # W last commanded, mm in program coordinates

    def targets(self, blocks: Sequence[Block]) -> Iterator[tuple[Block, Target]]:
        """Yield each block that cuts a circle with what it asks for."""
        for block in blocks:
            cycle = self.codes.cycle_of(block.text.call, block.codes)
            if cycle and block.end > block.at:
                yield block, self._target(block, *cycle)
            elif any(code in COMPENSATION for code in block.codes):
                self._remember(block)

    def _target(self, block: Block, dialect: str, remap: Remap | None) -> Target:
        view = View(block, self.moves[block.at])
        if dialect == "circle-mill":
            target = self._circle_mill(view, remap)
        else:
            target = getattr(self, f"_{dialect}")(view)
        code = next((f"G{code:g}" for code in block.codes if code in self.codes._known), CALL)
        turn = TURNS.get(code, target.turn)
        place = {"line": block.text.number, "file": block.text.file}
        place["face"] = view.start[2] - view.present("z")
        return replace(target, **place, code=code, dialect=dialect, turn=turn)

    def _haas(self, view: View) -> Target:
        words = view.words
        if "D" in words:
            self.offset, self.number = self._radius(words["D"]), round(words["D"])
        offset = self._radius(view.tool) if self.offset is None else self.offset
        target = self._inside(view, "K" if "K" in words else "I", offset, self.number)
        passes = int(words.get("L", 1))
        counts = (1,) if view.absolute else range(1, passes + 1)
        levels = tuple(view.height("Z", count) - view.start[2] for count in counts)
        return replace(
            target,
            origin=view.centre(),
            cleared=0.0 if "K" in words else core_of(target, target.radius),
            deepest=min(levels),
            levels=levels,
            passes=passes,
            feeds=Feeds(*[view.feed()] * 3, None),
        )

    def _yasnac(self, view: View) -> Target:
        words = view.words
        offset = self._radius(words["D"]) if "D" in words else 0.0
        target = self._inside(view, "I", offset, round(words.get("D", 0)))
        bore = abs(view.length("R") or view.length("J"))
        bore += target.loaded if bore and target.word else 0.0
        # A spiral has gone all round when it has grown by Q.
        spiral = abs(view.length("I")) - abs(view.length("K")) - view.length("Q")
        inner = target.radius - (max(0.0, spiral) if "K" in words else 0.0)
        return replace(
            target,
            cleared=bore or core_of(target, inner),
            bore=bore,
            passes=int(words.get("L", 1)),
            feeds=Feeds(None, view.feed(), None, None),
            **AT_PRESENT_Z,
        )

    def _mitsubishi(self, view: View) -> Target:
        number = view.words["D"]
        target = self._inside(view, "I", self._radius(number), round(number))
        cleared, feeds = core_of(target, target.radius), Feeds(*[view.feed()] * 3, None)
        return replace(target, cleared=cleared, passes=1, feeds=feeds, **AT_PRESENT_Z)

    def _inside(self, view: View, word: str, offset: float, number: int | None) -> Target:
        """Return a pocket; without an offset the tool's centre goes round on the circle."""
        circle, loaded = abs(view.length(word)), self._radius(view.tool)
        about = {"tool": view.tool, "loaded": loaded}
        place = (0, "", "", view.start, view.axes)
        if not offset:
            about |= {"circle": circle, "word": word}
            return Target(*place, circle + loaded, loaded, 0.0, **about)
        return Target(*place, circle, offset, 0.0, offset=number, **about)

    def _circle_mill(self, view: View, remap: Remap | None) -> Target:
        event = entries_of_call(view) if remap is None else entries_of_code(view, remap)
        if "W" in event:
            self.plane = event["W"]
        loaded, wall = self._radius(view.tool), event["R"]
        levels = levels_of(event, self.plane or 0.0, view.absolute)
        turn, finish_turn = ROUGH_FINISH[int(event.get("D", 0.0))]
        side = side_of(event.get("D", 0.0), event["C"])
        inner = wall - abs(event.get("L", 0.0)) - 2 * loaded
        if side == 0:
            wall, inner = wall + loaded, wall - loaded
        pocket = event.get("G", 0.0) == 7.0
        return Target(
            0,
            "",
            "",
            view.centre(),
            view.axes,
            wall,
            loaded,
            0.0 if pocket else max(0.0, inner),
            inside=side <= 0,
            deepest=levels[-1] - view.present("z"),
            smooth=False,
            circle=0.0 if side else event["R"],
            word="" if side else "R",
            tool=view.tool,
            loaded=loaded,
            turn=turn,
            finish_turn=finish_turn if "L" in event else 0,
            levels=tuple(level - view.present("z") for level in levels),
            passes=1 if "L" in event else len(levels),
            feeds=feeds_of(event, view.feed()),
        )

    def _remember(self, block: Block) -> None:
        """Note the D of a block that switches cutter compensation on."""
        view = View(block, self.moves[min(block.at, len(self.moves) - 1)])
        dynamic = any(code in (41.1, 42.1) for code in block.codes)
        if dynamic:
            self.offset, self.number = view.length("D") / 2, None
        else:
            self.number = round(block.words.get("D", view.tool))
            self.offset = self._radius(self.number)

    def _radius(self, tool: float) -> float:
        return self.diameters.get(round(tool), 0.0) / 2


class View:
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
        self._first = first

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
        turn = np.radians(self._first.rotation)
        move = [self._way(axis) for axis in "xy"]
        across = move[0] * np.cos(turn) - move[1] * np.sin(turn)
        up = move[0] * np.sin(turn) + move[1] * np.cos(turn)
        return self.start + np.array([across, up, 0.0])

    def height(self, letter: str, times: int) -> float:
        """Return the height in machine coordinates that a Z word leads to, ``times`` over."""
        if self.absolute:
            return self.start[2] + self.length(letter) - self.present("z")
        return self.start[2] + times * self.length(letter)

    def _way(self, axis: str) -> float:
        if axis.upper() not in self.words:
            return 0.0
        word = self.length(axis.upper())
        return word - self.present(axis) if self.absolute else word


def entries_of_call(view: View) -> dict[str, float]:
    """Return the entries of ``o<circle_mill> call``, mm; X and Y go where the words would."""
    given = dict(zip(ENTRIES, view.arguments))
    entries = {
        letter: value * (1.0 if letter in "GDC" else view.unit)
        for letter, value in given.items()
        if value != LEFT_OUT
    }
    view.words = {letter: given[letter] for letter in "XY"}
    return entries


def entries_of_code(view: View, remap: Remap) -> dict[str, float]:
    """Return the entries of a G12.2 or G13.2 block, mm."""
    letters = {"R": "R", "Z": "Z", "W": "I", "L": "Q", "K": "K", "P": "P"}
    entries = {entry: view.length(word) for entry, word in letters.items() if word in view.words}
    if view.words.get("L") == 0.0:
        entries["L"] = -entries["L"]
    entries["D"], entries["C"] = view.words.get("D", 0.0), view.words["H"]
    entries["G"] = 7.0 if POCKET in remap.handlers else 0.0
    return entries


def core_of(target: Target, wall: float) -> float:
    """Return the radius of what one ring along a wall leaves standing by design."""
    return max(0.0, wall - 2 * target.cutter)


def levels_of(event: Mapping[str, float], plane: float, absolute: bool) -> list[float]:
    """Return the heights that an event cuts at, in program coordinates, downward from W."""
    final = event["Z"] if absolute else plane + event["Z"]
    rough = final + max(0.0, event.get("L", 0.0))
    peck = event.get("K", plane - rough)
    levels = [plane - peck]
    while levels[-1] > rough + SAME_DEPTH:
        levels.append(levels[-1] - peck)
    levels[-1] = rough
    return levels + [final] * (rough > final)


def feeds_of(event: Mapping[str, float], feed: float | None) -> Feeds:
    """Return the feeds of an event; ``feed`` is the block's or the one in force."""
    rough = event.get("F", feed)
    finish = event.get("V", rough) if "L" in event else None
    return Feeds(event.get("P", rough), rough, rough, finish)


def side_of(direction: float, compensation: float) -> int:
    """Return where the cutter works: -1 inside the wall, +1 outside, 0 on the circle."""
    left_is = 1 if int(direction) in (0, 2) else -1  # clockwise has the outside on its left
    return {0: 0, 1: left_is, 2: -left_is}[int(compensation)]
