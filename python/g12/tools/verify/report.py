# SPDX-License-Identifier: GPL-2.0-or-later
"""A proof for people, one paragraph per pocket and section, and for programs, as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence

from g12.tools.path.part import Z
from g12.tools.path.slowest import Pace
from g12.tools.preview.moves import message_lines
from g12.tools.units import Unit, plain
from g12.tools.verify.axis_limits import SAME_ZERO
from g12.tools.verify.findings import (
    NOT_CUT,
    SAME_AREA,
    UNMEASURED,
    collision_text,
    gouged,
    pocket_findings,
    pocket_notes,
    section_findings,
    section_notes,
    stock_findings,
    stock_notes,
)
from g12.tools.verify.in_stock import StockFacts, zero_of
from g12.tools.verify.pocket import PocketFacts
from g12.tools.verify.pocket_entry import entry_json, entry_text
from g12.tools.verify.proof import Proof
from g12.tools.verify.rapids import Collision
from g12.tools.verify.section import SectionFacts
from g12.tools.verify.shape_findings import shape_findings, shape_json, shape_rows

GAP = 14  # columns of a row's name
TURNS = {-1: "clockwise", 1: "counterclockwise"}
SIDES = {1: "left of the contour (G41)", -1: "right of the contour (G42)"}
AXES = "XYZ"


def as_text(proof: Proof, unit: Unit) -> str:
    """Return the proof as text, one paragraph per pocket and section, and the verdict."""
    pockets = [pocket_text(facts, proof, unit) for facts in proof.pockets]
    sections = [section_text(facts, proof, unit) for facts in proof.sections]
    shapes = [
        paragraph(
            f"{line_text(facts.asked.line, facts.asked.file)}: {facts.asked.name}",
            shape_rows(facts, unit),
            [],
            list(shape_findings(facts, unit)),
        )
        for facts in proof.shapes
    ]
    count = len(proof.findings)
    verdict = "verdict: good, everything is as programmed"
    if count:
        verdict = f"verdict: {count} finding{'s' if count > 1 else ''}"
    unseen = [
        paragraph(f"line {line}: {code}", [], [], [UNMEASURED]) for line, code in proof.unseen
    ]
    unseen += [paragraph(f"line {line}: {code}", [], [], [NOT_CUT]) for line, code in proof.still]
    rapids = [
        paragraph(f"line {hit.line}: rapid", [], [], [collision_text(hit, unit)])
        for hit in proof.collisions
    ]
    stock = [stock_text(proof.stock, unit)] if proof.stock else []
    messages = "\n".join(message_lines(proof.subject.trace.messages))
    told = [*pockets, *shapes, *sections, *rapids, *stock, *unseen]
    paragraphs = [zero_text(proof, unit), *told, messages, verdict]
    return "\n\n".join(filter(None, paragraphs))


def zero_text(proof: Proof, unit: Unit) -> str:
    """Return where the program's zero is where it first cuts, "" if places are the program's.

    Places of a section are as far from the spindle as the program's; those on a cylinder are the
    program's.
    """
    contours = [facts.section for facts in proof.sections]
    zero = zero_of(proof.circles, contours, proof.subject.trace.moves)
    if max(abs(zero)) < SAME_ZERO:
        return ""
    place = point_text("Z", zero[Z:], unit) if contours else point_text(AXES, zero, unit)
    return f"places are those of the machine: the program's zero is {place}"


def pocket_text(facts: PocketFacts, proof: Proof, unit: Unit) -> str:
    """Return the paragraph of one pocket."""
    source, cutter = facts.target.source, facts.target.cutter
    turns = " and ".join(TURNS[turn] for turn in facts.turns) or "no full circle"
    x, y, _ = facts.target.wall.origin
    slow = point_text("XYZ", facts.pace.point, unit)
    stepover = unit.text(facts.stepover) if facts.stepover else "one ring"
    rows = [
        ("centre", f"X{unit.text(x)} Y{unit.text(y)}, cutter ⌀ {unit.text(2 * cutter.radius)}"),
        ("radius", radius(facts, unit)),
        ("deviation", deviation(facts.deviation, proof.tolerances.pocket, unit)),
        ("left inside", left_text(facts, unit)),
        ("gouged outside", unit.area(facts.gouge)),
        ("rings", f"{', '.join(unit.text(ring) for ring in facts.rings)} (tool centre), {turns}"),
        ("stepover", f"{stepover}, direction jump {plain(facts.jump, 2)}°"),
        ("depth", depth(facts, unit)),
        *([("entry", entry_text(facts.helix, unit))] if facts.helix else []),
        ("moves", spread(facts.shortest, facts.longest, unit)),
        ("lowest feed", slowest(facts.pace, slow, pocket_slowest_line(facts.pace, proof), unit)),
        *real_rows(facts, unit),
        ("time", time_text(facts.pace)),
    ]
    found = list(pocket_findings(facts, proof.tolerances.pocket, unit))
    title = f"{line_text(source.line, source.file)}: {source.code} ({source.dialect})"
    return paragraph(title, rows, list(pocket_notes(facts, unit)), found)


def line_text(line: int, file: str) -> str:
    """Return a line in words, with the file of the sub in which it is."""
    return f"line {line}{f' of {file}' if file else ''}"


def stock_text(facts: StockFacts, unit: Unit) -> str:
    """Return the paragraph of the stock."""
    low_x, low_y, high_x, high_y = (unit.text(value) for value in facts.shape.bounds)
    rows = [("where", f"X{low_x} to X{high_x}, Y{low_y} to Y{high_y}, top Z{unit.text(facts.top)}")]
    found = [f"line {line}: {text}" for line, text in stock_findings(facts, unit)]
    return paragraph(f"stock: {facts.stock.text}", rows, list(stock_notes(facts, unit)), found)


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
        ("left", unit.area(facts.left)),
        ("gouged", gouged(facts, unit)),
        ("pieces", f"{facts.pieces}, {spread(facts.shortest, facts.longest, unit)}"),
        ("direction jump", f"{plain(facts.jump, 2)}° from piece to piece"),
        ("lowest feed", slowest(facts.pace, slow, facts.slowest_line, unit)),
        ("speed of C", f"{plain(facts.c_speed, 1)} degrees/s at most, {limit}"),
        ("time", time_text(facts.pace)),
    ]
    found = list(section_findings(facts, proof.tolerances.polar, unit))
    notes = list(section_notes(facts))
    call = proof.subject.trace.moves[section.at].block
    own = not section.file and section.line <= call <= section.last
    called = f"{f' of {section.file}' if section.file else ''}, called in line {call}"
    title = f"lines {section.line} to {section.last}{'' if own else called}: {section.code}"
    return paragraph(title, rows, notes, found)


def plane_rows(facts: SectionFacts, proof: Proof, unit: Unit) -> list[tuple[str, str]]:
    """Return the rows that tell of a section's plane: where it lies, how deep and far it is cut."""
    section, reached = facts.section, sizes(facts.wanted, facts.reached, unit)
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
    texts = dict.fromkeys(tuple(map(unit.text, flat)) for flat in facts.flats)
    asked, got = (", ".join(column) for column in zip(*texts)) if texts else ("", "")
    text = f"programmed {asked}, reached {got} {unit.name}"
    return [("across flats", text)] if texts else []


