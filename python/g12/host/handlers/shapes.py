# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.4 and G13.4, the first and the last block of the subs of shapes and holes.

G12.4 takes the entries of the call from the sub's named locals, checks the shape as a whole, and
sets the locals of its motion. G13.4 restores the modes before G12.4.
"""

from __future__ import annotations

from interpreter import INTERP_OK

from g12.errors import Refusal
from g12.host import borrowed, messages
from g12.host.call_frame import locals_at, set_locals_at
from g12.host.handlers import sections
from g12.host.interp import Interp
from g12.host.interp_state import feed_spindle, read_state
from g12.host.kinematics_switch import face_in_force
from g12.host.machine import MACHINE
from g12.host.section_output import STOP_HERE
from g12.polar.polar_section import POLE_SHARE, Polar
from g12.section.effects import SectionStart, code_of_handler
from g12.section.line import BlockLocation
from g12.shapes import holes, pockets, polygon
from g12.shapes.entries import Extent, ShapeEntries, ShapeMachine, ShapePlan, check_nearest
from g12.shapes.holes import HoleMachine
from g12.state import beyond_travel

check_at_start = sections.check_ini
SHAPE_CALLS = {  # names of the entries, planner
    "polar_polygon": (polygon.POLYGON_ENTRIES, polygon.plan_polygon),
    "polar_slot": (pockets.SLOT_ENTRIES, pockets.plan_slot),
    "polar_pocket": (pockets.ROUND_POCKET_ENTRIES, pockets.plan_round_pocket),
}
SUB_OF_HOLES = "g12_holes"  # which all of these call
HOLE_CALLS = {
    "face_holes": (holes.FACE_HOLES, holes.plan_face_holes),
    "side_holes": (holes.SIDE_HOLES, holes.plan_side_holes),
    "face_hole_at": (holes.FACE_HOLE_AT, holes.plan_face_hole_at),
}


@messages.handler
def polar_shape(self, **words):
    """Check the shape of the calling sub, and set the locals of its motion: G12.4.

    Holes run in G61 as drilling cycles do. With blended rapids C would turn before the tool is out
    of its hole, or before the move that precedes the call has ended.
    """
    messages.settle(self)
    name, level = shape_at_work(self)
    if face_in_force(self):
        raise Refusal(sections.FACE_ON, name)
    section = Polar(start_of_shape(self, name), sections.section_machine())
    names = HOLE_CALLS[name][0] if name in HOLE_CALLS else SHAPE_CALLS[name][0]
    entries = ShapeEntries(name, names, locals_at(self, level), read_state(self))
    prepare = plan_of_holes if name in HOLE_CALLS else plan_of_shape
    plan = prepare(self, entries, section)
    set_locals_at(self, self.call_level - 1, plan.locals)
    messages.begin_cut(self, name, entries.given, plan.cut())
    borrowed.begin(self)
    self.execute(f"{STOP_HERE}G61" if name in HOLE_CALLS else STOP_HERE)
    return INTERP_OK


def plan_of_shape(interp: Interp, entries: ShapeEntries, section: Polar) -> ShapePlan:
    machine, (_, planner) = shape_machine(section), SHAPE_CALLS[entries.code]
    plan = planner(entries, machine)
    check_nearest(entries, plan.extent, machine)
    stay_in_travel(entries, plan.extent, section)
    own: dict[str, float] = {
        "x_word": 1 + section.rules.diameter,
        "x_rapid": 1 + section.state.diameter,
    }
    # on a wrapped axis a sign is the direction of the turn, and 360 is refused
    if interp.c_axis_wrapped:
        own["start_angle"] = plan.locals["start_angle"] % 360.0 % 360.0  # -1e-20 % 360 is 360
    return plan._replace(locals={**plan.locals, **own, **section_codes(entries)})


def plan_of_holes(interp: Interp, entries: ShapeEntries, section: Polar) -> ShapePlan:
    sections.check_clamp(entries.refuse)
    close, opens = MACHINE.settings.c_clamp or (0, 0)
    machine, (_, planner) = hole_machine(interp, section), HOLE_CALLS[entries.code]
    plan = planner(entries, machine)
    stay_in_travel(entries, plan.extent, section)
    own = {"clamp": close, "unclamp": opens, "spindle": machine.spindle}
    x_words = {name: plan.locals[name] * (1 + section.state.diameter) for name in ("x", "x_axis")}
    return plan._replace(locals={**plan.locals, **x_words, **own})


def hole_machine(interp: Interp, section: Polar) -> HoleMachine:
    spindle = tool_spindle(interp)
    turning = type(interp).spindle_turning.fget(interp, spindle)  # a property with an argument
    return HoleMachine(
        c=section.state.c,
        spindle=spindle,
        spindle_code=DIRECTION_M_CODES.get(turning, 5),
        speed=interp.speed[spindle],
        beside=section.beside,
        diameters=section.rules.diameter,
    )


@messages.handler
def polar_shape_done(self, **words):
    """Restore the modes before the shape, F and the spindle in use among them: G13.4."""
    shape_at_work(self)
    borrowed.give_back(self)
    messages.end_cut(self)
    return INTERP_OK


DIRECTION_M_CODES = {2: 3, 3: 4}  # M codes by CANON_DIRECTION; 1: stopped
LIVE_SPINDLE = 1  # where the main spindle is C


def tool_spindle(interp: Interp) -> int:
    """Return the number of the tool's spindle, never that of a spindle that is C."""
    if MACHINE.spindle_c_code and interp.num_spindles > LIVE_SPINDLE:
        return LIVE_SPINDLE
    return feed_spindle(interp)


