# SPDX-License-Identifier: GPL-2.0-or-later
"""The planners of the cycles without LinuxCNC: refusals, messages, edges of what can be cut.

What they cut is judged in interp/test_valid_cuts.py.
"""

import itertools
import re
from functools import partial

import pytest

from g12.cycles import bore, frame, haas, mitsubishi, thread, yasnac
from g12.cycles.circle_mill import plan_call, plan_code
from g12.cycles.plan import EventPlanes, pocket_descent
from g12.errors import Refusal
from g12.request import COUNTERCLOCKWISE, Words
from g12.settings import Settings
from g12.state import Tool
from support.planner_context import INCH, MM, reported, words_of

NONE = EventPlanes()
TABLE = {1: Tool(1, 0.125), 2: Tool(2, 0.25), 3: Tool(3, -0.125), 4: Tool(4, 0.0)}
HAAS = INCH._replace(z=0.1, spindle_tool=TABLE[1], tools=TABLE)


def planned(cycle, **settings):
    return lambda words: cycle.plan(words, COUNTERCLOCKWISE, Settings(**settings))


STANDING = MM._replace(x=1.0, y=2.0, z=3.0)
PLANNERS = {  # code, planner, state before the block, words that a row does not have
    "haas": ("G12", planned(haas), HAAS, ""),
    "yasnac": ("G12", planned(yasnac), MM, ""),
    "mitsubishi": ("G13", planned(mitsubishi), STANDING, ""),
    "pocket": ("G13.2", partial(plan_code, planes=NONE, pocket=True), INCH, "Y2 Z-.5 R1.5 I.1 H2"),
    "perimeter": ("G12.2", partial(plan_code, planes=NONE, pocket=False), INCH, "Z-.5 R1.5 I.1 H2"),
    "call": ("circle_mill", partial(plan_call, planes=NONE), INCH, "Z-.5 R1.5 W.1 C2"),
}


def plan(name, words="", found=None, *arguments, **changed):
    """Return the plan of a block; ``changed`` is what differs in the state before it."""
    code, planner, usual, needed = PLANNERS[name]
    event = "X1 Y2" if needed else ""
    context = (found or usual)._replace(**changed)
    return planner(Words(code, words_of(event, needed, words), context), *arguments)


NO_FINISH = "there is no finish pass with the tool centre on the circle"
SIDE = "is missing: 0 tool centre on the circle, 1 left, 2 right of it"
WITH_D, NO_D = "tool radius 10, D2", "no D"


def beyond(word, at, tool, rule):
    return f"{word} puts the tool centre at X{at} from the circle's centre ({tool}): {rule}"


def too_near(apart, to):
    return f"only {apart} from {to}; the smallest arc needs 0.00508"


REFUSED = {
    "haas": [
        ("I.12505 D1",
         "I0.12505 must be greater than the tool radius 0.125 (D1) by at least 0.0002"),
        ("I0 D0", "I0 must be greater than 0"),
        ("I.5 L0", "L0 must be at least 1"),
        ("I.5 L200000", "L makes 200000 circles, the most is 100000"),
        ("I.5 K1 Q1e-320", "Q9.99989e-321 makes 1000000001 circles, the most is 100000"),
    ],
    "yasnac": [
        ("I0", "I0 must be at least 0.00508"),
        ("I-5 R-6 D2", "I-5 must be greater in size than the tool radius 10 (D2)"),
        ("I30 R29.99746", beyond("R29.99746", 29.99746, NO_D,
         too_near(0.00254, "X30, where I30 puts it"))),
        ("I50 R20 K20.004 Q1 D2", beyond("K20.004", 10.004, WITH_D,
         too_near(0.004, "X10, where the cut begins"))),
        ("I-50 R-20 K-49.999 Q1", beyond("K-49.999", -49.999, NO_D,
         too_near(0.001, "X-50, where I-50 puts it"))),
        ("I50 K50 Q1", beyond("K50", 50, NO_D,
         "it must be between X0 and X50, where I50 puts it")),
        ("I50 R30 K30 Q1 D2", beyond("K30", 20, WITH_D,
         "it must be between X20 and X40, where I50 puts it")),
        ("I50 L0", "L0 must be at least 1"),
        ("I50 D3", "D3 has the negative diameter -4 in the tool table"),
        ("I50 K10 Q.0001", "K, Q and L make 800001 circles, the most is 100000"),
    ],
    "mitsubishi": [
        ("I0 D0", "I0 must be at least 0.00508"),
    ],
    "pocket": [
        ("Y", "Y is missing: the circle's centre"),
        ("Z", "Z is missing: the final depth"),
        ("R", "R is missing: the circle's radius"),
        ("H", f"H {SIDE}"),
        ("H3", "H3 must be at most 2"),
        ("J.00005", "J0.00005 must be at least 0.0002"),
        ("Q.00005", "Q0.00005 must be at least 0.0002"),
        ("L1", "L1 needs Q as well: the finish dimension"),
        ("Q.02 L2", "L2 must be at most 1"),
        ("Z.1", "Z0.1 must be below the first reference plane I0.1"),
        ("Z.09 Q.02", "Z0.09 must be below the first reference plane I0.1 by more than Q0.02"),
        ("R.27 Q.02", "R0.27 must be greater than the tool radius 0.25 (T1) + Q0.02"),
        ("J.001 K.0001", "J and K make 7500000 circles, the most is 100000"),
    ],
    "perimeter": [
        ("H1 J.3", "J0.3 is the roughing width of a pocket"),
        ("H0 R.00005", "R0.00005 must be at least 0.0002"),
    ],
    "call": [
        ("C", f"C {SIDE}"),
        ("G1", "G1 must be 0 (perimeter) or 7 (pocket)"),
        ("O0", "O0 must not be below the first reference plane W0.1"),
        ("L0", "L0 must not be 0; -9999 leaves it out"),
        ("F0", "F0 must be greater than 0"),
        ("C0 L-.02", f"L0.02: {NO_FINISH} (C0)"),
    ],
}  # fmt: skip


