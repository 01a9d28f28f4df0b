# SPDX-License-Identifier: GPL-2.0-or-later
"""What `check` finds of the face's kinematics, mistake by mistake; without LinuxCNC."""

import pytest

from g12.tools.install.config.findings import NOTE, PROBLEM
from g12.tools.install.lathe import kinematics_rules
from g12.tools.install.lathe.kinematics_rules import kinematics_findings
from support.sim_machines import ROOT
from support.small_configs import config_of, write_config

MOTION = "loadrt [KINS]KINEMATICS\nloadrt [EMCMOT]EMCMOT num_joints=3 # motmod num_aio=1\n"
GUARD = (ROOT / "configs/kinematics/polar_kinematics.hal").read_text()
LATHE = """\
[RS274NGC]
REMAP = G12.1 modalgroup=1 python=polar_on
REMAP = G13.1 modalgroup=1 python=polar_off

[G12]
POLAR_KINEMATICS = 1

[KINS]
JOINTS = 3
KINEMATICS = polar_xzc coordinates=XZC

[TRAJ]
COORDINATES = X Y Z C

[HAL]
HALFILE = motion.hal
HALFILE = polar.hal

[AXIS_X]
MIN_LIMIT = -200
MAX_LIMIT = 200
MAX_VELOCITY = 100
MAX_ACCELERATION = 700

[JOINT_0]
MIN_LIMIT = -5
MAX_LIMIT = 200
MAX_VELOCITY = 100
MAX_ACCELERATION = 1000

[AXIS_Y]
MIN_LIMIT = -200
MAX_LIMIT = 200
MAX_VELOCITY = 100
MAX_ACCELERATION = 700
"""
MISTAKES = [  # what is changed of the INI, what is found, a part of what is said
    ("KINEMATICS = polar_xzc coordinates=XZC", "KINEMATICS = trivkins coordinates=XZC", "kins",
     "KINEMATICS = trivkins coordinates=XZC"),
    ("coordinates=XZC", "coordinates=XYZC", "kins", "Y may not"),
    ("coordinates=XZC", "coordinates=XZ", "kins", "C have to be there"),
    ("JOINTS = 3", "JOINTS = 4", "kins", "JOINTS = 4, but"),
    ("COORDINATES = X Y Z C", "COORDINATES = X Z C", "coordinates", "lacks Y"),
    ("POLAR_KINEMATICS = 1", "POLAR_KINEMATICS = 0", "kinematics-unused", "makes segments"),
    ("HALFILE = polar.hal", "HALFILE = gone.hal", "kinematics-hal", "never leave"),
    ("HALFILE = motion.hal\nHALFILE = polar.hal", "HALFILE = polar.hal\nHALFILE = motion.hal",
     "kinematics-hal", "comes before"),
    ("[AXIS_Y]", "[AXIS_B]", "face-axis", "[AXIS_Y] has no MAX_LIMIT"),
    ("MIN_LIMIT = -200", "MIN_LIMIT = -5", "face-limits", "MIN_LIMIT = -200"),
    ("MAX_VELOCITY = 100", "MAX_VELOCITY = 150", "face-speed", "[AXIS_X] MAX_VELOCITY 150"),
    ("MAX_ACCELERATION = 700", "MAX_ACCELERATION = 1000", "face-acceleration", "= 700 in both"),
    ("MAX_ACCELERATION = 700", "MAX_ACCELERATION = 0", "face-axis", "must be above 0"),
    ("HALFILE = polar.hal", "HALFILE = polar.hal\nHALCMD = setp polar-xzc.tool-offset 0.02",
     "tool-offset", "POLAR_TOOL_OFFSET = 0, but polar-xzc.tool-offset is 0.02"),
    ("HALFILE = polar.hal", "HALFILE = polar.hal\nHALCMD = net a => motion.adaptive-feed",
     "pin-taken", "HALCMD: net a => motion.adaptive-feed: motion.adaptive-feed is the"),
    ("HALFILE = polar.hal", "HALFILE = polar.hal\nHALCMD = net fast => ini.x.max_acceleration",
     "pin-taken", "ini.x.max_acceleration is set by G12.1"),
    ("HALFILE = polar.hal", "HALFILE = polar.hal\nPOSTGUI_HALFILE = later.hal",
     "kins", "loads trivkins"),
]  # fmt: skip
PERIODS = [  # of the trajectory: the INI's, the HAL line's, what is said
    ("2000000", "2000000", "traj_period_nsec is 2 times servo_period_nsec"),
    ("1000000", "[EMCMOT](TRAJ_PERIOD)", ""),
    ("2000000", "", ""),  # no HAL line uses it
]
IN_THE_WAY = [
    *((f"net own => {pin}", "pin-taken") for pin in kinematics_rules.GUARD_PINS),
    ("net machine-on motion.motion-enabled", "pin-taken"),
    ("loadrt trivkins coordinates=XZC", "kins"),
    ("loadrt motmod num_joints=3 num_aio=2", "few-pins"),
]


