# SPDX-License-Identifier: GPL-2.0-or-later
"""The sections that a program runs, and what their words draw, apart from the planner.

A copy of the program is traced without the sections' motion: every block there reports its words
instead. LinuxCNC itself evaluates expressions, loops, calls and conditions.

C stays turned after a polar section. The next one is turned on the part with it, unless the program
commands C in between, or gives it another zero.
"""

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import accumulate, chain, count, islice
from pathlib import Path
from typing import Any, NamedTuple

from g12.tools.machine.ini import Ini
from g12.tools.path.part import C
from g12.tools.preview.executed_blocks import (
    COMMENTS,
    Block,
    Text,
    blocks_in,
    is_number,
    moves_differ,
    read_lines,
    reports_after,
    reports_before,
)
from g12.tools.preview.moves import Move
from g12.tools.preview.tracer import Parameters, Tools, Tracer
from g12.tools.verify.expected.contour import ACTS, BEGUN, Act, Element, SectionContour, ZeroLine
from g12.tools.verify.expected.words import kept_state
from g12.tools.verify.reading.codes import Codes
from g12.tools.verify.reading.executed_subs import Copies, called_files

ACTING_M = {*map(float, (3, 4, 5, 7, 8, 9, 48, 49, 50, 51, 52, 53)), *map(float, range(100, 200))}
DWELL = 4.0
PATH_CODES = (61.0, 61.1, 64.0)
SPINDLE = re.compile(r"\$\s*(#?-?[\d.]+|#<[^>]*>)")
RESTORE, SAVE_FOR_SUB = 72.0, 73.0
Pens = Mapping[str, Callable[[Block], Any]]
SUB_LINE = re.compile(
    r"(/?(?:n[0-9.]+)?o<?)((?<=<)[^>]+|[0-9.]+)>?(sub|endsub|return|call|$).*"
)  # and the O1000 of a body that M98 calls
NUMBER_OF_M98 = re.compile(r"(?<=p)[0-9]+")
FIRST_NAME = 99001  # in the copy, of the subs that sections call: free numbers from here on
POSITION = "#<_", "#54"  # position parameters, which a copy without motion cannot follow
SAME_ANGLE = 1e-3  # degree


class SectionLine(NamedTuple):
    """A line: what it says, as written, the sub in whose body it is, the lines of files before."""

    text: Text
    written: str
    sub: str = ""
    skip: int = 0

    @property
    def is_control(self) -> bool:
        """Whether it decides which line is next."""
        return self.text.control or bool(self.text.call) or returns(self.text)

    def with_drawn(self, subs: Mapping[str, str]) -> str:
        """Return it with the copy's name for one of ``subs``, by their names."""
        code = bare(self.written)
        named = SUB_LINE.fullmatch(code)
        if named and named[2] in subs:
            return code[: named.end(1)] + subs[named[2]] + code[named.end(2) :]
        by_m98 = not self.text.control and self.text.call in subs
        return NUMBER_OF_M98.sub(subs[self.text.call], code) if by_m98 else self.written


Bodies = Mapping[str, Sequence[SectionLine]]


def bare(line: str) -> str:
    """Return a line without spaces and comments, in lower case."""
    return re.sub(r"\s", "", COMMENTS.sub("", line)).lower()


def returns(text: Text) -> bool:
    """Tell whether a line is the M99 that ends a sub of M98."""
    return ("M", "99") in text.words


def section_lines(texts: Sequence[Text], written: Sequence[str]) -> list[SectionLine]:
    """Return the lines of files, one after the other."""
    found, sub, file = [], "", ""
    for index, (text, line) in enumerate(zip(texts, written)):
        named = SUB_LINE.fullmatch(bare(line))
        begins = bool(named) and named[3] in ("sub", "")
        sub = named[2] if named and begins else sub if text.file == file else ""
        file = text.file
        found.append(SectionLine(text, line, sub, index + 1 - text.number))
        sub = "" if returns(text) or (named and named[3] == "endsub") else sub
    return found


def bodies_of(lines: Sequence[SectionLine]) -> dict[str, list[SectionLine]]:
    """Return the lines of each sub by its name."""
    found: dict[str, list[SectionLine]] = {}
    for line in lines:
        found.setdefault(line.sub, []).append(line)
    return {sub: body for sub, body in found.items() if sub}


def drawn_subs(lines: Sequence[SectionLine], codes: Codes, bodies: Bodies) -> dict[str, str]:
    """Return the subs that sections call, directly or not, each with its name in the copy."""
    flagged = zip(lines, codes.with_switches(line.text for line in lines))
    called = subs_from([line.text.call for line, (_, _, inside) in flagged if inside], bodies)
    taken = {name for line in lines for name in (line.sub, line.text.call)}
    free = (name for name in map(str, count(FIRST_NAME)) if name not in taken)
    return dict(zip(sorted(called & bodies.keys()), free))