def paragraph(title: str, rows: Sequence, notes: Sequence[str], found: Sequence[str]) -> str:
    """Return a titled table with its notes and findings."""
    lines = [f"  {name:{GAP}}  {text}" for name, text in rows]
    lines += [f"  {'note':{GAP}}  {text}" for text in notes]
    lines += [f"  {'FINDING':{GAP}}  {text}" for text in found] or [f"  {'good':{GAP}}"]
    return "\n".join([title, *(line.rstrip() for line in lines)])


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
    heights = [unit.text(wall.height(depth)) for depth in facts.depths]
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
    return proof.subject.trace.moves[pace.move].block


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


def as_json(proof: Proof) -> str:
    """Return the proof for a program to read: lengths in mm, areas in mm², feeds in mm/min."""
    return json.dumps(
        {
            "program": str(proof.subject.program),
            "ini": str(proof.subject.ini.path),
            "real": proof.subject.real is not None,
            "pockets": [pocket_json(facts, proof) for facts in proof.pockets],
            "sections": [section_json(facts, proof) for facts in proof.sections],
            "shapes": [shape_json(facts) for facts in proof.shapes],
            "rapids": [collision_json(hit) for hit in proof.collisions],
            "stock": proof.stock and stock_json(proof.stock),
            "unseen": [{"line": line, "code": code} for line, code in proof.unseen],
            "messages": [message._asdict() for message in proof.subject.trace.messages],
            "still": [{"line": line, "code": code} for line, code in proof.still],
            "good": not proof.findings,
        },
        indent=2,
    )