@pytest.mark.parametrize(
    ("name", "words", "rule"), [(name, *row) for name, rows in REFUSED.items() for row in rows]
)
def test_a_bad_block_is_refused_by_name(name, words, rule):
    assert reported(plan, name, words) == f"{PLANNERS[name][0]}: {rule}"


VALID = {"haas": "I.75 Z-1", "yasnac": "I50", "mitsubishi": "I50 D2", "pocket": ""}
DIAMETER = "T8 in the spindle needs a diameter above 0 in the tool table, not"
OFFSET = "needs a move after G40: the tool is still beside the programmed point"
BAD_MODES = [
    *((name, *row) for name in VALID for row in [
        (dict(inverse_time=True), "needs G94 or G95, not G93"),
        (dict(compensated=True), "needs G40: compensation is switched on inside"),
        (dict(feed=0.0), "F0 must be greater than 0 (no feed commanded?)"),
        (dict(per_revolution=True),
         "needs a spindle speed for feed per revolution (G95), but S is 0"),
    ]),
    *((name, dict(plane="G18"), "needs the XY plane G17, but G18 is active")
      for name in ("haas", "yasnac", "pocket")),
    ("mitsubishi", dict(plane="G17.1"), "needs plane G17, G18 or G19, but G17.1 is active"),
    *((name, dict(offset_pending=True), OFFSET) for name in ("haas", "yasnac", "mitsubishi")),
    ("haas", dict(spindle_tool=TABLE[3]),
     "T3 in the spindle has the negative diameter -0.25 in the tool table"),
    ("haas", dict(spindle_tool=None),
     "D is missing, none was commanded before and no tool is loaded"),
    ("haas", dict(last_cutter=Tool(0, 0.8)),
     "I0.75 must be greater than the tool radius 0.8 (the D last commanded)"),
    ("pocket", dict(spindle_tool=None), "no tool is loaded: its diameter sets the path"),
    ("pocket", dict(spindle_tool=Tool(8, 0.0)), f"{DIAMETER} 0"),
    ("pocket", dict(spindle_tool=Tool(8, -0.25)), f"{DIAMETER} -0.5"),
    ("pocket", dict(spindle_tool=Tool(8, 0.005)),
     "J is missing: its default, the tool diameter 0.01 less 0.01, is too small"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "modes", "rule"), BAD_MODES)
def test_a_mode_that_cannot_work_is_refused(name, modes, rule):
    assert reported(plan, name, VALID[name], **modes) == f"{PLANNERS[name][0]}: {rule}"


OTHER_UNITS = MM._replace(machine_mm=25.4, spindle_tool=Tool(1, 6.0))  # G21 on an inch machine


