# SPDX-License-Identifier: GPL-2.0-or-later
"""The lines of the LinuxCNC program: one for each line of the file, further ones marked."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import printable
from g12.tools.translate.follow import FollowedProgram

LONGEST_LINE = 254  # characters that LinuxCNC reads of a line
LONGEST_MARK = 20  # of them for "/ " and "(line 123456)"
LONGEST_COMMENT = 200
OBEYED = re.compile(r"\((MSG|ABORT), ")
BLOCK_NUMBER = re.compile(r"(N[0-9]+ |)(?=\(|$)")  # with nothing but comments behind it


def lines_of(draft: Draft) -> list[str]:
    """Return the lines of one block, comments behind the first of them."""
    own = draft.written()
    lines = [draft.head] if draft.head else []
    lines += [*draft.before, *([own] if own else []), *draft.after]
    if draft.around:
        lines = [draft.around[0], *lines, draft.around[1]]
    for text in lines:
        if len(text) > LONGEST_LINE - LONGEST_MARK:
            raise NotTranslated(f"the block has {len(text)} characters on LinuxCNC, at most 254")
    slash = "/ " if draft.block.skipped else ""
    return with_comments([f"{slash}{line}" for line in lines], draft.comments)


def with_comments(lines: list[str], comments: Sequence[str]) -> list[str]:
    """Return lines with comments behind the first; what has no room there has lines of its own."""
    whole = "".join(f"({comment})" for comment in comments)
    first = f"{lines[0]} {whole}".rstrip() if lines else whole
    if len(first) <= LONGEST_LINE - LONGEST_MARK:
        return [first, *lines[1:]]
    pieces = [
        f"({comment[at : at + LONGEST_COMMENT]})"
        for comment in comments
        for at in range(0, len(comment), LONGEST_COMMENT)
    ]
    return [*lines, *pieces]


def with_marks(lines: Sequence[str], line: int) -> list[str]:
    """Return the lines of one line of the file: every further one says which it belongs to."""
    return [lines[0], *(with_mark(text, line) for text in lines[1:])]


def with_mark(text: str, line: int) -> str:
    """Return a further line with its mark; LinuxCNC obeys the last comment of a block only."""
    return f"(line {line}) {text}" if OBEYED.search(text) else f"{text} (line {line})"


def as_comment(text: str) -> str:
    """Return a line that is never executed."""
    return f"(not reached: {printable(text.strip())[:LONGEST_COMMENT]})" if text.strip() else ""


def output_lines(rows: Sequence[str], followed: FollowedProgram) -> Iterator[str]:
    """Yield the lines of a program from the drafts of its blocks; none of them is refused."""
    start = " ".join(followed.control.start)
    by_line = drafts_by_line(followed)
    for line, row in enumerate(rows, 1):
        lines = lines_of_row(row, by_line.get(line), followed)
        if line == 1 and start:
            lines = begun(start, lines, by_line.get(line))
        yield from with_marks(lines, line)


def drafts_by_line(followed: FollowedProgram) -> dict[int, list[int]]:
    """Return the indices of the blocks that each line has."""
    by_line: dict[int, list[int]] = {}
    for index, block in enumerate(followed.structure.blocks):
        by_line.setdefault(block.line, []).append(index)
    return by_line


def lines_of_row(row: str, indices: Sequence[int] | None, followed: FollowedProgram) -> list[str]:
    """Return the lines of one line of the file."""
    lines: list[str] = []
    for index in indices or ():
        draft = followed.drafts[index]
        block = followed.structure.blocks[index]
        if draft:
            lines += draft.lines
        elif block.words or block.kind not in ("words", "tape"):
            return [as_comment(row)]
        else:
            tape = [f"%{block.label}"] if block.kind == "tape" else []
            lines += with_comments([], [*tape, *block.comments])
        if index in followed.falls_off:
            lines.append("M2")
    return lines if indices else [as_comment(row)]


def begun(start: str, lines: list[str], indices: Sequence[int] | None) -> list[str]:
    """Return the first line's lines with the codes that hold when a program begins."""
    first = lines[0] if lines else ""
    number = BLOCK_NUMBER.match(first)
    if number:
        return [f"{number[1]}{start} {first[number.end(1) :]}".rstrip(), *lines[1:]]
    return [start, *lines]
