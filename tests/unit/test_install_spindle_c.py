# SPDX-License-Identifier: GPL-2.0-or-later
"""install --with spindle-c, and what check finds of it; without LinuxCNC."""

import re

import pytest

from g12.tools.errors import UsageError
from g12.tools.install.config import features
from g12.tools.install.lathe import kinematics_rules
from g12.tools.install.lathe.kinematics_rules import kinematics_findings
from g12.tools.install.lathe.spindle_c import live_spindle_missing, read_pins, spindle_c_findings
from g12.tools.install.plan import Refused, make_plan
from support.small_configs import TURNING as LATHE
from support.small_configs import TURNING_HAL as HAL
from support.small_configs import (
    config_of,
    files_of_package,
    package_of,
    put_in,
    restored,
    write_config,
)

PINS = """\
velocity = "drive.velocity"
velocity_scale = 60
position = "drive.position"
holds = "drive.mode"
brake = "drive.brake"
"""
TURNS_ONLY = HAL.replace("net c joint.2.motor-pos-cmd => joint.2.motor-pos-fb\n", "")
REFUSED = [  # what is changed of the INI or the HAL file, what is said
    ("trivkins coordinates=xzc", "trivkins coordinates=xza", "no joint is C alone"),
    ("encoder.position => spindle.0.revs", "a => b", "no HAL file connects spindle.0.revs"),
    (
        "HALFILE = motion.hal",
        "HALFILE = LIB:basic_sim.tcl",
        "LIB:basic_sim.tcl is Tcl, which install does not read: it cannot know the signals of "
        "spindle.0.revs, spindle.0.speed-in, spindle.0.index-enable",
    ),
    ("loadrt [KINS]", "loadrt lut5 count=1\nloadrt [KINS]", "loads lut5 too"),
    (
        "loadrt [KINS]",
        "loadrt pid names=drive\nloadrt [KINS]",
        'velocity = "drive.velocity": there is no such pin: LinuxCNC would not start',
    ),
    ("net c joint", "net d => motion.digital-out-02\nnet c joint", "motion.digital-out-02 is what"),
]
MISTAKES = [  # what is changed of an installed machine's INI, what is found
    ("JOINT = 2\n", "", "spindle-c"),
    *((f"{key} = {usual}", f"{key} = {wrong}", "spindle-c") for key, usual, wrong in (
        ("TIMEOUT", 30, 0), ("TIMEOUT", 30, -5), ("TIMEOUT", 30, "soon"), ("TIMEOUT", 30, ""),
        ("TIMEOUT", 30, 3601), ("ORIENT_SPEED", 0.5, "fast"), ("INDEX_SPEED", 0.25, 0),
        ("JOINT", 2, 1), ("JOINT", 2, "C"),
    )),
    ("TURNS = turns", "TURNS = other", "spindle-c-signal"),
    ("HALFILE = g12/configs/include/spindle_c.hal", "", "spindle-c-hal"),
    ("HALCMD = net spindle-c-holds => drive.mode\n", "", "spindle-c-drive"),
    ("HALCMD = loadusr sh g12/configs/include/spindle_c_limits.sh\n", "", "spindle-c-limits"),
    ("HALCMD = unlinkp drive.mode", "HALCMD = net d => joint.2.motor-pos-fb", "spindle-c-feedback"),
    ("HALCMD = unlinkp drive.mode", "HALCMD = net index => joint.2.index-enable",
     "spindle-c-index"),
    ("HALCMD = unlinkp drive.mode", "HALCMD = loadrt sum2", "spindle-c-module"),
    ("HALCMD = unlinkp drive.mode", "HALCMD = net x => spindle.0.is-oriented", "pin-taken"),
    ("HALCMD = unlinkp drive.position", "HALCMD = setp drive.positon 0", "hal-pin"),
]  # fmt: skip
LIVE = [  # [TRAJ] SPINDLES, what motion is loaded with, LIVE_SPINDLE, what check says
    ("", "", "", "warning", "[TRAJ] SPINDLES is 1: LinuxCNC has no spindle 1 for a live tool"),
    ("2", "", "", "problem", "motion.hal:2: loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO"),
    ("2", "2", "", "", ""),
    ("2", "[TRAJ]SPINDLES", "1", "", ""),
    (
        "2",
        "2",
        "3",
        "problem",
        "[G12] LIVE_SPINDLE = 3, but [TRAJ] SPINDLES is 2: LinuxCNC refuses",
    ),
    ("4", "3", "3", "problem", "motion.hal:2: loadrt [EMCMOT]EMCMOT"),
]


small_package = package_of(
    files_of_package(
        *(f"configs/include/spindle_c{end}" for end in (".hal", "_limits.sh", ".inc")),
        *(f"configs/kinematics/polar_{name}.hal" for name in ("kinematics", "tool_offset")),
        *("python/toplevel.py", "python/remap.py"),
    )
)


