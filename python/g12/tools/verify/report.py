# SPDX-License-Identifier: GPL-2.0-or-later
"""A judgement for people: a line for each cut, what was found, the verdict.

``--full`` puts the measures of each cut into rows; ``--json`` prints them all as plain values.
"""

import json
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from g12.tools.preview.moves import message_lines
from g12.tools.units import MM, Unit
from g12.tools.verify.judge import Judgement
from g12.tools.verify.measures import kind_of, measures
from g12.tools.verify.model.cut import Cut
from g12.tools.verify.model.finding import (
    FINDING,
    NOT_JUDGED,
    WARNING,
    Finding,
    in_words,
    is_known,
    lines_in_words,
    verdict,
)
from g12.tools.verify.model.solid import FACE
from g12.tools.verify.remains import left_of
from g12.tools.verify.rules.whole import travel_needed

GAP = "  "
NAMES = 14  # columns of a row's name
Row = tuple[str, str]  # a name, and its text with measures in braces
KINDS = ("pockets", "sections", "holes", "shapes")
TITLES = {FINDING: "findings", WARNING: "warnings", NOT_JUDGED: "not judged"}
LINES = {  # what the line of a cut has
    "pockets": "⌀ {radius:twice} to {square_to}{lowest:mm}",
    "sections": "{sides}, to {third}{lowest:mm}",
    "holes": "{count:holes} {depth:mm} deep, {side} ⌀ {circle:mm}",
    "shapes": "to Z{lowest:mm}",
}
CUTTER, CORE = "cutter ⌀ {cutter:mm}, ", ", a core of ⌀ {core:twice} stays"
OFF, TIME = "{deviation:fine} off ({allowed:small} allowed)", "{seconds:1} s"
# Of rows with one name the first one counts whose measures are all known.
ROWS: tuple[Row, ...] = (
    ("centre", "X{centre[0]:mm} Y{centre[1]:mm}"),
    ("cutter", "⌀ {cutter:mm}, {sides}"),
    ("cutter", "⌀ {cutter:mm}"),
    ("radius", "boss {boss:mm}"),
    ("radius", "wall {radius:mm}, reached {reached:length}"),
    ("core", "radius {core:length}"),
    ("rings", "{rings:list} (tool centre)"),
    ("entries", "{entries:words}"),
    ("holes", "{count} on ⌀ {circle:mm}, C {angles:turns}"),
    ("surface", "radius {surface:mm}"),
    ("zero line", "C {zero_line:3}"),
    ("X words", "{x_words}"),
    ("depth", "{depths:list}"),
    ("depth", "{third}{lowest:mm}"),
    ("depth", "{depth:mm}"),
    ("deviation", "{deviation:fine} ({allowed:fine} allowed)"),
    ("segments", "{segments}, {shortest:mm} to {longest:length} long"),
    ("speed", "{turn} {c_speed:1} degrees/s at most, limit {c_limit:1}"),
    ("time", "{real_seconds:1} s, {seconds_programmed:1} s at the programmed feeds"),
    ("time", "{seconds_programmed:1} s at the programmed feeds"),
    (
        "kinematics",
        "about {seconds_planned[segments]:1} s in segments, {seconds_planned[kinematics]:1} s with "
        "kinematics, {seconds_planned[least]:1} s at the limits of X and C",
    ),
)


def as_text(judgement: Judgement, unit: Unit, *, full: bool = False) -> str:
    """Return the report as text; ``full`` with every measure."""
    cuts = [] if full else ["\n".join(in_columns(_cut_lines(judgement, unit)))]
    trace = judgement.program.trace
    messages = (m._replace(line=judgement.user_line(m.line)) for m in trace.messages)
    listed = [(title, judgement.of(severity)) for severity, title in TITLES.items()]
    parts = [
        *(_paragraphs(judgement, unit) if full else cuts),
        _travel_text(judgement, unit) if full else "",
        assumption(judgement, unit),
        *(
            "\n".join([title, *_listed(found, judgement, unit)])
            for title, found in [*listed, ("accepted", judgement.accepted)]
            if found
        ),
        "\n".join(message_lines(messages)),
        f"verdict: {verdict(judgement.found)}",
    ]
    return "\n\n".join(filter(None, parts))


def as_json(judgement: Judgement) -> str:
    """Return the report for a program to read."""
    program, opened, solids = judgement.program, judgement.opened, judgement.solids
    cuts: dict[str, list] = {name: [] for name in KINDS}
    for cut in program.cuts:
        cuts[kind_of(cut)].append(_plain_measures(cut, judgement))
    listed = {
        "rapids": (each for each in judgement.found if "path" in each.values),
        "findings": judgement.of(FINDING),
        "warnings": judgement.of(WARNING),
        "not_judged": judgement.of(NOT_JUDGED),
        "accepted": judgement.accepted,
    }
    stock = solids.stock and {
        "text": solids.stock.text,
        "bounds": list(solids.of(FACE).shape.bounds),
        "top": solids.top(FACE),
    }
    values = {
        "program": str(opened.source if opened else program.file),
        "ini": str(program.ini.path),
        "real": program.real is not None,
        **cuts,
        "stock": stock,
        "assumed": assumption(judgement, MM),
        "messages": [
            {"line": judgement.user_line(message.line), "text": message.text}
            for message in program.trace.messages
        ],
        **{name: [_plain(each, judgement) for each in found] for name, found in listed.items()},
        "verdict": verdict(judgement.found),
    }
    return json.dumps(values, indent=2)


