# SPDX-License-Identifier: GPL-2.0-or-later
"""A proof for people: a line for each cut, then findings, notes, and what was not judged."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from g12.tools.preview.moves import message_lines
from g12.tools.units import Unit, counted_as, plain
from g12.tools.verify.compare.drilled import HolesFacts
from g12.tools.verify.paragraphs import AXES, line_text, paragraphs_of, zero_text
from g12.tools.verify.pocket import PocketFacts
from g12.tools.verify.proof import Proof
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.sections.section import SectionFacts
from g12.tools.verify.shape import ShapeFacts

GAP = "  "
SIDES = {1: "left of", -1: "right of", 0: "on"}


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
    others = [each for each in judged if not (each.is_finding or each.is_note)]
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
    first, last = (proof.user_line(line, section.file) for line in (section.line, section.last))
    where = f"lines {first} to {last}{f' of {section.file}' if section.file else ''}"
    off = off_text(facts.deviation, proof.tolerances.polar, unit)
    return CutLine(where, section.code, what, off, time_of(facts.pace))


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
