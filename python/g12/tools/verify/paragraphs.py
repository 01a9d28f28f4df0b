# SPDX-License-Identifier: GPL-2.0-or-later
"""Every measure of a proof, one paragraph per pocket, shape and section (``--full``)."""

from __future__ import annotations

from collections.abc import Sequence

from g12.tools.path.part import Z, x0_text
from g12.tools.path.slowest import Pace
from g12.tools.units import Unit, plain
from g12.tools.verify.axis_limits import SAME_ZERO
from g12.tools.verify.compare.drilled import HolesFacts
from g12.tools.verify.findings import SAME_AREA
from g12.tools.verify.in_material import zero_of
from g12.tools.verify.pocket import HelixFacts, PocketFacts
from g12.tools.verify.proof import Proof
from g12.tools.verify.sections.section import SectionFacts
from g12.tools.verify.shape import ShapeFacts
from g12.tools.verify.workpiece import Workpiece

GAP = 14  # columns of a row's name
TURNS = {-1: "clockwise", 1: "counterclockwise"}
SIDES = {1: "left of the contour (G41)", -1: "right of the contour (G42)"}
AXES = "XYZ"


def paragraphs_of(proof: Proof, unit: Unit) -> list[str]:
    """Return one paragraph for each pocket, shape and section, and for the stock."""
    given = proof.material.given
    stock = [stock_text(given, unit)] if given else []
    pockets = [pocket_text(facts, proof, unit) for facts in proof.pockets]
    return [
        *pockets,
        *(shape_text(facts, proof, unit) for facts in proof.shapes),
        *(holes_text(facts, proof, unit) for facts in proof.holes),
        *(section_text(facts, proof, unit) for facts in proof.sections),
        *stock,
    ]


def zero_text(proof: Proof, unit: Unit) -> str:
    """Return where the program's zero is on the machine, "" where they are the same.

    Places of a section are as far from the spindle as the program's; those on a cylinder are the
    program's. Where X0 lies must be the spindle's axis.
    """
    contours = [facts.section for facts in proof.sections]
    zero = zero_of(proof.asked.circles, contours, proof.subject.trace.moves)
    place = point_text("Z", zero[Z:], unit) if contours else point_text(AXES, zero, unit)
    moved = f"places are those of the machine: the program's zero is {place}"
    x0 = x0_text(proof.subject.part, unit) if contours else ""
    return "; ".join(filter(None, [moved if max(abs(zero)) >= SAME_ZERO else "", x0]))


def pocket_text(facts: PocketFacts, proof: Proof, unit: Unit) -> str:
    """Return the paragraph of one pocket."""
    source, cutter, asked = facts.target.source, facts.target.cutter, facts.target.asked
    turns = " and ".join(TURNS[turn] for turn in facts.turns) or "no full circle"
    x, y, _ = facts.target.wall.origin
    slow = point_text("XYZ", facts.pace.point, unit)
    stepover = unit.text(asked.stepover) if asked.stepover else "one ring"
    rows = [
        ("centre", f"X{unit.text(x)} Y{unit.text(y)}, cutter ⌀ {unit.text(2 * cutter.radius)}"),
        ("radius", radius(facts, unit)),
        ("deviation", deviation(facts.deviation, proof.tolerances.pocket, unit)),
        ("left inside", left_text(facts, unit)),
        ("rings", f"{', '.join(unit.text(ring) for ring in facts.rings)} (tool centre), {turns}"),
        ("stepover", stepover),
        ("depth", depth(facts, unit)),
        *([("entry", entry_text(facts.helix, unit))] if facts.helix else []),
        ("moves", spread(*facts.lengths, unit)),
        ("lowest feed", slowest(facts.pace, slow, pocket_slowest_line(facts.pace, proof), unit)),
        *real_rows(facts, unit),
        ("time", time_text(facts.pace)),
    ]
    title = f"{line_text(proof, source.line, source.file)}: {source.code} ({source.dialect})"
    return paragraph(title, rows)


def shape_text(facts: ShapeFacts, proof: Proof, unit: Unit) -> str:
    """Return the paragraph of one shape; its entries are as the call gives them."""
    call = facts.call
    entries = (f"{name} {plain(value, 4)}" for name, value in call.given.items())
    rows = [
        ("cutter", f"⌀ {unit.text(2 * call.cutter)}"),
        ("entries", ", ".join(entries)),
        ("deviation", deviation(facts.deviation, proof.tolerances.polar, unit)),
        ("depth", unit.text(facts.lowest)),
    ]
    return paragraph(f"{line_text(proof, call.line, call.file)}: {call.name}", rows)


