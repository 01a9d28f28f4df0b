# SPDX-License-Identifier: GPL-2.0-or-later
"""A section's zero line of C, its side of compensation and its place, levels that are the same."""

import math
import re
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from shapely.geometry import Point, Polygon

from g12.cut_report import CutElement, PocketCut
from g12.tools.verify.model.cut import MOST_OF_A_TURN, Cut, Outline
from g12.tools.verify.model.finding import FINDING, WARNING
from g12.tools.verify.model.program import SIZE, joined
from g12.tools.verify.model.solid import FACE
from g12.tools.verify.rules.table import Site, Values, rule

ROUND_ANGLE = 1e-3  # degrees: angles that are programmed are multiples of it
SAME_ANGLE = 1e-2
STAYED = 1e-6
AT_EDGE = 0.01  # mm
LEVELS_MEANT = 3  # L2 is a spring pass
STRAIGHT_BACK = -0.999999  # cosine of the angle between two directions, at most
BY_MACHINE = re.compile(r"G(53|28|30)(?!\d)")
SUB = re.compile(r"O.*SUB")
SIDE_CODE = re.compile(r"G4([0-2])(?!\d)")
FAR, WIDE = 3.0, 1.5  # times a bar


@rule(
    "c-zero",
    FINDING,
    "C is where line {line} left it, at {angle:3}°: its zero line is turned on the part (G0 C0?)",
)
def zero_line(site: Site) -> Values:
    cut, program = site.own, site.program
    commanded = cut.reported.c_commanded
    if not cut.is_section or cut.surface or not cut.index or commanded == "angle":
        return None
    before = program.cuts[cut.index - 1]
    left, here = program.moves[before.end - 1].end[5], program.moves[cut.at].start[5]
    angle, stayed = here - cut.zero_c, abs(here - left) < STAYED
    if not stayed and (is_multiple(angle) or not is_multiple(here - left)):
        return None
    first = next((each for each in program.cuts[: cut.index] if not each.surface), None)
    if same_turn(angle, first.reported.report.at[3] if first else 0.0):
        return None
    return {"line": before.line, "angle": angle}


def is_multiple(angle: float) -> bool:
    return abs(angle / ROUND_ANGLE - round(angle / ROUND_ANGLE)) < SAME_ANGLE


def same_turn(one: float, other: float) -> bool:
    return abs(math.remainder(one - other, 360.0)) < SAME_ANGLE


@rule(
    "c-zero-unknown", WARNING, "no C word comes before it: its zero line is where C is", once=True
)
def zero_line_unknown(site: Site) -> Values:
    cut = site.own
    unknown = cut.is_section and not cut.surface and not cut.index
    return {} if unknown and not cut.reported.c_commanded else None


@rule(
    "place-unknown",
    WARNING,
    "no line before it says {axes}: it is cut where the tool stands",
    once=True,
)
def place_unknown(site: Site) -> Values:
    cut, program = site.own, site.program
    if cut.file or program.calls_files or not (cut.is_circle or cut.is_section):
        return None
    own = program.texts[cut.line - 1 : cut.line] if not cut.reported.report.incremental else []
    text = "\n".join(t for t in [*program.texts[: cut.line - 1], *own] if not BY_MACHINE.search(t))
    axes = "XZ" if program.turning else "XYZ"
    if SUB.search(text):  # is called after lines that follow it
        return None
    unsaid = [axis for axis in axes if not re.search(rf"{axis}\s*[-+.\d\[#]", text)]
    return {"axes": " and ".join(unsaid)} if unsaid else None


@rule(
    "side",
    FINDING,
    "the tool comes from the other side of the contour: {instead} in line {lead}?",
    plain=True,
)
def wrong_side(site: Site) -> Values:
    if not site.cut:
        return _wrong_plain_side(site)
    for outline in site.cut.outlines:
        if _is_crossed(outline, site):
            instead = "G42" if outline.left else "G41"
            lead = outline.lines[0]
            return {"instead": instead, "lead": lead, "at_line": lead}
    return None


def _is_crossed(outline: Outline, site: Site) -> bool:
    """Return whether the lead-in begins on the part's side of a contour."""
    if outline.is_closed:
        start = Point(outline.lead.real, outline.lead.imag)
        if outline.polygon.exterior.distance(start) < AT_EDGE:
            return False
        return bool(outline.polygon.contains(start)) != outline.tool_inside
    along = outline.points[1] - outline.points[0]
    beside = ((outline.lead - outline.points[0]) * np.conj(along)).imag / abs(along)
    low = max(outline.level, outline.lead_level) < site.solids.top(site.own.surface)
    return low and (beside if outline.left else -beside) < -AT_EDGE


def _wrong_plain_side(site: Site) -> Values:
    """Judge LinuxCNC's own compensation where the tool goes round at depth."""
    program = site.program
    for left, lead, end in _compensated(site):
        start = program.tip(lead, FACE)[0]
        path = [program.tip(index, FACE) for index in range(lead + 1, end)]
        around = Closed(joined(path)) if path else None
        if start[2] > site.solids.top(FACE) - SIZE or not around or not around.is_closed:
            continue
        radius, at = program.cutter(lead), Point(start[:2])
        inside = around.is_left == left
        reached = around.polygon.buffer(radius if inside else -radius)
        if reached.contains(at) != inside:
            line = program.moves[lead].block
            return {"instead": "G42" if left else "G41", "lead": line, "at_line": line}
    return None