def pocket_json(facts: PocketFacts, proof: Proof) -> dict:
    """Return one pocket as plain values."""
    source, wall = facts.target.source, facts.target.wall
    return {
        "line": source.line,
        "file": source.file or None,
        "code": source.code,
        "dialect": source.dialect,
        "centre": [float(value) for value in wall.origin[:2]],
        "cutter": 2 * facts.target.cutter.radius,
        "radius": wall.radius,
        "reached": facts.reached,
        "deviation": finite(facts.deviation),
        "left": facts.left,
        "core": facts.target.wall.core,
        "gouge": facts.gouge,
        "rings": list(facts.rings),
        "square_to": AXES[wall.plane],
        "depths": [wall.height(depth) for depth in facts.depths],
        "entry": entry_json(facts.helix),
        "stepover": facts.stepover,
        "direction_jump": facts.jump,
        "shortest": facts.shortest,
        "longest": facts.longest,
        "off_circles": facts.off_rings,
        "off_path": facts.off_path,
        **pace_json(facts.pace, pocket_slowest_line(facts.pace, proof)),
        "notes": list(pocket_notes(facts)),
        "findings": list(pocket_findings(facts, proof.tolerances.pocket)),
    }


def section_json(facts: SectionFacts, proof: Proof) -> dict:
    """Return one section as plain values."""
    return {
        "lines": [facts.section.line, facts.section.last],
        "file": facts.section.file or None,
        "code": facts.section.code,
        "cutter": 2 * facts.tool,
        "surface": facts.section.surface or None,
        "zero_line": None if facts.section.surface else facts.zero,
        "x_words": "diameters" if facts.section.diameters else "radii",
        "lowest": facts.lowest,
        "along_z" if facts.section.surface else "radii": list(facts.wanted),
        "reached": list(facts.reached),
        "across_flats": [list(flat) for flat in facts.flats],
        "deviation": finite(facts.deviation),
        "left": facts.left,
        "gouge": facts.gouge,
        "gouge_is_least": facts.through,
        "direction_jump": facts.jump,
        "pieces": facts.pieces,
        "shortest": facts.shortest,
        "longest": facts.longest,
        "c_speed": facts.c_speed,
        "c_limit": finite(facts.c_limit),
        "turned_in_place": facts.in_place._asdict(),
        **pace_json(facts.pace, facts.slowest_line),
        "notes": list(section_notes(facts)),
        "findings": list(section_findings(facts, proof.tolerances.polar)),
    }


def collision_json(hit: Collision) -> dict:
    """Return a rapid through material as plain values."""
    return {
        "line": hit.line,
        "area": hit.area,
        "from": hit.path[0].tolist(),
        "to": hit.path[-1].tolist(),
        "findings": [collision_text(hit)],
    }


def stock_json(facts: StockFacts) -> dict:
    """Return what happens to the stock as plain values."""
    return {
        "text": facts.stock.text,
        "bounds": list(facts.shape.bounds),
        "top": facts.top,
        "below": facts.below,
        "plunges": [plunge._asdict() for plunge in facts.plunges],
        "standing": [standing._asdict() for standing in facts.standing],
        "rapids": [collision_json(hit) for hit in facts.rapids],
        "notes": list(stock_notes(facts)),
        "findings": [f"line {line}: {text}" for line, text in stock_findings(facts)],
    }


def pace_json(pace: Pace, line: int) -> dict:
    """Return feed and time as plain values."""
    return {
        "lowest_feed": pace.lowest,
        "lowest_feed_at": [float(value) for value in pace.point],
        "lowest_feed_line": line,
        "seconds": pace.seconds,
        "seconds_programmed": pace.expected,
    }


def finite(value: float) -> float | None:
    """Return a number that JSON has."""
    return value if abs(value) < float("inf") else None
