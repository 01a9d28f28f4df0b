# SPDX-License-Identifier: GPL-2.0-or-later
"""A shape that was measured: its facts, and what is wrong with them in words."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby

from g12.tools.path.follow import Followed
from g12.tools.path.track import Track
from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Move
from g12.tools.units import MM, Unit, plain
from g12.tools.verify.compare.state import StateDifference, state_differences
from g12.tools.verify.expected.contour import ACTS, SectionContour
from g12.tools.verify.result.tolerances import AREA, LAST_DECIMAL
from g12.tools.verify.shapes.shape_cut import LevelFacts, ShapeAreas, measure_areas, shift_of
from g12.tools.verify.shapes.shape_form import CORNERS, DIAMETER, FLATS, LENGTH, WIDTH, Shift
from g12.tools.verify.shapes.shape_motion import OffShape, motion_of_shape
from g12.tools.verify.shapes.shape_way import SAME_LEVEL, ShapeWay
from g12.tools.verify.shapes.wanted_shape import ShapeAsked

ROUNDING = 0.001  # mm, of the polygons that stand for areas
SIZES = {
    FLATS: "the flats are {} {unit} apart, not {}",
    CORNERS: "its corners are {} {unit} from the centre, not {}",
    WIDTH: "it is {} {unit} wide, not {}",
    LENGTH: "it is {} {unit} long, not {}",
    DIAMETER: "its diameter is {} {unit}, not {}",
}
PARTS = {
    FLATS: "a flat",
    CORNERS: "a corner",
    WIDTH: "a wall",
    LENGTH: "an end",
    DIAMETER: "the wall",
}


@dataclass(frozen=True)
class ShapeFacts:
    """What was measured of one shape.

    ``shift`` is how it lies otherwise than asked; all the rest is judged where it lies.
    ``motion`` is what of its motion is not as asked, ``acts`` what the call does besides moving,
    ``left_behind`` what it leaves otherwise than it was. ``tolerance`` (mm) is what its walls may
    be off.
    """

    asked: ShapeAsked
    shift: Shift
    areas: ShapeAreas
    motion: tuple[OffShape, ...]
    left_behind: tuple[StateDifference, ...]
    acts: tuple[str, ...]
    tolerance: float

    @property
    def reached(self) -> tuple[tuple[str, float, float], ...]:
        """Return the name of each size, the size asked, and the one reached."""
        end, asked = self.areas.end, self.asked.form.extremes
        if end is None or not end.stands:
            return ()
        sizes: dict[str, list[tuple[float, float]]] = {}
        for extreme, more in zip(asked, end.stands):
            sizes.setdefault(extreme.name, []).append((extreme.reach, extreme.reach + more))
        return tuple(
            (name, *(times_of(name) * sum(column) / len(pairs) for column in zip(*pairs)))
            for name, pairs in sizes.items()
        )


def measure_shape(
    block: Block,
    asked: ShapeAsked,
    sections: Sequence[SectionContour],
    path: Track,
    moves: Sequence[Move],
    tolerance: float,
    real: Followed | None = None,
) -> ShapeFacts:
    """Return the facts of a shape; ``sections`` are those of its call."""
    way = ShapeWay(asked, moves, path, real)
    allowed = tolerance + LAST_DECIMAL + ROUNDING
    shift = shift_of(way, allowed)
    way = way._replace(asked=replace(asked, form=asked.form.placed(shift)))
    areas = measure_areas(way, allowed)
    return ShapeFacts(
        asked,
        shift,
        areas,
        tuple(motion_of_shape(way, sections, areas.rough, allowed)),
        state_differences(block.left, asked.leaves),
        tuple(dict.fromkeys(each.text for each in block.own_events if ACTS.match(each.text))),
        allowed,
    )


def shape_findings(facts: ShapeFacts, unit: Unit = MM) -> Iterator[str]:
    """Yield what is wrong with a shape."""
    if not facts.areas.cut:
        yield "nothing is cut"
        return
    sizes = list(size_findings(facts, unit))
    yield from sizes
    yield from pass_findings(facts, unit)
    yield from allowance_findings(facts, unit)
    yield from area_findings(facts, unit)
    yield from (shape_text(off, unit) for off in facts.motion)
    yield from (f"{text} comes in it, which the call has not" for text in facts.acts)
    yield from map(leaving_text, facts.left_behind)


def leaving_text(left: StateDifference) -> str:
    """Return in words what is left behind otherwise than the words ask."""
    found, expected = left.texts()
    return f"it leaves {found}, not {expected}"


def shape_text(off: OffShape, unit: Unit) -> str:
    """Return in words what is not as asked."""
    return off.what.format(*map(unit.text, off.lengths), unit=unit.name)


def size_findings(facts: ShapeFacts, unit: Unit) -> Iterator[str]:
    """Yield which sizes of a shape are not those asked."""
    end, form = facts.areas.end, facts.asked.form
    if end is None or not end.stands:
        return
    if facts.shift.turned:
        yield f"it is turned by {plain(facts.shift.turned, 2)}°"
    if facts.shift.away:
        yield centre_text(facts, unit)
    if is_kept(end, facts):
        yield f"its allowance of {unit.text(facts.asked.allowance)} {unit.name} is left standing"
        return
    pairs = list(zip(form.extremes, end.stands))
    for name, group in groupby(sorted(pairs, key=lambda pair: pair[0].name), lambda p: p[0].name):
        yield from extreme_findings(name, list(group), facts, unit)


def is_kept(level: LevelFacts, facts: ShapeFacts) -> bool:
    """Tell whether all of a shape's allowance stands on its walls."""
    kept = facts.asked.allowance * facts.asked.form.outward
    flat = [m for e, m in zip(facts.asked.form.extremes, level.stands) if e.name != CORNERS]
    return kept != 0.0 and max(abs(more - kept) for more in flat) < facts.tolerance < abs(kept)


