# SPDX-License-Identifier: GPL-2.0-or-later
"""The words of a turning cycle's block as numbers, and the blocks of the contour that it names."""

from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignBlock
from g12.tools.translate.blocks.modal import MOVES, ModalState
from g12.tools.translate.blocks.positions import known_position
from g12.tools.translate.rules import codes, decimals
from g12.tools.translate.rules.tools import COMPENSATION_ON, offsets_radius
from g12.tools.translate.turning.moves import ARC_CODES, CycleMove, centre_of

BESIDE_CYCLE = frozenset("FSM")  # what a finishing cut does with its moves
KEPT_MODES = frozenset(("G40", "G41", "G42", "G94", "G95", "G96", "G97"))  # by a finishing cut
IN_CONTOURS = MOVES | {"G90", "G91"}
WORD_RULES_OF_CYCLES = (
    codes.keep_as_comments,
    codes.map_codes,
    codes.follow_modes,
    decimals.whole_units,
)


def take_number(draft: Draft, letter: str) -> float | None:
    word = draft.take(letter)
    if word and word.kind != "number":
        raise NotTranslated(f"{word.text}: a turning cycle is translated from numbers only")
    return word.number if word else None


def take_increments(draft: Draft, letter: str) -> float | None:
    """Take a length out that is in least increments where it has no decimal point."""
    word = draft.word(letter)
    number = take_number(draft, letter)
    if not number or "." in word.value:
        return number
    least = decimals.least_increment(draft, "length")
    if not least:
        raise NotTranslated(f"{word.text} has no decimal point, and no increment is set for it")
    return number * least


def take_whole(draft: Draft, letter: str) -> int | None:
    """Take a whole number out: how often, or the number of a block."""
    number = take_number(draft, letter)
    if number is not None and (number != int(number) or number < 0):
        raise NotTranslated(f"{letter}{number:g} must be a whole number")
    return None if number is None else int(number)


def stored_setting(draft: Draft, name: str) -> float:
    """Return a setting of the control for its turning cycles in the program's units, 0 if none."""
    values = {
        code: float(draft.control.value("turning", f"{name}_{unit}", 0.0))
        for code, unit in decimals.UNIT.items()
    }
    if not any(values.values()):
        return 0.0
    length = name.replace("_", " ")
    units = draft.sure("units", f"the control's {length} is a length")
    if units not in values:
        raise NotTranslated(
            f"the control's setting for the {length} depends on G20 or G21, and "
            "neither is programmed before it (--units)"
        )
    return values[units]


def start_point(draft: Draft) -> complex:
    x, z = known_position(draft.start, "X"), known_position(draft.start, "Z")
    if x is None or z is None:
        raise NotTranslated(
            "this begins at the tool's position, which is not known here: write G0 with X and Z as "
            "numbers in a block before it"
        )
    return complex(z, x / 2)


def take_end(draft: Draft, start: complex) -> dict[str, float]:
    """Take X, Z, U and W out; return the coordinates that they say, ``X`` as a radius."""
    found = {}
    for absolute, increment, scale, at in (("X", "U", 2, start.imag), ("Z", "W", 1, start.real)):
        own, step = take_number(draft, absolute), take_number(draft, increment)
        if own is not None and step is not None:
            raise NotTranslated(f"{absolute} and {increment} in one block")
        if own is not None:
            relative = draft.sure("distance", f"{absolute} is a position or an increment") == "G91"
            found[absolute] = own / scale + (at if relative else 0.0)
        elif step is not None:
            found[absolute] = at + step / scale
    return found


def named_blocks(draft: Draft, first: int, last: int) -> tuple[range, int]:
    """Return the blocks from P to Q, and that which follows the cycle.

    A contour that is after the cycle is not executed again; one before it is read back.
    """
    numbered = [(index, block.number) for index, block in draft.program if block.words]
    starts = [index for index, number in numbered if number == first]
    before = [index for index in starts if index < draft.index]
    recalled = "finishing" in draft.meanings and bool(before)
    begin = before[-1] if recalled else next((at for at in starts if at > draft.index), None)
    end = next((at for at, number in numbered if number == last and at >= (begin or 0)), None)
    if begin is None or end is None:
        number = first if begin is None else last
        raise NotTranslated(f"N{number} is not in this program after the cycle")
    return range(begin, end + 1), draft.index + 1 if recalled else end + 1


def read_contour(
    draft: Draft, indices: range, start: complex
) -> tuple[list[CycleMove], ModalState]:
    """Return the moves of some blocks as those of a contour, and the modes after them."""
    blocks = dict(draft.program)
    motion, state, at, moves = draft.state.motion, draft.state, start, []
    for index in indices:
        block = blocks[index]
        try:
            reader = _reader_of(draft, block, state)
            move = _contour_move(reader, motion, at)
        except NotTranslated as refusal:
            raise NotTranslated(f"line {block.line} in the contour: {refusal}") from None
        if move.end != at or move.centre is not None or move.others:
            moves.append(move)
        state, motion, at = reader.state, move.code, move.end
    if state.distance != draft.state.distance:
        raise NotTranslated(
            f"the contour ends in {state.distance}: end it in {draft.state.distance}, in which it "
            "begins"
        )
    if not moves:
        raise NotTranslated("the contour of the cycle has no moves")
    return moves, state


def _reader_of(draft: Draft, block: ForeignBlock, state: ModalState) -> Draft:
    if block.problem or block.kind != "words":
        raise NotTranslated(block.problem or "a contour has moves only, as numbers")
    if block.skipped:
        raise NotTranslated("/ in a contour: its cuts depend on the switch")
    reader = Draft(block, state, draft.control)
    for rule in WORD_RULES_OF_CYCLES:
        rule(reader)
    reader.meanings.pop("exact stop", None)
    return reader


def _contour_move(reader: Draft, motion: str, start: complex) -> CycleMove:
    if reader.meanings:
        code = next(iter(reader.meanings.values())).code
        raise NotTranslated(f"{code} cannot be in a contour")
    code = next((code for code in reader.codes() if code in MOVES), motion)
    if code not in MOVES:
        raise NotTranslated("G0 or G1 is missing")
    own = take_end(reader, start)
    end = complex(own.get("Z", start.real), own.get("X", start.imag))
    numbers = {letter: take_number(reader, letter) for letter in "RIK"}
    shape = {letter: number for letter, number in numbers.items() if number is not None}
    moves = end != start or (code in ARC_CODES and shape.keys() & {"I", "K"})
    if moves and shape and code not in ARC_CODES:
        corner = next(iter(shape))
        raise NotTranslated(f"{corner} beside {code}: write the corner's line or arc as a block")
    centre = centre_of(code, shape, start, end) if moves and code in ARC_CODES else None
    others: list[str] = []
    for word in reader.words:
        if word.letter in BESIDE_CYCLE or word.code in KEPT_MODES:
            others.append(word.text)
            if word.code in COMPENSATION_ON:
                others += [radius.text for radius in offsets_radius(reader)]
        elif word.letter != "N" and word.code not in IN_CONTOURS:
            raise NotTranslated(f"{word.text} cannot be in a contour")
    return CycleMove(code, end, centre, 0.0, tuple(others), start, reader.block.line)
