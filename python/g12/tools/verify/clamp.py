# SPDX-License-Identifier: GPL-2.0-or-later
"""Turns of C with its clamp closed, anywhere in a program."""

from collections.abc import Iterator
from itertools import islice

from g12.tools.path.part import C
from g12.tools.path.track import CART_FUZZ
from g12.tools.preview.executed_blocks import CLAMP
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.subject import Subject


def judge_clamp(subject: Subject) -> Iterator[Finding]:
    """Yield the first turn of C between each code that closes its clamp and the next code.

    Calls of holes are held to their own toolpath. In sections and shapes a light drag, if the
    machine has one, takes the place of the clamp.
    """
    commanded, moves, settings = subject.commanded, subject.moves, subject.ini.settings
    cuts = [call.moves for call in commanded.holes]
    if settings.c_clamp_shapes:
        cuts += [range(section.at, section.end) for section in commanded.sections]
        cuts += [call.moves for call in commanded.shapes]
    apart = {index for cut in cuts for index in cut}
    events = commanded.clamped or ()
    ends = [*(event.at for event in events[1:]), len(moves)]
    for event, end in zip(events, ends):
        close, opens = (f"M{code}" for code in settings.c_clamp)
        turns = (
            index
            for index in range(event.at, end)
            if index not in apart and abs(moves[index].end[C] - moves[index].start[C]) > CART_FUZZ
        )
        for index in islice(turns, int(event.text == f"{CLAMP} {close}")):
            values = {"what": "turn of C", "code": opens}
            yield Finding("clamp-closed", subject.line(index), values, subject.end(index))