def centre_text(facts: ShapeFacts, unit: Unit) -> str:
    """Return in words that a round pocket is not where it should be."""
    asked = facts.asked
    turn = cmath.rect(1.0, -math.radians(asked.zero[2]))
    centre = asked.form.centre
    was, wanted = (
        f"X{unit.text(place.real * (2 if asked.diameters else 1))} C{unit.text(place.imag)}"
        for place in ((centre + facts.shift.away) * turn, centre * turn)
    )
    return f"its centre is at {was}, not at {wanted}"


def extreme_findings(name: str, pairs: list, facts: ShapeFacts, unit: Unit) -> Iterator[str]:
    """Yield that the walls of one name are not where they should be: all alike, or the worst."""
    stands = [more for _, more in pairs]
    middle, reach = sum(stands) / len(stands), pairs[0][0].reach
    alike = max(stands) - min(stands) < 2 * facts.tolerance
    if max(map(abs, stands)) < facts.tolerance:
        return
    if name == DIAMETER or (alike and not (name == FLATS and len(pairs) % 2)):
        if abs(middle) > facts.tolerance:
            found, wanted = (times_of(name) * size for size in (reach + middle, reach))
            yield SIZES[name].format(unit.text(found), unit.text(wanted), unit=unit.name)
        return
    worst = middle if alike else max(stands, key=abs)
    what = "its flats are" if alike else f"{PARTS[name]} is"
    yield f"{what} {unit.text(reach + worst)} {unit.name} from the centre, not {unit.text(reach)}"


def times_of(name: str) -> float:
    """Return how often a size is the reach of its extremes: corners are told by their distance."""
    return 1.0 if name == CORNERS else 2.0


def pass_findings(facts: ShapeFacts, unit: Unit) -> Iterator[str]:
    """Yield that a shape is not cut at the heights of its passes, in their order."""
    wanted, cut = facts.asked.levels, facts.areas.cut
    same = len(wanted) == len(cut) and max(map(abs, map(float.__sub__, wanted, cut))) < SAME_LEVEL
    if not same:
        was, instead = (", ".join(f"Z{unit.text(each)}" for each in some) for some in (cut, wanted))
        yield f"it is cut at {was}, not at {instead}"
    if min(*cut, *wanted) - facts.areas.lowest > SAME_LEVEL:
        yield f"it goes down to Z{unit.text(facts.areas.lowest)}, below its depth"


