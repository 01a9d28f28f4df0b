# SPDX-License-Identifier: GPL-2.0-or-later
"""The kinematics of configs/kinematics, compiled on their own and called as motion calls them."""

import ctypes
import shutil
import subprocess

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from support.sim_machines import ROOT

pytestmark = pytest.mark.skipif(not shutil.which("cc"), reason="there is no C compiler")
COMPONENT = ROOT / "configs" / "kinematics" / "polar_xzc.comp"
# what halcompile and LinuxCNC's headers put in front of the component's C code
SURROUNDINGS = """
#include <math.h>
#include <string.h>
#include <stdio.h>
#define EMCMOT_MAX_JOINTS 16
#define EMCMOT_MAX_AXIS 9
#define RTAPI_MP_STRING(name, text)
#define RTAPI_MSG_ERR 1
#define rtapi_print_msg(level, ...) printf(__VA_ARGS__)
#define EXPORT_SYMBOL(name)
typedef struct { double x, y, z; } PmCartesian;
typedef struct EmcPose { PmCartesian tran; double a, b, c, u, v, w; } EmcPose;
typedef unsigned long KINEMATICS_FORWARD_FLAGS;
typedef unsigned long KINEMATICS_INVERSE_FLAGS;
typedef enum { KINEMATICS_BOTH = 4 } KINEMATICS_TYPE;
#define FUNCTION(name) static void name(struct __comp_state *__comp_inst)
#define EXTRA_SETUP() \\
    static int extra_setup(struct __comp_state *__comp_inst, char *prefix, long extra_arg)
"""
ENTRIES = """
int set_up(char *letters) { coordinates = letters; return extra_setup(&pins, 0, 0); }
void run_guard(void) { guard(&pins); }
"""


class Pose(ctypes.Structure):
    _fields_ = [(letter, ctypes.c_double) for letter in "xyzabcuvw"]


NUMBERS = {
    "request": 0, "centre": 0, "tool_offset": 0, "type": 0, "speed": 0, "feed": 1, "feed_upm": 0,
    "unit": 1, "most_override": 0,
}  # fmt: skip
BITS = {"enabled": 1, "program": 1, "stands": 1, "face": 0, "jog_inhibit": 0, "end_request": 0}
STATE = f"struct __comp_state {{ double {', '.join(NUMBERS)}; int {', '.join(BITS)}; }} pins;\n"
STATE += "".join(f"#define {name} (__comp_inst->{name})\n" for name in [*NUMBERS, *BITS])


class Pins(ctypes.Structure):
    _fields_ = [(name, ctypes.c_double) for name in NUMBERS]
    _fields_ += [(name, ctypes.c_int) for name in BITS]


class Kinematics:
    """The component with joints X, Z and C."""

    def __init__(self, library):
        self.library, self.pins = library, Pins.in_dll(library, "pins")
        assert self.set_up("XZC") == 0
        for name, value in {**NUMBERS, **BITS}.items():
            setattr(self.pins, name, value)
        self.library.kinematicsSwitch(0)
        self.library.run_guard()

    def set_up(self, letters):
        return self.library.set_up(letters.encode())

    def forward(self, *joints):
        pose, values = Pose(), (ctypes.c_double * 16)(*joints)
        assert self.library.kinematicsForward(values, ctypes.byref(pose), None, None) == 0
        return pose

    def inverse(self, pose, *present):
        """Return the joints at a pose, None where there are none."""
        values = (ctypes.c_double * 16)(*present)
        failed = self.library.kinematicsInverse(ctypes.byref(pose), values, None, None)
        return None if failed else tuple(values[: len(present)])

    def face(self, *joints):
        """Switch the face on where the joints stand, as motion does."""
        assert self.library.kinematicsSwitch(1) == 0
        return self.forward(*joints)

    def guard(self, **pins):
        """Set pins, run ten cycles, obey the type as motion would; return it."""
        for name, value in pins.items():
            setattr(self.pins, name, value)
        for _ in range(10):
            self.library.run_guard()
        self.library.kinematicsSwitch(int(self.pins.type))
        return self.pins.type


def compiled(folder, *options):
    """Return the component as a library."""
    code = COMPONENT.read_text().partition("\n;;\n")[2]
    code = "\n".join(line for line in code.splitlines() if not line.startswith("#include"))
    source = folder / "polar_xzc.c"
    source.write_text(SURROUNDINGS + STATE + code + ENTRIES)
    command = ["cc", "-Wall", "-Wextra", "-Werror", "-Wno-unused-function", "-O2", "-shared",
               "-fPIC", *options, "-o", folder / "polar_xzc.so", source, "-lm"]  # fmt: skip
    subprocess.run(command, check=True)
    return ctypes.CDLL(folder / "polar_xzc.so")


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return compiled(tmp_path_factory.mktemp("kinematics"))


@pytest.fixture
def kinematics(library):
    return Kinematics(library)


@pytest.mark.parametrize(
    ("letters", "joints", "axes"),
    [("XZC", (20, -3, 400), "xzc"), ("czxa", (90, -3, 20, 7), "czxa")],
)
def test_type_0_is_the_axes_of_its_letters(kinematics, letters, joints, axes):
    assert kinematics.set_up(letters) == 0
    pose = kinematics.forward(*joints)
    assert tuple(getattr(pose, axis) for axis in axes) == joints and pose.y == 0
    assert kinematics.inverse(pose, *[0] * len(joints)) == joints


def test_letters_that_have_no_face(kinematics):
    assert {kinematics.set_up(text) for text in ("XZ", "ZC", "XYZC", "XZCC", "X ZC")} == {-1}


