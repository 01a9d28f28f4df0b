# SPDX-License-Identifier: GPL-2.0-or-later
"""A mill's words on the face of a bar: X and Y in G12.1, Z along the spindle, holes beside it."""

from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.on_lathe.values import DrilledHole, MilledSurface, is_plain_number, times

LEAST_RADIUS = {"G20": 0.2, "G21": 5.0}  # a section begins off the spindle's axis


def _without_y(draft: Draft) -> None:
    word = draft.take("Y")
    draft.comments += [f"{word.text}: no Y here"] if word else []


def _same_words(draft: Draft) -> None:
    """Y is C in a section: the words stay."""


def _begin_on_face(draft: Draft, point: tuple[str, str], feed: float) -> list[str]:
    x, y = point
    least = LEAST_RADIUS[draft.state.units]
    start = f"[2 * SQRT[[{x}] ** 2 + [{y}] ** 2 + {least:g} ** 2]]"
    if is_plain_number(x) and is_plain_number(y):
        start = f"{2 * max(abs(complex(float(x), float(y))), least):.4f}"
    on, _ = draft.control.polar_codes
    return [f"G0 X{start} C0", "G8", on, f"G1 X{x} C{y} G94 F{feed:g}"]


def _end_on_face(draft: Draft) -> list[str]:
    return [draft.control.polar_codes[1], "G7"]


def _face_hole(draft: Draft, hole: DrilledHole) -> str:
    entries = (times(hole.x, 2), hole.y, hole.depth, hole.retract, hole.feed, hole.peck, hole.dwell)
    return f"o<face_hole_at> call {' '.join(f'[{entry}]' for entry in entries)} [0]"


FACE = MilledSurface(
    "Z", "on", "C", _same_words, _without_y, _begin_on_face, _end_on_face, _face_hole
)
