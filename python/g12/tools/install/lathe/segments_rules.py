# SPDX-License-Identifier: GPL-2.0-or-later
"""The gain from kinematics for a lathe that runs polar sections in segments.

Two contours are the examples: the cutter of 12 mm around a hexagon of 27 mm across flats, and a
circle of radius 10 mm, 20 mm off the axis.
"""

from collections.abc import Iterator
from math import pi, sqrt, tau

from g12.geometry.curve import Arc, Curve, Line
from g12.tools.install.config import features
from g12.tools.install.config.findings import ConfigFinding, note
from g12.tools.install.config.loaded import Config
from g12.tools.install.lathe.kinematics_rules import KINEMATICS_PAGE, selects_kinematics
from g12.tools.machine.ini import IniError
from g12.tools.path.lathe_axes import LatheAxes, lathe_axes
from g12.tools.path.section_times import Leg, section_times

FLAT, CUTTER = 13.5, 6.0  # mm, radii
SIXTH = pi / 3
EXAMPLE_FEEDS = (1000.0, 2000.0)  # mm/min


def hexagon() -> list[Curve]:
    path: list[Curve] = []
    for side in range(6):
        turn = complex(0.5, -sqrt(0.75)) ** side
        corner = FLAT * complex(1.0, -1.0 / sqrt(3.0))
        first, last = corner.conjugate() + CUTTER, corner + CUTTER
        path += [Line(first * turn, last * turn), Arc(last * turn, corner * turn, -SIXTH)]
    return path


CONTOURS: dict[str, list[Curve]] = {
    "a hexagon of 27 mm": hexagon(),
    "a circle of radius 10 mm, 20 mm off the axis": [Arc(30 + 0j, 20 + 0j, tau)],
}


def takes(path: list[Curve], axes: LatheAxes) -> str:
    times = (
        section_times([Leg(curve, feed / 60.0) for curve in path], axes) for feed in EXAMPLE_FEEDS
    )
    segments, face, least = (" and ".join(f"{t:.1f}" for t in kind) for kind in zip(*times))
    return f"{segments} s, with kinematics {face} s, at the limits of X and C {least} s"


def gained_by_kinematics(config: Config) -> Iterator[ConfigFinding]:
    """Report the times of polar sections on a lathe, from the limits of X and C in its INI."""
    ini = config.ini
    is_polar = not config.features.keys().isdisjoint(features.POLAR_FEATURES)
    if not is_polar or selects_kinematics(config) or not {"X", "C"} <= set(ini.axes):
        return
    known = all(ini.all(f"AXIS_{letter}", "MAX_ACCELERATION") for letter in "XC")
    try:
        axes = lathe_axes(ini) if known and not ini.tool_beside else None
    except IniError:  # another rule reports it
        return
    if axes:
        times = "; ".join(f"{what} {takes(path, axes)}" for what, path in CONTOURS.items())
        yield note(
            "segments",
            "polar sections are made in segments; the contour alone, without lead-in and lead-out, "
            f"takes at 1000 and 2000 mm/min about: {times}",
            f"nothing, or make kinematics if that is worth it ({KINEMATICS_PAGE})",
        )
