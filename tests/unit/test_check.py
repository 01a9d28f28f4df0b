# SPDX-License-Identifier: GPL-2.0-or-later
"""What `check` finds in a config, each finding once; without LinuxCNC."""

import pytest

from g12.tools.commands import check
from g12.tools.commands.main import main
from g12.tools.install import package_copy
from g12.tools.install.config import features
from g12.tools.install.config.findings import NOTE, PROBLEM
from g12.tools.install.lathe import hal
from g12.tools.install.lathe.spindle_c import Pins
from g12.tools.install.rules import findings_of
from g12.tools.preview.tracer import python_error
from support.small_configs import (
    HAAS,
    LATHE,
    MILL,
    TURNING,
    TURNING_HAL,
    config_of,
    module_of_kinematics,
    put_in,
    with_lines,
    write_config,
)

module = module_of_kinematics()
HANDLERS = {name: "g12.remap" for f in features.CODES for name in features.functions_of(f)}
HANDLERS |= {"g12_on_abort": "g12.remap"}
PYTHON = "[PYTHON]\nTOPLEVEL = toplevel.py\n"
SUBS = "SUBROUTINE_PATH = ngc\n"
ABORT = "ON_ABORT_COMMAND = O <g12_on_abort> call\n"
GOOD = with_lines(MILL, "RS274NGC", f"{SUBS}{HAAS}{ABORT}") + PYTHON


@pytest.fixture
def found(tmp_path):
    """Return a function: the findings about an INI with everything else in order."""

    def find(text, remap=HANDLERS, files=(), **facts):
        remaps = [features.remaps_of(feature) for feature in features.CODES]
        names = {remap.keywords.get("ngc", "") for each in remaps for remap in each}
        names |= {sub for feature in features.FEATURES.values() for sub in feature.subs}
        subs = {f"ngc__{name}_ngc": "" for name in (*names, "g12_on_abort")}
        ini = write_config(tmp_path, text, toplevel_py="", **{**subs, **dict(files)})
        return findings_of(config_of(ini, remap=remap, **facts))

    return find


def lines_of(feature):
    return "".join(f"REMAP = {remap.text}\n" for remap in features.remaps_of(feature)) + ABORT


def kinds(findings):
    return [finding.kind for finding in findings]


def test_what_was_changed_in_the_copy_is_named(found, tmp_path):
    copy = tmp_path / "g12"
    listed = {f"ngc/{name}.ngc": b"one\ntwo\n" for name in ("g12_haas", "form_slot_mm", "lost")}
    package_copy.build(copy, tmp_path / "none", listed)
    assert found(GOOD) == []
    for name in ("g12_haas", "form_slot_mm"):
        (copy / "ngc" / f"{name}.ngc").write_text("one\n")
    (copy / "ngc" / "lost.ngc").unlink()
    changed = "was changed after it was installed"
    assert {(finding.level, finding.text) for finding in found(GOOD)} == {
        (PROBLEM, f"{copy}: missing: ngc/lost.ngc"),
        (NOTE, f"{copy}/ngc/form_slot_mm.ngc: {changed}"),
        (NOTE, f"{copy}/ngc/g12_haas.ngc: {changed}"),
    }


