# SPDX-License-Identifier: GPL-2.0-or-later
"""The handlers of G12.1 and G13.1, whatever codes the REMAP lines give them."""

from __future__ import annotations

import functools
import os
from collections.abc import Iterator

import emccanon
import interpreter
import linuxcnc
from interpreter import INTERP_OK, MODE_ABSOLUTE

from g12.cycles.context import YZ
from g12.errors import Refusal, number
from g12.host import glue
from g12.host.call_frame import Frame
from g12.host.polar_section import Section, Setup
from g12.host.program_lines import Program
from g12.host.section_output import Emission
from g12.host.section_reader import Rules, block_of
from g12.machine_ini import (
    axes_of,
    code_number,
    coordinates_of,
    owns_g12_1,
    refuse_owned_codes,
    remap_lines,
)
from g12.polar import plan as polar
from g12.polar.soft_limits import Scale, Travel
from g12.section.block_rules import alone
from g12.section.line import Place, line_named

SWITCHED_OFF_BY = "polar_off"  # the handler's name in a REMAP line
LEAST_X_MM = 0.001  # a smaller part in X makes LinuxCNC 2.9 get the feed of a piece wrong
CLOSING_MM = 0.0127  # radius mismatch of an arc that LinuxCNC itself forgives
KINEMATICS_PARAMETER = "_kins_type"  # an interpreter that has it has a G12.1 of its own
OTHER_WORDS = "abdhktuvwy"
DROPPED_WORDS = "abcdhijkruvwxyz"  # nothing else in a block with G13.1 could read them
G96 = 960


INI = linuxcnc.ini(os.environ.get("INI_FILE_NAME") or os.devnull)
REMAPS = {remap.code: remap for remap in remap_lines(INI.findall)}
COORDINATES = set(coordinates_of(INI.find))


def check_at_start() -> None:
    """Say so, when LinuxCNC comes up, if it takes G12.1 for itself."""
    if hasattr(interpreter, "this"):
        owned = KINEMATICS_PARAMETER in interpreter.this.params.globals()
    else:  # milltask loads this module before its interpreter exists
        owned = owns_g12_1(linuxcnc.version)
    try:
        refuse_owned_codes(REMAPS, owned)
    except Refusal as refusal:
        glue.say_at_start(refusal)


check_at_start()


def polar_on(self, **words) -> Iterator[int]:
    """Read, plan and move a section: the handler of G12.1, which may have to wait."""
    try:
        glue.refuse_start_error()
        if in_mdi(self):
            code = glue.code_of_block(self)
            raise Refusal(f"{code} is not possible in MDI: it needs the lines behind it")
        program = Program(self, getattr(self, "g12_source", None))
        self.g12_source = program.home
        yield from run_section(self, Frame(self), program)
    except Exception as error:
        yield glue.refuse_block(self, error)
    yield INTERP_OK


@glue.handler
def polar_off(self, **words) -> int:
    """Do nothing: the handler of G13.1 outside a section, where it is a safety line."""
    block = self.blocks[self.remap_level]
    if any(getattr(block, f"{letter}_flag") for letter in DROPPED_WORDS):
        raise Refusal(f"{glue.code_of_block(self)} stands alone in its block")
    return INTERP_OK


def run_section(interp: object, frame: Frame, program: Program) -> Iterator[int]:
    """Run the section that begins with the block being remapped."""
    try:
        place = Place(glue.code_of_block(interp), program.place)
        check_start(interp, place)
        setup = setup_of_section(interp, place.code)
        emission = emission_of_section(interp, place.code)
        yield from Section(interp, setup, frame, program, emission).run()
    except Exception as error:
        line = line_named(error)
        called = program.source is not program.home and not line
        frame.give_up(line or program.line, called=called, home=program.home.filename)
        raise


def check_start(interp: object, place: Place) -> None:
    """Refuse to begin a section where it cannot."""
    code, found = place.code, glue.snapshot(interp)
    above = f"{code} needs the tool at X above zero, not at {number(found.x)} (radius)"
    rules = (
        ({"X", "C"} <= COORDINATES, f"{code} needs a machine with an X and a C axis"),
        (stands_alone(interp), f"{code} stands alone in its block"),
        (not found.compensated, f"{code} needs G40: compensation is switched on inside"),
        (not found.inverse_time, f"{code} needs G94 or G95, not G93"),
        (found.plane != YZ, f"{code} needs G18 or G17, not G19"),
        (
            G96 not in interp.active_g_codes,
            f"{code} needs G97: with G96 the speed would change with X",
        ),
        (
            not found.offset_pending,
            f"{code} needs a move after G40: the tool is still beside the programmed point",
        ),
        (interp.rotation_xy == 0, f"{code} needs an unrotated work offset (G10 L2 R0)"),
        (found.x > 0, above),
    )
    for holds, rule in rules:
        if not holds:
            raise place.refuse(rule)


