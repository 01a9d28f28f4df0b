# SPDX-License-Identifier: GPL-2.0-or-later
"""A section's zero line of C, side and place; what is drilled; levels that are the same."""

import math
import re
from collections.abc import Sequence

import numpy as np
from shapely.geometry import Point

from g12.cut_report import PocketCut, ThreadCut
from g12.tools.path.part import C, disc
from g12.tools.verify.model.cut import Outline
from g12.tools.verify.model.finding import FINDING, WARNING
from g12.tools.verify.model.program import SIZE, SUB_BEGIN
from g12.tools.verify.model.solid import FACE, JUST_ABOVE
from g12.tools.verify.rules.table import EACH, Site, Values, rule

ROUND_ANGLE = 1e-3  # degrees: angles that are programmed are multiples of it
SAME_ANGLE = 1e-2
STAYED = 1e-6
AT_EDGE = 0.01  # mm
MIDDLE = 0.2  # mm: the radius of a hole's middle
OPEN_INSIDE, OPEN_AROUND = 0.9, 1.1  # times the radius that is to be open
CLOSED_SHARE = 0.05  # of that area: less may stand
LEVELS_MEANT = 3  # L2 is a spring pass
BY_MACHINE = re.compile(r"G(53|28|30)(?!\d)")
FAR, WIDE = 3.0, 1.5  # times a bar
THROUGH = 2.0  # mm below the block: more is no through hole
POINT = 0.6  # of a drill's radius: how far its point goes below a hole


@rule("c-zero", FINDING, "C is where line {line} left it, {angle:3}°: the zero line is turned")
def zero_line(site: Site) -> Values:
    cut, program = site.own, site.program
    if not cut.is_section or cut.surface or not cut.index or cut.c_commanded == "angle":
        return None
    before = program.cuts[cut.index - 1]
    left, here = program.moves[before.end - 1].end[C], program.moves[cut.at].start[C]
    angle, stayed = here - cut.zero_c, abs(here - left) < STAYED
    if not stayed and (_is_round(angle) or not _is_round(here - left)):
        return None
    first = next((each for each in program.cuts[: cut.index] if not each.surface), None)
    turned = math.remainder(angle - (first.report.at[3] if first else 0.0), 360.0)
    return {"line": before.line, "angle": angle} if abs(turned) > SAME_ANGLE else None


def _is_round(angle: float) -> bool:
    return abs(angle / ROUND_ANGLE - round(angle / ROUND_ANGLE)) < SAME_ANGLE


@rule(
    "place-unknown",
    WARNING,
    "no line before it says {axes}: it is cut where the tool stands",
    once=True,
)
def place_unknown(site: Site) -> Values:
    cut, program = site.own, site.program
    has_subs = program.calls_files or any(map(SUB_BEGIN.search, program.texts))
    if cut.file or has_subs or not (cut.is_circle or cut.is_section):
        return None
    lines = program.texts[: cut.line - cut.report.incremental]
    unsaid = [axis for axis in ("XZ" if program.turning else "XYZ") if not _is_said(axis, lines)]
    on_face = cut.is_section and not cut.surface and not cut.index
    unsaid += ["C"] if on_face and not cut.c_commanded else []
    return {"axes": " and ".join(unsaid)} if unsaid else None


def _is_said(axis: str, lines: Sequence[str]) -> bool:
    word = re.compile(rf"{axis}\s*[-+.\d\[#]")
    return any(word.search(line) and not BY_MACHINE.search(line) for line in lines)


@rule("side", FINDING, "the tool comes from the other side: {instead} in line {lead}?")
def wrong_side(site: Site) -> Values:
    for outline in site.own.outlines:
        if _is_crossed(outline, site):
            instead = "G42" if outline.left else "G41"
            lead = outline.lines[0]
            return {"instead": instead, "lead": lead, "at_line": lead}
    return None


def _is_crossed(outline: Outline, site: Site) -> bool:
    """Return whether the lead-in begins on the part's side of a contour."""
    if outline.is_closed:
        start = Point(outline.lead.real, outline.lead.imag)
        if outline.polygon.boundary.distance(start) < AT_EDGE:
            return False
        return bool(outline.polygon.contains(start)) != outline.tool_inside
    along = outline.points[1] - outline.points[0]
    beside = ((outline.lead - outline.points[0]) * np.conj(along)).imag / abs(along)
    low = max(outline.level, outline.lead_level) < site.solids.top(site.own.surface)
    return low and (beside if outline.left else -beside) < -AT_EDGE


