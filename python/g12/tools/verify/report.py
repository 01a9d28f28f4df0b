# SPDX-License-Identifier: GPL-2.0-or-later
"""A proof for people: a line for each cut, then findings, notes, and what was not judged.

``--full`` puts the measures of each cut into rows; ``--json`` prints them all as plain values.
"""

import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from g12.tools.machine.ini import Ini
from g12.tools.path.part import Z, x0_text
from g12.tools.preview.moves import message_lines
from g12.tools.units import MM, Unit, counted_as, plain
from g12.tools.verify.proof import Proof
from g12.tools.verify.result.cut import MeasuredCut
from g12.tools.verify.result.finding import Finding, in_words, is_known
from g12.tools.verify.result.tolerances import SIZE
from g12.tools.verify.sections.section import times_of_section
from g12.tools.verify.workpiece import Workpiece

GAP = "  "
KINDS = {"findings": "is_finding", "notes": "is_note", "not_judged": "is_not_judged"}
NAMES = 14  # columns of a row's name
Row = tuple[str, str]  # a name, and its text with measures in braces

# Of rows with one name the first one counts whose measures are all known.
PACE: tuple[Row, ...] = (
    ("time", "{real_seconds:1} s, {seconds_programmed:1} s at the programmed feeds"),
    ("time", "{seconds_programmed:1} s at the programmed feeds"),
)
DEVIATION = ("deviation", "{deviation:fine} (allowed {allowed:fine})"), ("deviation", "{unknown}")
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
    ("entries", "{entries:words}"),
    *DEVIATION,
    ("depth", "{lowest:mm}"),
)
HOLES: tuple[Row, ...] = (
    ("entries", "{entries:words}"),
    ("holes", "{count} on ⌀ {circle:mm}, C {angles:turns}"),
    *DEVIATION,
    ("depth", "{depth:mm}"),
    *PACE,
)
STOCK: tuple[Row, ...] = (
    (
        "where",
        "X{bounds[0]:mm} to X{bounds[2]:mm}, Y{bounds[1]:mm} to Y{bounds[3]:mm}, top Z{top:mm}",
    ),
)


FORMS = {  # of a cut of each kind: what its line has, and the rows of --full
    "pockets": ("⌀ {radius:twice} to {square_to}{lowest:mm}", POCKET),
    "sections": ("cutter ⌀ {cutter:mm}, {sides}, to {third}{lowest:mm}", SECTION),
    "holes": ("{holes} {depth:mm} deep, {side} ⌀ {circle:mm}", HOLES),
    "shapes": ("cutter ⌀ {cutter:mm}, to Z{lowest:mm}", SHAPE),
}
PRINTED = ("pockets", "shapes", "holes", "sections")


def as_text(proof: Proof, unit: Unit, *, full: bool = False, strict: bool = False) -> str:
    """Return the proof as text; ``full`` with every measure, ``strict``: notes are findings."""
    judged = {
        "findings": [each for each in proof.judged if each.is_finding or (strict and each.is_note)],
        "notes": [each for each in proof.judged if each.is_note and not strict],
        "not judged": [each for each in proof.judged if each.is_not_judged],
    }
    listed = {title: _listed(found, proof, unit) for title, found in judged.items()}
    cuts = _paragraphs_of(proof, unit) if full else ["\n".join(in_columns(_cut_lines(proof, unit)))]
    messages = (m._replace(line=proof.user_line(m.line)) for m in proof.subject.trace.messages)
    parts = [
        _zero_text(proof, unit),
        *cuts,
        *("\n".join([title, *rows]) for title, rows in listed.items() if rows),
        "\n".join(message_lines(messages)),
        verdict(*map(len, listed.values())),
    ]
    return "\n\n".join(filter(None, parts))


def as_json(proof: Proof, strict: bool = False) -> str:
    """Return the proof for a program to read; with ``strict`` it is not good with a note."""
    judged = {
        name: [_judged_values(each, proof) for each in proof.judged if getattr(each, kind)]
        for name, kind in KINDS.items()
    }
    cuts, line = proof.cuts._asdict(), proof.user_line
    values = {
        "program": str(proof.opened.source if proof.opened else proof.subject.program),
        "ini": str(proof.subject.ini.path),
        "real": proof.subject.real is not None,
        **{kind: [_values_of(kind, cut, proof) for cut in cuts[kind]] for kind in FORMS},
        "rapids": [_judged_values(each, proof) for each in proof.judged if "path" in each.values],
        "stock": proof.given and _stock_values(proof.given),
        "unseen": [
            {"line": line(at), "code": code} for at, code in proof.lines_with("not-measured")
        ],
        "messages": [
            {"line": line(message.line), "text": message.text}
            for message in proof.subject.trace.messages
        ],
        "still": [{"line": line(at), "code": code} for at, code in proof.lines_with("not-cut")],
        **judged,
        "good": not (judged["findings"] or (strict and judged["notes"])),
    }
    return json.dumps(values, indent=2)