def _compensated(site: Site) -> Iterator[tuple[bool, int, int]]:
    """Yield G41 or G42 of plain moves: is it G41, the move that leads in, the move of G40."""
    program, code, lead = site.program, "", site.at
    line = program.moves[site.at].block - 1
    for index in site.moves:
        block = program.moves[index].block
        codes = SIDE_CODE.findall("\n".join(program.texts[min(line, block - 1) : block]))
        line = block
        if codes and codes[-1] != code:
            if code in ("1", "2"):
                yield code == "1", lead, index
            code, lead = codes[-1], index


class Closed:
    """A path that goes round: its area, and whether that is on its left."""

    def __init__(self, points: np.ndarray) -> None:
        path = points[:, 0] + 1j * points[:, 1]
        self.polygon = Polygon(points[:, :2] if len(path) > 3 else ()).buffer(0)
        middle = self.polygon.centroid if self.polygon.area else Point(points[0, :2])
        away = path - complex(middle.x, middle.y)
        turned = np.angle(away[1:] * np.conj(away[:-1])).sum()
        self.is_closed = abs(turned) > MOST_OF_A_TURN
        self.is_left = turned > 0


@rule(
    "side-missing",
    WARNING,
    "G40 without a G41 or G42 before it: the tool's centre is on the contour",
)
def side_missing(site: Site) -> Values:
    cut = site.own
    if not cut.is_section or cut.compensated or cut.file:
        return None
    lines = site.program.texts[cut.line : cut.last_line + 1]
    cancels = (n for n, text in enumerate(lines, cut.line + 1) if re.search(r"G40(?!\d)", text))
    line = next(cancels, 0)
    return {"at_line": line} if line else None


@rule(
    "goes-back",
    WARNING,
    "goes back along line {line}: under {code} the tool cuts both sides of that line",
)
def goes_back(site: Site) -> Values:
    drawn = [each for each in site.own.elements if each.end is not None and each.start != each.end]
    leads = {outline.lines[0] for outline in site.own.outlines}
    for before, after in pairwise(drawn):
        if before.line not in leads and _reverses(before, after):
            code = "G41" if after.side > 0 else "G42"
            return {"line": before.line, "code": code, "at_line": after.line}
    return None


def _reverses(before: CutElement, after: CutElement) -> bool:
    """Return whether both are lines of a compensated contour, the second back along the first."""
    if not before.side or before.side != after.side:
        return False
    if before.centre is not None or after.centre is not None:
        return False
    turn = (before.end - before.start) * (after.end - after.start).conjugate()
    return turn.real < STRAIGHT_BACK * abs(turn)


@rule(
    "far-beside",
    FINDING,
    "its contour goes to {reach:length} from the axis, the bar is {bar:mm}: C is a length here",
)
def far_beside(site: Site) -> Values:
    cut, stock = site.own, site.solids.stock
    if not cut.is_section or cut.surface or not (stock and stock.diameter):
        return None
    bar = stock.diameter / 2
    return (
        {"reach": cut.deep_reach, "bar": bar} if cut.deep_reach > FAR * bar + site.loaded else None
    )


@rule(
    "c-length",
    WARNING,
    "C goes to {c:length}, X to {x:length} at most: C is a length here, no angle",
)
def long_c(site: Site) -> Values:
    cut, stock = site.own, site.solids.stock
    if not cut.is_section or cut.surface or (stock and stock.diameter):
        return None
    points = [at for each in cut.elements for at in (each.start, each.end) if at is not None]
    x, c = (max((abs(part) for part in own), default=0.0) * cut.mm for own in _parts(points))
    return {"c": c, "x": x} if x > site.loaded and c > FAR * x else None


def _parts(points: list[complex]) -> tuple[list[float], list[float]]:
    return [at.real for at in points], [at.imag for at in points]


@rule(
    "surface",
    FINDING,
    "its cylinder of radius {radius:mm} is not the bar's, {bar:mm}: is C a radius here?",
)
def other_surface(site: Site) -> Values:
    stock, radius = site.solids.stock, site.own.surface
    if not site.own.is_section or not radius or not (stock and stock.diameter):
        return None
    bar = stock.diameter / 2
    return {"radius": radius, "bar": bar} if radius > WIDE * bar else None


@rule("beyond-axis", WARNING, "its lowest X is {size:length} beyond the part's axis")
def beyond_axis(site: Site) -> Values:
    cut: Cut = site.own
    lowest = min((min(each.z0, each.z1) for each in cut.elements), default=0.0) * cut.mm
    lowest = min(lowest, cut.floor) if cut.places else lowest
    return {"size": -lowest} if cut.surface and lowest < -SIZE else None


@rule("tap-undrilled", WARNING, "the tap goes deeper than what is drilled before it")
def undrilled(site: Site) -> Values:
    cut = site.own
    if not cut.is_tap:
        return None
    discs = (Point(at.real, at.imag).buffer(0.2) for at in cut.places)
    standing = (site.solids.standing(each, cut.floor, cut.surface, before=cut.at) for each in discs)
    return {} if any(each.area > 0.01 for each in standing) else None


@rule("same-levels", WARNING, "its {n} levels are all at Z{level:mm}: L steps down in G91 only")
def same_levels(site: Site) -> Values:
    cut = site.own
    levels = cut.levels if isinstance(cut.plan, PocketCut) else []
    if len(levels) < LEVELS_MEANT or max(levels) - min(levels) > SIZE:
        return None
    return {"n": len(levels), "level": levels[0] - cut.zero[2]}