def holes_text(facts: HolesFacts, proof: Proof, unit: Unit) -> str:
    """Return the paragraph of a call of holes."""
    holes, call = facts.holes, facts.holes.call
    angles = ", ".join(plain(angle, 3) for angle in holes.angles)
    entries = (f"{name} {plain(value, 4)}" for name, value in call.given.items())
    rows = [
        ("entries", ", ".join(entries)),
        ("holes", f"{holes.count} on ⌀ {unit.text(2 * holes.circle)}, C {angles}"),
        ("deviation", deviation(facts.deviation, proof.tolerances.polar, unit)),
        ("depth", unit.text(holes.depth)),
    ]
    return paragraph(f"{line_text(proof, call.line, call.file)}: {call.name}", rows)


def entry_text(helix: HelixFacts, unit: Unit) -> str:
    """Return how the tool comes down along a helix in words."""
    return f"helix of radius {unit.text(helix.radius)} (tool centre), {helix.angle:.3g}°"


def line_text(proof: Proof, line: int, file: str) -> str:
    """Return the user's line in words, with the file of the sub in which it is."""
    return f"line {proof.user_line(line, file)}{f' of {file}' if file else ''}"


def stock_text(facts: Workpiece, unit: Unit) -> str:
    """Return the paragraph of the stock."""
    low_x, low_y, high_x, high_y = (unit.text(value) for value in facts.shape.bounds)
    rows = [("where", f"X{low_x} to X{high_x}, Y{low_y} to Y{high_y}, top Z{unit.text(facts.top)}")]
    return paragraph(f"stock: {facts.stock.text}", rows)


def left_text(facts: PocketFacts, unit: Unit) -> str:
    """Return what a pocket leaves inside its wall in words."""
    core, area = facts.target.wall.core, unit.area(facts.left)
    if not core:
        return area
    more = f", and {area}" if facts.left > SAME_AREA else ""
    return f"a core of radius {unit.text(core)} {unit.name}, by design of a single ring{more}"


def section_text(facts: SectionFacts, proof: Proof, unit: Unit) -> str:
    """Return the paragraph of one section."""
    section = facts.section
    sides = " and ".join(SIDES[side] for side in facts.sides if side) or "on the contour"
    slow = place_on_section(facts, unit)
    limit = f"limit {plain(facts.c_limit, 1)}"
    rows = [
        ("cutter", f"⌀ {unit.text(2 * facts.tool)}, {sides}"),
        *plane_rows(facts, proof, unit),
        *width_rows(facts, unit),
        ("deviation", deviation(facts.deviation, proof.tolerances.polar, unit)),
        ("pieces", f"{facts.pieces}, {spread(facts.shortest, facts.longest, unit)}"),
        ("direction jump", f"{plain(facts.jump, 2)}° from piece to piece"),
        (
            "lowest feed",
            slowest(facts.pace, slow, proof.user_line(facts.slowest_line, section.file), unit),
        ),
        ("speed of C", f"{plain(facts.turns.speed, 1)} degrees/s at most, {limit}"),
        ("time", time_text(facts.pace)),
    ]
    call = proof.subject.trace.moves[section.at].block
    own = not section.file and section.line <= call <= section.last
    called = (
        f"{f' of {section.file}' if section.file else ''}, called in line {proof.user_line(call)}"
    )
    first, last = (proof.user_line(each, section.file) for each in (section.line, section.last))
    title = f"lines {first} to {last}{'' if own else called}: {section.code}"
    return paragraph(title, rows)


def plane_rows(facts: SectionFacts, proof: Proof, unit: Unit) -> list[tuple[str, str]]:
    """Return the rows that tell of a section's plane: where it lies, how deep and far it is cut."""
    section, reached = facts.section, sizes(facts.size.wanted, facts.size.reached, unit)
    if section.surface:
        on = f"radius {unit.text(section.surface)}, starts at C{plain(section.c, 3)}"
        modal = "diameters (G7)" if section.diameters else "radii (G8)"
        below = section.surface - (facts.lowest - facts.start_height + section.height)
        depth = ("depth", f"{unit.text(below)} below the surface")
        return [("surface", on), ("X words", modal), depth, ("along Z", reached)]
    return [
        ("zero line", f"C {plain(facts.zero, 3)}"),
        ("X words", x_words(facts, proof)),
        ("depth", unit.text(facts.lowest)),
        ("from centre", reached),
    ]


