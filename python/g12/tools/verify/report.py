# SPDX-License-Identifier: GPL-2.0-or-later
"""A proof for people: a line for each cut, then findings, notes, and what was not judged."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from g12.tools.path.part import Z, x0_text
from g12.tools.preview.moves import message_lines
from g12.tools.units import Unit, counted_as, plain
from g12.tools.verify.compare.drilled import HolesFacts
from g12.tools.verify.expected.calls import SubCall
from g12.tools.verify.measures import (
    AXES,
    holes_values,
    pocket_values,
    section_values,
    shape_values,
    stock_values,
)
from g12.tools.verify.pocket import PocketFacts
from g12.tools.verify.proof import Proof
from g12.tools.verify.result.finding import Finding, in_words, is_known
from g12.tools.verify.result.tolerances import SIZE
from g12.tools.verify.sections.section import SectionFacts
from g12.tools.verify.shape import ShapeFacts

GAP = "  "
SIDES = {1: "left of", -1: "right of", 0: "on"}
NAMES = 14  # columns of a row's name
Row = tuple[str, str]  # a name, and its text with measures in braces

# Of rows with one name the first one counts whose measures are all known.
PACE: tuple[Row, ...] = (
    ("time", "{real_seconds:1} s, {seconds_programmed:1} s at the programmed feeds"),
    ("time", "{seconds_programmed:1} s at the programmed feeds"),
)
DEVIATION = ("deviation", "{deviation:fine} (allowed {allowed:fine})"), ("deviation", "∞")
POCKET: tuple[Row, ...] = (
    ("centre", "X{centre[0]:mm} Y{centre[1]:mm}, cutter ⌀ {cutter:mm}"),
    (
        "radius",
        "programmed {circle[word]}{circle[radius]:mm} (tool centre), wall {radius:mm}, "
        "reached {reached:length}",
    ),
    ("radius", "programmed {radius:mm}, reached {reached:length}"),
    *DEVIATION,
    ("left inside", "{left:mm2}"),
    ("core", "radius {core:length}, by design of a single ring"),
    ("rings", "{rings:list} (tool centre), {turns}"),
    ("stepover", "{stepover:mm}"),
    ("stepover", "one ring"),
    ("depth", "plane at {square_to}{depths:list}, Z from {z[0]:mm} to {z[1]:mm}"),
    ("depth", "{depths:list}"),
    ("entry", "helix of radius {entry[radius]:mm} (tool centre), {entry[angle]:2}°"),
    ("moves", "{shortest:mm} to {longest:length} long"),
    ("lowest feed", "{lowest_feed:pace} at {lowest_feed_at:xyz} (line {lowest_feed_line})"),
    ("real motion", "{off_circles:fine} off the circles, {off_path:fine} off the path"),
    *PACE,
)
SECTION: tuple[Row, ...] = (
    ("cutter", "⌀ {cutter:mm}, {sides}"),
    ("surface", "radius {surface:mm}, starts at C{starts_at:3}"),
    ("zero line", "C {zero_line:3}"),
    ("X words", "{x_words} ({x_words_by})"),
    ("depth", "{below_surface:mm} below the surface"),
    ("depth", "{lowest:mm}"),
    ("along Z", "programmed {along_z:span}, reached {reached:span}"),
    ("from centre", "programmed {radii:span}, reached {reached:span}"),
    ("across flats", "programmed {flats:list}, reached {flats_reached:list}"),
    *DEVIATION,
    ("segments", "{segments}, {shortest:mm} to {longest:length} long"),
    ("direction jump", "{direction_jump:2}° from segment to segment"),
    ("lowest feed", "{lowest_feed:pace} at {lowest_feed_words:xyz} (line {lowest_feed_line})"),
    ("speed of C", "{c_speed:1} degrees/s at most, limit {c_limit:1}"),
    *PACE,
    (
        "kinematics",
        "about {seconds_planned[segments]:1} s in segments, {seconds_planned[kinematics]:1} s with "
        "kinematics, {seconds_planned[least]:1} s at the limits of X and C",
    ),
)
SHAPE: tuple[Row, ...] = (
    ("cutter", "⌀ {cutter:mm}"),
    ("entries", "{entries}"),
    *DEVIATION,
    ("depth", "{lowest:mm}"),
)
HOLES: tuple[Row, ...] = (
    ("entries", "{entries}"),
    ("holes", "{count} on ⌀ {circle:mm}, C {c}"),
    *DEVIATION,
    ("depth", "{depth:mm}"),
)
STOCK: tuple[Row, ...] = (
    (
        "where",
        "X{bounds[0]:mm} to X{bounds[2]:mm}, Y{bounds[1]:mm} to Y{bounds[3]:mm}, top Z{top:mm}",
    ),
)


class CutLine(NamedTuple):
    """The columns of a cut: where, which code, what, how far off the toolpath, how long."""

    where: str
    code: str
    what: str
    off: str = ""
    time: str = ""


def as_text(proof: Proof, unit: Unit, *, full: bool = False, strict: bool = False) -> str:
    """Return the proof as text; ``full`` with every measure, ``strict``: notes are findings."""
    judged = proof.judged
    findings = [each for each in judged if each.is_finding or (strict and each.is_note)]
    notes = [each for each in judged if each.is_note and not strict]
    others = [each for each in judged if each.is_not_judged]
    cuts = paragraphs_of(proof, unit) if full else ["\n".join(_in_columns(cut_lines(proof, unit)))]
    parts = [
        zero_text(proof, unit),
        *cuts,
        _listed("findings", findings, proof, unit),
        _listed("notes", notes, proof, unit),
        _listed("not judged", others, proof, unit),
        "\n".join(message_lines(messages_of(proof))),
        verdict(len(findings), len(notes)),
    ]
    return "\n\n".join(filter(None, parts))


def zero_text(proof: Proof, unit: Unit) -> str:
    """Return where the program's zero is on the machine, "" where they are the same.

    Places of a section are as far from the spindle as the program's; those on a cylinder are the
    program's. Where X0 lies must be the spindle's axis.
    """
    contours = [facts.section for facts in proof.sections]
    zero = proof.workpiece.program.zero()
    words = [*zip(AXES, zero)][Z if contours else 0 :]
    said = "places are those of the machine: the program's zero is {zero:xyz}"
    moved = in_words(said, {"zero": words}, unit) if max(abs(zero)) >= SIZE else ""
    return "; ".join(filter(None, [moved, x0_text(proof.subject.part, unit) if contours else ""]))


def paragraphs_of(proof: Proof, unit: Unit) -> Iterator[str]:
    """Yield every measure of each pocket, shape and section, and of the stock."""
    for pocket in proof.pockets:
        yield pocket_text(pocket, proof, unit)
    for shape in proof.shapes:
        yield call_text(shape.call, SHAPE, shape_values(shape, proof), proof, unit)
    for drilled in proof.holes:
        angles = ", ".join(plain(angle, 3) for angle in drilled.holes.angles)
        values = {**holes_values(drilled, proof), "count": drilled.holes.count, "c": angles}
        yield call_text(drilled.holes.call, HOLES, values, proof, unit)
    for section in proof.sections:
        yield section_text(section, proof, unit)
    if proof.given:
        values = stock_values(proof.given)
        yield paragraph(f"stock: {values['text']}", rows_of(STOCK, values, unit))


def pocket_text(facts: PocketFacts, proof: Proof, unit: Unit) -> str:
    """Return the paragraph of one pocket."""
    source, values = facts.target.source, pocket_values(facts, proof)
    values |= {"allowed": proof.tolerances.pocket, "real_seconds": real_seconds(values)}
    title = f"{line_text(proof, source.line, source.file)}: {source.code} ({source.dialect})"
    return paragraph(title, rows_of(POCKET, values, unit))


def section_text(facts: SectionFacts, proof: Proof, unit: Unit) -> str:
    """Return the paragraph of one section."""
    section, values = facts.section, section_values(facts, proof)
    values |= {"allowed": proof.tolerances.polar, "real_seconds": real_seconds(values)}
    flats = list(
        zip(*dict.fromkeys(tuple(round(size, 3) for size in each) for each in facts.size.flats))
    )
    values |= {"flats": flats[0], "flats_reached": flats[1]} if flats else {}
    call = proof.subject.trace.moves[section.at].block
    called = f", called in line {proof.user_line(call)}"
    own = not section.file and section.line <= call <= section.last
    title = f"{section_lines_text(facts, proof)}{'' if own else called}: {section.code}"
    return paragraph(title, rows_of(SECTION, values, unit))


def call_text(
    call: SubCall, rows: Sequence[Row], values: Mapping[str, Any], proof: Proof, unit: Unit
) -> str:
    """Return the paragraph of a call of a sub; its entries are in program units."""
    entries = ", ".join(f"{name} {plain(value, 4)}" for name, value in call.given.items())
    values = {**values, "allowed": proof.tolerances.polar, "entries": entries}
    title = f"{line_text(proof, call.line, call.file)}: {call.name}"
    return paragraph(title, rows_of(rows, values, unit))


def real_seconds(values: Mapping[str, Any]) -> float | None:
    """Return the time of a run, None without one: what is only reckoned knows no acceleration."""
    seconds = values["seconds"]
    return None if seconds == values["seconds_programmed"] else seconds


def rows_of(rows: Sequence[Row], values: Mapping[str, Any], unit: Unit) -> Iterator[Row]:
    """Yield the rows whose measures are known, the first of each name, in words."""
    named = {name: text for name, text in reversed(rows) if is_known(text, values)}
    for name in dict.fromkeys(name for name, _ in rows):
        if name in named:
            yield name, in_words(named[name], values, unit)


def paragraph(title: str, rows: Iterable[Row]) -> str:
    """Return a titled table."""
    return "\n".join([title, *(f"  {name:{NAMES}}  {text}".rstrip() for name, text in rows)])


def line_text(proof: Proof, line: int, file: str) -> str:
    """Return the user's line in words, with the file of the sub in which it is."""
    return f"line {proof.user_line(line, file)}{f' of {file}' if file else ''}"


