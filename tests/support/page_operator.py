# SPDX-License-Identifier: GPL-2.0-or-later
"""An operator at the Cycles page of a running screen: GladeVCP's handler in place of the page's.

It fills in, presses and reads the page's own widgets, then runs the program on the machine. What it
has seen is in result.json, the motion in samples, both in the folder of PROGRAM_PREFIX.
"""

import json
import os
import sys
import threading
import time
import traceback
from contextlib import suppress
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "tests")]

import linuxcnc  # noqa: E402
from gi.repository import GLib  # noqa: E402

from g12.tools.cycles_page import gtk_view  # noqa: E402
from g12.tools.headless.errors import MachineError  # noqa: E402
from g12.tools.headless.recording_screen import RecordingScreen  # noqa: E402

PATIENCE, START = 180.0, 10.0  # s, at most
PINS = [f"axis.{axis}.pos-cmd" for axis in "xyz"]
COMMON = {"tool": "5", "feed, mm/min": "6000", "retract height, mm": "2"}
POCKET = {**COMMON, "depth, Z, mm": "-1", "levels": "1", "first radius I, mm": "8",
          "finished radius K, mm": "24", "stepover Q, mm": "13"}  # fmt: skip
BORE = {**COMMON, "centre X, mm": "60", "depth, Z, mm": "-2", "radius I, mm": "9",
        "descent a turn P, mm": "0.5", "open radius K, mm": "0"}  # fmt: skip


class Operator(threading.Thread):
    """Works at the widgets of `cycles.ui`, in GTK's thread, from a thread of its own."""

    def __init__(self, builder, folder):
        super().__init__(daemon=True)
        self.builder, self.folder, self.result = builder, folder, {}

    def run(self):
        try:
            self.make_program()
            self.run_program()
        except BaseException:
            self.result["failed"] = traceback.format_exc()
        unfinished = self.folder / "result.new"
        unfinished.write_text(json.dumps(self.result))
        unfinished.rename(self.folder / "result.json")

    def make_program(self):
        self.choose("Circular pocket, Haas")
        self.fill(POCKET)
        self.result["refused"] = self.wait_for("Q13")
        self.press("Add")
        self.result["added_though_refused"] = self.steps()
        self.fill({"stepover Q, mm": "8,0"})
        self.result["ready"] = self.wait_for("from above")
        self.press("Add")
        self.choose("Bore along a helix")
        self.fill(BORE)
        self.wait_for("Z-2.000")
        self.press("Add")
        self.result["steps"] = self.steps()

    def run_program(self):
        screen = RecordingScreen(str(self.folder / "samples"), PINS)
        end = time.monotonic() + PATIENCE
        while not self.has_run(screen.panel, screen.sampler):
            # The screen still set the machine up: e-stop, manual mode.
            assert time.monotonic() < end, screen.panel.errors()
        screen.sampler.stop()
        # gmoccapy's own commands of the homed machine are refused where the program runs already.
        errors = screen.panel.errors()
        self.result["errors"] = [error for error in errors if " mode " not in str(error)]

    def has_run(self, panel, sampler):
        """Run the program; return whether it came to the place of its last step."""
        with suppress(MachineError):
            self.start_program(panel, sampler)
            panel.finish(PATIENCE)
        return abs(panel.poll().position[0] - float(BORE["centre X, mm"])) < 0.01

    def start_program(self, panel, sampler):
        opened = str(self.folder / "cycles.ngc")
        if panel.poll().file != opened:
            self.press("Open")
            panel.wait(lambda stat: stat.file == opened, PATIENCE, "program")
        panel.enable()
        panel.home()
        panel.errors(), panel.messages()
        sampler.start()
        panel.start()
        panel.wait(lambda stat: stat.interp_state != linuxcnc.INTERP_IDLE, START, "start")

    # What an operator sees and does.

    def do(self, action, *arguments):
        """Do something in GTK's thread and return what it returns."""
        done, results = threading.Event(), []

        def act():
            results.append(action(*arguments))
            done.set()

        GLib.idle_add(act)
        assert done.wait(PATIENCE), action
        return results[0]

    def object(self, name):
        return self.builder.get_object(name)

    def choose(self, title):
        titles = [row[1] for row in self.object("forms")]
        self.do(self.object("cycles").set_active, titles.index(title))

    def fill(self, texts):
        for label, text in texts.items():
            self.do(self.entry(label).set_text, text)

    def entry(self, label):
        grid = self.object("entries")
        rows = [row for row in range(99) if (cell := grid.get_child_at(0, row))
                and cell.get_text() == label]  # fmt: skip
        return grid.get_child_at(1, rows[0])

    def press(self, name):
        self.do(self.object(name).clicked)

    def steps(self):
        return len(self.object("steps").get_children())

    def wait_for(self, text):
        """Wait for a sentence with a text in it; return its kind and the sentence."""
        said, end = self.object("said"), time.monotonic() + PATIENCE
        while text not in self.do(said.get_text):
            assert time.monotonic() < end, (text, said.get_name(), said.get_text())
            time.sleep(0.02)
        return said.get_name(), said.get_text()


def get_handlers(halcomp, builder, options):
    handlers = gtk_view.get_handlers(halcomp, builder, options)
    ini = linuxcnc.ini(os.environ["INI_FILE_NAME"])
    Operator(builder, Path(ini.find("DISPLAY", "PROGRAM_PREFIX"))).start()
    return handlers
