# SPDX-License-Identifier: GPL-2.0-or-later
"""Codes that other controls read otherwise: G98 and G99 outside of a section of a lathe."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from g12.tools.preview.executed_blocks import Text
from g12.tools.verify.reading.codes import Codes
from g12.tools.verify.result.finding import Finding

RETURN_LEVELS = {98.0: "G94", 99.0: "G95"}  # what a lathe of the Fanuc kind means by them
DRILLING = (73.0, 74.0, *map(float, range(81, 90)))  # cycles that have return levels


def judge_return_levels(texts: Sequence[Text], codes: Codes) -> Iterator[Finding]:
    """Yield the first G98 and G99 outside of sections, where no drilling cycle uses them."""
    if any(code in DRILLING for text in texts for code in text.codes):
        return
    waiting = dict(RETURN_LEVELS)
    for text, _, inside in codes.with_switches(texts):
        for code in () if inside else text.codes:
            if code in waiting:
                values = {"code": f"G{code:g}", "meant": waiting.pop(code)}
                yield Finding("return-level", text.number, values)
