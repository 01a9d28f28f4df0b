# SPDX-License-Identifier: GPL-2.0-or-later
"""Pins that HAL lines name and no module makes; the modules' files are small ones."""

import pytest

from g12.tools.install.lathe import hal, hal_pins
from g12.tools.install.lathe.hal_pins import missing_pin, modules_of, pins_missing
from support.small_configs import MILL, config_of, write_config

FILES = {  # the formats of pins among other texts
    "edge": ["%s.in-edge", "edge.%d"],
    "sim_spindle": ["%s.scale"],
    "motmod": [
        "spindle.%d.on",
        "joint.%d.motor-pos-cmd",
        "joint.%d.motor-pos-fb",
        "axis.%c.pos-cmd",
        "motion.enable",
    ],
    "homemod": ["joint.%d.homed"],
    "pid": ["%s.command", "%s.feedback", "pid.%d", "%s.do-pid-calcs"],
    "mux2": ["%s.in0", "%s.sel", "mux2.%d"],
    "charge_pump": ["%s.enable", "charge-pump"],
    "hm2_eth": ["hm2_eth: no board"],
    "hostmot2": ["%s.pwmgen.%02d.value", "%s: a message. with words"],
    "boss_plc": ["boss_plc.%d.%c-position-in"],
}
LINES = """\
loadrt motmod num_joints=3
loadrt pid names=x-pid,drive.pid
loadrt mux2 count=2
loadrt charge_pump
loadrt boss_plc
loadrt hostmot2
loadrt edge
loadrt sim_spindle names=spindle
loadrt unknown names=own
"""
MADE = (
    "joint.2.motor-pos-cmd", "joint.0.homed", "axis.c.pos-cmd", "motion.enable",
    "x-pid.command", "drive.pid.feedback", "x-pid.do-pid-calcs.time", "mux2.1.sel",
    "charge-pump.enable", "hm2_7i76e.0.pwmgen.00.value", "boss_plc.0.x-position-in",
    "own.command", "spindle.0.on", "spindle.scale", "edge.0.in-edge",
    "halui.mode.is-auto", "drive.brake",
)  # fmt: skip
MISSING = {  # a pin that is not, and the nearest one
    "joint.2.motor-pos-fbb": "joint.2.motor-pos-fb",
    "joint.0.home": "joint.0.homed",
    "axis.c.pos-comd": "axis.c.pos-cmd",
    "x-pid.comand": "x-pid.command",
    "drive.pid.sel": "drive.pid.feedback",
    "mux2.1.cel": "mux2.1.sel",
    "motion.enabel": "motion.enable",
    "charge-pump.enabled": "charge-pump.enable",
}


@pytest.fixture(autouse=True)
def modules(tmp_path, monkeypatch):
    folder = tmp_path / "modules"
    folder.mkdir()
    for name, formats in FILES.items():
        texts = b"\0".join(form.encode() for form in formats)
        odd = b"xyza" if name == "boss_plc" else b""  # letters without an end
        (folder / f"{name}.so").write_bytes(b"\x7fELF\0" + odd + texts + b"\0\xff")
    monkeypatch.setattr(hal_pins, "linuxcnc_folder", lambda _: folder)
    monkeypatch.setattr(hal, "linuxcnc_folder", lambda _: None)
    return folder


def config_with(folder, lines, name="motion.hal"):
    ini = write_config(folder, f"{MILL}[HAL]\nHALFILE = {name}\n[EMCMOT]\nEMCMOT = motmod\n")
    (folder / name).write_text(lines)
    return config_of(ini)


@pytest.mark.parametrize("pin", MADE)
def test_a_pin_that_a_module_makes_or_may_make_is_not_missing(tmp_path, pin):
    config = config_with(tmp_path, LINES)
    assert missing_pin(pin, modules_of(config, hal.all_hal(config))) is None


@pytest.mark.parametrize(("pin", "nearest"), MISSING.items())
def test_a_pin_that_no_module_makes_is_named_with_the_nearest(tmp_path, pin, nearest):
    config = config_with(tmp_path, f"{LINES}net a own.x => \\\n  {pin} # it\n")
    (finding,) = pins_missing(config)
    assert finding.text == (
        f"motion.hal:10: net a own.x => {pin}: there is no pin {pin}: LinuxCNC does not start"
    )
    assert finding.cure == f"write {nearest}, if that is meant"


@pytest.mark.parametrize(
    "line",
    ["setp {}", "setp {} 1", "unlinkp {}", "linkpp own.x {}", "linksp s {}", "linkps {} s"],
)
def test_each_command_that_names_a_pin_is_read(tmp_path, line):
    (finding,) = pins_missing(config_with(tmp_path, f"{LINES}{line.format('x-pid.comand')}\n"))
    assert "there is no pin x-pid.comand" in finding.text


@pytest.mark.parametrize(
    "line",
    ["net joint.0.nothing own.x", "addf x-pid.nothing t", "alias pin own.x x-pid.nothing\n"
     "setp x-pid.nothing 1", "setp x-pid.$n 1", "net x-pid.nothing <= motion.enable"],
)  # fmt: skip
def test_what_is_no_pin_of_a_module_is_not_missing(tmp_path, line):
    assert list(pins_missing(config_with(tmp_path, f"{LINES}{line}\n"))) == []


def test_a_tcl_file_is_not_judged(tmp_path):
    lines = f"{LINES}net a x-pid.comand\n"
    assert list(pins_missing(config_with(tmp_path, lines, "motion.tcl"))) == []


def test_a_hal_file_of_linuxcncs_own_is_read(tmp_path, monkeypatch):
    library = tmp_path / "library"
    library.mkdir()
    (library / "core.hal").write_text("setp motion.enabel 1\n")
    monkeypatch.setattr(hal, "linuxcnc_folder", lambda _: library)
    for name in ("LIB:core.hal", "core.hal"):
        ini = write_config(tmp_path, f"{MILL}[HAL]\nHALFILE = {name}\n")
        (finding,) = pins_missing(config_of(ini))
        assert finding.text.startswith("core.hal:1: setp motion.enabel 1")
