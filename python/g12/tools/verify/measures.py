# SPDX-License-Identifier: GPL-2.0-or-later
"""The measures of a cut by the names of ``--json`` and of the report.

mm, mm², mm/min, degrees, seconds; None is not known. Positions are the program's.
"""

import cmath
import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from g12.cut_report import CutElement, HolesCut
from g12.geometry.curve import Arc, Curve, Line
from g12.machine_ini import AXIS_LETTERS
from g12.tools.machine.ini import Ini
from g12.tools.path.part import C, X
from g12.tools.path.section_times import Leg, SectionTimes, lathe_axes, section_times
from g12.tools.verify.judge import Judgement
from g12.tools.verify.model.cut import Cut
from g12.tools.verify.model.deviation import allowed_off, circles_of, off_circles
from g12.tools.verify.model.program import TracedProgram

SIDES = {1: "left of the contour (G41)", -1: "right of the contour (G42)", 0: "on the contour"}
THIRD = {"G17": 2, "G18": 1, "G19": 0}
TURN = 1e-3  # radians of a corner, mm
ROUNDED = 6  # decimals of rings


def kind_of(cut: Cut) -> str:
    """Return the name of a cut's list in ``--json``."""
    if cut.is_section:
        return "sections"
    return "pockets" if cut.is_circle else "holes" if cut.places else "shapes"


def measures(cut: Cut, judgement: Judgement) -> dict[str, Any]:
    program = judgement.program
    own = {"pockets": _circle, "sections": _section, "holes": _holes, "shapes": _shape}
    return {
        "code": cut.code,
        "cutter": 2 * (cut.cutter or max(map(cut.offset, cut.elements), default=0.0)) or None,
        "deviation": judgement.deviations[cut.index].size,
        "allowed": allowed_off(cut, program, judgement.tolerance),
        **_times(cut, program),
        **own[kind_of(cut)](cut, program),
    }


def _times(cut: Cut, program: TracedProgram) -> dict[str, Any]:
    if cut.at >= cut.end:
        return {}
    if cut.is_tap:  # no trace has the time of a synchronized move
        return {"seconds": None, "seconds_programmed": None}
    programmed = seconds = sum(map(program.path.seconds, cut.moves))
    if program.real:
        times = program.real.time[np.isin(program.real.move, cut.moves)]
        seconds = float(times[-1] - times[0]) if len(times) else 0.0
    return {"seconds": seconds, "seconds_programmed": programmed}


# ------------------------------------------------------------ kinds of cuts


def _circle(cut: Cut, program: TracedProgram) -> dict[str, Any]:
    third = THIRD[getattr(cut.plan, "plane", "G17")]
    rings = circles_of(cut, program)
    levels = cut.plan.levels
    return {
        "dialect": program.dialects.get(cut.code),
        "centre": [value * cut.mm for value in cut.plan.centre[:2]],
        "radius": cut.inner if cut.is_boss else cut.wall,
        "boss": cut.inner if cut.is_boss else None,
        "reached": max(rings.values(), default=0.0) + cut.cutter,
        "rings": list(dict.fromkeys(round(radius, ROUNDED) for radius in rings.values())),
        "core": cut.inner or None,
        "square_to": "XYZ"[third],
        "depths": list(dict.fromkeys(level * cut.mm for level in levels)),
        "lowest": min(levels, default=0.0) * cut.mm,
        "off_circles": off_circles(cut, program).size,
    }


def _section(cut: Cut, program: TracedProgram) -> dict[str, Any]:
    fed, diameters = program.fed(cut), program.diameters(cut.at)
    lengths = [length for i in fed if (length := program.moves[i].length) > 0]
    sides = dict.fromkeys(each.side for each in cut.elements if each.side) or {0: None}
    turn, _, height, _ = cut.roles
    times, limit = times_of(cut, program.ini), program.limits.axes[turn]
    lowest = cut.floor - (0.0 if cut.surface else cut.zero[2])
    return {
        "sides": " and ".join(SIDES[side] for side in sides),
        "surface": cut.surface or None,
        "zero_line": None if cut.surface else program.moves[cut.at].start[C],
        "x_words": "diameters" if diameters else "radii",
        "third": AXIS_LETTERS[height] if cut.surface else "Z",
        "lowest": 2 * lowest if cut.surface and height == X and diameters else lowest,
        "segments": len(fed),
        "shortest": min(lengths, default=0.0),
        "longest": max(lengths, default=0.0),
        "turn": AXIS_LETTERS[turn],
        "c_speed": max(_speeds_of_c(cut, program), default=0.0),
        "c_limit": limit if math.isfinite(limit) else None,
        "seconds_planned": times and times._asdict(),
    }


def _speeds_of_c(cut: Cut, program: TracedProgram) -> Iterator[float]:
    turn = cut.roles.turn
    for index in cut.moves:
        move, seconds = program.moves[index], program.path.seconds(index)
        if seconds:
            yield abs(move.end[turn] - move.start[turn]) / seconds


def times_of(cut: Cut, ini: Ini) -> SectionTimes | None:
    """Return about how long a section takes on this machine, None where that is not estimated.

    That is on a cylinder, with the tool beside the X line, and without a feed.
    """
    drawn = [each for each in cut.drawn if each.start != each.end]
    if cut.surface or ini.tool_beside or not drawn or not all(each.feed for each in cut.elements):
        return None
    plunges = (each for each in cut.elements if each.end is None)
    plunging = sum(60 * abs(each.z1 - each.z0) / each.feed for each in plunges)
    times = section_times(list(_legs(drawn, cut)), lathe_axes(ini))
    return SectionTimes(*(plunging + each for each in times))


def _legs(drawn: Sequence[CutElement], cut: Cut) -> Iterator[Leg]:
    """Yield the tool's moves beside a contour, with its leads, and arcs round outside corners."""
    curves = [_curve(each, cut) for each in drawn]
    beside = [c.offset(each.side * cut.offset(each)) for c, each in zip(curves, drawn)]
    end, side = curves[0].start, 0
    for n, each in enumerate(drawn):
        feed, curve = each.feed * cut.mm / 60, beside[n]
        if each.side != side:  # onto the contour, or away from it
            to = beside[n + 1].start if each.side and n + 1 < len(drawn) else curve.end
            curve = Line(end, to)
        elif each.side:
            turn = (curve.start - curves[n].start) * (end - curves[n].start).conjugate()
            sweep = cmath.phase(turn) if abs(turn) > TURN else 0.0
            if sweep * each.side < -TURN:
                yield Leg(Arc(end, curves[n].start, sweep), feed)
        yield Leg(curve, feed)
        end, side = curve.end, each.side


def _curve(element: CutElement, cut: Cut) -> Curve:
    start, end = cut.point(element.start), cut.point(element.end)
    if element.centre is None:
        return Line(start, end)
    return Arc(start, cut.point(element.centre), element.sweep)


def _shape(cut: Cut, program: TracedProgram) -> dict[str, Any]:
    lowest = cut.floor - cut.zero[2]
    return {"entries": dict(cut.report.words), "third": "Z", "lowest": lowest}


def _holes(cut: Cut, program: TracedProgram) -> dict[str, Any]:
    plan = cut.plan
    assert isinstance(plan, HolesCut)
    return {
        "entries": dict(cut.report.words),
        "count": len(plan.places),
        "side": "round" if cut.surface else "on",
        "circle": 2 * plan.places[0][0] * cut.mm,
        "angles": [c for *_, c in plan.places],
        "depth": plan.depth * cut.mm,
    }
