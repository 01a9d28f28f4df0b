# SPDX-License-Identifier: GPL-2.0-or-later
"""A G28 of a lathe whose place was never set: a rapid to machine zero, not to a tool change."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from g12.tools.machine.ini import Ini
from g12.tools.machine.stored_places import unset_places
from g12.tools.preview.executed_blocks import Text
from g12.tools.verify.result.finding import Finding

STORED = {28.0: "G28", 30.0: "G30"}
SETTING = {28.1: "G28", 30.1: "G30"}


def judge_home(texts: Sequence[Text], ini: Ini) -> Iterator[Finding]:
    """Yield the first G28 and the first G30 of which the var file has no place."""
    waiting = set(unset_places(ini))
    for text in texts:
        waiting -= {SETTING.get(number, "") for number in text.codes}
        for code in waiting.intersection(STORED.get(number, "") for number in text.codes):
            waiting.discard(code)
            yield Finding("place-not-set", text.number, {"code": code})
