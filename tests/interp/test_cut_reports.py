# SPDX-License-Identifier: GPL-2.0-or-later
"""The reports of cuts on the stock interpreter: where they come, what with them, who gets none.

What each planner reports is in unit/test_cut_report.py.
"""

import math
import subprocess

import pytest

from g12.cut_report import CUT, END, CutElement, ProgramFrame, UsedCutter
from g12.tools.machine.ini import read_ini
from g12.tools.preview.tracer import TraceFailure, Tracer
from support.clamped import with_clamp
from support.sim_machines import SIM

MILL = ["G21 G17 G90 G94 G40 G49", "T1 M6", "S1000 M3", "F300", "G0 X0 Y0 Z1"]
LATHE = ["G21 G18 G90 G94 G8 G40", "T1 M6", "S1000 M3", "F300", "G0 X30 Z2 C0"]
TOOLS = {1: 10.0, 2: 4.0}


def reported(machine, lines, tools=TOOLS, **more):
    """Return the trace of a program that ends after some lines, which LinuxCNC accepts."""
    with Tracer(SIM / f"{machine}.ini", tools=tools, reports=True, **more) as tracer:
        trace = tracer.trace_text([*lines, "M2"])
    assert trace.error is None
    return trace


# ---------------------------------------------------------------- where they come


def test_a_report_has_the_moves_of_its_block():
    trace = reported("mill_mm", [*MILL, "G13 X10 I6 K20 Q4 Z-3 D1", "G0 Z1", "X50", "G12 I6 Z-1"])
    first, second = trace.cuts
    assert (first.at, first.line, first.last_line) == (1, 6, 6)
    assert trace.moves[1].end[:3] == pytest.approx((10.0, 0.0, 1.0)) and first.end == second.at - 2
    assert second.end == len(trace.moves) and second.report.cut.wall == 6.0


def test_a_pocket_reports_the_state_that_linuxcnc_has():
    lines = [*MILL[:-1], "G10 L2 P1 X10 Y5 Z-2 R30", "G0 X0 Y0 Z1", "G52 X1", "G20"]
    report = reported("mill_mm", [*lines, "G91 G13 I.3 Z-.1 D1 F20"]).cuts[0].report
    assert report.frame == ProgramFrame(
        25.4,
        pytest.approx(((10 + 0.8660254) / 25.4, 5.5 / 25.4, -2 / 25.4, 0.0)),
        30.0,
        shifted=True,
    )
    assert report.at == pytest.approx((-1 / 25.4, 0.0, 1 / 25.4, 0.0))
    assert (report.feed, report.per_revolution, report.incremental) == (20.0, False, True)
    assert report.words == {"I": 0.3, "Z": -0.1, "D": 1.0}


@pytest.mark.parametrize(
    ("before", "cutter"),
    [
        ([], UsedCutter(5.0, "loaded", 1)),
        (["G13 I6 D2", "G10 L1 P2 R3"], UsedCutter(2.0, "last D", 2)),
        (["G13 I6 D2", "G41 D1 G1 X20", "G40 G1 X0", "G1 X0"], UsedCutter(5.0, "last D", 0)),
    ],
)
def test_a_pocket_without_d_has_the_cutter_of_the_last_one(before, cutter):
    assert reported("mill_mm", [*MILL, *before, "G13 I6"]).cuts[-1].report.cut.cutter == cutter


def test_a_call_is_reported_with_its_entries_and_its_own_section_is_not():
    call = "o<polar_polygon> call [6] [20] [2] [30] [0] [-9999] [-9999] [400] [-9999] [10]"
    (cut,) = reported("lathe_mm", [*LATHE, call]).cuts
    assert (cut.report.code, cut.line, cut.report.cut.angle) == ("polar_polygon", 6, 10.0)
    assert cut.report.words["across_flats"] == 20.0 and "allowance" not in cut.report.words


HOLES = "o<face_holes> call [4] [20] [0] [-9999] [5] [2] [100] [0] [0] [0]"
SECTION = ["G12.1", "G1 G42 X20 F300", "C5", "G40 X30", "G13.1"]


def test_an_element_of_a_section_has_its_side_even_with_a_cutter_of_no_size():
    cut = reported("lathe_mm", [*LATHE, *SECTION], tools={1: 0.0}).cuts[0]
    assert (cut.line, cut.last_line) == (6, 10)
    assert cut.report.cut.elements == (
        CutElement(7, -1, 0.0, 300.0, 2.0, 2.0, 30 + 0j, 20 + 0j),
        CutElement(8, -1, 0.0, 300.0, 2.0, 2.0, 20 + 0j, 20 + 5j),
        CutElement(9, 0, 0.0, 300.0, 2.0, 2.0, 20 + 5j, 30 + 5j),
    )


def test_a_section_on_a_cylinder_is_reported_on_its_unrolled_surface():
    """On ⌀ 36 / pi a turn is 36 mm: a degree is a tenth of one."""
    lines = ["G0 X40 Z-10 C20", "G7.1 C[18/3.14159265358979]", "G1 X5 F200", "C50", "G2 Z-12 K-1"]
    cut = reported("lathe_mm", [*LATHE, *lines, "G3 W-2 H20 R5", "G7.1 C0"]).cuts[0].report.cut
    plunge, line, arc, bow = cut.elements
    assert cut.surface == pytest.approx(18 / math.pi)
    assert (plunge.z0, plunge.z1, plunge.end) == (40.0, 5.0, None)
    assert (line.start, line.end) == pytest.approx((2 - 10j, 5 - 10j)) and line.z1 == 5.0
    assert (arc.end, arc.centre) == pytest.approx((5 - 12j, 5 - 11j)) and arc.sweep < 0
    assert bow.end == pytest.approx(7 - 14j) and 0 < bow.sweep < math.pi