def pins_of(folder, text=PINS):
    path = folder.parent / f"{folder.name}.toml"
    path.write_text(text)
    return read_pins(path)


def installed(folder, text=LATHE, hal=HAL):
    ini = write_config(folder, text, "lathe.ini", motion_hal=hal)
    put_in(ini, features.SPINDLE_AS_C, pins=pins_of(folder))
    return ini


@pytest.fixture
def kinematics_module(tmp_path, monkeypatch):
    """LinuxCNC has the module of the kinematics."""
    monkeypatch.setattr(kinematics_rules, "module_file", lambda: tmp_path)
    monkeypatch.setattr(kinematics_rules, "is_outdated", lambda _: False)


def loaded(folder):
    """Return what the interpreter has loaded of a machine with the package."""
    return {"remap_file": "g12/python/remap.py", "package": folder / "g12" / "python" / "g12"}


def findings(ini):
    config = config_of(ini)
    return [*spindle_c_findings(config), *kinematics_findings(config)]


def test_check_finds_nothing_and_uninstall_gives_every_byte_back(tmp_path):
    ini = write_config(tmp_path, LATHE, "lathe.ini", motion_hal=HAL)
    assert list(spindle_c_findings(config_of(ini))) == []  # of a machine without it
    with restored(ini):
        installed(tmp_path)
        assert list(spindle_c_findings(config_of(ini))) == []


@pytest.mark.parametrize(
    "steps",
    [
        [["polar", "polar-kinematics", "spindle-c"]],
        [["polar", "spindle-c"], ["polar-kinematics"]],
        [["polar", "polar-kinematics"], ["spindle-c"]],
    ],
)
def test_the_kinematics_of_the_face_and_this_share_a_signal_in_each_order(
    tmp_path, kinematics_module, steps
):
    ini = write_config(tmp_path, LATHE, "lathe.ini", motion_hal=HAL)
    with restored(ini):
        for number, names in enumerate(steps):
            put_in(ini, *names, pins=pins_of(tmp_path), **(loaded(tmp_path) if number else {}))
        assert findings(ini) == []
        assert config_of(ini).ini.get("SPINDLE_C", "ENABLED") == "polar-enabled"


def test_a_copy_of_the_kinematics_hal_file_names_the_machines_own_signal(
    tmp_path, kinematics_module
):
    motion = f"{HAL}net machine-on motion.motion-enabled => lamp\n"
    ini = write_config(tmp_path, LATHE, "lathe.ini", motion_hal=motion)
    put_in(ini, "polar", features.KINEMATICS)
    assert [finding.kind for finding in findings(ini)] == ["pin-taken"]
    guard = kinematics_rules.GUARD_HAL
    copy = (features.ROOT / guard).read_text().replace("net polar-enabled ", "net machine-on ")
    (tmp_path / "own.hal").write_text(copy)
    ini.write_text(ini.read_text().replace(f"g12/{guard}", "own.hal"))
    assert findings(ini) == []
    pins = pins_of(tmp_path)
    put_in(ini, features.KINEMATICS, features.SPINDLE_AS_C, pins=pins, **loaded(tmp_path))
    assert config_of(ini).ini.get("SPINDLE_C", "ENABLED") == "machine-on"
    (tmp_path / "own.hal").write_text(copy.replace("machine-on", "[SPINDLE_C](ENABLED)"))
    assert findings(ini) == []


def test_what_is_written(tmp_path):
    text = installed(tmp_path).read_text()
    for lines in (
        "HALFILE = g12/configs/include/spindle_c.hal\n"
        "HALCMD = unlinkp drive.velocity\nHALCMD = net spindle-c-velocity => drive.velocity\n",
        "HALCMD = net spindle-c-brake => drive.brake\n"
        "HALCMD = loadusr sh g12/configs/include/spindle_c_limits.sh\n",
        "[SPINDLE_C]\nJOINT = 2\nTURNS = turns\nRPS = rps\nINDEX = index\n"
        "REACHED = spindle-c-always\nENABLED = sc-enabled\n",
        "COMMAND = c\n",
        "VELOCITY_SCALE = 60\nPOSITION_SCALE = 1\n",
    ):
        assert lines in text


def test_install_asks_for_the_pins(tmp_path):
    ini = write_config(tmp_path, LATHE, "lathe.ini", motion_hal=HAL)
    with pytest.raises(Refused) as refused:
        make_plan(config_of(ini), [features.SPINDLE_AS_C])
    assert [finding.kind for finding in refused.value.args] == ["pins"]
    assert "--pins spindle.toml" in refused.value.args[0].cure


@pytest.mark.parametrize(("old", "new", "said"), REFUSED)
def test_refused_for_what_the_machine_has(tmp_path, old, new, said):
    with pytest.raises(Refused) as refused:
        installed(tmp_path, LATHE.replace(old, new), HAL.replace(old, new))
    assert said in "".join(finding.text for finding in refused.value.args)