def subs_from(calls: Iterable[str], bodies: Bodies) -> set[str]:
    """Return the subs that are called, directly or not."""
    waiting, found = [*calls], {""}
    while waiting:
        sub = waiting.pop()
        if sub not in found:
            found.add(sub)
            waiting += [line.text.call for line in bodies.get(sub, ())]
    return found - {""}


def doubt_of(line: SectionLine, bodies: Bodies) -> str:
    """Return why the copy cannot follow a line of a section, "" if it can."""
    called = subs_from([line.text.call], bodies)
    lines = [each for sub in called for each in bodies.get(sub, ())]
    if called - bodies.keys() or any(map(own_doubt, lines)):
        return f"line {line.text.number} calls o<{line.text.call}>"
    return own_doubt(line)


def own_doubt(line: SectionLine) -> str:
    """Return why the copy cannot follow a line, its calls aside."""
    if line.text.too_long:
        return f"line {line.text.number} is too long"
    asks = any(name in bare(line.written) for name in POSITION)
    return f"line {line.text.number} asks for a position" if asks else ""


def doubts_of(lines: Sequence[SectionLine], codes: Codes, bodies: Bodies) -> dict[Text, str]:
    """Return what the copy of the program cannot follow, by the line that begins a section."""
    doubts: dict[Text, str] = {}
    first: Text | None = None
    flagged = codes.with_switches(line.text for line in lines)
    for line, (text, switch, inside) in zip(lines, flagged):
        first = text if switch == "on" else first
        why = doubt_of(line, bodies) if inside else ""
        if first and why:
            doubts[first] = why
    return doubts


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
    lines = section_lines(copies.texts, copies.lines)
    bodies = bodies_of(lines)
    drawn = drawn_subs(lines, codes, bodies)
    more = {f"{name}.ngc": flattened(bodies[sub], codes, drawn, sub) for sub, name in drawn.items()}
    copy = copies.trace(tracer, flattened(lines, codes, drawn), more, tools, parameters)
    copied = blocks_in(copy, copies.texts)
    groups = list(grouped(copied, codes))
    if [own[0].text for own in found] != [group[0].text for group in groups]:
        raise moves_differ(program)
    doubts = doubts_of(lines, codes, bodies)
    actual, expected = paths_in_force(blocks), paths_in_force(copied)
    return [
        replace(
            section_of(own, group, codes, pens),
            doubt=doubts.get(own[0].text, ""),
            paths_after=() if restores(group) else (actual[id(own[-1])], expected[id(group[-1])]),
            commanded_paths=(expected[id(group[0])], *paths_in(group)),
        )
        for own, group in zip(found, groups)
    ]


def flattened(
    lines: Sequence[SectionLine], codes: Codes, drawn: Mapping[str, str], sub: str = ""
) -> list[list[str]]:
    """Return the lines that replace each line in the copy without the sections' motion.

    What a line does besides moving stays: LinuxCNC itself reports it. ``drawn`` are the subs that
    sections call: their copies, of which ``sub`` is one, are in a section from the first line on.
    """
    found = []
    own = {name: copied for name, copied in drawn.items() if name == sub}
    flagged = codes.with_switches((line.text for line in lines), bool(sub))
    for line, (text, switch, inside) in zip(lines, flagged):
        if switch or (inside and text.words and not line.is_control and not text.too_long):
            slash = "/" if text.deleted else ""
            acting = "" if switch else acting_words(text, line.written, codes)
            kept = [slash + words for words in (acting, *text.assignments) if words]
            found.append([*reports_before(text, line.skip), *kept, *reports_after(text, line.skip)])
        else:
            named = drawn if inside else {} if line.text.call == sub else own
            found.append([line.with_drawn(named)])
    return found


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
        height=height,
        diameters=diameters,
        c=first.state["_c"],
        acts=tuple(acts),
        events=tuple(event for block in own[1:] for event in block.events),
        expected_state={**pen.leaves(first.state), **({} if restores(group) else kept)},
        state_after=last.state_after,
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
        each.at: zero_line(previous, each, moves, lines)
        for previous, each in zip([None, *polar], polar)
    }
    return [replace(each, zero_line=found.get(each.at, BEGUN)) for each in sections]


def zero_line(
    previous: SectionContour | None, section: SectionContour, moves: Sequence[Move], lines: set[int]
) -> ZeroLine:
    """Return what has become of C since the section before, or the program's beginning."""
    between = moves[previous.end if previous else 0 : section.at]
    commanded = any(move.end[C] != move.start[C] or move.line in lines for move in between)
    if previous is None:
        return ZeroLine(commanded)
    angle, other = (moves[each.at].start[C] for each in (section, previous))
    turned = (angle - other + 180.0) % 360.0 - 180.0
    offsets = (
        angle - section.c,
        moves[previous.end - 1].end[C] - previous.state_after.get("_c", math.nan),
    )
    commanded = commanded or abs(offsets[0] - offsets[1]) > SAME_ANGLE
    return ZeroLine(commanded, turned if abs(turned) > SAME_ANGLE else 0.0, previous.last)
