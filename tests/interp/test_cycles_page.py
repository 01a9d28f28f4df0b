# SPDX-License-Identifier: GPL-2.0-or-later
"""The Cycles page on the simulated machines: drawn as typed, refused in words, a program."""

import os
import signal
import subprocess
import sys
import threading
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from g12.tools.cycles_page import page as page_module
from g12.tools.cycles_page.machine import MachineState, machine_state, open_in_linuxcnc, tools_of
from g12.tools.cycles_page.page import Page
from g12.tools.cycles_page.sketch import MESSAGE, READY, REFUSED
from g12.tools.errors import UsageError
from g12.tools.machine.ini import read_ini
from support.sim_machines import ROOT, SIM, copy_of_machines, trace_text, with_package

NOWHERE = MachineState({}, 0, (0.0,) * 9)


class Typed(Page):
    """A page with an operator who waits for the drawing."""

    def __init__(self, name, folder=SIM):
        self.drawn = threading.Event()
        super().__init__(folder / f"{name}_headless.ini", self.drawn.set)

    def wait(self):
        assert self.drawn.wait(60)
        return self.sketch

    def show(self, name, **texts):
        """Fill in a form and return its sketch."""
        form = next(form for form in self.forms if form.name == name)
        self.drawn.clear()
        self.select(form)
        self.wait()
        return self.fill(**texts)

    def fill(self, **texts):
        """Type into entries of the form and return its sketch."""
        for entry, text in texts.items():
            self.drawn.clear()
            self.type(entry, text)
            self.wait()
        return self.sketch


