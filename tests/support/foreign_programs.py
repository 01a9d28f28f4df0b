# SPDX-License-Identifier: GPL-2.0-or-later
"""Programs of other controls for tests: their machines, their options, and what they cut."""

import json
from contextlib import ExitStack
from functools import cache
from itertools import groupby

import pytest

from g12.tools.commands import translate
from g12.tools.machine.ini import read_ini
from g12.tools.preview.tracer import Tracer
from g12.tools.translate.blocks.control import read_control
from support.sim_machines import PROGRAMS, SIM

FOREIGN = PROGRAMS / "foreign"
MACHINES = {
    "haas-mill": "mill_inch",
    "fanuc-mill": "mill_mm",
    "yasnac-mill": "mill_yasnac_mm",
    "mitsubishi-mill": "mill_mitsubishi_mm",
    "fanuc-lathe": "lathe_mm",
    "haas-lathe": "lathe_inch",
    "mazak-lathe": "lathe_mm",
    "okuma-lathe": "lathe_mm",
}
BUILDERS_CODES = (133, 135, 154, 155, 200, 202, 203, 205, 110, 109, 146, 13, 12)
control_of = cache(read_control)
OPTIONS = json.loads((FOREIGN / "options.json").read_text(encoding="utf-8"))


def tracer_of(control, tools=None):
    """Return a Tracer of the machine that stands for a control's; lathes know builders' codes."""
    ini = read_ini(SIM / f"{MACHINES[control]}.ini")
    overrides = with_builders_codes(ini) if control.endswith("lathe") else {}
    return Tracer(ini, overrides=overrides, tools=tools)


def with_builders_codes(ini):
    """Return the overrides for a lathe that knows the codes of builders."""
    codes = [f"M{number} modalgroup=10 ngc=m35" for number in BUILDERS_CODES]
    remaps = [*ini.all("RS274NGC", "REMAP"), *codes]
    return {"RS274NGC": {"REMAP": remaps}, "TRAJ": {"SPINDLES": "2"}}


def kept_tracer_of(control):
    """Return a fixture: the Tracer of a control's machine, for the tests of a module."""

    @pytest.fixture(scope="module")
    def tracer():
        with tracer_of(control) as opened:
            yield opened

    return tracer


def kept_tracers():
    """Return a fixture: a function for the Tracer of a control's machine, opened once a module."""

    @pytest.fixture(scope="module")
    def tracers():
        with ExitStack() as stack:
            yield cache(lambda control: stack.enter_context(tracer_of(control)))

    return tracers


def translation(path, control, *options):
    """Return what the command prints for a program, without printing it."""
    requested = translate.command_parser().parse_args(
        ["--control", str(control), str(path), *options]
    )
    return translate.translated(
        requested, translate.changed(read_control(requested.control), requested)
    )


def path_of(traced):
    """Return the moves that go anywhere, without the lines that they come from."""
    assert traced.error is None, traced.error
    found, last = [], (0.0,) * 9
    for m in traced.moves:
        end = tuple(map(sum, zip(m.end, m.tool_offset)))  # where the machine stands
        plane = m.plane if m.kind == "arc" else 0
        if m.kind == "arc" or end != near(last):
            found.append((m.kind, end, m.centre, m.turns, m.feed, m.feed_mode, plane, m.tool))
        last = end
    return found


def assert_same_part(one, other):
    """Assert that two traces are the same moves at the same feeds, with the same events between."""
    left, right = path_of(one), path_of(other)
    for number, (a, b) in enumerate(zip(left, right)):
        for value, expected in zip(a, b):
            exact = isinstance(expected, str) or expected is None
            assert value == (expected if exact else near(expected)), (number, a, b)
    assert len(left) == len(right), (left[len(right) :], right[len(left) :])
    assert events(one) == events(other), (events(one), events(other))


def near(expected):
    """Return what equals a number, or each number of a tuple, to 1e-6."""
    return pytest.approx(expected, abs=1e-6)


def events(traced):
    """Return what a program does beside moving: spindle, coolant, tools, dwells."""
    texts = [event.text for event in traced.events if not event.text.startswith(("G5", "G6", "G4"))]
    return [text for text, _ in groupby(text for text in texts if text != "dwell 0")]
