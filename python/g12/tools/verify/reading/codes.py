# SPDX-License-Identifier: GPL-2.0-or-later
"""Which codes of a machine are cycles, and of which dialect: by what its REMAP lines call."""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from g12.machine_ini import Remap, code_number, remap_lines
from g12.tools.machine.ini import Ini
from g12.tools.preview.executed_blocks import Text, is_number

CALL = "circle_mill"  # the event's sub, which programs may call
SHAPES = ("polar_polygon", "polar_slot", "polar_pocket")  # subs that programs call
HOLES = ("face_holes", "side_holes", "face_hole_at")  # likewise
SHAPE_HANDLER = "polar_shape"  # of the code that checks their entries
EVENT, POLAR, CYLINDER = "circle-mill", "polar", "cylinder"
SECTIONS = (POLAR, CYLINDER)
DIAMETER_MODES = {7.0, 8.0}
COMPENSATION = (41.0, 42.0, 41.1, 42.1)
TURNS = {"g12": -1, "g13": 1}  # by what the handler's name begins with
DIALECTS = ("haas", "yasnac", "mitsubishi")
DIALECT_OF_HANDLER = {
    **{f"{code}_{name}": name for code in TURNS for name in DIALECTS},
    "circle_mill_perimeter": EVENT,
    "circle_mill_pocket": EVENT,
    "polar_on": POLAR,
    "polar_off": POLAR,
    "cylinder_mode": CYLINDER,
}
DIALECT_OF_SUB = {f"g12_{name}": name for name in DIALECTS}
SUBS = {*DIALECT_OF_SUB, "g12_circle_mill"}
NAMED = {"#<polar_on>": "polar_on", "#<polar_off>": "polar_off"}  # G codes as parameters


class Cycle(NamedTuple):
    """What a code makes: its dialect, and its handler, "" where a machine has its own there."""

    dialect: str
    handler: str = ""

    @property
    def turn(self) -> int:
        """-1 for clockwise, +1 for counterclockwise, 0 where the handler does not say."""
        return TURNS.get(self.handler[:3], 0)


class Codes:
    """Which codes of a machine are cycles, by its REMAP lines."""

    def __init__(self, ini: Ini) -> None:
        lines = remap_lines(ini.all)
        found = ((line.number[1] / 10, cycle_of_line(line)) for line in lines)
        self._cycles = {code: cycle for code, cycle in found if cycle}
        ours = (cycle_of_line(line) or line.keywords.get("ngc") in SUBS for line in lines)
        self._ours = {line.number for line, its in zip(lines, ours) if its}
        self._remapped = {line.number for line in lines}
        self._shapes = any(SHAPE_HANDLER in line.handlers for line in lines)

    def knows(self, code: str) -> bool:
        """Tell whether a remapped code, as ``Move.remap`` has it, is one of the package."""
        return code_number(code) in self._ours

    def remaps(self, code: str) -> bool:
        """Tell whether a code has another meaning than LinuxCNC's own."""
        return code_number(code) in self._remapped

    def cycle_of(self, call: str, codes: Sequence[float]) -> Cycle | None:
        """Return the cycle that a block calls or commands, sections aside."""
        if call == CALL:
            return Cycle(EVENT)
        known = (self._cycles.get(code) for code in codes)
        return next((cycle for cycle in known if cycle and cycle.dialect not in SECTIONS), None)

    def shape_of(self, text: Text) -> str:
        """Return the shape that a line calls, "" without one, or where the sub is another's."""
        return text.call if self._shapes and text.call in SHAPES else ""

    def holes_of(self, text: Text) -> str:
        """Return the sub of holes that a line calls, "" without one."""
        return text.call if self._shapes and text.call in HOLES else ""

    def name_of(self, codes: Sequence[float]) -> str:
        """Return the code among a block's that is a cycle; a call has the name of its sub."""
        return next((f"G{code:g}" for code in codes if code in self._cycles), CALL)

    def section(self, text: Text) -> Cycle | None:
        """Return what kind of section a line switches on or off, if it does.

        The subs of the shapes have their section's codes as locals: see ``NAMED``.
        """
        for letter, value in text.words:
            if letter == "G" and value in NAMED:
                return Cycle(POLAR, NAMED[value])
        known = filter(None, map(self._cycles.get, text.codes))
        return next((cycle for cycle in known if cycle.dialect in SECTIONS), None)

    def switch(self, text: Text, inside: bool) -> str:
        """Return ``on``, ``off`` or nothing: what a line does to a section, inside of one or not.

        One code switches on by a cylinder's radius and off by 0.
        """
        found = self.section(text)
        if found and found.dialect == CYLINDER:
            radius = dict(text.words).get("C", "")
            return "off" if inside or (is_number(radius) and not float(radius)) else "on"
        return found.handler.rpartition("_")[2] if found else ""

    def with_switches(self, texts: Iterable[Text]) -> Iterator[tuple[Text, str, bool]]:
        """Yield lines, each with how it switches a section, and whether one is on after it.

        No section goes on from one file to the next.
        """
        inside, file = False, ""
        for text in texts:
            inside = inside and file == text.file
            file, switch = text.file, self.switch(text, inside)
            inside = switch == "on" if switch else inside
            yield text, switch, inside

    def commanded(self, text: Text, switch: str) -> str:
        """Return the cycle, section or sub that a line is to make, "" if there is none."""
        if switch == "on" or self.cycle_of(text.call, text.codes):
            return self.name_of(text.codes)
        return self.shape_of(text) or self.holes_of(text)

    def selected_in(self, texts: Iterable[Text]) -> set[Text]:
        """Return the lines of a file whose words matter for what is programmed, or may: G[12], G#1.

        In a section compensation does not: a line that is put beside it may change its plan.
        """
        return {
            text
            for text, switch, inside in self.with_switches(texts)
            if switch
            or self.cycle_of(text.call, text.codes)
            or self.shape_of(text)
            or self.holes_of(text)
            or text.hides_code
            or not DIAMETER_MODES.isdisjoint(text.codes)
            or (compensates(text.codes) and not inside)
        }


def compensates(codes: Sequence[float]) -> bool:
    """Tell whether one of a block's codes switches cutter compensation on."""
    return any(code in COMPENSATION for code in codes)


def cycle_of_line(line: Remap) -> Cycle | None:
    """Return the cycle of a REMAP line: by its handler, else by its sub."""
    for handler in line.handlers:
        if handler in DIALECT_OF_HANDLER:
            return Cycle(DIALECT_OF_HANDLER[handler], handler)
    dialect = DIALECT_OF_SUB.get(line.keywords.get("ngc", ""))
    return Cycle(dialect) if dialect else None
