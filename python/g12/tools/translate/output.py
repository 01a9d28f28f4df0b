# SPDX-License-Identifier: GPL-2.0-or-later
"""The lines of the LinuxCNC program: one for each line of the file, further ones marked.

Its programs stand each below all of its calls: LinuxCNC looks for a subprogram from the call on
downwards, other controls do not mind. A file whose main program is first and whose subprograms
stand below their calls stays in its order.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from graphlib import CycleError, TopologicalSorter

from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignBlock, printable
from g12.tools.translate.follow import FollowedProgram
from g12.tools.translate.structure import MAIN, Structure

LONGEST_LINE = 254  # characters that LinuxCNC reads of a line
LONGEST_MARK = 20  # of them for "/ " and "(line 123456)"
LONGEST_COMMENT = 200
ACTIVE_COMMENT = re.compile(r"\((MSG|ABORT), ")
NUMBERED = re.compile("(/ )?(N[0-9]+ )?")  # what LinuxCNC takes at the start of a line only
NUMBER_PREFIX = re.compile(r"(N[0-9]+ |)(?=\(|$)")  # with nothing but comments after it


def written_order(followed: FollowedProgram, count: int) -> tuple[list[int], frozenset[int]]:
    """Return a file's lines as they are written, and the programs that call each other."""
    parts = _file_parts(followed.structure, count)
    part_of = {number: at for at, (_, numbers) in enumerate(parts) for number in numbers}
    above: dict[int, set[int]] = {at: set() for at in range(len(parts))}
    for number, callers in followed.callers.items():
        callers_parts = {part_of[followed.structure.programs[index]] for index in callers}
        above[part_of[number]] |= callers_parts
    sorter = TopologicalSorter(above)
    try:
        sorter.prepare()
    except CycleError as cycle:
        return [], frozenset(number for at in cycle.args[1] for number in parts[at][1])
    ready: list[int] = []
    lines: list[int] = []
    while sorter.is_active():
        first, *ready = sorted((*ready, *sorter.get_ready()))
        lines += parts[first][0]
        sorter.done(first)
    return lines, frozenset()


def _file_parts(structure: Structure, count: int) -> list[tuple[range, list[int]]]:
    """Return the lines that stay together, and the numbers of the programs in them.

    A part is a program that begins a line, or the text around.
    """
    parts: list[tuple[range, list[int]]] = []
    begun, numbers = 1, [] if MAIN in structure.starts.values() else [MAIN]
    for index in sorted(structure.starts):
        line = structure.blocks[index].line
        if line > begun and structure.blocks[index - 1].line != line:
            parts.append((range(begun, line), numbers))
            begun, numbers = line, []
        numbers.append(structure.starts[index])
    last = structure.blocks[-1] if structure.blocks else None
    closed = last and last.kind == "tape" and last.line > begun
    end = last.line if closed else count + 1
    return [*parts, (range(begun, end), numbers), (range(end, count + 1), [])]


def lines_of(draft: Draft) -> list[str]:
    own = draft.written()
    lines = [*filter(None, [draft.head]), *draft.before, *filter(None, [own]), *draft.after]
    for text in lines:
        if size(text) > LONGEST_LINE - LONGEST_MARK:
            raise NotTranslated(f"the block has {size(text)} characters on LinuxCNC, at most 254")
    slash = "/ " if draft.block.skipped else ""
    return _with_comments([f"{slash}{line}" for line in lines], draft.comments)


def _with_comments(lines: list[str], comments: Sequence[str]) -> list[str]:
    """Return lines with comments after the first; those without room get lines, and are cut off.

    A message stays the last comment of its line: LinuxCNC obeys no other one.
    """
    whole = "".join(f"({comment})" for comment in comments)
    at = next((at for at, line in enumerate(lines) if not ACTIVE_COMMENT.search(line)), len(lines))
    first = " ".join(filter(None, [*lines[at : at + 1], whole]))
    if size(first) <= LONGEST_LINE - LONGEST_MARK:
        return [*lines[:at], first, *lines[at + 1 :]]
    lengths = (LONGEST_COMMENT if c.isascii() else LONGEST_COMMENT // 4 for c in comments)
    return [*lines, *(f"({comment[:length]})" for comment, length in zip(comments, lengths))]


def size(text: str) -> int:
    """Return the length of a line in bytes, as LinuxCNC counts it."""
    return len(text.encode())


def _with_mark(text: str, line: int) -> str:
    """Add the file's line number; LinuxCNC obeys only the last comment of a block."""
    if not ACTIVE_COMMENT.search(text):
        return f"{text} (line {line})"
    number = NUMBERED.match(text)[0]
    return f"{number}(line {line}) {text[len(number) :]}"


def _as_comment(text: str) -> str:
    kept = printable(text.strip())[: LONGEST_COMMENT // 2]
    return f"(not reached: {kept})" if kept else ""


def output_lines(
    rows: Sequence[str], order: Iterable[int], followed: FollowedProgram
) -> Iterator[str]:
    """Yield the lines of a program from the drafts of its blocks; none of them is refused.

    ``order`` are the file's lines as they are written. From where they are not in their own order
    any more every line has its number.
    """
    start = " ".join(followed.control.start)
    ends = followed.ends_of_macros()
    indices: dict[int, list[int]] = {}
    for index, block in enumerate(followed.structure.blocks):
        indices.setdefault(block.line, []).append(index)
    in_place = True
    for number, line in enumerate(order, 1):
        lines = _lines_of_row(rows[line - 1], indices.get(line, ()), followed, ends)
        if number == 1 and start:
            lines = _with_start_codes(start, lines)
        if number == 1:
            lines[1:1] = followed.control.notes
        in_place = in_place and number == line
        yield from lines[:in_place]
        yield from (_with_mark(text, line) for text in lines[in_place:])


def _lines_of_row(
    row: str, indices: Sequence[int], followed: FollowedProgram, ends: Mapping[int, str]
) -> list[str]:
    """Return the output of one line of the file; ``ends`` are the ends of macros, by block."""
    lines: list[str] = []
    is_written = False
    for index in indices:
        draft = followed.drafts[index]
        own = draft.lines if draft else _unreached(followed.structure.blocks[index])
        if own is None:
            own = [] if is_written else [_as_comment(row)]
            is_written = True
        lines += own
        lines += [ends[index]] if index in ends else []
        if index in followed.falls_off:
            lines.append("M2")
    return lines if indices else [_as_comment(row)]


def _unreached(block: ForeignBlock) -> list[str] | None:
    """Return the lines of a block that is never reached, None if it has words."""
    if block.words or block.problem or block.kind not in ("words", "tape"):
        return None
    tape = [f"%{block.label}"] if block.kind == "tape" else []
    return _with_comments([], [*tape, *block.comments])


def _with_start_codes(start: str, lines: list[str]) -> list[str]:
    first = lines[0] if lines else ""
    number = NUMBER_PREFIX.match(first)
    if number:
        return [f"{number[1]}{start} {first[number.end(1) :]}".rstrip(), *lines[1:]]
    return [start, *lines]