def section_lines_text(facts: SectionFacts, proof: Proof) -> str:
    """Return the user's lines of a section in words."""
    section = facts.section
    first, last = (proof.user_line(line, section.file) for line in (section.line, section.last))
    return f"lines {first} to {last}{f' of {section.file}' if section.file else ''}"


def messages_of(proof: Proof) -> Iterator:
    """Yield the program's messages with the user's lines."""
    for message in proof.subject.trace.messages:
        yield message._replace(line=proof.user_line(message.line))


def _listed(title: str, found: Sequence[Finding], proof: Proof, unit: Unit) -> str:
    """Return findings under a title, "" without any; what is the same of several lines once."""
    lines: dict[str, list[str]] = {}
    for each in found:
        where = line_text(proof, each.line, each.file) if each.line else ""
        lines.setdefault(proof.text(each, unit), []).append(where)
    rows = [f"{GAP}{where_text(where)}{text}" for text, where in lines.items()]
    return "\n".join([title, *rows]) if rows else ""


def where_text(where: Sequence[str]) -> str:
    """Return the lines of a sentence: the first of them, and how many more."""
    named = [each for each in dict.fromkeys(where) if each]
    more = f" (and {counted_as(len(named) - 1, 'line')} more)" if len(named) > 1 else ""
    return f"{named[0]}{more}: " if named else ""