FIRST, SECOND = HAAS.splitlines()
OWN_G13 = "REMAP = g13 modalgroup=1 ngc=mine"
ON_LATHE = with_lines(LATHE, "RS274NGC", SUBS + lines_of("polar")) + PYTHON
NO_ABORT = {name: "g12.remap" for name in HANDLERS if name != "g12_on_abort"}
FILTER = "[FILTER]\nnc = python3 tools/g12 translate --control haas-mill\n"
COMMANDS = {"files": {"tools__g12__main_py": ""}}
ONE_FINDING = [  # an INI, what else is there, what is found and a part of what is said
    (MILL, {}, "no-codes", ""),
    (with_lines(GOOD, "RS274NGC", f"{OWN_G13}\n"), {}, "taken",
     f"mill.ini:5: G13 is remapped here already: {OWN_G13}"),
    (ON_LATHE, {"owned": {"G12.1"}}, "owned", "polar-g12.3"),
    (with_lines(LATHE, "RS274NGC", lines_of("polar")) + PYTHON, {}, "no-sub",
     "g12_skipped_over.ngc and g12_on_abort.ngc are in none of the folders"),
    (GOOD.replace("ngc=g12_haas", "ngc=g12_hass"), {}, "no-sub", "g12_hass.ngc is in none"),
    (GOOD.replace(ABORT, ""), {}, "on-abort", "ON_ABORT_COMMAND is missing: after an abort"),
    (GOOD.replace(ABORT, ABORT.upper().replace("O <", "o<")), {"remap": NO_ABORT}, "no-import",
     "remap, where LinuxCNC looks for handlers, has no g12_on_abort"),
    (GOOD.replace("O <g12_on_abort> call", "O <mine> call"), {}, "on-abort",
     "O <g12_on_abort> call, and [G12] ON_ABORT_COMMAND = O <mine> call"),
    (GOOD.replace("epilog=cycle_done", "epilog=cycle_don"), {}, "no-import", "has no cycle_don"),
    (GOOD + "[DISPLAY]\nPROGRAM_PREFIX = programs\n", {"files": {"programs__g12_haas_ngc": "x"}},
     "shadowed", "ngc is found before"),
    (GOOD.replace(PYTHON, ""), {"remap": {}}, "no-python", "TOPLEVEL is missing"),
    (GOOD, {"error": "No module named 'g12' (remap.py:1)"}, "python-fails", "PATH_APPEND"),
    (GOOD, {"remap": {**HANDLERS, "cycle_done": "remap"}}, "no-import", "has no cycle_done"),
    (GOOD + "[G12]\nCLEARING = squares\n", {}, "setting",
     "[G12] CLEARING = squares: must be rings or spiral"),
    (GOOD + "[G12]\nLIVE_SPINDLE = inf\n", {}, "setting", "[G12] LIVE_SPINDLE = inf: must be "),
    (GOOD + "[G12]\n[G12]\nPOLAR_Z = allow\n", {}, "setting", "[G12] occurs twice"),
    (GOOD + "[g12]\nPOLAR_Z = allow\n", {}, "setting", "[g12]"),
    (GOOD + "[G12]\nC_CLAMP = M8 M9\nC_CLAMP_SHAPES = M110\n", {"files": {"nc_files__M110": ""}},
     "setting", "[G12] C_CLAMP_SHAPES: M110 is no code of this machine: an executable file M110?"),
    (GOOD.replace("X Y Z", "X Z"), {}, "no-axis", "haas needs axis Y; [TRAJ] COORDINATES has X Z"),
    (with_lines(MILL, "RS274NGC", SUBS + lines_of("cylinder")) + PYTHON, {}, "no-axis",
     "cylinder needs axis C"),
    (with_lines(LATHE, "RS274NGC", SUBS + lines_of("polar-shapes")) + PYTHON, {}, "no-polar",
     "needs polar or polar-g12.3"),
    (GOOD + FILTER, COMMANDS, "filter", "nc is not for .NC files"),
    (GOOD + f"{FILTER}NC = mine\n", COMMANDS, "filter", "nc is not for .NC files"),
    (GOOD + "[FILTER]\ndyn = python3 gone/g12 dynapath\nDYN = python3 gone/g12 dynapath\n", {},
     "filter filter", "gone/g12 is not there"),
]  # fmt: skip


IN_ORDER = [  # an INI, what else is there
    (GOOD, {}),
    (ON_LATHE, {}),
    (with_lines(MILL.replace("X Y Z", "X Y Z A"), "RS274NGC", SUBS + lines_of("cylinder"))
     + PYTHON, {}),
    (GOOD + "[FILTER]\npy = python3\n[HAL]\nHALFILE = gone.hal\n", {}),
    (with_lines(LATHE, "RS274NGC", SUBS + lines_of("polar-g12.3") + lines_of("polar-shapes"))
     + PYTHON, {}),
]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "facts", "kind", "says"), [*ONE_FINDING, *((*row, "", "") for row in IN_ORDER)]
)
def test_one_thing_that_is_wrong_is_one_finding(found, text, facts, kind, says):
    findings = found(text, **facts)
    assert kinds(findings) == kind.split()
    assert says in "".join(f"{finding.text}\n{finding.cure}" for finding in findings)


