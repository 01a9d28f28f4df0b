# SPDX-License-Identifier: GPL-2.0-or-later
"""Work offsets beyond LinuxCNC's nine, and offsets that a program sets.

LinuxCNC has no offsets for G154 P1 to P99 (G110 to G129 are the first twenty): they are kept in
numbered parameters, as the var file keeps G54's (in machine units, angles in degrees), ten for
each: X Y Z A B C from ``first_parameter`` on. To select one is to copy it into G59.3 and to select
that.

G10 of these controls: L2 P1-P6 is G54 to G59, P0 is G52; L20 P1-P99 is G154.
"""

from g12.tools.translate.blocks.draft import AXIS_NUMBERS, Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.rules.modes import check_axis

SLOT, SLOT_PARAMETER = "G59.3", 5381  # LinuxCNC's ninth system
SYSTEMS = 99
SYSTEM_CODES = range(110, 130)  # G codes of the first of them
FIRST_PARAMETER = 4001
LENGTHS = "XYZ"
SCALE = "#<machine_units>"
SET_SCALE = f"{SCALE}=[[25.4 - 24.4 * #<_metric>] / [25.4 - 24.4 * #<_metric_machine>]]"
OWN_SYSTEMS = frozenset(("G54", "G55", "G56", "G57", "G58", "G59"))
OF_TOOLS = range(10, 14)


def numbered_offset(draft: Draft) -> None:
    code = draft.meanings.pop("numbered offset", None)
    for own in OWN_SYSTEMS.intersection(draft.codes()):
        if code:
            raise NotTranslated(f"{own} and {code.code} in one block")
        draft.change(offset=own)
    if not code:
        return
    named = code.number in SYSTEM_CODES
    number = SYSTEM_CODES.index(int(code.number)) + 1 if named else _system_number(draft, code.code)
    draft.comments.insert(0, f"G154 P{number} overwrites {SLOT}")
    draft.before += [*_unset_lines(draft, number), _load_system(draft, number)]
    draft.change(offset=f"P{number}")


def _unset_lines(draft: Draft, number: int) -> list[str]:
    """Return lines that report a system that was never set; LinuxCNC then reads 0."""
    if number in draft.state.known_offsets:
        return []
    draft.change(known_offsets=draft.state.known_offsets | {number})
    parameters = [f"#{_parameter_of(draft, number, axis)}" for axis in draft.control.axes]
    label = f"o<unset_{draft.index}>"
    return [
        f"{label} if [{' AND '.join(f'[{name} EQ 0]' for name in parameters)}]",
        f"(MSG, G154 P{number} was never set, it counts as 0: X is {parameters[0]})",
        f"{label} endif",
    ]


def _system_number(draft: Draft, code: str) -> int:
    return _take_number(draft, range(1, SYSTEMS + 1), code)


def _take_number(draft: Draft, numbers: range, code: str) -> int:
    """Take P out, the number of an offset or a tool."""
    word = draft.take("P")
    if not word or word.kind != "number" or not word.number.is_integer():
        raise NotTranslated(f"{code} needs P and a whole number")
    if int(word.number) not in numbers:
        raise NotTranslated(f"{code} P{word.number:g} must be from {numbers[0]} to {numbers[-1]}")
    return int(word.number)


def _parameter_of(draft: Draft, number: int, axis: str) -> int:
    first = draft.control.value("offsets", "first_parameter", FIRST_PARAMETER)
    return first + 10 * (number - 1) + AXIS_NUMBERS[axis] - 1


def _load_system(draft: Draft, number: int) -> str:
    copies = (
        f"#{SLOT_PARAMETER + AXIS_NUMBERS[axis] - 1}=#{_parameter_of(draft, number, axis)}"
        for axis in draft.control.axes
    )
    return f"G10 L2 P9 R0 {SLOT} {' '.join(copies)}"


def offset_by_program(draft: Draft, code: ForeignWord) -> None:
    kind = draft.take("L")
    number = int(kind.number) if kind and kind.kind == "number" else 0
    if draft.sure("distance", "G10 sets or adds") == "G91":
        raise NotTranslated("G10 under G91 adds to the offset: write G90 and its new value")
    if draft.control.is_lathe:
        raise NotTranslated("G10 of a lathe is not translated: set the offset on the machine")
    if number == 2:
        _work_offset(draft)
    elif number == 20:
        _numbered_offset_values(draft)
    elif number in OF_TOOLS:
        raise NotTranslated(f"G10 {kind.text}: set the tool's length and diameter in the table")
    else:
        raise NotTranslated("G10 needs L2 or L20")
    draft.after += draft.take_codes({"G90", "G91"})
    if not draft.is_empty():
        raise NotTranslated(f"{draft.words[-1].text} cannot be beside G10")
    lines, draft.after = draft.after, []
    draft.write(lines)


def _axis_values(draft: Draft, code: str) -> list[ForeignWord]:
    words = draft.axis_words()
    draft.drop(words)
    if not words:
        raise NotTranslated(f"{code} without an axis sets nothing")
    for word in words:
        check_axis(draft, word)
    return words


def _work_offset(draft: Draft) -> None:
    """G10 L2: G54 to G59, or G52."""
    number = _take_number(draft, range(7), "G10 L2")
    texts = [word.text for word in _axis_values(draft, "G10 L2")]
    draft.after.append(" ".join([f"G10 L2 P{number}" if number else "G52", *texts]))


def _numbered_offset_values(draft: Draft) -> None:
    number = _system_number(draft, "G10 L20")
    draft.after.append(SET_SCALE)
    values = []
    for word in _axis_values(draft, "G10 L20"):
        parameter = f"#{_parameter_of(draft, number, word.letter)}"
        scale = f" * {SCALE}" if word.letter in LENGTHS else ""
        values.append(f"{parameter}=[{word.value}{scale}]")
    draft.after.append(" ".join(values))
    draft.change(known_offsets=draft.state.known_offsets | {number})
    if draft.sure("offset", "G10 L20 changes a work offset") == f"P{number}":
        draft.after.append(_load_system(draft, number))
