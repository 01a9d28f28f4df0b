# SPDX-License-Identifier: GPL-2.0-or-later
"""A slide and C in one feed block outside a section: G93 with the time that the control takes.

On a Fanuc F is along the path of millimetres (X as a radius) and degrees together; LinuxCNC takes
it along X, Y and Z alone. The control's ``feed_of_c`` is ``mm and degrees``, ``degrees`` (F is C's)
or ``mm`` (as LinuxCNC). A slide that moves next to nothing is refused: LinuxCNC 2.9.0~pre1 runs too fast
then.
"""

from math import hypot

from g12.tools.translate.blocks.draft import AXIS_NUMBERS, Draft, word_of
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.modal import CONSUMERS, UNKNOWN
from g12.tools.translate.blocks.positions import axis_of, known_position

LEAST_SLIDE_MM = 0.001  # a slide moves by that or not at all
SLIDES = "XYZ"
INSTEAD = "write G0 with X, Z and C as numbers in a block before it"


def feed_of_c(draft: Draft) -> None:
    rule, state = draft.control.feed_of_c, draft.state
    axes = {axis_of(word.letter) for word in (*draft.axis_words(), *draft.increments())}
    if "C" not in axes or not axes & set(SLIDES) or not _is_feed(draft) or rule == "mm":
        return
    moved = _distances(draft, axes)
    turned, along = abs(moved["C"]), hypot(*(moved.get(axis, 0.0) for axis in SLIDES))
    if turned and along and state.feed_mode != "G93":
        _check_rule(draft, rule)
        if along < _least_of(draft):
            raise NotTranslated("a slide goes less than 0.001 mm beside C: leave its word out")
        path = turned if rule == "degrees" else hypot(turned, along)
        missing = "C beside a slide at a feed: F must be a number here: write it"
        _write_inverse_time(draft, path / number_of_feed(draft, missing))


def _is_feed(draft: Draft) -> bool:
    other = draft.state.polar != "off" or draft.meanings or draft.state.cycle
    codes = {*CONSUMERS, "G53", "G33"}.intersection(draft.codes())
    return draft.motion() not in ("G0", UNKNOWN) and not other and not codes


def _distances(draft: Draft, axes: set[str]) -> dict[str, float]:
    """Return how far each axis goes, in mm, inches or degrees; X as a radius."""
    moved = {}
    for axis in (axis for axis in AXIS_NUMBERS if axis in axes):
        start, end = known_position(draft.start, axis), known_position(draft.state, axis)
        if start is None or end is None:
            raise NotTranslated(
                f"C beside a slide at a feed: its time depends on the position of {axis}, which "
                f"is not known here: {INSTEAD}"
            )
        moved[axis] = (end - start) * _scale_of(draft, axis)
    return moved


def _scale_of(draft: Draft, axis: str) -> float:
    if axis != "X":
        return 1.0
    return 0.5 if draft.sure("x_words", "C beside a slide") == "G7" else 1.0


def _check_rule(draft: Draft, rule: str) -> None:
    if rule == "say":
        raise NotTranslated(
            'C beside a slide at a feed: say what F is then, feed_of_c = "mm and degrees", '
            '"degrees" or "mm" in a control of your own'
        )
    if draft.sure("feed_mode", "C beside a slide at a feed") != "G94":
        raise NotTranslated(
            "C beside a slide needs a feed per minute: on a lathe of system A write G98 and F"
        )
    if {"G2", "G3"} & {*draft.codes(), draft.state.motion if not draft.codes() else ""}:
        raise NotTranslated("C beside an arc: write the arc as lines, or in polar mode")


def number_of_feed(draft: Draft, missing: str) -> float:
    """Return F; it must be a number above 0, else it is refused as ``missing``."""
    try:
        feed = float(draft.sure("feed", missing))
    except ValueError:
        feed = 0.0
    if feed <= 0:
        raise NotTranslated(missing)
    return feed


def _write_inverse_time(draft: Draft, minutes: float) -> None:
    draft.take_codes({"G94"})
    draft.take("F")
    if draft.state.own_feed != "G93":
        draft.words.append(word_of("G93"))
    draft.words.append(word_of(f"F{1 / minutes:.10g}"))
    draft.has_feed = True
    draft.change(own_feed="G93")


def _least_of(draft: Draft) -> float:
    inches = draft.sure("units", "C beside a slide") == "G20"
    return LEAST_SLIDE_MM / 25.4 if inches else LEAST_SLIDE_MM