def test_linuxcncs_own_word_only_where_nothing_else_explains_it(found):
    said = "toplevel here\n'x' is no function - 10:REMAP = M6\nBad character 'g' used\n"
    (failure,) = found(GOOD, failure=said)
    assert failure.kind == "does-not-load"
    assert "'x' is no function - 10:REMAP = M6" in failure.text
    assert kinds(found(GOOD.replace("= ngc\n", "= typo\n"), failure=said)) == ["no-sub"]


def test_python_errors_name_the_module_and_its_line():
    printed = (
        "initialize: module '/m/toplevel.py' init failed: \nTraceback (most recent call last):\n\n"
        '  File "/m/toplevel.py", line 4, in <module>\n    import remap\n\n'
        "ModuleNotFoundError: No module named 'remap'\n\n"
        "Python plugin configure() failed, status = -11\nPython plugin required for prolog=\n"
    )
    assert python_error(printed) == ("ModuleNotFoundError: No module named 'remap' (toplevel.py:4)")
    assert python_error("hello from toplevel\n") is None


# A lathe's kinematics, its spindle as C, its HAL files.


@pytest.fixture
def lathe(tmp_path, module):
    """Return the INI of a lathe with the kinematics and the spindle as C."""
    text = TURNING.replace("JOINTS = 3", "JOINTS = 3\n[EMCMOT]\nEMCMOT = motmod")
    text = text.replace("[TRAJ]\n", "[TRAJ]\nSPINDLES = 2\n")
    loading = TURNING_HAL.replace("num_joints", "num_spindles=[TRAJ]SPINDLES num_joints")
    ini = write_config(tmp_path, text, "lathe.ini", motion_hal=loading, later_hal="# nothing\n")
    drive = {"velocity": "drive.velocity", "position": "drive.position", "holds": "drive.mode"}
    numbers = {"TOLERANCE": 0.02, "ORIENT_SPEED": 0.5, "ORIENT_ACCELERATION": 1, "TIMEOUT": 30,
               "INDEX_SPEED": 0.25, "VELOCITY_SCALE": 1, "POSITION_SCALE": 1}  # fmt: skip
    put_in(ini, "polar", "polar-kinematics", "spindle-c", pins=Pins(drive, numbers))
    return ini


def found_of(ini):
    return findings_of(config_of(ini, remap=HANDLERS))