def place_on_section(facts: SectionFacts, unit: Unit) -> str:
    """Return the place of the lowest feed as the section's words have it."""
    x, c, z = facts.slowest_at
    x = 2 * x if facts.section.diameters else x
    if facts.section.surface:
        return f"X{unit.text(x)} C{plain(c, 3)} Z{unit.text(z)}"
    return point_text("XCZ", (x, c, z), unit)


def width_rows(facts: SectionFacts, unit: Unit) -> list[tuple[str, str]]:
    """Return the row that only a contour with parallel sides has: widths, the greatest first."""
    texts = dict.fromkeys(tuple(map(unit.text, flat)) for flat in facts.size.flats)
    asked, got = (", ".join(column) for column in zip(*texts)) if texts else ("", "")
    text = f"programmed {asked}, reached {got} {unit.name}"
    return [("across flats", text)] if texts else []


def paragraph(title: str, rows: Sequence) -> str:
    """Return a titled table."""
    lines = [f"  {name:{GAP}}  {text}".rstrip() for name, text in rows]
    return "\n".join([title, *lines])


def sizes(wanted: Sequence[float], reached: Sequence[float], unit: Unit) -> str:
    """Return programmed and reached sizes in words."""
    asked, got = (" to ".join(unit.text(size) for size in both) for both in (wanted, reached))
    return f"programmed {asked}, reached {got} {unit.name}"


def deviation(size: float, tolerance: float, unit: Unit) -> str:
    """Return a deviation and what it may be in words."""
    return f"{unit.fine(size)} {unit.name} (allowed {unit.fine(tolerance)})"


def spread(shortest: float, longest: float, unit: Unit) -> str:
    """Return lengths from the shortest to the longest in words."""
    return f"{unit.text(shortest)} to {unit.text(longest)} {unit.name} long"


def radius(facts: PocketFacts, unit: Unit) -> str:
    """Return the radius as programmed and reached in words."""
    cutter, reached = facts.target.cutter, f"reached {unit.text(facts.reached)} {unit.name}"
    wall = unit.text(facts.target.wall.radius)
    if cutter.word:
        word = f"{cutter.word}{unit.text(cutter.circle)}"
        return f"programmed {word} (tool centre), wall {wall}, {reached}"
    return f"programmed {wall}, {reached}"


def depth(facts: PocketFacts, unit: Unit) -> str:
    """Return the depths in words: of a circle in another plane than XY where it stands."""
    wall = facts.target.wall
    heights = [unit.text(wall.height(depth)) for depth in facts.target.depths]
    if AXES[wall.plane] == "Z":
        return ", ".join(heights)
    reach = max(facts.rings, default=0.0)
    low, high = (unit.text(wall.origin[2] + side) for side in (-reach, reach))
    return f"plane at {AXES[wall.plane]}{', '.join(heights)}, Z from {low} to {high}"


def x_words(facts: SectionFacts, proof: Proof) -> str:
    """Return what X words are in a section, and what decides it."""
    reading = proof.subject.ini.settings.polar_x
    kind, modal = ("diameters", "G7") if facts.section.diameters else ("radii", "G8")
    return f"{kind} ({modal if reading == 'inherit' else f'POLAR_X = {reading}'})"


def point_text(letters: str, point: Sequence[float], unit: Unit) -> str:
    """Return a point in words."""
    return " ".join(f"{letter}{unit.text(at)}" for letter, at in zip(letters, point))


def pocket_slowest_line(pace: Pace, proof: Proof) -> int:
    """Return the program's line of the lowest feed."""
    return proof.user_line(proof.subject.trace.moves[pace.move].block)


def slowest(pace: Pace, where: str, line: int, unit: Unit) -> str:
    """Return the lowest feed and where it is in words."""
    return f"{plain(pace.lowest / unit.mm, 1)} {unit.name}/min at {where} (line {line})"


def time_text(pace: Pace) -> str:
    """Return the time in words; what is only reckoned knows no acceleration."""
    programmed = f"{plain(pace.expected, 1)} s at the programmed feeds"
    same = pace.seconds == pace.expected
    return programmed if same else f"{plain(pace.seconds, 1)} s, {programmed}"


def real_rows(facts: PocketFacts, unit: Unit) -> list[tuple[str, str]]:
    """Return the rows that only a run has."""
    if facts.off_path is None:
        return []
    text = f"{unit.fine(facts.off_rings)} off the circles, {unit.fine(facts.off_path)} off the path"
    return [("real motion", f"{text}, {unit.name}")]
