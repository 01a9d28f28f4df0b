# SPDX-License-Identifier: GPL-2.0-or-later
"""A whole program: text in, text out, or every block that is refused."""

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from g12.tools.translate.blocks.control import Control
from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import (
    ALL,
    ForeignBlock,
    blocks_of,
    remarks_of,
    source_lines,
)
from g12.tools.translate.follow import FollowedProgram
from g12.tools.translate.output import lines_of, output_lines, written_order
from g12.tools.translate.rules.subprograms import unset_variables
from g12.tools.translate.structure import LOCAL_BLOCKS, MAIN, structure_of
from g12.tools.translate.whole_program import (
    control_of_program,
    lacking_constructs,
    own_constructs,
    with_message,
)

READ, FOLLOWED = 0.5, 0.35  # shares of the time


class RefusedBlock(NamedTuple):
    """A block that is not translated: its line, and the sentence that says why."""

    line: int
    sentence: str


class Translation(NamedTuple):
    """A LinuxCNC program, or the blocks for which there is none."""

    text: str
    refused: list[RefusedBlock]


def translate_program(
    text: str, control: Control, progress: Callable[[float], None] = lambda share: None
) -> Translation:
    """Return the translation of a program's text.

    ``progress`` is called with the finished share, 0 to 1.
    """
    rows = source_lines(text)
    if not control.onto and (own := next(own_constructs(rows), None)):
        return _native_program(rows, own)
    blocks = _read_blocks(rows, control, progress)
    control = control_of_program(control, blocks)
    structure = structure_of(blocks, control)
    followed = FollowedProgram(
        structure,
        control,
        lambda index: progress(READ + FOLLOWED * min(1, index / len(blocks))),
    )
    refused = sorted(set(_refusals(followed)))
    if refused:
        return Translation("", refused)
    order, circular = written_order(followed, len(rows))
    if circular:
        return Translation("", sorted(_circular_calls(followed, circular)))
    return Translation("\n".join([*output_lines(rows, order, followed), ""]), [])


def _native_program(rows: Sequence[str], own: tuple[int, str]) -> Translation:
    """Return a program of LinuxCNC as it is; a mixture with another control's is refused."""
    line, text = own
    for other_line, other in lacking_constructs(rows):
        sentence = (
            f"{text} is LinuxCNC's, {other} in line {other_line} another control's: write the "
            "program for one of them"
        )
        return Translation("", [RefusedBlock(line, sentence)])
    return Translation(with_message(rows), [])


def _read_blocks(
    rows: Sequence[str], control: Control, progress: Callable[[float], None]
) -> list[ForeignBlock]:
    blocks: list[ForeignBlock] = []
    variables = control.variables()
    remarks = ALL if control.remarks else remarks_of(rows)
    for line, row in enumerate(rows, 1):
        blocks += blocks_of(line, row, remarks, variables)
        if line % 1000 == 0:
            progress(READ * line / len(rows))
    return blocks


def _circular_calls(followed: FollowedProgram, circular: frozenset[int]) -> Iterator[RefusedBlock]:
    structure = followed.structure
    for number in circular:
        for index in followed.callers[number]:
            if structure.programs[index] in circular:
                sentence = (
                    f"{structure.name_of(number)} cannot be written below this call: it calls "
                    "itself, by way of others or not, or there is something before its number on "
                    "its line"
                )
                yield RefusedBlock(structure.blocks[index].line, sentence)


def _refusals(followed: FollowedProgram) -> Iterator[RefusedBlock]:
    if not any(draft and (draft.words or draft.refusal) for draft in followed.drafts):
        yield RefusedBlock(1, "there is no block in the file")
    for draft in filter(None, followed.drafts):
        if refusal := draft.refusal or _unwritable(draft):
            yield RefusedBlock(draft.block.line, str(refusal))
    for index in followed.falls_off:
        sentence = _missing_end(followed, index)
        if sentence and not followed.drafts[index].refusal:
            yield RefusedBlock(followed.structure.blocks[index].line, sentence)
    for number, draft in zip(followed.structure.programs, followed.drafts):
        is_macro = followed.kinds.get(number) == "macro"
        for sentence in unset_variables(draft, number if is_macro else 0) if draft else ():
            yield RefusedBlock(draft.block.line, sentence)


def _unwritable(draft: Draft) -> NotTranslated | None:
    """Store the lines of a block; return the refusal if they cannot be written."""
    try:
        draft.lines = lines_of(draft)
    except NotTranslated as refusal:
        return refusal
    return None


def _missing_end(followed: FollowedProgram, index: int) -> str | None:
    number = followed.structure.programs[index]
    following = followed.structure.starts.get(index + 1, 0)
    if following >= LOCAL_BLOCKS:
        return f"N{following - LOCAL_BLOCKS} is called by M97 and also reached from above it"
    if number == MAIN:
        return None
    return f"{followed.structure.name_of(number)} ends here without M99"