@pytest.fixture
def found(tmp_path, monkeypatch):
    """Return a function: the findings about an INI and its HAL files."""
    module = tmp_path / "polar_xzc.so"

    def find(text, motion=MOTION, installed=b"%s.end-request"):
        module.write_bytes(installed or b"")
        monkeypatch.setattr(kinematics_rules, "module_file", lambda: module if installed else None)
        files = {"motion_hal": motion, "polar_hal": GUARD, "later_hal": "loadrt trivkins\n"}
        ini = write_config(tmp_path, text, "lathe.ini", **files)
        return list(kinematics_findings(config_of(ini)))

    return find


def test_a_lathe_without_is_not_looked_at(found):
    text = LATHE.replace("polar_xzc", "trivkins").replace("= 1", "= 0")
    assert found(text, installed=None) == []


def test_the_module_is_missing(found):
    (missing,) = found(LATHE, installed=None)
    assert (missing.level, missing.kind) == (PROBLEM, "no-kinematics")
    assert "make kinematics" in missing.cure


@pytest.mark.parametrize(("ini", "used", "says"), PERIODS)
def test_a_slower_trajectory_is_a_note(found, ini, used, says):
    text = f"{LATHE}[EMCMOT]\nSERVO_PERIOD = 1000000\nTRAJ_PERIOD = {ini}\n"
    own = f" traj_period_nsec={used}" if used else ""
    motion = f"{MOTION}loadrt motmod servo_period_nsec=[EMCMOT]SERVO_PERIOD{own}\n"
    notes = [each for each in found(text, motion) if each.level == NOTE]
    assert [each.kind for each in notes] == ["traj-period"] * bool(says)
    assert all(says in each.text for each in notes)


@pytest.mark.parametrize(("good", "bad", "kind", "says"), MISTAKES)
def test_mistake(found, good, bad, kind, says):
    assert good in LATHE
    findings = found(LATHE.replace(good, bad, 1))
    assert {finding.kind for finding in findings} == {kind}
    assert says in findings[0].text + findings[0].cure


@pytest.mark.parametrize(("line", "kind"), IN_THE_WAY)
def test_something_in_the_way(found, line, kind):
    (finding,) = found(LATHE, motion=f"{MOTION}{line}\n")
    assert (finding.level, finding.kind) == (PROBLEM, kind)
    assert finding.text.startswith(f"motion.hal:3: {line}")


def test_a_module_that_is_older(found):
    text = LATHE.replace("[KINS]", "POLAR_TOOL_OFFSET = 8\n\n[KINS]")
    line = (ROOT / "configs/kinematics/polar_tool_offset.hal").read_text()
    (old,) = found(text, MOTION + line, b"%s.centre")
    assert (old.level, old.kind) == (PROBLEM, "no-kinematics")
    assert "make kinematics" in old.cure