def test_a_centre_off_the_joints_zero(kinematics):
    kinematics.pins.centre = -100.0
    assert kinematics.face(-80, 0, 30).x == -80
    pose = kinematics.forward(-80, 0, 120)
    assert (pose.x, pose.y) == pytest.approx((-100, 20))
    assert kinematics.inverse(pose, -80, 0, 119) == pytest.approx((-80, 0, 120))


@settings(max_examples=300, deadline=None)
@given(
    radius=st.floats(0.001, 300),
    zero=st.floats(-90000, 90000),
    turn=st.floats(-4000, 4000),
    ahead=st.floats(-170, 170),
    beside=st.sampled_from([0.0, 0.02, -12.0]),
)
def test_round_trip(library, radius, zero, turn, ahead, beside):
    kinematics = Kinematics(library)
    kinematics.pins.tool_offset = beside
    kinematics.face(50, 0, zero)
    pose = kinematics.forward(radius, 1, zero + turn)
    there = kinematics.inverse(pose, 7, 7, zero + turn + ahead)
    assert there == pytest.approx((radius, 1, zero + turn), abs=1e-7)


def test_the_face_of_a_tool_beside_the_x_line(kinematics):
    kinematics.face(20, 0, 0)
    kinematics.pins.tool_offset = 10.0  # which counts when the face is switched on
    assert kinematics.forward(20, 0, 0).y == 0
    pose = kinematics.face(20, 5, 30)
    assert (pose.x, pose.y, pose.c) == (20, 10, 30)
    pose = kinematics.forward(20, 5, 120)
    assert (pose.x, pose.y) == pytest.approx((-10, 20))
    pose.x, pose.y = 0.0, 10.0 + 1e-9
    assert kinematics.inverse(pose, 20, 5, 120) == pytest.approx((0, 5, 30), abs=0.002)
    pose.y = 9.999
    assert kinematics.inverse(pose, 20, 5, 120) is None


def test_c_keeps_its_angle_in_the_centre(kinematics):
    pose = kinematics.face(20, 0, 30)
    pose.x = pose.y = 0.0
    assert kinematics.inverse(pose, 1, 0, 75) == (0, 0, 75)


def test_the_face_does_not_begin_beyond_the_centre(kinematics):
    assert kinematics.face(-5, 0, 30).x == -5
    kinematics.library.run_guard()
    assert not kinematics.pins.face


def test_y_means_nothing_without_the_face_and_c_nothing_on_it(kinematics):
    assert kinematics.inverse(Pose(x=20, y=0.001), 20, 0, 0) is None
    pose = kinematics.face(20, 0, 30)
    pose.c = 30.001
    assert kinematics.inverse(pose, 20, 0, 30) is None
    assert kinematics.library.kinematicsSwitch(2) == -1  # there are two types


def test_type_0_is_declared_the_identity_where_linuxcnc_asks(library, tmp_path):
    newer = compiled(tmp_path, "-DKINSTYPE_IDENTITY=4", "-DKINSTYPE_PRIMARY=8")
    assert [newer.kinematicsTypeFlags(kind) for kind in (0, 1, 2)] == [4, 8, -1]
    assert library.kinematicsTypeFlags(0) == -1


# ---------------------------------------------------------------- the guard


ON, OFF = {"request": 1.0}, {"request": 0.0}
STEPS = [  # pins that change, and the type after that
    [({**ON, "stands": 0}, 0), ({"stands": 1}, 1), ({**OFF, "stands": 0}, 1), ({"stands": 1}, 0)],
    # a request counts once
    *([(ON, 1), (ended, 0), ({"enabled": 1, "program": 1}, 0), (OFF, 0), (ON, 1)]
      for ended in ({"enabled": 0}, {"end_request": 1})),
    # not under a jog, at once when the machine is off
    [(ON, 1), ({"program": 0, **OFF}, 1), ({"program": 1, **OFF}, 0), (ON, 1),
     ({"enabled": 0, "stands": 0}, 0)],
    [(ON, 1), ({"program": 0}, 1), ({"program": 1}, 0), (OFF, 0), (ON, 1)],
]  # fmt: skip


@pytest.mark.parametrize("steps", STEPS)
def test_the_guard_chooses_the_type(kinematics, steps):
    assert [kinematics.guard(**pins) for pins, _ in steps] == [kind for _, kind in steps]


def test_guard_waits_until_the_joints_are_where_they_go(kinematics):
    kinematics.guard(request=1.0, stands=0)
    kinematics.pins.stands = 1
    types = []
    for _ in range(10):
        kinematics.library.run_guard()
        types.append(kinematics.pins.type)
    assert types == [0] * 5 + [1] * 5


@pytest.mark.parametrize(
    ("pins", "refused"),
    [
        ({"request": 0}, False),
        ({"request": 1}, False),
        ({"request": 1, "stands": 0}, True),
        ({"request": 1, "stands": 0, "program": 0}, False),  # a jog
        ({"request": 1, "stands": 0, "end_request": 1}, False),  # the request ended by itself
    ],
)
def test_a_line_is_refused_where_another_world_is_asked_for(kinematics, pins, refused):
    kinematics.guard(**pins)
    there = kinematics.forward(20, 0, 0)
    there.x += 1
    assert kinematics.inverse(there, 20, 0, 0) is not None  # of a cycle, not of a line
    kinematics.library.run_guard()
    assert (kinematics.inverse(there, 20, 0, 0) is None) is refused


def test_a_line_is_refused_until_the_machine_has_switched(kinematics):
    kinematics.forward(20, 0, 0)
    kinematics.pins.request = 1
    kinematics.library.run_guard()
    assert kinematics.inverse(Pose(x=21), 20, 0, 0) is None
