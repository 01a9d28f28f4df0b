# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.1 and G7.1: real deviation, section times, interpreting time."""

import cmath
import math

import numpy as np

from bench import Figure
from bench.haas import against_plain
from g12.geometry.curve import Arc, Line
from g12.tools.preview.tracer import Tracer
from support.contour_geometry import Round, shape_of
from support.operated_machine import Machine
from support.polar_programs import INCHES, MILLIMETRES, feed_moves
from support.sim_machines import PROGRAMS, SIM

MM_PER_INCH = 25.4
SAMPLES = PROGRAMS / "polar"
MANUAL_TOOLS = {1: 0.5, 8: 0.0}
TOLERANCE = 0.005  # mm
LINES = 10000
LONGEST = 600  # s that a trace may take on a busy computer
BLOCKS = {"hexagon": range(10, 16), "manual_b": (14, 15, 16), "slot": (7,)}  # of the contour


def figures():
    """Yield the polar rows of the promised figures."""
    yield interpreting()
    with Machine(SIM / "lathe_mm.ini") as lathe:
        for name in MILLIMETRES:
            yield real_deviation("polar", name, proof_of(lathe, SAMPLES / f"{name}.ngc"), TOLERANCE)
        yield against_ideal(lathe, "hexagon", 250)
        for program in sorted((PROGRAMS / "cylinder").glob("*.ngc")):
            yield from on_cylinder(lathe, program)
    with Machine(SIM / "lathe_inch.ini", tools=MANUAL_TOOLS) as lathe:
        for name in INCHES:
            yield real_deviation(
                "polar", name, proof_of(lathe, SAMPLES / f"{name}.ngc"), 0.0002 * MM_PER_INCH
            )
        yield against_ideal(lathe, "manual_b", 250 / MM_PER_INCH)


def on_cylinder(lathe, program):
    """Yield the rows of a sample on the cylinder, run once at its own feed of F250."""
    proof = proof_of(lathe, program)
    yield real_deviation("cylinder", program.stem, proof, TOLERANCE)
    (section,) = proof.sections
    seconds, ideal = (section.values[name] for name in ("seconds", "seconds_programmed"))
    what = f"cylinder: section time against the ideal at F250, {program.stem}"
    yield Figure(what, seconds / ideal, 1.05, f"{seconds:.2f} s")


def proof_of(lathe, program):
    """Return the proof of a sample's motion on a machine as it came up."""
    lathe.reset()
    return lathe.proof_of_run(program.read_text())


def real_deviation(code, name, proof, tolerance):
    """Compare the motion of a program, sampled at 1 kHz, with what its words command."""
    what = f"{code}: real motion against the programmed contour, {name}"
    off = max(section.deviation for section in proof.sections)
    return Figure(what, off, tolerance + 0.001, "of the tool's centre, sampled at 1 kHz", " mm")


def against_ideal(lathe, name, feed):
    """Compare the time of a contour at F250 of millimetres with its length over the feed."""
    seconds = seconds_at(lathe, name, feed)
    length = sum(segment.length for segment in contour_of(name, lathe.ini))
    what = f"polar: section time against the ideal at F250, {name}"
    return Figure(what, seconds / (length / 250 * 60), 1.05, f"{seconds:.2f} s for {length:.1f} mm")


def contour_of(name, ini):
    """Return the toolpath of a sample's contour: parallels of its elements, arcs about corners."""
    with Tracer(ini, reports=True) as lathe:
        traced = lathe.trace(SAMPLES / f"{name}.ngc")
    cut, path = traced.cuts[0], []
    mm, radius = cut.report.frame.mm, traced.radius(cut.at)
    for each in cut.report.cut.elements:
        if each.line in BLOCKS[name] and each.start is not None:
            start, end = each.start * mm, each.end * mm
            curve = Arc(start, each.centre * mm, each.sweep) if each.centre else Line(start, end)
            own = shape_of(curve.offset(each.side * radius))
            if path and abs(own.start - path[-1].end) > TOLERANCE:
                turn = cmath.phase((own.start - start) / (path[-1].end - start))
                path.append(Round(path[-1].end, start, turn))
            path.append(own)
    return path


def interpreting():
    """Compare a section of 10,000 lines with the blocks it becomes."""
    head, ini = ["G21 G18 G8 G40 G64 G90 G94 F1000", "G0 X30 Z0 C0"], SIM / "lathe_mm.ini"
    section = [*head, "G12.1", *hexagons(), "G13.1", "M2"]
    with Tracer(ini) as tracer:
        moves = feed_moves(tracer.trace_text(section, timeout=LONGEST))
    plain = [f"G1 X{move.end[0]:.6f} C{move.end[5]:.6f} F{move.feed:.4f}" for move in moves]
    what = "polar: interpreting a 10,000-line section against the same path expanded"
    return against_plain(what, 2.0, ini, "T1 P1 D12", section, [*head, *plain, "M2"])


def hexagons():
    """Return the lines of hexagons of growing size, to and fro, so that C does not run away."""
    lines = ["G1 X16 C9"]
    for turn in range(LINES // 6):
        radius = 16 + turn % 100 * 0.01
        for corner in range(6) if turn % 2 else range(6, 0, -1):
            angle = math.radians(30 - 60 * corner)
            lines.append(f"X{radius * math.cos(angle):.4f} C{radius * math.sin(angle):.4f}")
    return lines


def seconds_in(run, blocks):
    """Return the time a run spent in blocks."""
    assert run.error is None, run.error
    return np.isin(run.samples.line, list(blocks)).sum() * 0.001


def seconds_at(lathe, name, feed):
    """Return the time of a sample's contour at another feed."""
    return seconds_in(lathe.run_text(at_feed(name, feed)), BLOCKS[name])


def at_feed(name, feed):
    """Return a sample whose contour has another feed."""
    lines = (SAMPLES / f"{name}.ngc").read_text().splitlines()
    for block in BLOCKS[name]:
        words = [word for word in lines[block - 1].split() if word[0] != "F"]
        lines[block - 1] = " ".join([*words, f"F{feed:.9g}"])
    return lines