@pytest.mark.parametrize(
    ("name", "words", "text"),
    [
        ("haas", "I.5 D1", "greater than the tool radius 6{} (D1)"),
        ("haas", "I7 K30 Q13 D1", "Q13 is greater than the tool diameter 12{}: material is left"),
        ("yasnac", "I.5 D1", "greater than the tool radius 6{} (D1)"),
        ("yasnac", "I9 R1 D1", "centre (tool radius 6{}, D1): it must be"),
        ("mitsubishi", "I.5 D1", "greater than the tool radius 6{} (D1)"),
        ("pocket", "Z-1 I1 R.5", "greater than the tool radius 6{} (T1)"),
        ("pocket", "R60 J13.5", "than the tool diameter 12{}: material is left"),
    ],
)
def test_a_tools_size_has_its_unit_where_the_machines_is_another(name, words, text):
    """The table's numbers are the machine's: 0.5 may look right to who does not see the G21."""
    for found, unit in ((OTHER_UNITS, " mm"), (OTHER_UNITS._replace(machine_mm=1.0), "")):
        try:
            message = plan(name, words, found).message
        except Refusal as refusal:
            message = refusal.message
        assert text.format(unit) in message


DEEP = MM._replace(incremental=True)
UPRIGHT = STANDING._replace(plane="G18")
LOADED = MM._replace(spindle_tool=Tool(1, 12.0))
UP = planned(thread)
TILT = 30 * (1 + 4 / 58)


@pytest.mark.parametrize(
    ("planner", "words", "state", "reached"),
    [  # X, Y and Z, from and to
        (planned(haas), "I20 K50 Q5 Z-4 L3 D2", DEEP, (-40, 40, -40, 40, -2, 6)),
        (planned(yasnac), "I-50 R-40 D2", MM, (-40, 40, -40, 40, 10, 10)),
        (planned(mitsubishi), "I-50 D2", UPRIGHT, (-39, 41, 2, 2, -37, 43)),
        (partial(plan_code, planes=NONE, pocket=True), "X3 Y4 Z-9 I2 E5 R50 Q.5 H2", LOADED,
         (-35, 41, -34, 42, -9, 5)),
        (partial(plan_code, planes=NONE, pocket=False), "X3 Y4 Z-9 I2 E5 R50 Q.5 H1", LOADED,
         (-59.5, 65.5, -58.5, 66.5, -9, 5)),
        (planned(bore), "Z-9 R0 I25 P1 K21 D2", MM, (-15, 15, -15, 15, -9, 10)),
        (UP, "Z-9 R0 I20 P1 D2", MM, (-10, 10, -10, 10, -9, 10)),
        (UP, "Z-9 R0 I20 P1 E-.1 J3 D2", MM, (-10.45, 10.45, -10.45, 10.45, -9, 10)),
        (UP, "Z-9 R0 I20 P1 K19 H1 D2", MM, (-TILT, TILT, -TILT, TILT, -9, 10)),
        (planned(frame), "Z-9 I40 J30 R12 H1 D2", MM, (-10, 10, -5, 5, -9, 10)),
        (planned(frame), "Z-9 I40 J30 R5 H2 D2", MM, (-48, 48, -43, 43, -9, 10)),
    ],
)  # fmt: skip
def test_a_cycle_may_reach_its_limits_and_not_go_beyond(planner, words, state, reached):
    for side, end in enumerate(reached):
        for over in (-0.001, 0.001):  # of this limit, the others are far
            ends = [-999.0, 999.0] * 3
            ends[side] = end + (over if side % 2 else -over)
            travel = {axis: ends[2 * n : 2 * n + 2] for n, axis in enumerate("XYZ")}
            block = Words("G13", words_of(words), state._replace(travel=travel))
            if over > 0:
                assert planner(block)
            else:
                assert f"the {'XYZ'[side // 2]} axis would go to" in reported(planner, block)


def test_a_frame_goes_down_at_the_machine_s_share_of_the_feed():
    words = Words("G13.7", words_of("Z-9 I40 J30 R12 D2"), MM)
    numbers = planned(frame, plunge_feed=40.0)(words).locals
    assert numbers["plunge_feed"] == pytest.approx(0.4 * MM.feed)


# ---------------------------------------------------------------- Haas


