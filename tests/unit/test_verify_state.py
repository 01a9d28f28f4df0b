# SPDX-License-Identifier: GPL-2.0-or-later
"""The modal state and the other events of a block, against its words."""

import pytest

from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Event
from g12.tools.verify.compare.state import extra_events, judge_state


def block(events, codes=(12.0,), m_codes=(), **words):
    own = tuple(Event(0, 1, text) for text in events)
    return Block(None, words, codes, m_codes, (), {}, 0, 1, own_events=own)


@pytest.mark.parametrize(
    ("found", "expected", "says"),
    [
        ({"_metric": 0.0}, {"_metric": 1.0}, ["it leaves G20, not G21"]),
        ({"_motion_mode": 30.0}, {"_motion_mode": 0.0}, ["it leaves G3, not G0"]),
        ({"_feed": 600.0000001}, {"_feed": 600.0}, []),
        ({"_feed": 1200.0}, {"_feed": 600.0}, ["it leaves F1200, not F600"]),
        ({"_selected_tool": 5.0}, {"_selected_tool": 4.0}, ["it leaves T5, not T4"]),
        ({"_c": 370.0}, {"_c": 10.0}, []),
    ],
)
def test_what_a_block_leaves(found, expected, says):
    assert [each.text() for each in judge_state(found, expected, 1)] == says


@pytest.mark.parametrize(
    ("events", "words", "extra"),
    [
        (["M8 on", "M4"], {"m_codes": (8.0,)}, ["M4"]),
        (["M7 off", "M8 off"], {"m_codes": (9.0,)}, []),
        (["S1000", "G61"], {"S": 1000.0}, ["G61"]),
        (["G61"], {"codes": (12.0, 61.0)}, []),
        (["G64 P0.1 Q0.1"], {"codes": (12.0, 20.0)}, []),
        (["G64 P0.1 Q0.1"], {}, ["G64 P0.1 Q0.1"]),
        (["tool 5", "dwell 1", "dwell 0", "message hello"], {}, ["tool 5", "dwell 1"]),
    ],
)
def test_events_that_the_words_do_not_say(events, words, extra):
    assert list(extra_events(block(events, **words))) == extra
