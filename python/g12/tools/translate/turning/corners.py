# SPDX-License-Identifier: GPL-2.0-or-later
"""Direct drawing on a lathe outside of cycles: angles, corners that a word breaks or rounds."""

from collections.abc import Iterator

from g12.tools.translate.blocks.draft import Draft, line_as_word
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.modal import AS_PROGRAMMED
from g12.tools.translate.rules.motion import in_absolute_words
from g12.tools.translate.turning.contour import contour_of, ends_of
from g12.tools.translate.turning.given_words import contour_blocks, start_point
from g12.tools.translate.turning.moves import lines_of_moves, moves_along

DRAWN = frozenset((",A", ",C", ",R", "A", "I", "K", "R"))
REPLACED = frozenset("XZUW") | DRAWN


def direct_drawing(draft: Draft) -> None:
    """Write a line with a corner or an angle as the moves that it is."""
    if not _is_drawn(draft) and not _goes_on_from_a_corner(draft):
        return
    if not draft.control.is_lathe or draft.state.polar != "off":
        word = next(w for w in draft.words if w.letter in DRAWN)
        raise NotTranslated(
            f"{word.text}: a corner that is broken or rounded by a word: write its line or arc as "
            "a block"
        )
    if draft.sure("x_words", "a corner's X is a diameter") != "G7":
        raise NotTranslated("a corner by a word where X words are radii: write it as a block")
    start = start_point(draft)
    blocks, _ = contour_blocks(draft, _chain_of(draft))
    own = [s for s in contour_of(blocks, start) if s.block is blocks[0]]
    lines = list(lines_of_moves(moves_along(own), start))
    if not lines:
        raise NotTranslated("a corner or an angle needs a move of G1 in its block")
    first, *others = lines
    code, _, words = first.partition(" ")
    draft.words = [w for w in draft.words if w.letter not in REPLACED]
    draft.words.append(line_as_word(words if code in draft.codes() else first))
    draft.after += others
    in_absolute_words(draft)
    last = next((line[:2] for line in reversed(others) if line[0] == "G"), "G1")
    sharp = ends_of(blocks, start)[0]
    draft.has_motion = True
    own_motion = AS_PROGRAMMED if last == "G1" else last
    draft.change(motion="G1", own_motion=own_motion, corner=len(own) > 1)
    draft.change(at_x=2 * sharp.imag, at_z=sharp.real)


def _is_drawn(draft: Draft) -> bool:
    letters, codes = draft.letters(), set(draft.codes())
    if any(letter[0] == "," for letter in letters):
        return True
    free = not draft.meanings and not draft.state.turning_cycle and draft.state.polar == "off"
    line = draft.motion() == "G1" and not codes - {"G1", "G94", "G95"}
    moves = not letters.isdisjoint(DRAWN) and not letters.isdisjoint("XZUW")
    return draft.control.is_lathe and free and line and moves


def _goes_on_from_a_corner(draft: Draft) -> bool:
    """Whether increments of a block start at a corner that LinuxCNC has cut off."""
    corner, increments = draft.state.corner, draft.increments()
    if not corner or not (draft.axis_words() or increments):
        return False
    draft.change(corner=False)
    return bool(increments) or draft.state.distance == "G91"


def _chain_of(draft: Draft) -> Iterator[int]:
    """Yield the block, and those after it as long as a corner or an angle needs the next one."""
    for index, block in draft.program:
        letters = {word.letter for word in block.words}
        if index < draft.index or not letters - {"N"}:
            continue
        yield index
        if not letters & DRAWN:
            return