ADDED = "HALFILE = motion.hal\n"
GUARD = "HALFILE = g12/configs/kinematics/polar_kinematics.hal\n"
MISTAKES = [  # what is changed of the INI, what is found, a part of what is said
    ("KINEMATICS = polar_xzc coordinates=XZC", "KINEMATICS = trivkins coordinates=XZC", "kins",
     "KINEMATICS = trivkins coordinates=XZC"),
    ("polar_xzc coordinates=XZC", "polar_xzc coordinates=XYZC", "kins", "Y not"),
    ("JOINTS = 3", "JOINTS = 4", "kins", "JOINTS = 4"),
    ("COORDINATES = X Y Z C\n#", "COORDINATES = X Z C\n#", "coordinates", "lacks Y"),
    (GUARD, "", "kinematics-hal", "no HALFILE"),
    (ADDED, f"{GUARD}{ADDED}", "kinematics-hal", "after the one that loads motion"),
    ("MIN_LIMIT = -200\n#", "MIN_LIMIT = -5\n#", "face-axis", "MIN_LIMIT = -200 and MAX_LIMIT"),
    ("[AXIS_Y]", "[AXIS_Y]\nMAX_VELOCITY = 150", "face-axis", "MAX_VELOCITY is more"),
    ("MAX_ACCELERATION = 700\n#", "MAX_ACCELERATION = 1000\n#", "face-axis", "= 700 in both"),
    ("MAX_ACCELERATION = 700\n#", "MAX_ACCELERATION = 0\n#", "face-axis", "must be above 0"),
    (GUARD, f"{GUARD}HALCMD = net a => motion.adaptive-feed\n", "pin-taken",
     "HALCMD: net a => motion.adaptive-feed: motion.adaptive-feed is on polar"),
    ("later.hal\n", "later.hal\nHALCMD = loadrt trivkins\n", "kins", "loads trivkins"),
    ("JOINT = 2\n", "", "spindle-c", "JOINT = 2"),
    ("JOINT = 2\n", "JOINT = 1\n", "spindle-c", "has to be 2"),
    *((f"{key} = {usual}\n", f"{key} = {wrong}\n", "spindle-c", f"{key} = ") for key, usual, wrong
      in (("TIMEOUT", 30, 0), ("TIMEOUT", 30, "soon"), ("TIMEOUT", 30, 3601),
          ("ORIENT_SPEED", 0.5, "fast"), ("INDEX_SPEED", 0.25, 0))),
    ("TURNS = turns", "TURNS = other", "spindle-c", "TURNS = turns"),
    ("ENABLED = polar-enabled", "ENABLED = other", "spindle-c", "ENABLED = polar-enabled"),
    ("HALCMD = net spindle-c-holds => drive.mode\n", "", "spindle-c-hal", "uses spindle-c-holds"),
    ("HALCMD = loadusr sh g12/configs/include/spindle_c_limits.sh\n", "", "spindle-c-hal",
     "spindle_c_limits.sh"),
    ("HALCMD = unlinkp drive.mode\n", "HALCMD = net d => joint.2.motor-pos-fb\n", "pin-taken",
     "joint.2.motor-pos-fb is on sc-c-feedback already"),
    ("HALCMD = unlinkp drive.mode\n", "HALCMD = net index => joint.2.index-enable\n",
     "spindle-c-index", "shares the index"),
    ("HALCMD = unlinkp drive.mode\n", "HALCMD = loadrt sum2\n", "hal-module", "sum2 is loaded"),
    ("SPINDLES = 2", "SPINDLES = 1", "live-spindle", "SPINDLES is 1"),
    ("[G12]\n", "[G12]\nLIVE_SPINDLE = 3\n", "live-spindle", "no spindle 3"),
]  # fmt: skip


@pytest.mark.parametrize(("good", "bad", "kind", "says"), MISTAKES)
def test_a_mistake_on_a_lathe(lathe, good, bad, kind, says):
    text = lathe.read_text()
    assert good in text and found_of(lathe) == []
    lathe.write_text(text.replace(good, bad, 1))
    findings = [finding for finding in found_of(lathe) if finding.kind == kind]
    assert any(says in finding.text + finding.cure for finding in findings)


def test_a_module_that_is_missing_or_older(lathe, module):
    module.write_bytes(b"%s.centre")
    (old,) = found_of(lathe)
    module.unlink()
    (missing,) = found_of(lathe)
    for finding, says in ((old, "is older than this package"), (missing, "has no module")):
        assert (finding.level, finding.kind) == (PROBLEM, "no-kinematics")
        assert says in finding.text and "make kinematics" in finding.cure


FORMATS = {  # of pins, among other texts, in the files of modules
    "edge": ["%s.in-edge", "edge.%d"],
    "motmod": ["spindle.%d.on", "joint.%d.motor-pos-fb", "axis.%c.pos-cmd", "motion.enable"],
    "homemod": ["joint.%d.homed"],
    "pid": ["%s.command", "pid.%d", "%s.do-pid-calcs"],
    "charge_pump": ["%s.enable", "charge-pump"],
    "hm2_eth": ["hm2_eth: no board"],
    "hostmot2": ["%s.pwmgen.%02d.value", "%s: a message. with words"],
    "boss_plc": ["boss_plc.%d.%c-position-in"],
}
LINES = """\
loadrt motmod num_joints=3
loadrt pid names=x-pid,drive.pid
loadrt charge_pump
loadrt boss_plc
loadrt hostmot2
loadrt edge
loadrt unknown names=own
"""
MADE = (
    "joint.0.homed", "axis.c.pos-cmd", "motion.enable", "x-pid.command", "drive.pid.command",
    "x-pid.do-pid-calcs.time", "charge-pump.enable", "hm2_7i76e.0.pwmgen.00.value",
    "boss_plc.0.x-position-in", "own.command", "spindle.0.on", "edge.0.in-edge",
    "halui.mode.is-auto", "drive.brake",
)  # fmt: skip
MISSING = (
    "joint.2.motor-pos-fbb", "joint.0.home", "axis.c.pos-comd", "x-pid.comand", "motion.enabel",
    "charge-pump.enabled", "drive.pid.commands",
)  # fmt: skip


