# SPDX-License-Identifier: GPL-2.0-or-later
"""What a planned section hands to the interpreter, block by block."""

import pytest

from g12.errors import Refusal
from g12.host import borrowed
from g12.host.interp import kept
from g12.host.section_output import STOP_HERE, PathControl, SectionOutput
from g12.machine_ini import Axis
from g12.moves.setup import SectionMachine
from g12.moves.steps import Segments
from g12.polar.polar_section import Polar
from g12.section.effects import Action, SectionModes
from g12.settings import Settings
from support.section_starts import START

MODES = SectionModes(incremental=False, per_revolution=False, feed=100.0, speed=500.0, motion=10)
LINE = [(10.0, 0.5, 0.0, 250.0), (11.0, 1.0, 0.0, 260.0)]


def written(**words):
    """Return a block with every digit of its numbers."""
    return "".join(f"{word}{value:.17f}" for word, value in words.items())


FIRST, LAST = written(X=10, C=0.5, F=250), written(X=11, C=1, F=260)
NEXT = [("F", 260.0), (11.0, 1.0, 0.0)]  # the last as it goes to the canonical functions


class Interpreter:
    """Records what is executed; knows of modes what an emission asks for.

    ``begins`` is the line of the stop in front of the section, which is not among ``done``.
    """

    def __init__(self, tolerance=0.0, merging=0.0):
        self.active_g_codes = [-1] * 11 + [640, -1, -1, 911, 80]
        self.active_settings = [0, 0, 0, tolerance, merging]
        self.feed_mode = 0
        self.a_axis_wrapped = self.b_axis_wrapped = self.c_axis_wrapped = True
        self.call_level, self.motion_mode, self.distance_mode = 1, 0, 0
        self.ijk_distance_mode, self.plane, self.active_spindle, self.length_units = 1, 3, -1, 2
        self.active_m_codes, self.task, self.feed_rate = [-1] * 9, 0, 100.0
        kept(self, borrowed.Borrowed).stack.append(borrowed.modes_in_force(self))
        self.current_y = self.AA_current = self.BB_current = 0.0
        self.u_current = self.v_current = self.w_current = 0.0
        self.done, self.levels, self.begins = [], [], None
        self.current_x = self.CC_current = self.current_z = self.status = 0
        self.moving = None

    def read(self, text):
        self._read = text

    def execute(self, text):
        if text == STOP_HERE and self.begins is None:
            self.begins = self.sequence_number
            return 0
        self.done.append(self._read if text is None else text)
        self.current_x += self.done[-1] == self.moving
        self.levels.append(self.call_level)
        if self.done[-1].startswith("G6"):
            self._path(self.done[-1])
        if self.done[-1] in ("G90", "G91"):
            self.distance_mode = int(self.done[-1] == "G91")
        if self.done[-1] in ("G94", "G95"):
            self.feed_mode = 2 * (self.done[-1] == "G95")
        return self.status if text is None else 0

    def _path(self, text):
        words = text.replace("Q", " Q").replace("P", " P").split()
        self.active_g_codes[11] = round(float(words[0][1:]) * 10)
        values = {word[0]: float(word[1:]) for word in words[1:]}
        if words[0] == "G64":
            self.active_settings[3:] = [values.get("P", 0.0), values.get("Q", values.get("P", 0.0))]


class Canon:
    """Records in the same list what goes past the interpreter's parser."""

    def __init__(self, interp):
        self.interp = interp

    def _record(self, what):
        self.interp.done.append(what)
        self.interp.levels.append(self.interp.call_level)

    def SET_FEED_RATE(self, rate):  # noqa: N802
        self._record(("F", rate))

    def STRAIGHT_FEED(self, line, x, y, z, a, b, c, u, v, w):  # noqa: N802
        assert (y, a, b, u, v, w) == (0, 0, 0, 0, 0, 0)
        self._record((x, c, z))


def emission_of(interp):
    axes = {letter: Axis(-100.0, 100.0, 50.0, 1000.0) for letter in "XZC"}
    section = Polar(START, SectionMachine(frozenset(axes), Settings(), axes))
    return SectionOutput(interp, section, canon=Canon(interp))


def handed_over(steps, interp=None, exact=()):
    interp = interp or Interpreter()
    assert list(emission_of(interp).run(steps, MODES, exact)) == []
    return interp


def run(stop=False, line=7, axes="XC", segments=LINE):
    return Segments(line, axes, segments, stop)


SMOOTH, OLD = "G64P0.0025Q0", "G64P0Q0"
RELEASED = ["F100"]


@pytest.mark.parametrize(("tolerance", "blended"), [(0.1, [SMOOTH, "G64P0.1Q0"]), (0.001, [])])
def test_where_c_stands_the_tolerance_is_no_coarser_than_the_section_s(tolerance, blended):
    interp = Interpreter(tolerance=tolerance)
    path = PathControl(interp, borrowed.saved_modes(interp), 0.0025, 0.0254)
    for turning in (True, False, True):
        path.inside(turning)
    assert interp.done == blended


def test_a_segment_that_another_is_blended_into_is_stopped_by_a_dwell():
    one = [run(segments=LINE[:1]), run(segments=LINE[1:], stop=True)]
    for steps in ([run(stop=True), run()], [*one, run()]):
        done = handed_over(steps).done
        end = done.index(STOP_HERE)
        assert done[0] == SMOOTH and done[end + 1 :] == [FIRST, *NEXT, OLD, *RELEASED]
    assert done[1:end] == [FIRST, LAST]


def test_g9_is_an_exact_stop_at_the_end_of_its_block():
    done = handed_over([run(), run(line=8)], exact={8}).done
    assert done == [SMOOTH, FIRST, *NEXT, FIRST, *NEXT, STOP_HERE, OLD, *RELEASED]
    alone = handed_over([run(segments=LINE[:1], line=8)], exact={8}).done
    assert alone == ["G61.1", FIRST, OLD, *RELEASED]


@pytest.mark.parametrize(
    ("fact", "value", "why"),
    [
        ("moving", "M411", "M411 moves the machine: not inside a sect"),
        ("status", 2, "M411 waits for the machine"),
    ],
)
def test_an_action_that_moves_or_waits_is_refused(fact, value, why):
    interp = Interpreter()
    setattr(interp, fact, value)
    with pytest.raises(Refusal, match=rf"G12\.1 line 8: {why}"):
        handed_over([Action(8, "M411", MODES)], interp)


class Failing(Interpreter):
    """Refuses a block with a text of its own, as LinuxCNC hands it to Python."""

    def read(self, text):
        raise SystemError(text)

    def get_errormsg(self):
        return b"no \xfe such mode".decode("utf-8")


def test_a_block_that_fails_leaves_the_call_level_and_any_text_of_the_interpreters():
    interp = Failing()
    with pytest.raises(Refusal) as refused:
        handed_over([Action(9, "M72", MODES, 3)], interp)
    assert str(refused.value) == "G12.1 line 9: no \ufffd such mode"
    assert interp.call_level == 1