def test_a_section_reports_the_modes_before_its_first_line():
    lines = [*LATHE, "F200", "G0 C30", "G12.1", "G1 X20 F300", "G91", "G95 F.2", "G13.1"]
    report = reported("lathe_mm", lines).cuts[0].report
    assert (report.at, report.feed) == ((30.0, 0.0, 2.0, 30.0), 200.0)
    assert not (report.per_revolution or report.incremental)


def test_what_follows_m66_continues_the_section():
    lines = [*LATHE, "G12.1", "G1 X20", "M66 P0 L0", "Z-1", "G13.1", "G0 Z2"]
    trace = reported("lathe_mm", lines)
    (cut,) = trace.cuts
    assert [each.line for each in cut.report.cut.elements] == [7, 9]
    assert (cut.at, cut.end, cut.last_line) == (1, len(trace.moves) - 1, 10)


def test_a_section_in_a_file_of_its_own_names_it_and_its_own_lines(tmp_path):
    lines = ["o<flat> sub", "(the flat)", *SECTION, "o<flat> endsub"]
    (tmp_path / "flat.ngc").write_text("\n".join([*lines, ""]))
    path = read_ini(SIM / "lathe_mm.ini").get("RS274NGC", "SUBROUTINE_PATH")
    own = {"RS274NGC": {"SUBROUTINE_PATH": f"{path}:{tmp_path}"}}
    (cut,) = reported("lathe_mm", [*LATHE, "o<flat> call"], overrides=own).cuts
    assert (cut.line, cut.report.file, cut.report.line, cut.last_line) == (6, "flat.ngc", 3, 7)


# ---------------------------------------------------------------- what comes with them


@pytest.mark.parametrize(
    ("between", "how"),
    [
        (["G0 Z5"], ""),
        (["G0 C[2*15]"], "angle"),
        (["G28", "G0 X30 Z2"], "angle"),
        (["G91 G0 C30", "G90"], "increment"),
        (["G91 G0 C30", "G90 G0 C0"], "angle"),
    ],
)
def test_it_is_known_how_c_was_commanded_since_the_cut_before(between, how):
    first, second = reported("lathe_mm", [*LATHE, *SECTION, *between, *SECTION]).cuts
    assert (first.c_commanded, second.c_commanded) == ("angle", how)


def test_events_show_the_codes_of_the_clamp(tmp_path):
    lines = [*LATHE, "M10", "G0 Z5", "M11", *SECTION]
    overrides = with_clamp("lathe_mm", tmp_path, C_CLAMP_SHAPES="M12")
    trace = reported("lathe_mm", lines, overrides=overrides)
    told = [(each.at, each.text) for each in trace.events if each.text.startswith("clamp ")]
    end = trace.cuts[0].end
    assert told == [(1, "clamp M10"), (2, "clamp M11"), (2, "clamp M12"), (end, "clamp M11")]
    with Tracer(SIM / "lathe_mm.ini", overrides=overrides, tools=TOOLS) as tracer:
        silent = tracer.trace_text([*lines, "M2"])
    assert silent.moves == trace.moves and silent.cuts == []
    assert not any(each.text.startswith("clamp ") for each in silent.events)


# ---------------------------------------------------------------- who gets none


def test_another_preview_shows_nothing_of_them(tmp_path):
    """``rs274`` prints every canonical call, as a screen's preview gets them."""
    program = tmp_path / "program.ngc"
    lines = [*LATHE, "(a comment)", "G12.1", "G1 X20", "G13.1", HOLES, "M2"]
    program.write_text("\n".join([*lines, ""]))
    with Tracer(SIM / "lathe_mm.ini", tools=TOOLS) as tracer:
        table, ini = (tracer.folder / name for name in ("tool.tbl", "machine.ini"))
        command = ["rs274", "-g", "-i", ini, "-t", table, "-v", tmp_path / "own.var", program]
        done = subprocess.run(command, capture_output=True, text=True, cwd=SIM)
    seen = done.stdout
    assert "PROGRAM_END" in seen, done.stderr
    assert CUT not in seen and END not in seen


OTHERWISE = f"""\
import sys
sys.path.insert(0, "{SIM.parents[1] / "python"}")
import remap
from g12 import cut_report
def other(report, text_of=cut_report.report_text):
    return text_of(report).replace('schema": 1', 'schema": 9')
cut_report.report_text = other
"""


def test_a_machine_whose_package_reports_otherwise_is_named(tmp_path):
    (tmp_path / "toplevel.py").write_text(OTHERWISE)
    overrides = {"PYTHON": {"TOPLEVEL": str(tmp_path / "toplevel.py")}}
    says = pytest.raises(TraceFailure, match="reports its cuts by schema 9, this one reads 1")
    options = {"tools": TOOLS, "reports": True, "overrides": overrides}
    with Tracer(SIM / "mill_mm.ini", **options) as tracer, says:
        tracer.trace_text([*MILL, "G13 I6 Z-1 D1", "M2"])