@pytest.fixture
def hal_findings(tmp_path, monkeypatch):
    """Return a function: what is found of HAL lines in a LinuxCNC with small modules."""
    for name, formats in FORMATS.items():
        texts = b"\0".join(form.encode() for form in formats)
        odd = b"xyza" if name == "boss_plc" else b""  # letters without an end
        (tmp_path / f"{name}.so").write_bytes(b"\x7fELF\0" + odd + texts + b"\0\xff")
    monkeypatch.setattr(hal, "linuxcnc_folder", lambda _: tmp_path)

    def find(lines, name="motion.hal"):
        ini = write_config(tmp_path, f"{MILL}[HAL]\nHALFILE = {name}\n")
        (tmp_path / name.removeprefix("LIB:")).write_text(LINES + lines)
        config = config_of(ini)
        return [*hal.pins_missing(config), *hal.pins_taken(config)]

    return find


NAMING = [  # a line, a pin
    *((line, "x-pid.comand") for line in
      ("setp {}", "unlinkp {}", "linkpp own.x {}", "linksp s {}", "linkps {} s")),
    *(("net a own.x => {}", pin) for pin in MISSING),
]  # fmt: skip


@pytest.mark.parametrize("name", ["motion.hal", "LIB:motion.hal"])
@pytest.mark.parametrize(("line", "pin"), NAMING)
def test_a_pin_that_no_module_makes_is_named(hal_findings, line, pin, name):
    command, _, rest = line.format(pin).partition(" ")
    (finding,) = hal_findings(f"{command} \\\n  {rest} # it\n", name)
    said = f"motion.hal:8: {command} {rest}: there is no pin {pin}: LinuxCNC does not start"
    assert finding.text == said


@pytest.mark.parametrize("line", ["net a own.x", "linkps own.x a", "linksp a own.x"])
def test_a_pin_on_two_signals_is_named(hal_findings, line):
    (finding,) = hal_findings(f"{line}\nnet b own.x\n")
    assert finding.text.startswith("motion.hal:9: net b own.x: own.x is on a already")


@pytest.mark.parametrize(
    "line",
    ["".join(f"setp {pin} 1\n" for pin in MADE), "net joint.0.nothing own.x",
     "addf x-pid.nothing t", "alias pin own.x x-pid.nothing\nsetp x-pid.nothing 1",
     "setp x-pid.$n 1", "net x-pid.nothing <= motion.enable",
     "net a own.x\nunlinkp own.x\nnet b own.x", "net a own.x =>\ndelsig a\nnet b own.x",
     "linkps own.x a\nlinksp a own.x"],
)  # fmt: skip
def test_what_is_in_order_in_hal_files(hal_findings, line):
    assert hal_findings(f"{line}\n") == []
    assert hal_findings("net a x-pid.comand\n", "motion.tcl") == []


# The command.


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("nowhere.ini", "no such file"),
        ("mill.tbl", "no [RS274NGC]"),
        ("mill.ini.expanded", "name mill.ini"),
        ("odd.ini", "holds NUL bytes"),
    ],
)
def test_wrong_use_is_one_line_and_exit_code_2(tmp_path, capsys, name, says):
    write_config(tmp_path, **{"mill.ini_expanded": MILL}, odd_ini=f"{MILL}\0")
    assert main(["check", str(tmp_path / name)]) == 2
    error = capsys.readouterr().err
    assert error.startswith("g12 check: ") and says in error
    assert error.count("\n") == 1


def test_the_report_says_what_is_there_and_what_is_wrong(tmp_path):
    config = config_of(write_config(tmp_path, GOOD + FILTER))
    said = list(check.report_of(config, findings_of(config)))
    meaning = "G12/G13 circular pocket, Haas words (mill.ini:6)"
    assert said[1] == f"  G12    haas         {meaning}"
    assert "  .nc    programs of haas-mill" in said
    assert any(line.startswith("problem [filter]: ") for line in said)