@rule(
    "far-beside",
    FINDING,
    "it goes to {reach:length} from the axis, the bar is {bar:mm}: C in degrees?",
)
def far_beside(site: Site) -> Values:
    cut, bar = site.own, site.solids.given_bar
    far = cut.is_section and not cut.surface and cut.deep_reach > FAR * bar + site.loaded
    return {"reach": cut.deep_reach, "bar": bar} if bar and far else None


@rule("surface", FINDING, "its radius {radius:mm} is not the bar's, {bar:mm}: is C a radius here?")
def other_surface(site: Site) -> Values:
    bar, radius = site.solids.given_bar, site.own.surface
    other = site.own.is_section and bar and radius > WIDE * bar
    return {"radius": radius, "bar": bar} if other else None


@rule("tap-undrilled", WARNING, "the tap goes deeper than what is drilled", plain=EACH)
def undrilled(site: Site) -> Values:
    cut, program = site.cut, site.program
    if not (cut.is_tap if cut else site.radius and program.moves[site.at].block in program.tapping):
        return None
    if cut:
        places, level, side = cut.places, cut.floor, cut.surface
    else:
        _, tip = site.lowest
        places, level, side = [complex(*tip[:2])], tip[2], FACE
    middles = (Point(at.real, at.imag).buffer(MIDDLE) for at in places)
    left = (site.solids.standing(each, level, side, before=site.at) for each in middles)
    return {} if any(each.area > MIDDLE**2 for each in left) else None


@rule("below-stock", FINDING, "it goes {below:length} below the block", plain=EACH)
def below_stock(site: Site) -> Values:
    bottom = site.solids.bottom
    if site.cut:
        below = bottom - site.cut.floor
        return {"below": below} if below > THROUGH else None
    index, tip = site.lowest
    below = bottom - tip[2]
    line = site.program.where(index)[0]
    deep = below > THROUGH + POINT * site.radius
    return {"below": below, "place": tip, "at_line": line} if deep else None


@rule("beside-stock", WARNING, "it cuts beside the stock alone", plain=EACH)
def beside_stock(site: Site) -> Values:
    program, solids, stock = site.program, site.solids, site.solids.stock
    if site.cut or not site.radius or not (stock and stock.is_whole):
        return None
    index, tip = site.lowest
    if tip[2] > solids.top(FACE) - JUST_ABOVE:
        return None
    approach = program.cut_at(min(site.moves.stop, len(program.moves) - 1))
    met = solids.of(FACE).is_under(program.tips(site.moves)[:, :2], site.radius)
    line = program.where(index)[0]
    return None if approach or met else {"place": tip, "at_line": line}


@rule(
    "not-open",
    FINDING,
    "{area:mm2} of material stand at Z{level:mm} where it is to be open: was it cut before?"
    " (--stock 'bore DIAMETER')",
)
def not_open(site: Site) -> Values:
    """Look inside of a bore's K and of an inner thread, and around the boss of an outer one."""
    cut, program = site.own, site.program
    plan = cut.plan
    if isinstance(plan, ThreadCut) and plan.outside:
        boss = disc(cut.centre, OPEN_AROUND * cut.wall)
        region = disc(cut.centre, cut.wall + 2 * cut.radius).difference(boss)
    elif isinstance(plan, ThreadCut):
        region = disc(cut.centre, OPEN_INSIDE * plan.small * cut.mm)
    elif program.dialects.get(cut.code) == "bore":
        region = disc(cut.centre, OPEN_INSIDE * cut.report.words.get("K", 0.0) * cut.mm)
    else:
        return None
    standing = site.solids.standing(region, cut.floor, cut.surface, before=cut.at)
    closed = standing.area > CLOSED_SHARE * region.area
    return {"area": standing.area, "level": cut.floor - cut.zero[2]} if closed else None


@rule("same-levels", WARNING, "its {n} levels are all at Z{level:mm}: L steps in G91 only")
def same_levels(site: Site) -> Values:
    cut = site.own
    levels = cut.levels if isinstance(cut.plan, PocketCut) else []
    if len(levels) < LEVELS_MEANT or max(levels) - min(levels) > SIZE:
        return None
    return {"n": len(levels), "level": levels[0] - cut.zero[2]}
