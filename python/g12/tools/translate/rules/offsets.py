# SPDX-License-Identifier: GPL-2.0-or-later
"""Work offsets beyond LinuxCNC's nine, and offsets that a program sets.

LinuxCNC has no place for G154 P1 to P99 (G110 to G129 are the first twenty): they are kept in
numbered parameters, in machine units as the var file keeps G54's, ten for each: X Y Z A B C from
``first_parameter`` on. To select one is to copy it into G59.3 and to select that.

G10 of these controls: L2 P1-P6 is G54 to G59, P0 is G52; L20 P1-P99 is G154; L10 and L11 are a
tool's length and its wear, L12 and L13 its diameter and its wear. LinuxCNC's tool table has one
value for length and wear: wear is kept in parameters and the sum is in the table.
"""

from g12.tools.translate.blocks.draft import AXIS_NUMBERS, Draft, line_as_word
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.blocks.modal import UNKNOWN, UNSURE

SLOT, SLOT_PARAMETER = "G59.3", 5381  # LinuxCNC's ninth system
SYSTEMS = 99
FIRST_PARAMETER = 4001
LENGTH_WEAR, DIAMETER_WEAR = 3000, 3200  # and the tool's number
TOOLS = 100
G52_PARAMETER, G54_PARAMETER = 5211, 5221
SCALE = "#<machine_units>"
BARE_HEIGHT = "#<height_without_tool>"
SET_SCALE = f"{SCALE}=[[25.4 - 24.4 * #<_metric>] / [25.4 - 24.4 * #<_metric_machine>]]"
OWN_SYSTEMS = frozenset(("G54", "G55", "G56", "G57", "G58", "G59"))
TOOL_TABLE = {10: ("length", False), 11: ("length", True), 12: ("size", False), 13: ("size", True)}


def numbered_offset(draft: Draft) -> None:
    """Select one of the systems that are kept by number."""
    code = draft.meanings.pop("numbered offset", None)
    for own in OWN_SYSTEMS.intersection(draft.codes()):
        if code:
            raise NotTranslated(f"{own} and {code.code} in one block")
        draft.change(offset=own)
    if not code:
        return
    number = _system_number(draft, code)
    draft.comments.insert(0, f"G154 P{number} overwrites {SLOT}")
    draft.before += [*_unset_lines(draft, number), _load_system(draft, number)]
    draft.change(offset=f"P{number}")


def _unset_lines(draft: Draft, number: int) -> list[str]:
    """Return lines that report a system that was never set; LinuxCNC then reads 0."""
    known = draft.state.known_offsets
    known = () if known == UNSURE else known
    if number in known:
        return []
    draft.change(known_offsets=(*known, number))
    parameters = [f"#{_parameter_of(draft, number, axis)}" for axis in draft.control.axes]
    label = f"o<unset_{draft.index}>"
    return [
        f"{label} if [{' AND '.join(f'[{name} EQ 0]' for name in parameters)}]",
        f"(MSG, G154 P{number} was never set, it counts as 0: X is {parameters[0]})",
        f"{label} endif",
    ]


def _system_number(draft: Draft, code: ForeignWord) -> int:
    whole = int(code.number)
    if 110 <= whole <= 129:
        return whole - 109
    return _whole_number_of(draft, "P", range(1, SYSTEMS + 1), code.code)


def _whole_number_of(draft: Draft, letter: str, numbers: range, code: str) -> int:
    word = draft.take(letter)
    if not word or word.kind != "number" or not word.number.is_integer():
        raise NotTranslated(f"{code} needs {letter} and a whole number")
    if int(word.number) not in numbers:
        raise NotTranslated(
            f"{code} {letter}{word.number:g} must be from {numbers[0]} to {numbers[-1]}"
        )
    return int(word.number)


def _parameter_of(draft: Draft, number: int, axis: str) -> int:
    first = draft.control.value("offsets", "first_parameter", FIRST_PARAMETER)
    return first + 10 * (number - 1) + AXIS_NUMBERS[axis] - 1


def _load_system(draft: Draft, number: int) -> str:
    """Return the block that copies a numbered system into G59.3 and selects it."""
    copies = (
        f"#{SLOT_PARAMETER + AXIS_NUMBERS[axis] - 1}=#{_parameter_of(draft, number, axis)}"
        for axis in draft.control.axes
    )
    return f"G10 L2 P9 R0 {SLOT} {' '.join(copies)}"


def offset_by_program(draft: Draft, code: ForeignWord) -> None:
    """Write G10, which sets an offset from the program."""
    kind = draft.take("L")
    number = int(kind.number) if kind and kind.kind == "number" else 0
    incremental = draft.sure("distance", "G10 sets or adds") == "G91"
    if draft.control.is_lathe:
        raise NotTranslated("G10 of a lathe is not translated: set the offset on the machine")
    if number == 2:
        _work_offset(draft, incremental)
    elif number == 20:
        _numbered_offset_values(draft, incremental)
    elif number in TOOL_TABLE:
        _tool_offset(draft, *TOOL_TABLE[number], incremental)
    else:
        raise NotTranslated("G10 needs L2, L10, L11, L12, L13 or L20")
    draft.after += draft.take_codes({"G90", "G91"})
    if not draft.is_empty():
        raise NotTranslated(f"{draft.words[-1].text} cannot stand beside G10")
    _settle(draft)


