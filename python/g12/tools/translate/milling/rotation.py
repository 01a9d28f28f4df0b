# SPDX-License-Identifier: GPL-2.0-or-later
"""G68 X Y R: the program turned about a point, until G69.

LinuxCNC turns a work offset about its origin. G59.3 becomes a copy of the offset in force, with the
origin where the turn takes it: the offset itself is not touched, and G69 selects it again.

A local offset, G52 or G92, is turned with the rest on LinuxCNC, on the control it is not: c being
the centre, g the local offset and R the turn, the origin goes on by (1 - R)(c + g).
"""

from g12.tools.translate.blocks.draft import AXIS_NUMBERS, Draft, position
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.expressions import UNSIGNED
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.blocks.modal import UNKNOWN, UNSURE
from g12.tools.translate.blocks.positions import LOST
from g12.tools.translate.rules.offsets import (
    G54_PARAMETER,
    OWN_SYSTEMS,
    SCALE,
    SET_SCALE,
    SLOT,
    SLOT_PARAMETER,
)

CENTRES = {"X": "#<turn_x>", "Y": "#<turn_y>"}
LOCAL_OFFSETS = {"X": "#5210 * #5211", "Y": "#5210 * #5212"}  # 0 where none is active


def follow_rotation(draft: Draft) -> None:
    turned = draft.state.turned
    if turned and (OWN_SYSTEMS.intersection(draft.codes()) or "numbered offset" in draft.meanings):
        raise NotTranslated("another work offset within G68: write G69 before it")
    _follow_local_offset(draft)


def end_of_rotation(draft: Draft, code: ForeignWord) -> None:
    draft.comments.append(code.code)
    if draft.state.turned:
        draft.write([draft.sure("turned", "G69 selects the work offset again")])
        draft.change(turned=UNKNOWN, **LOST)


def _follow_local_offset(draft: Draft) -> None:
    """Follow G52. Within G68 it must not change: LinuxCNC rotates it, the control does not."""
    if {"G52", "G92"}.isdisjoint(draft.codes()):
        return
    state = draft.state
    known: dict[str, float | str] = {} if isinstance(state.local, str) else dict(state.local)
    known |= {w.letter: _constant_of(w) for w in draft.words if w.letter in CENTRES}
    local = tuple(sorted(known.items()))
    changed = local != state.local or UNSURE in known.values() or "G92" in draft.codes()
    if state.turned and changed:
        raise NotTranslated("a local offset within G68, which turns with it here: write G69 first")
    draft.change(local=local)


def _constant_of(word: ForeignWord) -> float | str:
    """Return the value of a word, UNSURE where only the machine knows it."""
    value = word.value.strip("[]")
    return float(value) if UNSIGNED.fullmatch(value.removeprefix("-")) else UNSURE


def rotation(draft: Draft, word: ForeignWord) -> None:
    code = word.code
    system = draft.sure("offset", f"{code} turns the work offset")
    if draft.state.turned or system not in OWN_SYSTEMS or draft.state.distance != "G90":
        raise NotTranslated(f"{code} needs G54 to G59 by name before it, G90, and no {code} before")
    if draft.state.plane not in ("G17", UNKNOWN):
        raise NotTranslated(f"{code} is translated in G17 only")
    words = {letter: draft.take(letter) for letter in "XYR"}
    if not words["R"]:
        raise NotTranslated(f"{code} needs R, the angle")
    centres = [
        f"{name}=[[{words[a].value if words[a] else position(a)}] * {SCALE} + {LOCAL_OFFSETS[a]}]"
        for a, name in CENTRES.items()
    ]
    x, y = CENTRES.values()
    angle = f"[{words['R'].value}]"
    first = G54_PARAMETER + 20 * (int(system[1:]) - 54)
    shift = {
        "X": f"{x} * [1 - COS{angle}] + {y} * SIN{angle}",
        "Y": f"{y} * [1 - COS{angle}] - {x} * SIN{angle}",
    }
    values = [
        f"#{SLOT_PARAMETER + n - 1}=[#{first + n - 1}"
        + (f" + {shift[axis]}]" if axis in shift else "]")
        for axis, n in AXIS_NUMBERS.items()
        if axis in draft.control.axes
    ]
    draft.comments.append(f"{code} overwrites {SLOT}")
    draft.write([SET_SCALE, *centres, *values, f"G10 L2 P9 R{angle}", SLOT])
    draft.change(turned=system, **LOST)
