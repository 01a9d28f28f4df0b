# SPDX-License-Identifier: GPL-2.0-or-later
"""Every INI that ships: starts, runs a program to its end, and is twin to its twin."""

import pytest

from g12.tools.machine.ini import read_ini
from support.kinematics import marked
from support.operated_machine import Machine, smoke
from support.sim_machines import SIM, copy_of_machines
from support.x_screen import kept_display, launched

INIS = sorted(SIM.glob("*.ini"))
HEADLESS = [ini for ini in INIS if ini.stem.endswith("_headless")]
GMOCCAPY = [ini for ini in INIS if ini.stem.endswith("_gmoccapy")]
DESKTOP = [ini for ini in INIS if ini not in (*HEADLESS, *GMOCCAPY)]
OF_EACH_KIND = [SIM / f"{kind}_headless.ini" for kind in ("mill_mm", "lathe_mm_kinematics")]
SCREENS = [SIM / f"{kind}.ini" for kind in (
    "mill_helix_mm", "lathe_inch", "lathe_mm_kinematics", "lathe_spindle_c_mm",
)]  # fmt: skip
RUN_HERE = [ini for ini in DESKTOP if ini.stem != "lathe_spindle_c_inch"]  # in test_spindle_c
screen = kept_display()
QUICK = "G21 G90\n(MSG, hello)\nG1 X2 F3000\nM0\nG0 Z1\nM2\n"
HARMLESS = (
    "Attribute error",  # gmoccapy, of each desktop setting that it cannot copy
    "[GladeVCP.QTVCP.QT_ISTAT]",  # of each entry of [DISPLAY] that it does without
    "emc.ini: error: Cannot open",  # ngcgui in AXIS on 2.10, for the keys of its entries
)


def name(ini):
    return ini.stem


def sample(ini):
    return read_ini(ini).file("DISPLAY", "OPEN_FILE")


@pytest.mark.parametrize("ini", marked(RUN_HERE), ids=name)
def test_every_machine_runs_its_sample_to_the_end(ini):
    with Machine(ini) as machine:
        machine.feed_override(10.0)
        result = machine.run(sample(ini), timeout=300)
        assert result.error is None
        assert result.seconds > 0.5


@pytest.mark.parametrize("ini", marked(OF_EACH_KIND), ids=name)
def test_linuxcnc_runs_a_program_without_a_screen_and_exits_with_0(ini, tmp_path):
    program = tmp_path / "quick.ngc"
    program.write_text(QUICK)
    code, log = smoke(ini, program, timeout=300)
    assert code == 0, log
    assert "message: hello" in log
    assert f"{program}: done" in log


def test_linuxcnc_exits_with_1_if_the_program_has_an_error(tmp_path):
    program = tmp_path / "bad.ngc"
    program.write_text("G21\nG1 X2 Q\nM2\n")
    code, log = smoke(HEADLESS[0], program, timeout=300)
    assert code == 1
    assert "error: No characters found in reading real value" in log
    assert f"{program}: FAILED" in log


def test_linuxcnc_runs_the_sample_if_no_program_is_named(tmp_path):
    machines = copy_of_machines(tmp_path)
    (machines / "samples" / "mill_mitsubishi_mm.ngc").write_text(QUICK)
    code, log = smoke(machines / "mill_mitsubishi_mm_headless.ini", timeout=300)
    assert code == 0, log
    assert "samples/mill_mitsubishi_mm.ngc: done" in log


def log_of_screen(ini, screen, component, done="up\n", text=None):
    """Return LinuxCNC's log once its screen is up and ``done`` stands in it."""
    started = f"until halcmd -s show comp {component} | grep -q {component}; do sleep 0.2; done"
    command = f"linuxcnc -r {ini} & {started}; sleep 3; echo up; wait"
    with launched(ini, screen, command, text) as wait:
        return wait(lambda log, _: done in log)


@pytest.mark.parametrize("ini", [*marked(SCREENS), *GMOCCAPY], ids=name)
def test_its_screen_comes_up_with_the_sample_previewed(ini, screen):
    log = log_of_screen(ini, screen, "gmoccapy" if ini in GMOCCAPY else "axisui")
    reported = "\n".join(line for line in log.splitlines() if not line.startswith(HARMLESS))
    assert "rror" not in reported and "Missing required" not in reported, log


LOOK = """
def look():
    views = [commands.set_view_y, commands.set_view_z, commands.set_view_p]
    seen = []
    for _ in range(3):
        next_face_view()
        seen.append(o.get_view())
    print("views", seen, widgets.view_z.winfo_manager(), flush=True)
root_window.after(1500, look)
"""


def test_axis_shows_the_face_on_a_lathe(screen, tmp_path):
    """As on a machine with LATHE = 1: its views are plane 1, face 2, perspective 3."""
    commands = tmp_path / "look.py"
    commands.write_text((SIM.parent / "include/axis_face.py").read_text() + LOOK)
    ini = SIM / "lathe_mm.ini"
    text = ini.read_text().replace("../include/axis_face.py", str(commands))
    log = log_of_screen(ini, screen, "axisui", "views ", text)
    assert "views [2, 3, 1] pack" in log
