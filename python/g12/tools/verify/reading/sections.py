# SPDX-License-Identifier: GPL-2.0-or-later
"""The sections that a program runs, and what their words draw, apart from the planner.

A copy of the program is traced in which the section's motion is left out and every block tells
its words instead; expressions, loops, calls and conditions are LinuxCNC's own doing.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from g12.tools.preview.executed_blocks import (
    Block,
    Text,
    after,
    before,
    blocks_in,
    is_number,
    lines_as_written,
    moves_otherwise,
    read_lines,
)
from g12.tools.preview.tracer import Parameters, Tools, Tracer
from g12.tools.verify.expected.block_words import kept_state
from g12.tools.verify.expected.contour import ACTS, Act, Element, SectionContour
from g12.tools.verify.reading.codes import Codes
from g12.tools.verify.reading.executed_subs import Copies, called_files, files_with
from g12.tools.verify.reading.inside import SectionLine, followed_subs, section_lines, with_flags

ACTING_M = {*map(float, (3, 4, 5, 7, 8, 9, 48, 49, 50, 51, 52, 53)), *map(float, range(100, 200))}
DWELL = 4.0
PATH_CODES = (61.0, 61.1, 64.0)
SPINDLE = re.compile(r"\$\s*(#?-?[\d.]+|#<[^>]*>)")
RESTORE, SAVE_FOR_SUB = 72.0, 73.0
Place = tuple[str, int]
Pens = Mapping[str, Callable[[Block], Any]]


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
    every = sorted(called_files(read_lines(program), tracer.ini))
    read = {
        file: section_lines(read_lines(file), lines_as_written(file)) for file in (program, *every)
    }
    subs = followed_subs(list(read.values()), codes)
    files = files_with(codes.sections_in, every)
    files += [file for file in every if file.stem in subs and file not in files]
    copies = Copies(program, sorted(files), partial(flattened_file, codes=codes, subs=subs))
    copy = copies.trace(tracer, tools, parameters)
    texts = copies.texts
    copied = blocks_in(copy, texts)
    groups = list(grouped(copied, codes))
    if [own[0].text for own in found] != [group[0].text for group in groups]:
        raise moves_otherwise(program)
    doubts = doubts_of(section_lines(texts, copies.lines), codes, subs)
    paths = zip(*(paths_of(some, codes) for some in (blocks, copied)))
    return [
        replace(
            section_of(own, group, codes, pens, doubts.get(place_of(own[0].text), "")),
            paths=() if restores(group) else (left, asked),
            path=begun,
            asked_paths=(begun, *paths_told(group)),
        )
        for own, group, ((_, left), (begun, asked)) in zip(found, groups, paths)
    ]


def flattened_file(
    path: Path, texts: Sequence[Text], codes: Codes, skip: int, subs: set[str]
) -> list[str]:
    """Return the lines of a file without the sections' motion; see ``flattened``."""
    groups = flattened(section_lines(texts, lines_as_written(path)), codes, subs, skip)
    return [line for group in groups for line in group]


def flattened(
    lines: Sequence[SectionLine], codes: Codes, subs: set[str], skip: int = 0
) -> Iterator[tuple[str, ...]]:
    """Yield the lines that stand for each line in the copy without the sections' motion.

    What a line does besides moving stays: LinuxCNC itself tells of it. ``subs`` are those that
    only sections call.
    """
    before_it = False
    for line, inside in with_flags(lines, codes, subs):
        text, switch = line.text, codes.switch(line.text, before_it)
        if switch or (inside and text.words and not text.control and not text.too_long):
            slash = "/" if text.deleted else ""
            acting = "" if switch else acting_words(text, line.written, codes)
            kept = tuple(slash + words for words in (acting, *text.assignments) if words)
            yield (*before(text, skip), *kept, *after(text, skip))
        else:
            yield (line.written,)
        before_it = inside


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


def doubts_of(lines: Sequence[SectionLine], codes: Codes, subs: set[str]) -> dict[Place, str]:
    """Return what the copy of the program cannot follow, by the place of a section's start."""
    doubts: dict[Place, str] = {}
    first: Place | None = None
    for line in lines:
        text = line.text
        switch = codes.switch(text, bool(first))
        first = {"on": place_of(text), "off": None}.get(switch, first)
        if first and text.call and text.call not in subs:
            doubts[first] = f"line {text.number} calls o<{text.call}>"
        elif first and text.too_long:
            doubts[first] = f"line {text.number} is too long"
        elif first and line.asks_position:
            doubts[first] = f"line {text.number} asks for a position"
    return doubts


def place_of(text: Text) -> Place:
    """Return the file of a sub, "" for the program, and the number of a line."""
    return text.file, text.number


def paths_of(blocks: Sequence[Block], codes: Codes) -> list[list[str]]:
    """Return G61 or G64 as in force where each section begins and where it ends.

    In the copy a section's events come behind its first block.
    """
    path, found, inside = "", [], False
    for block in blocks:
        path = next(iter(paths_told([block])[::-1]), path)
        switch = switched(block, codes, inside)
        if switch == "on" and not inside:
            found.append([path, path])
        elif switch == "off" and inside:
            found[-1][1] = path
        inside = switch == "on" if switch else inside
    return found


def paths_told(blocks: Sequence[Block]) -> list[str]:
    """Return each G61 or G64 that a trace tells of in some blocks."""
    return [event.text for block in blocks for event in block.events if event.text.startswith("G6")]


def restores(group: Sequence[Block]) -> bool:
    """Tell whether a section gives saved modes back, of which its copy knows nothing."""
    return any(code in (RESTORE, SAVE_FOR_SUB) for block in group for code in block.m_codes)


def section_of(
    own: Sequence[Block], group: Sequence[Block], codes: Codes, pens: Pens, doubt: str
) -> SectionContour:
    """Return the section that executed blocks describe; ``own`` are the program's own of it."""
    first, last = own[0], own[-1]
    told = tuple(event for block in own[1:] for event in block.events)
    kind = codes.section(first.text)
    pen = pens[kind.dialect](first)
    start, height, diameters = pen.at, pen.depth, pen.x_unit < pen.unit
    elements: list[Element] = []
    acts: list[Act] = []
    for block in group[1:]:
        texts = (event.text for event in block.events if ACTS.match(event.text))
        acts += [Act(block.text.number, text, len(elements)) for text in texts]
        if block is not group[-1]:  # whose words are those of the code that switches off
            elements += pen.draw(block)
    return SectionContour(
        first.text.number,
        last.text.number,
        first.at,
        last.end,
        f"G{first.codes[0]:g}",
        start,
        tuple(elements),
        doubt,
        height,
        diameters,
        first.state["_c"],
        last.left.get("_c", math.nan),
        acts=tuple(acts),
        told=told,
        leaves={**pen.leaves(first.state), **kept_behind(group)},
        left=last.left,
        surface=pen.surface,
        file=first.text.file,
    )


def kept_behind(group: Sequence[Block]) -> dict[str, float]:
    """Return the modes that the blocks of a section leave as they are."""
    if restores(group):
        return {}
    return kept_state(group[0].state, [code for block in group for code in block.codes])
