# SPDX-License-Identifier: GPL-2.0-or-later
"""The handlers of G12.1 and G13.1, whatever codes the REMAP lines give them."""

from __future__ import annotations

import functools
import os
from collections.abc import Iterator, Sequence
from pathlib import Path

import emccanon
import interpreter
import linuxcnc
from interpreter import INTERP_ERROR, INTERP_OK

from . import host, polar
from .context import YZ
from .errors import Refusal, number
from .frame import Frame
from .polar.block import Place, alone, line_named
from .program import Program
from .section import Section, Setup, block_of
from .settings import section_entries
from .travel import Axis, Scale, Travel, axes_from_ini

SWITCHED_OFF_BY = "polar_off"  # the handler's name in a REMAP line
DEFAULT_TOLERANCE_MM, DEFAULT_TOLERANCE_INCH = 0.005, 0.0002
LEAST_X_MM = 0.001  # a smaller part in X makes LinuxCNC 2.9 get the feed of a piece wrong
CLOSING_MM = 0.0127  # radius mismatch of an arc that LinuxCNC itself forgives
OTHER_WORDS = "abdhktuvwy"
OWNED_SINCE_KINS = "_kins_type"  # a LinuxCNC with this parameter has a G12.1 of its own


def ini_text() -> str:
    """Return the machine's INI file, as LinuxCNC names it to the interpreter."""
    path = os.environ.get("INI_FILE_NAME")
    return Path(path).read_text(encoding="utf-8", errors="replace") if path else ""


def remaps_from_ini(text: str) -> dict[str, dict[str, str]]:
    """Return the REMAP lines of an INI file: code in upper case, then its options."""
    lines = [value.split() for key, value in section_entries(text, "RS274NGC") if key == "REMAP"]
    return {
        code.upper(): dict(option.split("=", 1) for option in options if "=" in option)
        for code, *options in lines
    }


REMAPS = remaps_from_ini(ini_text())
AXES = axes_from_ini(ini_text())


def refuse_owned_codes(parameters: Sequence[str], remaps: dict[str, dict[str, str]]) -> None:
    """Refuse a REMAP of G12.1 where the interpreter has that code itself, and ignores the line."""
    owned = {"G12.1", "G13.1"} & remaps.keys()
    if owned and OWNED_SINCE_KINS in parameters:
        raise Refusal(
            f"REMAP = {min(owned)}: this LinuxCNC has a G12.1 of its own (kinematics selection). "
            "Use configs/include/polar_g12_3.inc and write G12.3 and G13.3 in programs"
        )


if hasattr(interpreter, "this"):  # milltask loads this module before its interpreter exists
    refuse_owned_codes(interpreter.this.params.globals(), REMAPS)


def polar_on(self, **words) -> Iterator[int]:
    """Handler of G12.1: a generator, since a section may have to wait for the machine."""
    try:
        host.refuse_start_error()
        if in_mdi(self):
            raise Refusal(
                f"{host.code_of_block(self)} is not possible in MDI: it needs the lines behind it"
            )
        yield from run_section(self, Frame(self), Program(self))
    except Refusal as refusal:
        self.set_errormsg(refusal.message)
        yield INTERP_ERROR
    yield INTERP_OK


def run_section(interp: object, frame: Frame, program: Program) -> Iterator[int]:
    """Run the section that begins with the block being remapped."""
    try:
        setup = setup_of_section(interp, Place(host.code_of_block(interp), program.place))
        yield from Section(interp, setup, frame, program).run()
    except Refusal as refusal:
        line = line_named(refusal)
        frame.give_up(
            line or program.line, called=program.in_sub_file and not line, home=program.home
        )
        raise


@host.handler
def polar_off(self, **words) -> int:
    """Handler of G13.1 outside a section, where it is a safety line; inside, it is never called."""
    return INTERP_OK