@pytest.mark.parametrize(
    ("words", "helix", "message"),
    [
        ("I.3 K1.5 Q.3 Z-1", False,
         "Q0.3 is greater than the tool diameter 0.25: material is left between the rings"),
        ("I.4 K1.5 Q.25 Z-1", False,
         "I0.4 is greater than 1.5 x the tool diameter 0.25: a core is left in the centre"),
        # a helix clears its own radius, 0.9 of the cutter's, more than a straight way down
        ("I.4875 K1.5 Q.25 Z-1", True, None),
        ("I.4876 K1.5 Q.25 Z-1", True,
         "I0.4876 is greater than 1.95 x the tool diameter 0.25: a ring is left about the centre"),
    ],
)  # fmt: skip
def test_material_left_is_a_message(words, helix, message):
    made = planned(haas, entry="helix" if helix else "plunge")(
        Words("G12", words_of(words, "D1"), HAAS)
    )
    assert made.message == (message and f"G12: {message}")


# ---------------------------------------------------------------- a helix of too many turns

HELIX = Settings(entry="helix", entry_angle=3.0)


def down(first, *heights, cutter=5.0):
    pocket_descent(Words("G13", {}, MM), HELIX, first, cutter, heights)


@pytest.mark.parametrize(
    ("cutter", "height", "further", "advice"),
    [
        (5.0, 100.0, 1.0, r"I from ([\d.]+) fits, or \[G12\] ENTRY = plunge"),
        (0.0, 100.0, 1.0, r"I from ([\d.]+) fits, or \[G12\] ENTRY = plunge"),  # D0 has no size
        (5.0, 2000.0, 1e9, r"([\d.]+) down fits at most, or \[G12\] ENTRY = plunge"),
    ],
)
def test_the_advice_of_a_refused_helix_holds(cutter, height, further, advice):
    """Of a thousand turns, to the first level alone."""
    with pytest.raises(Refusal) as refused:
        down(0.01, height, further, cutter=cutter)
    advised = float(re.search(f"the most is 1000: {advice}$", refused.value.message)[1])
    wide = advice.startswith("I")
    fits = (advised - cutter + 1e-4, height) if wide else (100.0, advised - 1e-2)
    fails = (advised - cutter - 0.005, height) if wide else (100.0, advised * 1.005)
    down(*fits, further, cutter=cutter)
    with pytest.raises(Refusal):
        down(*fails, further, cutter=cutter)


# ---------------------------------------------------------------- other edges


def test_an_approach_that_only_misses_the_centre_by_rounding_is_no_fast_move():
    table = {2: Tool(2, 10 - 1e-11)}
    assert plan("yasnac", "I50 R10 D2", tools=table).locals["approach"] == 0


def test_what_is_as_small_as_a_refusal_says_is_cut():
    cutter = MM._replace(spindle_tool=Tool(5, 6.0))
    assert plan("haas", "I.1252 D1").locals["first_radius"] == pytest.approx(0.0002)
    assert plan("yasnac", "I.00508").locals["radius"] == 0.00508
    assert plan("mitsubishi", "I.00508 D0").locals["radius"] == 0.00508
    assert plan("mitsubishi", "I1 D3").locals["radius"] == 3  # its diameter is negative
    assert plan("perimeter", "X0 Y0 I2 R.00508 H0", cutter).locals["rough_radius"] == 0.00508
    assert plan("pocket", "Z-5 I2 R40 Q.00508", cutter).locals["side_finish"]
    assert plan("pocket", "Z-5 I2 R6.1 J.00508", cutter).locals["roughing_width"] <= 0.00508


def test_a_pocket_has_the_pairs_that_put_the_tool_inside():
    inside = {(0, 2), (2, 2), (1, 1), (3, 1)}
    for d, h in itertools.product(range(4), range(3)):
        for name, side in (("pocket", "H"), ("call", "C")):
            words = f"{'G7 ' if name == 'call' else ''}D{d} {side}{h}"
            if (d, h) in inside:
                assert plan(name, words)
            else:
                rule = f"D{d} with {side}{h} does not put the tool inside the pocket: D0 and D2"
                assert rule in reported(plan, name, words)


def test_an_earlier_second_plane_below_the_first_is_refused_as_such():
    words = Words("G13.2", words_of("X1 Y2 Z-.5 R1.5 H2 I.8"), INCH)
    assert reported(plan_code, words, EventPlanes(0.3, 0.7), True) == (
        "G13.2: E0.7 must not be below the first reference plane I0.8:"
        " it is that of an earlier event, give a new E"
    )


def test_a_roughing_width_above_the_tool_diameter_is_a_message():
    assert plan("pocket", "J.7").message == (
        "G13.2: the roughing width 0.625 is greater than the tool diameter 0.5:"
        " material is left between the rings"
    )
    assert plan("pocket", "J.5").message is None