def in_mdi(interp: object) -> bool:
    """Tell whether the block comes from MDI, where the next line could be an old program's."""
    if not interp.task:
        return False
    status = linuxcnc.stat()
    status.poll()
    return status.task_mode == linuxcnc.MODE_MDI


def stands_alone(interp: object) -> bool:
    """Tell whether the block holds nothing but the code."""
    block = interp.blocks[interp.remap_level]
    others = any(getattr(block, f"{word}_flag") for word in OTHER_WORDS)
    return alone(block_of(block)) and not others


def setup_of_section(interp: object, code: str) -> Setup:
    """Return what a section needs to know that begins with the block being remapped."""
    units, off_code = glue.program_units_per_machine_unit(interp), code_switching_off(code)
    axes = axes_of(INI.find, "XZC")
    mm = glue.millimetres_per_unit(interp)
    return Setup(
        rules=rules_of_section(interp, code),
        off_code=off_code,
        on=number_of_code(code),
        off=number_of_code(off_code),
        c=interp.CC_current,
        plan=polar.Settings(
            tolerance=tolerance() * units,
            least_x=LEAST_X_MM / mm,
            x_acceleration=axes["X"].acceleration * units,
            c_acceleration=axes["C"].acceleration,
            c_speed=axes["C"].velocity * 60,
            pole_refused=glue.SETTINGS.polar_pole == "refuse",
        ),
        travel=Travel(axes, scales_of_axes(interp)),
        remapped={
            remap.number[1] // 10: "ngc" in remap.keywords
            for remap in REMAPS.values()
            if remap.number[0] == "M"
        },
    )


def rules_of_section(interp: object, code: str) -> Rules:
    """Return how a section reads its words."""
    settings, units = glue.SETTINGS, glue.program_units_per_machine_unit(interp)
    g7 = glue.diameter_mode(interp)
    diameter = g7 if settings.polar_x == "inherit" else settings.polar_x == "diameter"
    return Rules(
        code=code,
        level=interp.call_level,
        diameter=diameter,
        x_scale=(0.5 if diameter else 1.0) / (0.5 if g7 else 1.0),  # G7 has halved it already
        z_with_x=settings.polar_z == "allow",
        rapid_feed=settings.polar_g0_feed * units if settings.polar_g0 == "feed" else None,
        closing=CLOSING_MM / glue.millimetres_per_unit(interp),
        tool_radius=functools.partial(tool_radius, interp),
    )


def emission_of_section(interp: object, code: str) -> Emission:
    """Return what hands the moves of a section over."""
    return Emission(
        interp,
        code,
        x_factor=2.0 if glue.diameter_mode(interp) else 1.0,
        blending=tolerance() / 2 * glue.program_units_per_machine_unit(interp),
        absolute=MODE_ABSOLUTE,
        canon=emccanon,
    )


def tolerance() -> float:
    """Return POLAR_TOLERANCE in machine units."""
    return glue.SETTINGS.tolerance(glue.millimetres_per_machine_unit())


def tool_radius(interp: object) -> float | None:
    """Return the radius of the tool in the spindle in program units, None if there is none."""
    tool = glue.tool_in_spindle(interp)
    return tool.radius if tool else None


def code_switching_off(code: str) -> str:
    """Return the code that ends a section begun by ``code``."""
    for name, remap in REMAPS.items():
        if remap.keywords.get("python") == SWITCHED_OFF_BY:
            return name
    return f"G{float(code[1:]) + 1:g}"


def number_of_code(code: str) -> int:
    """Return a G code as the parser numbers it: G12.1 is 121."""
    return code_number(code)[1]


def scales_of_axes(interp: object) -> dict[str, Scale]:
    """Return how the program's X, Z and C become machine coordinates."""
    factor, tool = 1 / glue.program_units_per_machine_unit(interp), interp.tool_offset
    x = interp.origin_offset_x + interp.axis_offset_x + tool.x
    z = interp.origin_offset_z + interp.axis_offset_z + tool.z
    c = interp.CC_origin_offset + interp.CC_axis_offset + tool.c
    return {"X": Scale(factor, x * factor), "Z": Scale(factor, z * factor), "C": Scale(1.0, c)}
