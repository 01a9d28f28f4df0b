# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.1: real deviation, section times, interpreting time."""

import math

import numpy as np

from bench import Figure
from bench.haas import against_plain
from g12.tools.preview.tracer import Tracer
from support.contour_geometry import FROM_COLUMNS, distance, spaced
from support.operated_machine import Machine
from support.polar_programs import INCHES, MILLIMETRES, Cut, feed_moves, toolpath_of
from support.sim_machines import PROGRAMS, SIM

MM_PER_INCH = 25.4
SAMPLES = PROGRAMS / "polar"
MANUAL_TOOLS = {1: 0.5, 8: 0.0}
TOLERANCE = 0.005  # mm
LINES = 10000
LONGEST = 600  # s that a trace may take on a busy computer
HEXAGON_BLOCKS, FLAT_BLOCKS = range(10, 16), (14, 15, 16)


def figures():
    """Yield the polar rows of the promised figures."""
    yield interpreting()
    with Machine(SIM / "lathe_mm.ini") as lathe:
        for name in MILLIMETRES:
            yield real_deviation(lathe, name, TOLERANCE)
        yield against_ideal(lathe, "hexagon", "F250", HEXAGON_BLOCKS)
        yield against_equal_angles(lathe)
    with Machine(SIM / "lathe_inch.ini", tools=MANUAL_TOOLS) as lathe:
        for name in INCHES:
            yield real_deviation(lathe, name, 0.0002 * MM_PER_INCH)
        yield against_ideal(lathe, "manual_b", f"F{250 / MM_PER_INCH:.6f}", FLAT_BLOCKS)


def real_deviation(lathe, name, tolerance):
    """Compare the motion of a sample program, sampled at 1 kHz, with what its words command."""
    lathe.reset()
    proof = lathe.proof_of_run((SAMPLES / f"{name}.ngc").read_text())
    return Figure(
        f"polar: real motion against the programmed contour, {name}",
        max(section.deviation for section in proof.sections),
        tolerance + 0.001,
        " mm",
        "of the tool's centre, sampled at 1 kHz",
    )


def against_ideal(lathe, name, feed, blocks):
    """Compare the time of a contour at F250 with its length over the feed."""
    program = at_feed((SAMPLES / f"{name}.ngc").read_text(), feed, blocks)
    seconds = seconds_in(lathe.run_text(program), blocks)
    length = sum(segment.length for segment in contour_of(name, lathe.ini, blocks))
    return Figure(
        f"polar: section time against the ideal at F250, {name}",
        seconds / (length / 250 * 60),
        1.05,
        "",
        f"{seconds:.2f} s for {length:.1f} mm",
    )


def against_equal_angles(lathe):
    """Compare the hexagon at F1000 with the coarsest equal angles of the same tolerance."""
    text = (SAMPLES / "hexagon.ngc").read_text()
    ours = seconds_in(lathe.run_text(at_feed(text, "F1000", HEXAGON_BLOCKS)), HEXAGON_BLOCKS)
    segments = contour_of("hexagon", lathe.ini, HEXAGON_BLOCKS)
    points = np.concatenate([equal_angles(segment) for segment in segments])
    lathe.mdi("G21 G90 G94 G8 G0 Z5")
    theirs = lathe.run_text(blocks_of(points, 1000))
    seconds = seconds_in(theirs, range(5, 5 + len(points)))
    return Figure(
        "polar: section time against equal angles of the same tolerance, F1000, hexagon",
        ours / seconds,
        1.0,
        "",
        f"{ours:.2f} s against {seconds:.2f} s for {len(points)} equal angles "
        f"(which leave the contour by {distance_of(theirs, segments):.4f} mm)",
    )


def contour_of(name, ini, blocks):
    """Return the toolpath of some lines of a sample program."""
    path = toolpath_of(name, ini)
    return [segment for block in blocks for segment in path[block]]


def distance_of(run, segments):
    """Return how far a run leaves a contour."""
    return distance(Cut(run).points @ FROM_COLUMNS, segments).max()


def equal_angles(segment, tolerance=TOLERANCE):
    """Return the fewest points on a segment, at equal C angles, whose X-C moves stay near it."""
    fine = spaced(segment, 0.002)
    radii, angles = abs(fine), np.unwrap(np.angle(fine))
    if angles[-1] < angles[0]:
        radii, angles = radii[::-1], angles[::-1]
    for count in range(1, 10000):
        at = np.linspace(angles[0], angles[-1], count + 1)
        straight = np.interp(angles, at, np.interp(at, angles, radii))
        if segment.distance(straight * np.exp(1j * angles)).max() <= tolerance:
            break
    x = np.interp(at, angles, radii)
    if (segment.start * np.exp(-1j * at[0])).real < x[0] - 1e-6:
        x, at = x[::-1], at[::-1]
    return np.column_stack([x[1:], at[1:]])


def blocks_of(points, feed):
    """Return a program of straight X-C moves, each with the F that makes ``feed`` on the part."""
    angles = np.degrees(np.unwrap(points[:, 1]))
    start = (19.5**2 + 12**2) ** 0.5, math.degrees(math.atan2(12, 19.5))
    blocks, before = [], start
    for x, c in zip(points[:, 0], angles):
        plane = [
            (r * math.cos(math.radians(a)), r * math.sin(math.radians(a)))
            for r, a in ((x, c), before)
        ]
        minutes = math.dist(*plane) / feed
        dx = abs(x - before[0])
        rate = dx / minutes if dx > 0.001 else abs(c - before[1]) / minutes
        blocks.append(f"G1 X{x if dx > 0.001 else before[0]:.6f} C{c:.6f} F{rate:.6f}")
        before = (x if dx > 0.001 else before[0], c)
    head = ["G21 G18 G8 G90 G94 G64 P0.0025", f"G0 X{start[0]:.6f} C{start[1]:.6f}", "Z2", "(cut)"]
    return [*head, *blocks, "M2"]


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


def at_feed(text, feed, blocks):
    """Return a sample program whose blocks run at another feed."""
    lines = text.splitlines()
    for block in blocks:
        words = [word for word in lines[block - 1].split() if word[0] != "F"]
        lines[block - 1] = " ".join([*words, feed])
    return lines