def _plain(found: Finding, judgement: Judgement) -> dict[str, Any]:
    """Return a finding as plain values, its sentence in mm."""
    return {
        "code": found.code,
        "line": judgement.user_line(found.line, found.file) or None,
        "lines": _lines_of(found, judgement),
        "file": found.file or None,
        "text": sentence_in(found, judgement, MM),
        "place": None if found.place is None else [float(value) for value in found.place],
    }


def _plain_measures(cut: Cut, judgement: Judgement) -> dict[str, Any]:
    first, last = (judgement.user_line(line, cut.file) for line in (cut.line, cut.last_line))
    lines = {"lines": [first, last]} if cut.is_section else {"line": first}
    return {**lines, "file": cut.file or None, **measures(cut, judgement)}


def assumption(judgement: Judgement, unit: Unit) -> str:
    """Return what is solid before the first move, in words."""
    solids, program = judgement.solids, judgement.program
    stock, top = solids.stock, f" (machine Z{unit.text(solids.z0)})" if program.is_placed else ""
    if program.is_round and not solids.stock:
        return "assumed: solid up to the radius of each section round it"
    if program.is_round:
        return f"stock: {stock.text}, about the axis of rotation"
    if stock and (stock.is_whole or program.turning):
        return f"stock: {stock.text}, its top at Z0{top}"
    bar = f", a bar of ⌀ {unit.text(2 * solids.bar)}" if program.turning and solids.bar else ""
    bores = f", {stock.text} in every pocket" if stock else ""
    return f"assumed: solid below Z0{top}{bar}{bores}; the tool starts clear of it"


def _travel_text(judgement: Judgement, unit: Unit) -> str:
    """Return what travel a program needs from a zero that is not known."""
    needs = travel_needed(judgement.program)
    text = ", ".join(f"{axis} {unit.text(low)} to {unit.text(high)}" for axis, low, high in needs)
    return text and f"travel needed from the work offset, which is not set (--var): {text}"


def sentence_in(found: Finding, judgement: Judgement, unit: Unit) -> str:
    text = found.text(unit)
    return judgement.opened.in_source(text) if judgement.opened and not found.file else text


def where_text(found: Finding, judgement: Judgement) -> str:
    """Return the user's lines of a finding in words, "" of the whole program."""
    lines = _lines_of(found, judgement)
    of_file = f" of {found.file}" if found.file else ""
    return lines_in_words(lines) + of_file if lines else ""


def _lines_of(found: Finding, judgement: Judgement) -> list[int]:
    lines = found.lines or (found.line,)
    return sorted({judgement.user_line(line, found.file) for line in lines if line})


def _listed(found: Sequence[Finding], judgement: Judgement, unit: Unit) -> Iterator[str]:
    for each in found:
        where = where_text(each, judgement)
        text = f"{sentence_in(each, judgement, unit)} [{each.code}]"
        yield f"{GAP}{where}: {text}" if where else f"{GAP}{text}"


def in_columns(rows: Iterable[Sequence[str]]) -> Iterator[str]:
    """Yield rows with their columns below each other."""
    rows = list(rows)
    widths = [max(map(len, column)) for column in zip(*rows)]
    for row in rows:
        cells = (cell.ljust(width) for cell, width in zip(row, widths))
        yield GAP.join(cells).rstrip()


def _cut_lines(judgement: Judgement, unit: Unit) -> Iterator[tuple[str, ...]]:
    """Yield the columns of each cut: where, which code, what, how far off, how long."""
    for cut in judgement.program.cuts:
        values, name = measures(cut, judgement), kind_of(cut)
        cutter = CUTTER if values["cutter"] and name in ("sections", "shapes") else ""
        stays = cut.is_ring and cut.inner > cut.cutter and not cut.upright
        core = CORE if stays and left_of(cut.core, cut, judgement.solids).area > 0 else ""
        what = in_words(cutter + LINES[name] + core, values, unit)
        time = in_words(TIME, values, unit) if is_known(TIME, values) else ""
        off = in_words(OFF, values, unit)
        yield _lines_text(cut, judgement), _code_text(values), what, off, time


def _lines_text(cut: Cut, judgement: Judgement) -> str:
    last = f" to {judgement.user_line(cut.last_line, cut.file)}" if cut.is_section else ""
    of_file = f" of {cut.file}" if cut.file else ""
    return f"line{'s' * bool(last)} {judgement.user_line(cut.line, cut.file)}{last}{of_file}"


def _code_text(values: dict[str, Any]) -> str:
    dialect = values.get("dialect")
    return f"{values['code']} ({dialect})" if dialect else values["code"]


def _paragraphs(judgement: Judgement, unit: Unit) -> Iterator[str]:
    """Yield every measure of each cut."""
    for cut in judgement.program.cuts:
        values = measures(cut, judgement)
        if values.get("seconds") != values.get("seconds_programmed"):
            values["real_seconds"] = values["seconds"]
        named = {name: text for name, text in reversed(ROWS) if is_known(text, values)}
        names = [name for name in dict.fromkeys(name for name, _ in ROWS) if name in named]
        rows = (f"{GAP}{name:{NAMES}}  {in_words(named[name], values, unit)}" for name in names)
        yield "\n".join([f"{_lines_text(cut, judgement)}: {_code_text(values)}", *rows])
