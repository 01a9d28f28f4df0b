# SPDX-License-Identifier: GPL-2.0-or-later
"""G50 S and G92 S: the speed limit, which LinuxCNC takes as D beside G96; with axes the origin."""

from __future__ import annotations

from g12.tools.translate.blocks.draft import Draft, word_of
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.modal import UNKNOWN


def speed_limit(draft: Draft) -> None:
    """Remember a limit, write it where G96 begins; an origin becomes G92."""
    code = draft.meanings.pop("speed limit or origin", None)
    if code:
        limit_or_origin(draft, code.code)
    if "G96" in draft.codes() and not code:
        limit = draft.sure("limit", "G96 needs the speed limit")
        if limit != UNKNOWN:
            draft.words.append(word_of(f"D{limit}"))


def limit_or_origin(draft: Draft, code: str) -> None:
    """Take the S of a speed limit; what is left must be axes."""
    limit = draft.take("S")
    if limit:
        draft.change(limit=limit.value)
        draft.comments.append(f"{code} {limit.text}")
        if draft.sure("spindle_mode", f"{code} S limits G96") == "G96":
            limit_now(draft, code, limit.value)
    if draft.axis_words():
        draft.put_first("G92")
    elif not limit or draft.letters() & set("UVWH"):
        raise NotTranslated(f"{code} needs S, a speed limit, or X and Z, an origin")


def limit_now(draft: Draft, code: str, limit: str) -> None:
    """Write the limit for the surface speed that is on."""
    surface = draft.sure("surface", f"{code} S within G96")
    if surface == UNKNOWN:
        raise NotTranslated(f"{code} S within G96, and the S of G96 is not known here")
    draft.after.append(f"G96 S{surface} D{limit}")
