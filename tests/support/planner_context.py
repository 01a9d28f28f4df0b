# SPDX-License-Identifier: GPL-2.0-or-later
"""What a block finds in the planners' own tests, modes, position, tools; words and refusals."""

import pytest

from g12.errors import LONGEST_MESSAGE, Refusal
from g12.state import State, Tool

MM = State(
    inch=False,
    machine_mm=1.0,
    x=0.0,
    y=0.0,
    z=10.0,
    offsets=dict.fromkeys("XYZABC", 0.0),
    shifts=dict.fromkeys("XYZ", 0.0),
    rotation=0.0,
    incremental=False,
    plane="G17",
    inverse_time=False,
    per_revolution=False,
    speed=0.0,
    feed=300.0,
    compensated=False,
    offset_pending=False,
    spindle_tool=None,
    last_cutter=None,
    d_is_earlier=lambda: False,
    tools={1: Tool(1, 6.0), 2: Tool(2, 10.0), 3: Tool(3, -2.0), 4: Tool(4, 0.0)},
)
INCH = MM._replace(
    inch=True,
    machine_mm=25.4,
    z=1.0,
    feed=10.0,
    spindle_tool=Tool(1, 0.25),
    tools={1: Tool(1, 0.25), 2: Tool(2, 0.125)},
)


def words_of(*texts):
    """Return the words of texts, as "I50 R-40 D2"; a letter without a number takes its word out."""
    words = {word[0]: word[1:] for text in texts for word in text.split()}
    return {letter: float(value) for letter, value in words.items() if value}


def reported(planner, *arguments, **options):
    """Return the sentence of a refusal, which there must be."""
    with pytest.raises(Refusal) as refused:
        planner(*arguments, **options)
    assert len(refused.value.message) < LONGEST_MESSAGE
    return refused.value.message