def without_c(text=LATHE):
    """Return a lathe's INI without C."""
    for old, new in (("xzc", "xz"), ("X Z C", "X Z"), ("JOINTS = 3", "JOINTS = 2")):
        text = text.replace(old, new)
    return text[: text.index("[AXIS_C]")]


def said_to(folder, text):
    """Return what install tells the owner of a lathe without C to write."""
    with pytest.raises(Refused) as refused:
        installed(folder, text, TURNS_ONLY)
    (finding,) = refused.value.args
    return finding.cure


def test_a_lathe_without_c_is_told_its_lines_and_with_them_it_is_installed(tmp_path):
    text = without_c()
    first, *lines = said_to(tmp_path, text).splitlines()
    assert "configs/spindle_c.md" in first
    blank = lines.index("")
    for line in lines[:blank]:
        section, key, value = re.fullmatch(r"(\[\w+\]) (\w+) = (.*)", line).groups()
        head, tail = text.split(section, 1)
        text = head + section + re.sub(rf"(?m)^{key} = .*", f"{key} = {value}", tail, count=1)
    assert "KINEMATICS = trivkins coordinates=XZC kinstype=B\nJOINTS = 3\n" in text
    assert "COORDINATES = X Z C\n" in text
    ini = installed(tmp_path, "\n".join((text, *lines[blank:], "")), TURNS_ONLY)
    assert list(spindle_c_findings(config_of(ini))) == []
    simulated = (features.ROOT / "configs" / "sim" / "lathe_spindle_c_mm.ini").read_text()
    assert "\n".join(lines[blank:]) in simulated  # that machine runs with these sections


def test_a_section_that_is_there_is_not_written_again(tmp_path):
    cure = said_to(tmp_path, f"{without_c()}\n[JOINT_2]\nTYPE = ANGULAR\n")
    assert "[AXIS_C]" in cure
    assert "[JOINT_2]" not in cure


@pytest.mark.parametrize("module", ["mykins", "trivkins", "trivkins coordinates=xzcc"])
def test_a_lathe_of_other_joints_is_told_the_page_alone(tmp_path, module):
    text = LATHE.replace("trivkins coordinates=xzc kinstype=B", module)
    assert said_to(tmp_path, text) == (
        "make C a joint of its own, as the steps in configs/spindle_c.md say"
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("velocity = 'a'", "position, holds: missing"),
        (f"{PINS}\nspeed = 'a'", "speed is none of velocity, position"),
        (PINS.replace("60", "'fast'"), "velocity_scale is a number, not 'fast'"),
        (PINS.replace("60", "9" * 400), "velocity_scale = 9999"),
        (f"{PINS}\ntimeout = -5", "timeout = -5: must be above 0"),
        (f"{PINS}\nindex_speed = 0", "index_speed = 0: must not be 0"),
        (f"{PINS}\ntolerance = inf", "tolerance = inf: must be 1e.09 at most"),
        (f"{PINS}\ntolerance = nan", "tolerance = nan: must be 1e.09 at most"),
        (PINS.replace('"drive.mode"', "3"), "holds is the name of a pin, not 3"),
        ("velocity", "Expected .=. after a key"),
    ],
)
def test_a_file_of_pins_that_says_something_else(tmp_path, text, said):
    with pytest.raises(UsageError, match=said):
        pins_of(tmp_path, text)


@pytest.mark.parametrize(("old", "new", "kind"), MISTAKES)
def test_check_finds(tmp_path, old, new, kind):
    ini = installed(tmp_path)
    text = ini.read_text()
    assert old in text
    ini.write_text(text.replace(old, new))
    found = list(spindle_c_findings(config_of(ini)))
    assert kind in [finding.kind for finding in found]


@pytest.mark.parametrize(("spindles", "loaded", "said", "level", "text"), LIVE)
def test_the_spindle_of_a_live_tool(tmp_path, spindles, loaded, said, level, text):
    lines = f"[TRAJ]\nSPINDLES = {spindles}\n" if spindles else "[TRAJ]\n"
    ini = LATHE.replace("[TRAJ]\n", lines) + "[EMCMOT]\nEMCMOT = motmod\n"
    ini += f"[G12]\nLIVE_SPINDLE = {said}\n" if said else ""
    joints = "num_joints=[KINS]JOINTS"
    hal = HAL.replace(joints, f"{joints} num_spindles={loaded}" if loaded else joints)
    found = list(live_spindle_missing(config_of(installed(tmp_path, ini, hal))))
    assert [finding.level for finding in found] == ([level] if level else [])
    assert "".join(finding.text for finding in found).startswith(text)


def test_no_live_tool_is_asked_for_without_it(tmp_path):
    ini = write_config(tmp_path, LATHE, "lathe.ini", motion_hal=HAL)
    assert list(live_spindle_missing(config_of(ini))) == []