def verdict(findings: int, notes: int) -> str:
    """Return the last line: good, or how many findings, and how many notes."""
    first = counted_as(findings, "finding") if findings else "good"
    return f"verdict: {', '.join([first, *([counted_as(notes, 'note')] if notes else [])])}"


def _in_columns(rows: Iterable[CutLine]) -> Iterator[str]:
    """Yield rows with their columns below each other."""
    rows = list(rows)
    widths = [max(map(len, column)) for column in zip(*rows)]
    for row in rows:
        cells = (cell.ljust(width) for cell, width in zip(row, widths))
        yield GAP.join(cells).rstrip()


def cut_lines(proof: Proof, unit: Unit) -> list[CutLine]:
    """Return a line for each cut."""
    pockets = [pocket_line(facts, proof, unit) for facts in proof.pockets]
    shapes = [shape_line(facts, proof, unit) for facts in proof.shapes]
    shapes += [holes_line(facts, proof, unit) for facts in proof.holes]
    return [*pockets, *shapes, *(section_line(facts, proof, unit) for facts in proof.sections)]


def pocket_line(facts: PocketFacts, proof: Proof, unit: Unit) -> CutLine:
    """Return the line of a pocket."""
    source, wall = facts.target.source, facts.target.wall
    depth = unit.text(wall.height(facts.target.deepest))
    what = f"⌀ {unit.text(2 * wall.radius)} to {AXES[wall.plane]}{depth}"
    off = off_text(facts.deviation, proof.tolerances.pocket, unit)
    where = line_text(proof, source.line, source.file)
    return CutLine(where, f"{source.code} ({source.dialect})", what, off, time_of(facts.pace))


def section_line(facts: SectionFacts, proof: Proof, unit: Unit) -> CutLine:
    """Return the line of a section."""
    section = facts.section
    sides = " and ".join(SIDES[side] for side in facts.sides) or "on"
    depth = f"{AXES[section.third]}{unit.text(facts.lowest)}"
    what = f"cutter ⌀ {unit.text(2 * facts.tool)} {sides} the contour, to {depth}"
    off = off_text(facts.deviation, proof.tolerances.polar, unit)
    return CutLine(section_lines_text(facts, proof), section.code, what, off, time_of(facts.pace))


def shape_line(facts: ShapeFacts, proof: Proof, unit: Unit) -> CutLine:
    """Return the line of a shape; its section, which has the time, has a line of its own."""
    call = facts.call
    what = f"cutter ⌀ {unit.text(2 * call.cutter)}, to Z{unit.text(facts.lowest)}"
    off = off_text(facts.deviation, proof.tolerances.polar, unit)
    return CutLine(line_text(proof, call.line, call.file), call.name, what, off)


def holes_line(facts: HolesFacts, proof: Proof, unit: Unit) -> CutLine:
    """Return the line of a call of holes."""
    holes, call = facts.holes, facts.holes.call
    where = "round" if holes.side else "on"
    what = (
        f"{counted_as(holes.count, 'hole')} {unit.text(holes.depth)} deep, {where}"
        f" ⌀ {unit.text(2 * holes.circle)}"
    )
    off = off_text(facts.deviation, proof.tolerances.polar, unit)
    return CutLine(line_text(proof, call.line, call.file), call.name, what, off)


def off_text(size: float, tolerance: float, unit: Unit) -> str:
    """Return a deviation and what it may be in words."""
    return f"{unit.fine(size)} {unit.name} off ({unit.fine(tolerance)} allowed)"


def time_of(pace) -> str:
    """Return the time that a cut takes."""
    return f"{plain(pace.seconds, 1)} s"