def _settle(draft: Draft) -> None:
    first, *draft.after = draft.after
    draft.words.append(line_as_word(first))


def _axis_values(draft: Draft, code: str) -> list[ForeignWord]:
    words = draft.axis_words()
    draft.words = [word for word in draft.words if word not in words]
    if not words:
        raise NotTranslated(f"{code} without an axis sets nothing")
    return words


def _work_offset(draft: Draft, incremental: bool) -> None:
    """G10 L2: G54 to G59, or G52."""
    number = _whole_number_of(draft, "P", range(7), "G10 L2")
    words = _axis_values(draft, "G10 L2")
    first = G54_PARAMETER + 20 * (number - 1) if number else G52_PARAMETER
    if incremental:
        draft.after.append(SET_SCALE)
    values = " ".join(
        f"{word.letter}[#{first + AXIS_NUMBERS[word.letter] - 1} / {SCALE} + {word.value}]"
        if incremental
        else word.text
        for word in words
    )
    draft.after.append(f"G10 L2 P{number} {values}" if number else f"G52 {values}")


def _numbered_offset_values(draft: Draft, incremental: bool) -> None:
    """G10 L20: a system that is kept by number."""
    number = _whole_number_of(draft, "P", range(1, SYSTEMS + 1), "G10 L20")
    draft.after.append(SET_SCALE)
    values = []
    for word in _axis_values(draft, "G10 L20"):
        parameter = f"#{_parameter_of(draft, number, word.letter)}"
        old = f"{parameter} + " if incremental else ""
        values.append(f"{parameter}=[{old}{word.value} * {SCALE}]")
    draft.after.append(" ".join(values))
    if draft.sure("offset", "G10 L20 changes a work offset") in (f"P{number}", UNKNOWN):
        draft.after += [_load_system(draft, number)] if draft.state.offset else []


def _tool_offset(draft: Draft, what: str, wear: bool, incremental: bool) -> None:
    """G10 L10 to L13: write the tool table; wear is also kept in a parameter."""
    tool = _whole_number_of(draft, "P", range(1, TOOLS + 1), "G10")
    value = draft.take("R")
    if not value:
        raise NotTranslated("G10 needs R, the tool's value")
    draft.after.append(SET_SCALE)
    kept = f"#{(LENGTH_WEAR if what == 'length' else DIAMETER_WEAR) + tool}"
    added = f"[{value.value}]"
    if what == "length":
        _set_length(draft, tool, added, kept, wear, incremental)
    else:
        _set_size(draft, tool, added, kept, wear, incremental)
    if wear:
        old = f"{kept} + " if incremental else ""
        draft.after.append(f"{kept}=[{old}{added} * {SCALE}]")


def _new_value(now: str, added: str, kept: str, wear: bool, incremental: bool) -> str:
    """Return the table's new value: geometry and wear, from its value now if that is needed."""
    if incremental:
        return f"{now} + {added}"
    return f"{now} - {kept} / {SCALE} + {added}" if wear else f"{added} + {kept} / {SCALE}"


def _set_length(
    draft: Draft, tool: int, added: str, kept: str, wear: bool, incremental: bool
) -> None:
    """Set a tool's length; its present one is what G43 makes of the height."""
    active = draft.sure("length", "G10 changes a tool's length")
    if wear or incremental:
        draft.after += ["G49", f"{BARE_HEIGHT}=#5422", f"G43 H{tool}"]
    value = _new_value(f"[{BARE_HEIGHT} - #5422]", added, kept, wear, incremental)
    draft.after.append(f"G10 L1 P{tool} Z[{value}]")
    if active == str(tool):
        draft.after.append(f"G43 H{tool}")
    elif wear or incremental:
        back = "G49" if active in (UNKNOWN, "0") else f"G43 H{active}"
        draft.after.append(back)


def _set_size(
    draft: Draft, tool: int, added: str, kept: str, wear: bool, incremental: bool
) -> None:
    """Set a tool's diameter; LinuxCNC tells the present one of the loaded tool only."""
    known = dict(() if draft.state.sizes == UNSURE else draft.state.sizes)
    loaded = draft.state.tool == str(tool)
    if (wear or incremental) and not loaded and tool not in known:
        raise NotTranslated(
            f"G10 for the diameter of T{tool}: its present one is known only while it is in the "
            f"spindle (T{tool} M6 before it)"
        )
    half = draft.control.value("tools", "size", "diameter") == "diameter"
    now = f"#5410 / {SCALE}" if half else f"#5410 / {SCALE} / 2"
    if tool in known and not loaded:
        now = f"[{known[tool]} + {kept} / {SCALE}]"
    known.pop(tool, None)
    if not wear and not incremental and "#" not in added:
        known[tool] = added
    elif wear and not loaded and not incremental:
        known[tool] = dict(draft.state.sizes)[tool]
    draft.change(sizes=tuple(sorted(known.items())))
    value = _new_value(now, added, kept, wear, incremental)
    draft.after.append(f"G10 L1 P{tool} R[[{value}]{' / 2' if half else ''}]")
