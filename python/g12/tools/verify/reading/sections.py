# SPDX-License-Identifier: GPL-2.0-or-later
"""The sections that a program runs, and what their words draw, apart from the planner.

A copy of the program is traced without the sections' motion: every block there reports its words
instead. LinuxCNC itself evaluates expressions, loops, calls and conditions.
"""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import accumulate, islice
from pathlib import Path
from typing import Any

from g12.tools.preview.executed_blocks import (
    COMMENTS,
    Block,
    Text,
    blocks_in,
    is_number,
    read_lines,
    reports_after,
    reports_before,
)
from g12.tools.preview.tracer import Parameters, Tools, Tracer
from g12.tools.verify.expected.contour import ACTS, Act, Element, SectionContour
from g12.tools.verify.expected.words import kept_state
from g12.tools.verify.reading.codes import Codes
from g12.tools.verify.reading.executed_subs import Copies, called_files, moves_differ
from g12.tools.verify.result.tolerances import LEVEL

ACTING_M = {*map(float, (3, 4, 5, 7, 8, 9, 48, 49, 50, 51, 52, 53)), *map(float, range(100, 200))}
DWELL, CANCEL = 4.0, 40.0
PATH_CODES = (61.0, 61.1, 64.0)
SPINDLE = re.compile(r"\$\s*(#?-?[\d.]+|#<[^>]*>)")
RESTORE, SAVE_FOR_SUB = 72.0, 73.0
Pens = Mapping[str, Callable[[Block], Any]]
SUB = re.compile(r"(?:n[0-9.]+)?o<?((?<=<)[^>]+|[0-9.]+)>?(?:sub)?")
INSIDE = "#<_g12_inside>"  # in the copy: not 0 in a section, also in the subs that it calls
# position parameters, which a copy without motion cannot follow; #<_value> is a sub's
POSITION = re.compile(r"#<_(?!value(_returned)?>)|#54")


def bare(line: str) -> str:
    """Return a line without spaces and comments, in lower case."""
    return re.sub(r"\s", "", COMMENTS.sub("", line)).lower()


def doubts_of(copies: Copies) -> dict[Text, str]:
    """Return the lines that a copy without motion cannot follow in a section, and why."""
    subs = {name[1] for name in map(SUB.fullmatch, map(bare, copies.lines)) if name}
    doubts = {}
    for text, line in zip(copies.texts, copies.lines):
        if text.call and text.call not in subs:
            doubts[text] = f"line {text.number} calls o<{text.call}>"
        elif text.too_long:
            doubts[text] = f"line {text.number} is too long"
        elif POSITION.search(bare(line)):
            doubts[text] = f"line {text.number} asks for a position"
    return doubts


def lines_of_copy(
    copies: Copies, codes: Codes, doubts: Mapping[Text, str]
) -> Iterator[Sequence[str]]:
    """Yield the lines that replace each line: those of a section report their words alone.

    A line outside of them does so where a section has called it.
    """
    flagged = list(codes.with_switches(copies.texts))
    calls = any(text.call for text, _, inside in flagged if inside)
    for index, (line, (text, switch, inside)) in enumerate(zip(copies.lines, flagged)):
        skip, kept = index + 1 - text.number, words_kept(text, line, switch, codes)
        reported = text if kept is not None else text._replace(words=())
        report = [*reports_before(reported, skip), *(kept or ()), *reports_after(reported, skip)]
        if kept is None and text not in doubts:
            yield [line]
        elif switch or (inside and kept is not None):
            yield report
        elif inside:
            yield [*report, line]
        elif not calls:
            yield [line]
        else:
            label = f"o<g12_line_{index}>"
            motion = [f"{label} endif", line]
            if kept is not None:
                motion = [f"{label} else", line, f"{label} endif"]
            yield [f"{label} if [{INSIDE}]", *report, *motion]


def words_kept(text: Text, line: str, switch: str, codes: Codes) -> list[str] | None:
    """Return what remains of a line in the copy, None if it remains as it is.

    What it does besides moving remains: LinuxCNC itself reports it.
    """
    if switch:
        radius = dict(text.words).get("C", "1")
        kept = [f"{INSIDE}={radius if switch == 'on' else 0}"]
    elif text.words and not (text.control or text.call or text.too_long or is_m99(text)):
        kept = [acting_words(text, line, codes)]
    else:
        return None
    slash = "/" if text.deleted else ""
    return [slash + words for words in (*kept, *text.assignments) if words]


def is_m99(text: Text) -> bool:
    """Tell whether a line is the M99 that ends a sub of M98."""
    return ("M", "99") in text.words