def allowance_findings(facts: ShapeFacts, unit: Unit) -> Iterator[str]:
    """Yield that a level's walls have not the allowance to those of the last round."""
    end, asked = facts.areas.end, facts.asked
    if end is None or is_kept(end, facts):
        return
    for level in facts.areas.levels:
        pairs = zip(asked.form.extremes, level.stands, end.stands)
        walls = [(more - last) for each, more, last in pairs if each.name != CORNERS]
        off = [more * asked.form.outward for more in walls]
        if not off or max(abs(each - asked.allowance) for each in off) < 2 * facts.tolerance:
            continue
        least, most = (f"{unit.text(each)} {unit.name}" for each in (min(off), max(off)))
        found = most if max(off) - min(off) < 2 * facts.tolerance else f"{least} to {most}"
        at = f"at Z{unit.text(level.height)}"
        yield f"{at} its walls keep {found}, not {unit.text(asked.allowance)}"
        return


def area_findings(facts: ShapeFacts, unit: Unit) -> Iterator[str]:
    """Yield what is left and gouged, at the first level where it is and at the end."""
    end = facts.areas.end
    for what in ("left", "gouge"):
        rough = [level for level in facts.areas.levels if getattr(level, what) > AREA]
        done = [end] if end and getattr(end, what) > AREA else []
        for level in [*rough, *done][:1]:
            yield area_text(what, level, level is end, facts, unit)


def area_text(what: str, level: LevelFacts, at_end: bool, facts: ShapeFacts, unit: Unit) -> str:
    """Return in words what a level leaves, or cuts away."""
    area, at = unit.area(getattr(level, what)), f"at Z{unit.text(level.height)}"
    kept = facts.asked.allowance and not at_end
    if what == "left":
        return f"{area} are left standing {'beyond the allowance ' if kept else ''}{at}"
    return f"{area} are {'cut out of the allowance' if kept else 'gouged'} {at}"


def shape_rows(facts: ShapeFacts, unit: Unit) -> list[tuple[str, str]]:
    """Return the rows of a shape's paragraph in a report."""
    asked, sizes = facts.asked, facts.reached
    reached = ", ".join(f"{name} {unit.text(got)}" for name, _, got in sizes) or "nothing"
    wanted = ", ".join(f"{name} {unit.text(size)}" for name, size, _ in sizes)
    heights = ", ".join(unit.text(height) for height in facts.areas.cut)
    return [
        ("cutter", f"⌀ {unit.text(2 * asked.cutter)}"),
        ("programmed", f"{wanted} {unit.name}".strip()),
        ("reached", f"{reached} {unit.name}"),
        ("levels", heights or "none"),
        ("allowance", f"{unit.text(asked.allowance)} {unit.name}" if asked.allowance else "none"),
    ]


def shape_json(facts: ShapeFacts) -> Mapping[str, object]:
    """Return one shape as plain values: mm, mm², degrees."""
    asked, areas = facts.asked, facts.areas
    return {
        "line": asked.line,
        "file": asked.file or None,
        "code": asked.name,
        "cutter": 2 * asked.cutter,
        "sizes": {name: [size, got] for name, size, got in facts.reached},
        "turned": facts.shift.turned,
        "allowance": asked.allowance,
        "levels": list(areas.cut),
        "left": max((level.left for level in levels_of_areas(areas)), default=None),
        "gouge": max((level.gouge for level in levels_of_areas(areas)), default=None),
        "findings": list(shape_findings(facts)),
    }


def levels_of_areas(areas: ShapeAreas) -> list[LevelFacts]:
    """Return what is known of all levels, the end included."""
    return [*areas.levels, *([areas.end] if areas.end else [])]