def setup_of_section(interp: object, place: Place) -> Setup:
    """Check that a section may begin here, and return what it needs to know."""
    code = place.code
    check_start(interp, place)
    settings, units = host.SETTINGS, host.program_units_per_machine_unit(interp)
    millimetre = host.snapshot(interp).length(1.0)
    tolerance = tolerance_of(settings) * units
    g7 = host.diameter_mode(interp)
    diameter = g7 if settings.polar_x == "inherit" else settings.polar_x == "diameter"
    off_code = code_switching_off(code)
    return Setup(
        code=code,
        off_code=off_code,
        on=number_of_code(code),
        off=number_of_code(off_code),
        diameter=diameter,
        x_scale=(0.5 if diameter else 1.0) / (0.5 if g7 else 1.0),
        x_factor=2.0 if g7 else 1.0,
        z_with_x=settings.polar_z == "allow",
        rapid_feed=settings.polar_g0_feed * units if settings.polar_g0 == "feed" else None,
        closing=CLOSING_MM * millimetre,
        blending=tolerance / 2,
        plan=polar.Settings(
            tolerance=tolerance,
            least_x=LEAST_X_MM * millimetre,
            x_acceleration=AXES["X"].acceleration * units,
            c_acceleration=AXES["C"].acceleration,
            c_speed=AXES["C"].velocity * 60,
            pole_refused=settings.polar_pole == "refuse",
        ),
        travel=Travel(AXES, scales_of_axes(interp, units)),
        remapped={
            int(name[1:]): "ngc" in options for name, options in REMAPS.items() if name[0] == "M"
        },
        tool_radius=functools.partial(tool_radius, interp),
    )


def check_start(interp: object, place: Place) -> None:
    """Refuse to begin a section where it cannot."""
    found = host.snapshot(interp)
    rules = (
        (stands_alone(interp), f"{place.code} stands alone in its block"),
        (not found.compensated, f"{place.code} needs G40: compensation is switched on inside"),
        (not found.inverse_time, f"{place.code} needs G94 or G95, not G93"),
        (found.plane != YZ, f"{place.code} needs G18 or G17, not G19"),
        (interp.rotation_xy == 0, f"{place.code} needs an unrotated work offset (G10 L2 R0)"),
        (
            found.x > 0,
            f"{place.code} needs the tool at X above zero, not at {number(found.x)} (radius)",
        ),
    )
    for holds, rule in rules:
        if not holds:
            raise place.refuse(rule)


def in_mdi(interp: object) -> bool:
    """Tell whether the block comes from MDI, where the next line could be that of an old program."""
    if not interp.task:
        return False
    status = linuxcnc.stat()
    status.poll()
    return status.task_mode == linuxcnc.MODE_MDI


def stands_alone(interp: object) -> bool:
    """Tell whether the block holds nothing but the code."""
    block = interp.blocks[interp.remap_level]
    return alone(block_of(block)) and not any(
        getattr(block, f"{word}_flag") for word in OTHER_WORDS
    )


def tolerance_of(settings: object) -> float:
    """Return POLAR_TOLERANCE in machine units."""
    if settings.polar_tolerance:
        return settings.polar_tolerance
    metric = emccanon.GET_EXTERNAL_LENGTH_UNITS() > 0.5  # machine units per mm
    return DEFAULT_TOLERANCE_MM if metric else DEFAULT_TOLERANCE_INCH


def tool_radius(interp: object) -> float | None:
    """Return the radius of the tool in the spindle in program units, None if there is none."""
    tool = host.tool_in_spindle(interp)
    return tool.radius if tool else None


def code_switching_off(code: str) -> str:
    """Return the code that ends a section begun by ``code``."""
    for name, options in REMAPS.items():
        if options.get("python") == SWITCHED_OFF_BY:
            return name
    return f"G{float(code[1:]) + 1:g}"


def number_of_code(code: str) -> int:
    """Return a G code as the parser numbers it: G12.1 is 121."""
    return round(float(code[1:]) * 10)


def scales_of_axes(interp: object, units: float) -> dict[str, Scale]:
    """Return how the program's X, Z and C become machine coordinates; ``units`` per machine unit."""
    offset = interp.tool_offset
    x = interp.origin_offset_x + interp.axis_offset_x + offset.x
    z = interp.origin_offset_z + interp.axis_offset_z + offset.z
    c = interp.CC_origin_offset + interp.CC_axis_offset + offset.c
    return {"X": Scale(1 / units, x / units), "Z": Scale(1 / units, z / units), "C": Scale(1.0, c)}
