# SPDX-License-Identifier: GPL-2.0-or-later
"""Work offsets beyond LinuxCNC's nine, and offsets that a program sets.

LinuxCNC has no offsets for G154 P1 to P99 (G110 to G129 are the first twenty): they are kept in
numbered parameters, as the var file keeps G54's (in machine units, angles in degrees), ten for
each: X Y Z A B C from ``first_parameter`` on. To select one is to copy it into G59.3 and to select
that.

G10 of these controls: L2 P1-P6 is G54 to G59, P0 is G52; L20 P1-P99 is G154; L10 and L11 are a
tool's length and its wear, L12 and L13 its diameter and its wear. LinuxCNC's tool table has one
value for length and wear: wear is kept in parameters and the sum is in the table.
"""

from typing import NamedTuple

from g12.tools.translate.blocks.draft import AXIS_NUMBERS, Draft, position
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.blocks.modal import UNKNOWN, UNSURE
from g12.tools.translate.rules.modes import check_axis

SLOT, SLOT_PARAMETER = "G59.3", 5381  # LinuxCNC's ninth system
SYSTEMS = 99
SYSTEM_CODES = range(110, 130)  # G codes of the first of them
FIRST_PARAMETER = 4001
LENGTH_WEAR, DIAMETER_WEAR = 3000, 3200  # and the tool's number
TOOLS = 100
G52_PARAMETER, G54_PARAMETER = 5211, 5221
LENGTHS = "XYZ"
SCALE = "#<machine_units>"
BARE_HEIGHT = "#<height_without_tool>"
SET_SCALE = f"{SCALE}=[[25.4 - 24.4 * #<_metric>] / [25.4 - 24.4 * #<_metric_machine>]]"
OWN_SYSTEMS = frozenset(("G54", "G55", "G56", "G57", "G58", "G59"))
TOOL_TABLE = {
    10: (True, False),
    11: (True, True),
    12: (False, False),
    13: (False, True),
}  # length, wear


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


def _scaled(by: str, letter: str) -> str:
    return f" {by} {SCALE}" if letter in LENGTHS else ""


def _work_offset(draft: Draft, incremental: bool) -> None:
    """G10 L2: G54 to G59, or G52."""
    number = _take_number(draft, range(7), "G10 L2")
    words = _axis_values(draft, "G10 L2")
    first = G54_PARAMETER + 20 * (number - 1) if number else G52_PARAMETER
    draft.after += [SET_SCALE] if incremental else []
    texts = [word.text for word in words]
    if incremental:
        parameters = [f"#{first + AXIS_NUMBERS[word.letter] - 1}" for word in words]
        texts = [
            f"{w.letter}[{p}{_scaled('/', w.letter)} + {w.value}]"
            for w, p in zip(words, parameters)
        ]
    draft.after.append(" ".join([f"G10 L2 P{number}" if number else "G52", *texts]))


def _numbered_offset_values(draft: Draft, incremental: bool) -> None:
    number = _system_number(draft, "G10 L20")
    draft.after.append(SET_SCALE)
    values = []
    for word in _axis_values(draft, "G10 L20"):
        parameter = f"#{_parameter_of(draft, number, word.letter)}"
        old = f"{parameter} + " if incremental else ""
        values.append(f"{parameter}=[{old}{word.value}{_scaled('*', word.letter)}]")
    draft.after.append(" ".join(values))
    draft.change(known_offsets=draft.state.known_offsets | {number})
    if draft.sure("offset", "G10 L20 changes a work offset") == f"P{number}":
        draft.after.append(_load_system(draft, number))


class _ToolValue(NamedTuple):
    """R of G10 L10 to L13: for which tool, and what happens to it."""

    tool: int
    added: str  # R as an expression
    kept: str  # the parameter of the tool's wear
    wear: bool  # R is the wear, else the geometry
    incremental: bool

    @property
    def needs_present(self) -> bool:
        """Whether the new value is worked out from the one in the table."""
        return self.wear or self.incremental

    def new(self, present: str) -> str:
        """Return the table's new value: geometry and wear."""
        if self.incremental:
            return f"{present} + {self.added}"
        wear = f"{self.kept} / {SCALE}"
        return f"{present} - {wear} + {self.added}" if self.wear else f"{self.added} + {wear}"


def _tool_offset(draft: Draft, is_length: bool, wear: bool, incremental: bool) -> None:
    tool = _take_number(draft, range(1, TOOLS + 1), "G10")
    word = draft.take("R")
    if not word:
        raise NotTranslated("G10 needs R, the tool's value")
    draft.after.append(SET_SCALE)
    kept = f"#{(LENGTH_WEAR if is_length else DIAMETER_WEAR) + tool}"
    value = _ToolValue(tool, f"[{word.value}]", kept, wear, incremental)
    (_set_length if is_length else _set_size)(draft, value)
    if wear:
        old = f"{kept} + " if incremental else ""
        draft.after.append(f"{kept}=[{old}{value.added} * {SCALE}]")


def _set_length(draft: Draft, value: _ToolValue) -> None:
    """Set a tool's length; G43 shows the present one as a change of Z."""
    active = draft.sure("length", "G10 changes a tool's length")
    with_tool = f"G43 H{value.tool}"
    if value.needs_present:
        draft.after += ["G49", f"{BARE_HEIGHT}={position('Z')}", with_tool]
    present = f"[{BARE_HEIGHT} - {position('Z')}]"
    draft.after.append(f"G10 L1 P{value.tool} Z[{value.new(present)}]")
    if active == str(value.tool):
        draft.after.append(with_tool)
    elif value.needs_present:
        draft.after.append("G49" if active in (UNKNOWN, "0") else f"G43 H{active}")


def _set_size(draft: Draft, value: _ToolValue) -> None:
    """Set a tool's diameter; LinuxCNC has the present one of the loaded tool only."""
    tool, needs_present = value.tool, value.needs_present
    known = dict(() if draft.state.sizes == UNSURE else draft.state.sizes)
    loaded = draft.state.tool == str(tool)
    if needs_present and not loaded and tool not in known:
        raise NotTranslated(
            f"G10 for the diameter of T{tool}: its present one is known only while it is in the "
            f"spindle (T{tool} M6 before it)"
        )
    half = " / 2" if draft.control.value("tools", "size", "diameter") == "diameter" else ""
    present = f"#5410 / {SCALE}" if half else f"#5410 / {SCALE} / 2"
    geometry = known.pop(tool, None)
    if geometry is not None and not loaded:
        present = f"[{geometry} + {value.kept} / {SCALE}]"
    if not needs_present and "#" not in value.added:
        known[tool] = value.added
    elif value.wear and not loaded and not value.incremental:
        known[tool] = geometry
    draft.change(sizes=tuple(sorted(known.items())))
    draft.after.append(f"G10 L1 P{tool} R[[{value.new(present)}]{half}]")
