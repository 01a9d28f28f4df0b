# SPDX-License-Identifier: GPL-2.0-or-later
"""What only a whole program shows: its G code system, numbers with a decimal point and without.

Many programs of G code system A have the modes of B besides: G90 G18 at their head, G91 and G95,
with G50 S and U W. G91 and G95 are no codes of A, so such a program is certain: G90, G91, G94 and
G95 are modes in it, if no G90 or G94 in it can be a cycle, and no G98 or G99 has two meanings.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from g12.tools.translate.blocks.control import Control
from g12.tools.translate.blocks.lexer import ForeignBlock
from g12.tools.translate.blocks.modal import MOTIONS

LACKING = ("G91", "G95")  # in system A
CYCLES = frozenset(("G90", "G94"))
FEED_MODES = (frozenset(("G94", "G95")), frozenset(("G98", "G99")))
OF_SYSTEM_B = frozenset(("G33", "G77", "G78", "G79"))
AXES = "XYZ"
OF_CYCLES = frozenset("XZUW")


def control_of_program(control: Control, blocks: Sequence[ForeignBlock]) -> Control:
    """Return a control with what the program shows, and the messages about that."""
    notes = list(_mixed_numbers(control, blocks)) if control.decimals else []
    modes = _modes_of_b(control, blocks)
    if modes:
        notes.append(f"(MSG, {', '.join(modes)} are modes in this program, not cycles)")
        control = replace(control, meanings={**control.meanings, **dict.fromkeys(modes, "same")})
    return replace(control, notes=tuple(notes))


def _modes_of_b(control: Control, blocks: Sequence[ForeignBlock]) -> list[str]:
    """Return the codes that are modes in a program of system A, none where that is not certain."""
    lacking = {code for code in LACKING if control.meanings.get(code, "").startswith("refuse: ")}
    used: set[str] = set()
    for block in blocks:
        codes, letters = {w.code for w in block.words}, {w.letter for w in block.words}
        used |= codes
        cuts = codes & CYCLES and letters & OF_CYCLES and not codes & MOTIONS
        if cuts or ("G92" in codes and "S" in letters):
            return []
    is_a = control.meanings.get("G90") == "turning pass" and not used & OF_SYSTEM_B
    is_certain = is_a and used & lacking and not all(used & modes for modes in FEED_MODES)
    return sorted(CYCLES | lacking) if is_certain else []


def _mixed_numbers(control: Control, blocks: Sequence[ForeignBlock]) -> Iterator[str]:
    """Yield a message for each axis that has numbers with a decimal point and without."""
    lines: dict[tuple[str, bool], int] = {}
    for block in blocks:
        if not any(control.meanings.get(word.code) == "dwell" for word in block.words):
            for word in block.words:
                if word.letter in AXES and word.kind == "number" and not word.is_zero:
                    lines.setdefault((word.letter, word.lacks_point), block.line)
    for axis in AXES:
        with_point, without = (lines.get((axis, lacks)) for lacks in (False, True))
        if with_point and without:
            yield (
                f"(MSG, {axis} has a decimal point in line {with_point}, none in line {without}: "
                "look at both)"
            )
