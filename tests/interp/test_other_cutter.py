# SPDX-License-Identifier: GPL-2.0-or-later
"""D that is not the loaded tool: one message for each tool, before the first motion."""

import pytest

from g12.tools.preview.tracer import Tracer
from support.sim_machines import SIM

TOOLS = {1: 6.0, 2: 10.0, 3: 6.1}


@pytest.mark.parametrize("machine", ["mill_mm", "mill_yasnac_mm", "mill_mitsubishi_mm"])
def test_one_message_for_each_tool(machine):
    """T1 and D3 differ by wear; the two D2 with T1 are one message; no radius but D's is cut."""
    lines = ["F300 T1 M6", "G12 I20 D2", "G13 I20 D2", "G12 I20 D3", "T2 M6", "G12 I20 D2"]
    with Tracer(SIM / f"{machine}.ini", tools=TOOLS) as mill:
        traced = mill.trace_text([*lines, "G20", "G13 I1 D1", "G12 I1 D1", "M2"])
    assert traced.error is None
    assert [tuple(message) for message in traced.messages] == [
        (2, "G12: the cycle uses D2, diameter 10; the loaded tool T1 has 6"),
        (8, "G13: the cycle uses D1, diameter 0.23622 in; the loaded tool T2 has 0.393701 in"),
    ]
    reported = next(event for event in traced.events if "the cycle uses D2" in event.text)
    assert [move.block for move in traced.moves[: reported.at]] == []
    radii = [move.radius for move in traced.moves if move.block == 2 and move.kind == "arc"]
    assert max(radii) == pytest.approx(15.0)


def test_a_d_that_still_counts_is_reported_with_the_next_tool():
    lines = ["F300 T1 M6", "G12 I20 D1", "T2 M6", "G12 I20", "G12 I20", "M2"]
    with Tracer(SIM / "mill_mm.ini", tools=TOOLS) as mill:
        traced = mill.trace_text(lines)
        refused = mill.trace_text(["F300 T1 M6", "G12 I3 D2", "M2"])
    text = "G12: the cycle uses the D last commanded, diameter 6; the loaded tool T2 has 10"
    assert [tuple(message) for message in traced.messages] == [(4, text)]
    assert refused.error and refused.messages == []