def shape_at_work(interp: Interp) -> tuple[str, int]:
    """Return the name of the sub that the program calls, and its call level.

    The code is in that sub, or in the one that moves for all holes; elsewhere it is refused.
    """
    level, code = interp.call_level - 1, messages.code_of_block(interp)
    moves_for_holes = interp.sub_context[level].subname == SUB_OF_HOLES
    level -= moves_for_holes
    name = interp.sub_context[level].subname
    if name not in (HOLE_CALLS if moves_for_holes else SHAPE_CALLS):
        *names, last = *SHAPE_CALLS, *HOLE_CALLS
        where = f"belongs in the subs {', '.join(names)} and {last}: call one of them"
        raise Refusal(where, code)
    if not sections.is_alone(interp.blocks[interp.remap_level]):
        raise Refusal("must be alone in its block", code)
    return name, level


def start_of_shape(interp: Interp, name: str) -> SectionStart:
    line = messages.line_of(interp, name) or 0
    start = sections.start_of_section(interp, 0)
    state = start.state._replace(x=1.0)  # the sub itself moves the tool to its start
    return start._replace(location=BlockLocation(name, line), state=state)


def shape_machine(section: Polar) -> ShapeMachine:
    beside = section.beside
    return ShapeMachine(
        diameters=section.rules.diameter,
        entry_angle=MACHINE.settings.entry_angle,
        plunge_share=MACHINE.settings.plunge_feed / 100,
        pole=POLE_SHARE * section.tolerance,
        pole_refused=section.pole_refused,
        nearest=abs(beside) + section.tolerance if beside else 0.0,
    )


def section_codes(entries: ShapeEntries) -> dict[str, float]:
    remaps = MACHINE.remaps.values()
    numbers = {}
    for name in ("polar_on", "polar_off"):
        code = code_of_handler(remaps, name)
        if code is None:
            raise entries.refuse(f"needs a REMAP line with python={name}")
        numbers[name] = code
    return numbers


def stay_in_travel(entries: ShapeEntries, extent: Extent, section: Polar) -> None:
    """Refuse a shape that leaves the travel of an axis."""
    at = section.state.on_machine
    ends = zip("XCZ", (extent.x, extent.c, extent.z))
    ranges = [(axis, at(axis, low), at(axis, high)) for axis, (low, high) in ends]
    limits, diameters = section.machine.axes, section.rules.diameter
    beyond = beyond_travel(section.state, limits, ranges, diameters=diameters)
    if beyond:
        raise entries.refuse(beyond.rule)