def _judged_values(found: Finding, proof: Proof) -> dict:
    """Return a finding or a note as plain values, its sentence in mm."""
    return {
        "code": found.code,
        "line": proof.user_line(found.line, found.file) or None,
        "lines": _lines_of(found, proof),
        "file": found.file or None,
        "text": proof.text(found, MM),
        "place": None if found.place is None else [float(value) for value in found.place],
    }


def _values_of(kind: str, cut: MeasuredCut, proof: Proof) -> dict[str, Any]:
    """Return the measures of a cut with the user's lines; entries are in program units."""
    first, last = (proof.user_line(line, cut.file) for line in (cut.line, cut.last))
    lines = {"lines": [first, last]} if cut.last else {"line": first}
    values = {**lines, "file": cut.file or None, "code": cut.code, **cut.values}
    if "lowest_feed_line" in values:
        values["lowest_feed_line"] = proof.user_line(values["lowest_feed_line"], cut.file)
    return values | _section_values(cut, proof.subject.ini) if kind == "sections" else values


def _section_values(cut: MeasuredCut, ini: Ini) -> dict[str, Any]:
    """Return what decides how a section's X words are read, and its time with kinematics."""
    section, reading = cut.commanded, ini.settings.polar_x
    by_mode = section.surface or reading == "inherit"
    modal = "G7" if section.diameters else "G8"
    times = times_of_section(section, cut.path, ini)
    by = {"x_words_by": modal if by_mode else f"POLAR_X = {reading}"}
    return {**by, "seconds_planned": times and times._asdict()}


def _stock_values(workpiece: Workpiece) -> dict[str, Any]:
    bounds = list(workpiece.shape.bounds)
    return {"text": workpiece.stock.text, "bounds": bounds, "top": workpiece.top}


def _zero_text(proof: Proof, unit: Unit) -> str:
    """Return where the program's zero is on the machine, "" where they are the same.

    Positions in a section are as far from the spindle as the program's; those on a cylinder are
    the program's. X0 must be the spindle's axis.
    """
    zero = proof.subject.zero
    words = [*zip("XYZ", zero)][Z if proof.subject.part.turning else 0 :]
    text = "positions below are the machine's; the program's zero is at machine {zero:xyz}"
    text += ", its axes turned by {rotation:1}°" if proof.subject.rotation else ""
    is_moved = max(abs(zero)) >= SIZE or proof.subject.rotation
    values = {"zero": words, "rotation": proof.subject.rotation}
    moved = in_words(text, values, unit) if is_moved else ""
    x0 = x0_text(proof.subject.part, unit) if proof.subject.part.turning else ""
    return "; ".join(filter(None, [moved, x0]))


def _paragraphs_of(proof: Proof, unit: Unit) -> Iterator[str]:
    """Yield every measure of each pocket, shape and section, and of the stock."""
    for kind, cut in _in_order(proof):
        yield paragraph_of(kind, cut, proof, unit)
    if proof.given:
        values = _stock_values(proof.given)
        yield paragraph(f"stock: {values['text']}", rows_of(STOCK, values, unit))


def _in_order(proof: Proof) -> list[tuple[str, MeasuredCut]]:
    """Return each cut with its kind, as the program runs them."""
    cuts = ((kind, cut) for kind in PRINTED for cut in getattr(proof.cuts, kind))
    return sorted(cuts, key=lambda pair: pair[1].own.start)


def paragraph_of(kind: str, cut: MeasuredCut, proof: Proof, unit: Unit) -> str:
    values = _values_of(kind, cut, proof)
    flats = values.get("across_flats", ())
    flats = dict.fromkeys(tuple(round(size, 3) for size in each) for each in flats)
    seconds, programmed = (values.get(name) for name in ("seconds", "seconds_programmed"))
    values |= {
        "allowed": _allowed_of(kind, [cut], proof),
        "unknown": "not judged" if math.isnan(cut.deviation) else "∞",
        "real_seconds": None if seconds == programmed else seconds,  # without acceleration
        **dict(zip(("flats", "flats_reached"), zip(*flats))),
    }
    call = proof.subject.trace.moves[cut.own.start].block
    inside = not cut.last or (not cut.file and cut.line <= call <= cut.last)
    called = "" if inside else f", called in line {proof.user_line(call)}"
    title = f"{line_text(proof, cut.line, cut.file, cut.last)}{called}: {_code_text(cut)}"
    return paragraph(title, rows_of(FORMS[kind][1], values, unit))


def _allowed_of(kind: str, cuts: Sequence[MeasuredCut], proof: Proof) -> float:
    """Return how far off cuts of a kind may be, mm: a run's corners are blended in sections."""
    usual = proof.tolerances.pocket if kind == "pockets" else proof.tolerances.polar
    return max(cut.values.get("allowed", usual) for cut in cuts)