def sections(
    tracer: Tracer,
    program: Path,
    codes: Codes,
    pens: Pens,
    blocks: Sequence[Block],
    tools: Tools,
    parameters: Parameters = None,
) -> list[SectionContour]:
    """Return the sections in the order they are run.

    ``blocks`` are the program's own, which say where sections begin. ``pens`` are those for each
    kind of section.
    """
    found = list(grouped(blocks, codes))
    if not found:
        return []
    copies = Copies(program, called_files(read_lines(program), tracer.ini))
    doubts = doubts_of(copies)
    lines, setup = lines_of_copy(copies, codes, doubts), (f"{INSIDE}=0",)
    copy = copies.trace(tracer, lines, tools, parameters, setup=setup)
    copied = blocks_in(copy, copies.texts)
    groups = list(grouped(copied, codes))
    if [own[0].text for own in found] != [group[0].text for group in groups]:
        raise moves_differ(program)
    actual, expected = paths_in_force(blocks), paths_in_force(copied)
    return [
        replace(
            section_of(own, group, codes, pens),
            doubt=next((doubts[block.text] for block in group if block.text in doubts), ""),
            paths_after=() if restores(group) else (actual[id(own[-1])], expected[id(group[-1])]),
            commanded_paths=(expected[id(group[0])], *paths_in(group)),
        )
        for own, group in zip(found, groups)
    ]


def acting_words(text: Text, line: str, codes: Codes) -> str:
    """Return those words of a line that act on the machine without motion, dwells included."""
    acting = [
        f"M{value}"
        for letter, value in text.words
        if letter == "M" and is_number(value) and float(value) in ACTING_M
        if not codes.remaps(f"M{value}")
    ]
    dwells = [f"G{code:g}" for code in text.codes if code == DWELL or code in PATH_CODES]
    arguments = "PQ" if acting or dwells else ""
    words = [letter + value for letter, value in text.words if letter in "S" + arguments]
    spindle = SPINDLE.search(line)
    found = [*dwells, *acting, *words]
    return " ".join([*found, spindle[0]] if found and spindle else found)


def grouped(blocks: Sequence[Block], codes: Codes) -> Iterator[list[Block]]:
    """Yield the blocks of each section, the one that switches it on first."""
    group: list[Block] = []
    for block in blocks:
        switch = switched(block, codes, bool(group))
        if switch == "on":
            group = [block]
        elif group:
            group.append(block)
        if switch == "off" and group:
            yield group
            group = []


def switched(block: Block, codes: Codes, inside: bool) -> str:
    """Return what a block did to a section; its text cannot tell that of G7.1 C#1 where #1 is 0."""
    switch = codes.switch(block.text, inside)
    return "off" if switch == "on" and block.words.get("C") == 0.0 else switch


def paths_in_force(blocks: Sequence[Block]) -> dict[int, str]:
    """Return G61 or G64 as in force after each block, by its id, "" where that is not known.

    In the copy a section's events come after its first block.
    """
    paths = accumulate(blocks, lambda path, block: (path, *paths_in([block]))[-1], initial="")
    return dict(zip(map(id, blocks), islice(paths, 1, None)))


def paths_in(blocks: Sequence[Block]) -> list[str]:
    """Return each G61 or G64 that a trace reports in some blocks."""
    return [event.text for block in blocks for event in block.events if event.text.startswith("G6")]


def restores(group: Sequence[Block]) -> bool:
    """Tell whether a section restores saved modes, of which its copy knows nothing."""
    return any(code in (RESTORE, SAVE_FOR_SUB) for block in group for code in block.m_codes)


def section_of(
    own: Sequence[Block], group: Sequence[Block], codes: Codes, pens: Pens
) -> SectionContour:
    """Return the section that executed blocks describe; ``own`` are the program's own of it."""
    first, last = own[0], own[-1]
    kind = codes.section(first.text)
    pen = pens[kind.dialect](first)
    start, height, diameters = pen.at, pen.depth, pen.x_unit < pen.unit
    elements: list[Element] = []
    acts: list[Act] = []
    cancelled = 0
    for block in group[1:]:
        texts = (event.text for event in block.events if ACTS.match(event.text))
        acts += [Act(block.text.number, text, len(elements)) for text in texts]
        if block is not group[-1]:  # whose words are those of the code that switches off
            drawn = list(pen.draw(block))
            if CANCEL in block.codes and any(each.length for each in drawn) and not cancelled:
                has_cut = any(each.depth < pen.surface - LEVEL for each in elements)
                cancelled = block.text.number * has_cut
            elements += drawn
    kept = kept_state(group[0].state, [code for block in group for code in block.codes])
    return SectionContour(
        first.text.number,
        last.text.number,
        first.at,
        last.end,
        f"G{first.codes[0]:g}",
        start,
        tuple(elements),
        height=height,
        diameters=diameters,
        c=first.state["_c"],
        acts=tuple(acts),
        events=tuple(event for block in own[1:] for event in block.events),
        expected_state={**pen.leaves(first.state), **({} if restores(group) else kept)},
        state_after=last.state_after,
        surface=pen.surface,
        cancelled=0 if any(each.side for each in elements) else cancelled,
        file=first.text.file,
    )