@pytest.fixture
def page(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    opened = []

    def of(name, state=NOWHERE, **options):
        monkeypatch.setattr(page_module, "machine_state", lambda _: state)
        opened.append(Typed(name, **options))
        return opened[-1]

    yield of
    for each in opened:
        each.close()


def test_a_machine_offers_the_forms_of_its_codes(page):
    names = [form.name for form in page("mill_yasnac_mm").forms]
    assert names == ["yasnac", "circle_mill", "bore", "thread", "frame"]
    assert len(page("lathe_mm").forms) == 5


POCKET = {"tool": "5", "i": "8", "k": "30", "q": "8"}


def test_a_pocket_is_drawn_to_its_wall(page):
    sketch = page("mill_mm").show("haas", **POCKET, x="3", levels="1")
    assert (sketch.state, sketch.radius) == (READY, 6.0)
    cut = np.concatenate(sketch.cut)
    assert np.hypot(*(cut - (3, 0)).T).max() + sketch.radius == pytest.approx(30, abs=1e-3)


def test_holes_round_a_bar_are_points_of_the_unrolled_surface(page):
    sketch = page("lathe_mm").show("side_holes", surface_diameter="40", height="2", count="4")
    assert sketch.text.startswith("on the unrolled surface: ")
    cut = np.concatenate(sketch.cut)
    assert sorted({*cut[:, 0].round(2)}) == pytest.approx([0, 34.56, 69.12, 103.67], abs=0.01)
    assert {*cut[:, 1].round(6)} == {-10.0}


def test_the_flats_of_a_polygon_are_where_they_are_typed(page):
    sketch = page("lathe_mm").show("polygon", across_flats="27", tool="1")
    assert (sketch.state, sketch.text.partition(":")[0]) == (READY, "on the face")
    assert np.hypot(*np.concatenate(sketch.cut).T).min() == pytest.approx(27 / 2 + 6, abs=0.01)


HAAS = {"i": "6", "k": "20", "q": "5"}
WRONG = [
    (
        "haas",
        {**HAAS, "i": "20", "k": "40", "tool": "5"},
        "G13: I20 is greater than 1.5 x the tool",
    ),
    ("circle_mill", {"tool": "5", "j": "30"}, "circle_mill: the roughing width 16.85 is greater"),
    ("haas", {**HAAS, "i": "1"}, "G13: I1 must be greater than the tool radius 3.175 (D1)"),
    ("haas", {**HAAS, "i": ""}, "first radius I: a number is missing"),
    ("haas", {**HAAS, "x": "490", "i": "8", "tool": "5"}, "the X axis would go to "),
    ("haas", {**HAAS, "tool": "77"}, "Requested tool 77 not found in the tool table"),
]


@pytest.mark.parametrize(("name", "texts", "said"), WRONG)
def test_what_is_wrong_is_said_in_the_cycle_s_words(page, name, texts, said):
    sketch = page("mill_mm").show(name, **texts)
    assert (sketch.state, sketch.text[: len(said)]) == (REFUSED, said)
    assert bool(sketch.cut) == ("axis" in said)


def test_travel_is_judged_with_work_offset_and_tool_length_and_depth_is_below_it(page):
    moved = MachineState({5220: 1.0, 5221: 490.0, 5223: 160.0}, 0, (0.0,) * 9)
    shown = page("mill_mm", state=moved)
    assert shown.show("haas", **POCKET, retract="5").text.startswith("the X axis would go to ")
    assert shown.fill(x="-100").text.endswith("at the programmed feeds, down to Z-4.000")
    text = "the Z axis would go to 305.000, beyond its limit 300"  # with 160, and 35 of T5
    assert shown.fill(retract="110").text == text


def test_the_default_tool_is_the_loaded_one_else_the_first_with_a_diameter(page):
    first = page("mill_mm")
    assert (first.texts["tool"], first.texts["q"], first.wait().state) == ("1", "4.44", READY)
    loaded = page("mill_mm", state=NOWHERE._replace(tool=4))
    assert (loaded.texts["tool"], loaded.tool()) == ("4", (10.0, "10 mm end mill"))
    loaded.type("tool", "0")  # which a form takes for the loaded one
    assert loaded.tool() == (10.0, "10 mm end mill")


def test_steps_become_a_program_that_cuts_and_are_read_back(page, tmp_path):
    made = page("mill_mm")
    for x in ("0", "80"):
        made.show("haas", **POCKET, levels="1", x=x)
        made.add()
    assert made.move(1, -1) == 0
    path = made.save(tmp_path / "cycles.ngc")
    trace = trace_text(path.read_text(), made.ini)
    assert trace.error is None and max(move.end[0] for move in trace.moves) > 80
    again = page("mill_mm")
    again.load(path)
    assert again.steps == made.steps


def test_a_refused_form_is_not_added_however_quick_the_operator(page):
    made = page("mill_mm")
    made.show("haas", **POCKET)
    made.type("i", "1")
    with pytest.raises(UsageError, match="I1 must be greater"):
        made.add()
    assert made.steps == []


def test_a_form_has_the_values_that_it_was_added_with(page):
    made = page("mill_mm")
    made.show("haas", tool="5", i="7.5", q="8")
    made.add()
    made.select(made.forms[1])
    made.select(made.forms[0])
    assert made.texts["i"] == "7.5"


def test_the_drawing_fills_its_place(page):
    sketch = page("mill_mm").show("haas", **POCKET)
    up = np.concatenate(sketch.cut)[:, 1]
    (_, pen, lines), *_ = sketch.strokes(400, 300)
    drawn = np.concatenate(lines)
    low, high = drawn.min(axis=0) - pen / 2, drawn.max(axis=0) + pen / 2
    assert high - low == pytest.approx([0.92 * 300] * 2, abs=0.1)
    assert drawn[up.argmax(), 1] == drawn[:, 1].min()
    assert (low + high) / 2 == pytest.approx([200, 150], abs=0.1)


def test_the_page_opens_and_draws_in_qt(tmp_path):
    """In a process of its own, under a screen that nobody sees; in GTK the screens do (sim)."""
    own = dict.fromkeys(("XDG_STATE_HOME", "XDG_RUNTIME_DIR"), str(tmp_path))
    environment = with_package(os.environ) | own | {"QT_QPA_PLATFORM": "offscreen"}
    script, picture = ROOT / "tests/support/qt_page.py", tmp_path / "page.png"
    command = ["/usr/bin/python3", script, SIM / "mill_mm_headless.ini", picture]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert picture.stat().st_size > 10_000


GARBAGE = "T1.2.3 P1 D4\nT P. D--\nT7 P7 D6..2 ;odd\nT99999999999 D1\n\xff\x00T2 P2 D8 ;good\n"


def test_garbage_in_the_tables_is_no_tool_and_no_offset(tmp_path, monkeypatch):
    monkeypatch.delenv("INI_FILE_NAME", raising=False)
    (tmp_path / "tool.tbl").write_text(GARBAGE, encoding="latin-1")
    (tmp_path / "saved.var").write_text("5221 1.5\n5222 two\n\u00b2 3\n5223 nan\n5224\n")
    ini = tmp_path / "machine.ini"
    ini.write_text(
        "[EMCIO]\nTOOL_TABLE = tool.tbl\n[RS274NGC]\nPARAMETER_FILE = saved.var\n"
        "[TRAJ]\nCOORDINATES = XYZ\nLINEAR_UNITS = mm\n"
    )
    assert tools_of(read_ini(ini))[2].diameter == 8
    assert machine_state(read_ini(ini)).parameters == {5221: 1.5}


def test_a_program_of_the_other_unit_is_not_loaded(page, tmp_path):
    inch, mm = page("mill_inch"), page("mill_mm")
    inch.show("bore")
    program = inch.save(tmp_path / "inch.ngc")
    with pytest.raises(UsageError, match=r"inch\.ngc: its forms are not those of a machine in mm"):
        mm.load(program)
    assert mm.steps == []


def test_turns_on_each_other_are_drawn_as_few(page):
    sketch = page("mill_mm").show("bore", p="0.001")
    assert sketch.state == READY and sum(map(len, sketch.cut)) < 2000
    cut = np.concatenate(sketch.cut)
    assert np.abs(cut[-1]).max() < 1e-6


@pytest.mark.parametrize(
    "name", ["mill_mm", "mill_inch", "mill_yasnac_mm", "mill_mitsubishi_mm", "lathe_mm"]
)
def test_every_form_is_ready_as_it_first_appears(page, name):
    page = page(name)
    said = {form.name: page.show(form.name) for form in page.forms}
    assert [(form, each.text) for form, each in said.items() if each.state == REFUSED] == []


@pytest.fixture
def machines(tmp_path):
    return copy_of_machines(tmp_path)


TABLES = [
    (b"T5 P5 D1e30\n", "mill_mm.tbl:1: D1E30: no number that a machine can have"),
    (None, "Requested tool 5 not found in the tool table"),
    (b"T5 P5 D70\n", "G13: I8 must be greater than the tool radius 35 (D5)"),
]


@pytest.mark.parametrize(("table", "said"), TABLES)
def test_a_tool_table_that_changes_is_read_again(page, machines, table, said):
    shown = page("mill_mm", folder=machines)
    assert shown.show("haas", **POCKET).state == READY
    path = machines / "mill_mm.tbl"
    before = path.read_bytes()
    path.unlink()
    if table:
        path.write_bytes(table)
    sketch = shown.fill(y="1")
    assert (sketch.state, said in sketch.text) == (REFUSED, True), sketch.text
    path.write_bytes(before)
    assert shown.fill(y="2").state == READY


def test_an_ini_edited_meanwhile_is_told_and_not_gone_by(page, machines):
    shown = page("mill_mm", folder=machines)
    shown.show("haas", **POCKET)
    shown.ini.path.write_text(shown.ini.path.read_text().replace("-500", "-1"))
    sketch = shown.fill(y="1")
    assert (sketch.state, len(sketch.cut) > 10) == (MESSAGE, True)
    assert sketch.text.startswith("mill_mm_headless.ini was edited: ")
    shown.ini.path.unlink()
    assert shown.fill(y="2").text == sketch.text


def interpreters(page):
    """Return the processes of a page's thread."""
    own = Path(f"/proc/self/task/{page._thread.native_id}/children").read_text()
    return [int(number) for number in own.split()]


def test_an_interpreter_yields_to_the_screen_and_when_it_dies_another_one_draws(page):
    shown = page("mill_mm")
    shown.show("haas", **POCKET)
    (interpreter,) = interpreters(shown)
    assert os.getpriority(os.PRIO_PROCESS, interpreter) > 0
    os.kill(interpreter, signal.SIGKILL)
    sketch = shown.fill(y="1")
    assert (sketch.state, sketch.text) == (REFUSED, "the interpreter died")
    assert shown.fill(y="2").state == READY


@pytest.mark.parametrize("text", [None, "\0", "[TRAJ]\nLINEAR_UNITS = cubit\n"])
def test_a_machine_that_cannot_be_read_is_a_sentence(page, tmp_path, text):
    if text:
        (tmp_path / "mill_headless.ini").write_text(text)
    shown = page("mill", folder=tmp_path)
    assert (shown.sketch.state, shown.entries, shown.tool()) == (REFUSED, (), None)
    assert "mill_headless.ini" in shown.sketch.text
    with pytest.raises(UsageError, match="mill_headless"):
        shown.save(tmp_path / "cycles.ngc")


def test_a_library_that_is_missing_is_a_sentence(page, monkeypatch):
    monkeypatch.setitem(sys.modules, "g12.tools.cycles_page.interpreter", None)
    assert "interpreter" in page("mill_mm").wait().text


def runs():
    return SimpleNamespace(interp_state=2, poll=lambda: None)


def broken():
    raise RuntimeError


OPENED = [
    (runs, "a program runs: stop it"),
    (broken, "LinuxCNC does not answer: the program is saved"),
]


@pytest.mark.parametrize(("status", "said"), OPENED)
def test_a_program_is_not_opened_over_one_that_runs(monkeypatch, status, said):
    linuxcnc = SimpleNamespace(stat=status, INTERP_IDLE=1)
    monkeypatch.setitem(sys.modules, "linuxcnc", linuxcnc)
    with pytest.raises(UsageError, match=said):
        open_in_linuxcnc("cycles.ngc")
