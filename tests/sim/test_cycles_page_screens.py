# SPDX-License-Identifier: GPL-2.0-or-later
"""The Cycles page in LinuxCNC's screens: filled in, refused, mended, opened, and cut as drawn."""

import json
import re
import shutil

import numpy as np
import pytest
from shapely.geometry import LineString, Point
from shapely.ops import unary_union

from g12.tools.cycles_page.interpreter import Sketcher
from g12.tools.cycles_page.machine import machine_state
from g12.tools.cycles_page.steps import read_program
from g12.tools.machine.ini import read_ini
from g12.tools.system import PYTHON
from support.sim_machines import ROOT, SIM
from support.x_screen import kept_display, launched

screen = kept_display()
OPERATOR = "../../tests/support/page_operator.py"
NGCGUI = re.compile(
    r"^(TKPKG|NGCGUI_|EMBED_TAB_NAME = Forms\nEMBED_TAB_LOCATION.*\nEMBED_TAB_COMMAND).*\n",
    re.MULTILINE,
)
PAGE_ALONE = """import sys
sys.path.insert(0, "python")
from g12.tools.cycles_page import gtk_view
from gi.repository import Gtk
builder = Gtk.Builder.new_from_file("configs/include/cycles.ui")
gtk_view.get_handlers(None, builder, [])
Gtk.main()
"""
LENGTH = 35.0  # mm, of T5
NEAR = 0.15  # mm: blended corners (G64), and 0.1 mm from one sample to the next


def operated(ini, display, folder):
    """Have the operator work at a screen's page; return what was seen, the program, the motion."""
    text = NGCGUI.sub("", ini.read_text())  # which takes its time
    text = text.replace("../../python/g12/tools/cycles_page/gtk_view.py", OPERATOR)
    text = text.replace("PROGRAM_PREFIX = ../../tests/programs", "PROGRAM_PREFIX = {folder}")
    with launched(ini, display, f"linuxcnc -r {ini}", text) as wait:
        scratch = []

        def is_done(_log, folder):
            scratch[:] = [folder]
            return (folder / "result.json").exists()

        log = wait(is_done)
        for name in ("result.json", "cycles.ngc", "samples"):
            if (scratch[0] / name).exists():
                shutil.copy(scratch[0] / name, folder)
    seen = json.loads((folder / "result.json").read_text())
    if "failed" in seen:
        pytest.fail(f"{seen['failed']}\n{log}")
    motion = np.fromfile(folder / "samples").reshape(-1, 6)[:, :3]
    with_tool = np.argmax(motion[:, 2] > LENGTH)
    return seen, (folder / "cycles.ngc").read_text(), motion[with_tool:]


@pytest.mark.parametrize("name", ["mill_mm", "mill_mm_gmoccapy"])
def test_two_steps_are_made_opened_and_cut_as_drawn(name, screen, tmp_path):
    seen, program, motion = operated(SIM / f"{name}.ini", screen, tmp_path)
    kind, sentence = seen["refused"]
    assert (kind, sentence[:46]) == ("refused", "G13: Q13 is greater than the tool diameter 12:")
    assert (seen["added_though_refused"], seen["steps"], seen["errors"]) == (0, 2, [])
    assert seen["ready"][0] == "ready"
    steps = read_program(program)
    assert [step.form.name for step in steps] == ["haas", "bore"]
    ini = read_ini(SIM / "mill_mm_headless.ini")
    sketcher = Sketcher(ini)
    drawn = [sketcher.sketch(step.form, step.call, machine_state(ini)).cut for step in steps]
    sketcher.close()
    cut = motion[motion[:, 2] < LENGTH - 0.01, :2]
    lines = unary_union([LineString(line) for part in drawn for line in part if len(line) > 1])
    assert max(lines.distance(Point(at)) for at in cut[::5]) < NEAR
    missed = [
        np.hypot(*(motion[:, :2] - at).T).min() for part in drawn for line in part for at in line
    ]
    assert max(missed) < NEAR
    assert np.hypot(*cut.T)[cut[:, 0] < 30].max() == pytest.approx(24 - 6, abs=0.01)
    assert np.hypot(*(cut[cut[:, 0] > 30] - (60, 0)).T).max() == pytest.approx(9 - 6, abs=0.01)
    assert motion[:, 2].min() == pytest.approx(LENGTH - 2, abs=1e-3)


def test_qtvcp_gets_the_number_of_the_window_that_it_embeds(screen):
    """QtVCP waits for it: GladeVCP 2.10 does not print it, so the page has to."""
    ini = SIM / "mill_mm.ini"
    page = f"cd {ROOT} && {PYTHON} -c '{PAGE_ALONE}'"
    embedded = f"export QTVCP_FORWARD_EVENTS_TO=1 INI_FILE_NAME={ini}; {page}"
    with launched(ini, screen, embedded) as wait:
        wait(lambda log, _folder: re.search(r"^\d+$", log, re.MULTILINE))
