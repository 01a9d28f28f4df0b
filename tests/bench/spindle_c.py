# SPDX-License-Identifier: GPL-2.0-or-later
"""The spindle that becomes C: jumps at 200 changes, threads and flats before and after ten."""

from bench import Figure
from support.spindle_lathe import (
    FIRST,
    FLATS,
    SPINDLE_LATHE,
    TEN_CHANGES,
    SpindleLathe,
    angle_of_flat,
    changes_of,
    jumps,
    motor_jumps,
    pitch_and_start,
    random_changes,
)

SEED = 7
MOST = 0.05  # degrees
PITCH = 1.5
THREAD = ["S400 M3", "G0 X20 Z5", f"G33 Z-8 K{PITCH}", "G0 X25", "M5"]
PARTS = [*FIRST, *FLATS, *THREAD, *TEN_CHANGES, *THREAD, *FLATS, "M2"]


def figures():
    """Yield the figures of one lathe."""
    with SpindleLathe(SPINDLE_LATHE) as lathe:
        yield from at_changes(lathe)
        yield from before_and_after(lathe)


def at_changes(lathe):
    """Look at a hundred changes each way, at random angles and speeds, sampled at 1 kHz."""
    run = lathe.run_text([*FIRST, *random_changes(SEED, 100)], timeout=1200)
    assert run.error is None, run.error
    changes = [at for both in changes_of(run.samples) for at in both]
    assert len(changes) == 200
    command, feedback, error = jumps(run.samples, changes)
    how = "200 changes, 50 ms before and after each"
    for what, value, limit in (
        ("step of C's command", command, 0.0),
        ("step of C's feedback", feedback, MOST),
        ("following error of C", error, MOST),
        ("step of the motor", motor_jumps(run.samples, changes) / 1000, MOST),
    ):
        yield Figure(f"spindle as C: {what} at a change", value, limit, how, "°")


def before_and_after(lathe):
    """Compare a thread and a flat before and after ten changes."""
    run = lathe.run_text(PARTS, timeout=300)
    assert run.error is None, run.error
    lines = [number for number, block in enumerate(PARTS, 1) if "G33" in block]
    before, after = (pitch_and_start(run.samples, line)[0] for line in lines)
    what = "spindle as C: pitch of G33 after ten changes against before"
    yield Figure(what, abs(after / before - 1), 0.005, f"{before:.5f} and {after:.5f} mm")
    lines = [number for number, block in enumerate(PARTS, 1) if block == "X20 C-20"]
    before, after = (angle_of_flat(run.samples, line) for line in lines)
    what = "spindle as C: a flat after ten changes against before"
    yield Figure(what, abs(after - before), MOST, f"{before:.4f}° and {after:.4f}°", "°")