def _code_text(cut: MeasuredCut) -> str:
    dialect = cut.values.get("dialect")
    return f"{cut.code} ({dialect})" if dialect else cut.code


def rows_of(rows: Sequence[Row], values: Mapping[str, Any], unit: Unit) -> Iterator[Row]:
    """Yield the rows whose measures are known, the first of each name, in words."""
    named = {name: text for name, text in reversed(rows) if is_known(text, values)}
    for name in dict.fromkeys(name for name, _ in rows):
        if name in named:
            yield name, in_words(named[name], values, unit)


def paragraph(title: str, rows: Iterable[Row]) -> str:
    """Return a titled table."""
    return "\n".join([title, *(f"  {name:{NAMES}}  {text}".rstrip() for name, text in rows)])


def line_text(proof: Proof, line: int, file: str, last: int = 0) -> str:
    """Return the user's line or lines in words, with the file of the sub in which they are."""
    end = f" to {proof.user_line(last, file)}" if last else ""
    of_file = f" of {file}" if file else ""
    return f"line{'s' * bool(last)} {proof.user_line(line, file)}{end}{of_file}"


def where_text(proof: Proof, found: Finding) -> str:
    """Return the user's lines of a finding in words, "" of the whole program."""
    lines = _lines_of(found, proof)
    of_file = f" of {found.file}" if found.file else ""
    return in_words("{lines:lines}", {"lines": lines}, MM) + of_file if lines else ""


def _lines_of(found: Finding, proof: Proof) -> list[int]:
    return sorted({proof.user_line(line, found.file) for line in found.lines})


def _listed(found: Sequence[Finding], proof: Proof, unit: Unit) -> list[str]:
    """Return findings as rows; what is the same of several lines once."""
    lines: dict[str, list[str]] = {}
    for each in found:
        lines.setdefault(proof.text(each, unit), []).append(where_text(proof, each))
    return [f"{GAP}{_first_of_lines(where)}{text}" for text, where in lines.items()]


def _first_of_lines(where: Sequence[str]) -> str:
    """Return the lines of a sentence: the first, how many more, how often if not once in each."""
    named = [each for each in dict.fromkeys(where) if each]
    more = [f"and {counted_as(len(named) - 1, 'line')} more"] if len(named) > 1 else []
    often = [f"{len(where)} times"] if len(where) > len(named) else []
    added = f" ({', '.join([*more, *often])})" if more or often else ""
    return f"{named[0]}{added}: " if named else ""


def verdict(findings: int, notes: int, not_judged: int) -> str:
    """Return the last line, which counts the rows of what was found, and was not judged."""
    counts = [
        counted_as(findings, "finding") if findings else "good",
        counted_as(notes, "note") if notes else "",
        f"{not_judged} not judged" if not_judged else "",
    ]
    return f"verdict: {', '.join(filter(None, counts))}"


def in_columns(rows: Iterable[Sequence[str]]) -> Iterator[str]:
    """Yield rows with their columns below each other."""
    rows = list(rows)
    widths = [max(map(len, column)) for column in zip(*rows)]
    for row in rows:
        cells = (cell.ljust(width) for cell, width in zip(row, widths))
        yield GAP.join(cells).rstrip()


def _cut_lines(proof: Proof, unit: Unit) -> Iterator[tuple[str, ...]]:
    """Yield the columns of each cut: where, which code, what, how far off, how long.

    The section in a shape's sub is measured with its shape.
    """
    of_shapes = {each.own for shape in proof.cuts.shapes for each in _sections_of(shape, proof)}
    for kind, cut in _in_order(proof):
        if kind == "sections" and cut.own in of_shapes:
            continue
        what = in_words(FORMS[kind][0], {**cut.values, **_what_words(kind, cut)}, unit)
        inside = _sections_of(cut, proof) if kind == "shapes" else []
        worst = max(each.deviation for each in (cut, *inside))
        allowed = unit.fine(_allowed_of(kind, [cut, *inside], proof))
        off = f"{unit.fine(worst)} {unit.name} off ({allowed} allowed)"
        off = "not judged" if math.isnan(worst) else off
        seconds = [each.values.get("seconds") for each in inside or [cut]]
        time = "" if None in seconds else f"{plain(sum(seconds), 1)} s"
        yield line_text(proof, cut.line, cut.file, cut.last), _code_text(cut), what, off, time


def _sections_of(shape: MeasuredCut, proof: Proof) -> list[MeasuredCut]:
    return [section for section in proof.sections if section.own.start in shape.own]


def _what_words(kind: str, cut: MeasuredCut) -> Mapping[str, str]:
    if kind == "sections":
        section = cut.commanded
        factor = 2 if section.surface and section.diameters else 1
        return {"third": "XYZ"[section.third], "lowest": factor * cut.values["lowest"]}
    if kind == "holes":
        side = "round" if cut.commanded.is_side else "on"
        return {"holes": counted_as(cut.values["count"], "hole"), "side": side}
    return {}
