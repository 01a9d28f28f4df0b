# SPDX-License-Identifier: GPL-2.0-or-later
"""Surprises on a lathe whose spindle is C: the screen's picture, the turns of C, G28."""

import re
from collections.abc import Iterator

from g12.lengths import DEGREES_PER_TURN
from g12.tools.install.config import features
from g12.tools.install.config.findings import ConfigFinding, note, warning
from g12.tools.install.config.loaded import Config
from g12.tools.install.config.screen import screen_of
from g12.tools.install.lathe.kinematics_rules import uses_face_kinematics
from g12.tools.machine.stored_positions import unset_positions

WITH_PREVIEW = ("axis", "gmoccapy", "gscreen", "qtvcp", "touchy")
GEOMETRY_LINE = re.compile(r"GEOMETRY = CXY?Z!")
ON_A_LATHE = tuple(features.AXES_NEEDED)


def geometry_for(axes: str) -> str:
    """Return the GEOMETRY of a lathe's axes: C, which rotates the part, before the slides."""
    return f"C{''.join(axis for axis in 'XYZ' if axis in axes)}!"


def without_geometry(config: Config) -> Iterator[ConfigFinding]:
    found = config.ini.get("DISPLAY", "GEOMETRY") or ""
    letters = found.upper()
    turns_first = 0 <= letters.find("C") < letters.find("X")
    if screen_of(config) in WITH_PREVIEW and not turns_first:
        yield warning(
            "geometry",
            f"[DISPLAY] GEOMETRY {f'= {found}' if found else 'is missing'}: the screen draws a "
            "section as a line to and fro along X",
            f"have: GEOMETRY = {geometry_for(config.ini.axes)}",
        )


def unwinding_c(config: Config) -> Iterator[ConfigFinding]:
    low, high = (config.ini.number("AXIS_C", key, default)
                 for key, default in (("MIN_LIMIT", -1e99), ("MAX_LIMIT", 1e99)))  # fmt: skip
    wrapped = config.ini.number("AXIS_C", "WRAPPED_ROTARY", 0.0)
    if not wrapped and high - low > DEGREES_PER_TURN and not uses_face_kinematics(config):
        yield note(
            "unwinding",
            "[AXIS_C] WRAPPED_ROTARY is not set: G0 C0 after a section unwinds every turn that C "
            "has made",
            "have WRAPPED_ROTARY = 1, if no program names a C above 360 (configs/README.md)",
        )


def never_set_g28(config: Config) -> Iterator[ConfigFinding]:
    path = config.ini.file("RS274NGC", "PARAMETER_FILE")
    if "G28" in unset_positions(config.ini):
        yield note(
            "g28",
            f"G28.1 was never set ({path.name if path else 'no var file'}: #5161 to #5169 are 0): "
            "G28 U0 W0 is one rapid, X and Z together, to machine zero",
            "jog where tools are changed and run G28.1 in MDI once",
        )


def lathe_findings(config: Config) -> Iterator[ConfigFinding]:
    if "C" in config.ini.axes and not config.features.keys().isdisjoint(ON_A_LATHE):
        yield from without_geometry(config)
        yield from unwinding_c(config)
        yield from never_set_g28(config)
