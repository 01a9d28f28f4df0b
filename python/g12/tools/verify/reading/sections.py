# SPDX-License-Identifier: GPL-2.0-or-later
"""The sections that a program runs, and what their words draw, apart from the planner.

A copy of the program is traced in which the section's motion is left out and every block tells
its words instead; expressions, loops, calls and conditions are LinuxCNC's own doing.

C stays turned behind a polar section. The next one is turned on the part with it, unless the
program commands C in between, or gives it another zero.
"""

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

from g12.tools.machine.ini import Ini
from g12.tools.path.part import C
from g12.tools.preview.executed_blocks import (
    COMMENT,
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
from g12.tools.preview.moves import Move
from g12.tools.preview.tracer import Parameters, Tools, Tracer
from g12.tools.verify.expected.contour import ACTS, BEGUN, Act, Element, SectionContour, ZeroLine
from g12.tools.verify.expected.words import kept_state
from g12.tools.verify.reading.codes import Codes
from g12.tools.verify.reading.executed_subs import Copies, called_files, files_with

ACTING_M = {*map(float, (3, 4, 5, 7, 8, 9, 48, 49, 50, 51, 52, 53)), *map(float, range(100, 200))}
DWELL = 4.0
PATH_CODES = (61.0, 61.1, 64.0)
SPINDLE = re.compile(r"\$\s*(#?-?[\d.]+|#<[^>]*>)")
RESTORE, SAVE_FOR_SUB = 72.0, 73.0
Place = tuple[str, int]
Pens = Mapping[str, Callable[[Block], Any]]
BODY = re.compile(r"/?(?:n[0-9.]+)?o(?:<([^>]+)>|([0-9.]+))(sub|endsub)")
POSITION = "#<_", "#54"  # position parameters, which a copy without motion cannot follow
SAME_ANGLE = 1e-3  # degree


class SectionLine(NamedTuple):
    """A line of a file: what it says, as it is written, and the sub whose body it is in."""

    text: Text
    written: str
    sub: str

    @property
    def asks_position(self) -> bool:
        """Tell whether it asks where the tool is."""
        return any(name in self.written.replace(" ", "") for name in POSITION)


def section_lines(texts: Sequence[Text], written: Sequence[str]) -> list[SectionLine]:
    """Return the lines of a file."""
    found, sub = [], ""
    for text, line in zip(texts, written):
        body = BODY.match(re.sub(r"\s", "", COMMENT.sub("", line)).lower())
        sub = (body[1] or body[2]) if body and body[3] == "sub" else sub
        found.append(SectionLine(text, line, sub))
        sub = "" if body and body[3] == "endsub" else sub
    return found


def followed_subs(files: Sequence[Sequence[SectionLine]], codes: Codes) -> set[str]:
    """Return the subs that are called in sections and nowhere else, and ask for no position."""
    subs = {line.text.call for lines in files for line in lines if line.text.control} - {""}
    subs -= {line.sub for lines in files for line in lines if line.asks_position}
    while True:
        flagged = [each for lines in files for each in with_flags(lines, codes, subs)]
        elsewhere = {line.text.call for line, within in flagged if not within}
        if not subs & elsewhere:
            return subs
        subs -= elsewhere


def with_flags(
    lines: Sequence[SectionLine], codes: Codes, subs: set[str]
) -> Iterator[tuple[SectionLine, bool]]:
    """Yield lines, each with whether it is in a section: its first one is, its last is not."""
    inside = False
    for line in lines:
        switch = codes.switch(line.text, inside)
        inside = inside if not switch else switch == "on"
        yield line, inside or line.sub in subs


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
    files = files_with(lambda texts: any(map(codes.section, texts)), every)
    files += [file for file in every if file.stem in subs and file not in files]
    copies = Copies(program, sorted(files), partial(flattened_file, codes=codes, subs=subs))
    texts = copies.texts
    copied = blocks_in(copies.trace(tracer, tools, parameters), texts)
    groups = list(grouped(copied, codes))
    if [own[0].text for own in found] != [group[0].text for group in groups]:
        raise moves_otherwise(program)
    doubts = doubts_of(section_lines(texts, copies.lines), codes, subs)
    paths = zip(*(paths_of(some, codes) for some in (blocks, copied)))
    return [
        replace(
            section_of(
                own, group, codes, pens, doubts.get((own[0].text.file, own[0].text.number), "")
            ),
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
    """Return what the copy of the program cannot follow, by file and line of a section's start."""
    doubts: dict[Place, str] = {}
    first: Place | None = None
    for line in lines:
        text = line.text
        switch = codes.switch(text, bool(first))
        first = {"on": (text.file, text.number), "off": None}.get(switch, first)
        if first and text.call and text.call not in subs:
            doubts[first] = f"line {text.number} calls o<{text.call}>"
        elif first and text.too_long:
            doubts[first] = f"line {text.number} is too long"
        elif first and line.asks_position:
            doubts[first] = f"line {text.number} asks for a position"
    return doubts


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
    kept = kept_state(group[0].state, [code for block in group for code in block.codes])
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
        leaves={**pen.leaves(first.state), **({} if restores(group) else kept)},
        left=last.left,
        surface=pen.surface,
        file=first.text.file,
    )


def with_zero_lines(
    sections: Sequence[SectionContour],
    moves: Sequence[Move],
    program: Path,
    codes: Codes,
    ini: Ini,
) -> list[SectionContour]:
    """Return the sections of a program, each polar one with what has become of C before it."""
    if not sections:
        return []
    texts = read_lines(program)
    flagged = codes.with_switches(texts)
    outside = [text for text, switch, inside in flagged if not (inside or switch)]
    subs = chain.from_iterable(map(read_lines, called_files(texts, ini)))
    lines = {text.number for text in (*outside, *subs) if "C" in dict(text.words)}
    polar = [each for each in sections if not each.surface]
    found = {
        each.at: zero_line(before, each, moves, lines)
        for before, each in zip([None, *polar], polar)
    }
    return [replace(each, zero_line=found.get(each.at, BEGUN)) for each in sections]


def zero_line(
    before: SectionContour | None, section: SectionContour, moves: Sequence[Move], lines: set[int]
) -> ZeroLine:
    """Return what has become of C since the section before, or the program's beginning."""
    between = moves[before.end if before else 0 : section.at]
    commanded = any(move.end[C] != move.start[C] or move.line in lines for move in between)
    if before is None:
        return ZeroLine(commanded)
    angle, other = (moves[each.at].start[C] for each in (section, before))
    turned = (angle - other + 180.0) % 360.0 - 180.0
    offsets = angle - section.c, moves[before.end - 1].end[C] - before.left_c
    commanded = commanded or abs(offsets[0] - offsets[1]) > SAME_ANGLE
    return ZeroLine(commanded, turned if abs(turned) > SAME_ANGLE else 0.0, before.last)
