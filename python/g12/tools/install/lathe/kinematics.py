# SPDX-License-Identifier: GPL-2.0-or-later
"""The face's kinematics (`configs/kinematics`) in a lathe's INI: the lines of `install`, checks.

`install` changes a lathe on trivkins whose X, Z and C are joints of their own; its trial refuses
what the checks find. Any other config is not changed: the page has the steps.
"""

import re
from collections.abc import Iterator, Sequence
from itertools import product
from math import hypot, isclose
from pathlib import Path

from g12.errors import Refusal
from g12.machine_ini import (
    FACE_KINEMATICS,
    coordinates_of,
    face_joints,
    face_of,
    leading_number,
)
from g12.tools.install.config.features import COPY, POLAR_FEATURES
from g12.tools.install.config.findings import ConfigFinding, problem, warning
from g12.tools.install.config.loaded import Config, folder_from_ini
from g12.tools.install.lathe.hal import all_hal, hal_files, linuxcnc_folder, names

KINEMATICS_PAGE = "configs/kinematics/README.md"
GUARD_HAL = Path("configs/kinematics/polar_kinematics.hal")
OFFSET_HAL = Path("configs/kinematics/polar_tool_offset.hal")
REQUEST = "polar-xzc.request"  # a pin that only a HAL file with the guard's lines names
NEWEST_PIN = b".end-request"  # of the module
LOADS_KINEMATICS = re.compile(r"loadrt\s+(\w*kins)\b")
LIMIT_KEYS = ("MIN_LIMIT", "MAX_LIMIT", "MAX_VELOCITY", "MAX_ACCELERATION")
LIMIT_SLACK = 1.001
SHARE = 0.7  # of the slide's acceleration, for X and Y each


def uses_face_kinematics(config: Config) -> bool:
    """Return whether G12.1 moves X and Y; another rule reports a wrong setting."""
    return bool(config.settings and config.settings.polar_kinematics)


def are_of_lathe(letters: str) -> bool:
    """Return whether the letters of joints are X and C, each once, without Y."""
    return {"X", "C"} <= set(letters) and "Y" not in letters and len({*letters}) == len(letters)


# Installation.


def joints(config: Config) -> str:
    """Return the letters of a trivkins machine's joints, "" where they are not given."""
    module, *parameters = (config.ini.get("KINS", "KINEMATICS") or "").split() or [""]
    named = dict(parameter.partition("=")[::2] for parameter in parameters)
    known = module == "trivkins" and set(named) <= {"coordinates", "kinstype"}
    return named.get("coordinates", "").upper() if known else ""


def obstacles(config: Config, codes: Sequence[str]) -> Iterator[ConfigFinding]:
    if set(POLAR_FEATURES).isdisjoint([*codes, *config.features]):
        cure = "install --with polar polar-kinematics"
        yield problem("kinematics", "there is no G12.1 here", cure)
    for reason in unusual(config):
        yield problem(
            "kinematics",
            f"{reason}: install leaves the kinematics of this machine alone",
            f"by hand: the steps in {KINEMATICS_PAGE}, and check reports what is missing or wrong",
        )


def unusual(config: Config) -> Iterator[str]:
    """Yield why a lathe is not one of the usual form."""
    letters, axes = joints(config), coordinates_of(config.ini.get)
    if not are_of_lathe(letters):
        found = config.ini.get("KINS", "KINEMATICS")
        yield f"[KINS] KINEMATICS = {found} is not trivkins coordinates=…, X and C once, without Y"
        return
    if set(axes) != set(letters):
        yield f"[TRAJ] COORDINATES = {' '.join(axes)} is not coordinates={letters}"
    slide = f"JOINT_{letters.index('X')}"
    needed = [*product(("AXIS_X", slide), LIMIT_KEYS), *product(("AXIS_C",), LIMIT_KEYS[2:])]
    values = {key: leading_number(config.ini.get(*key) or "") for key in needed}
    yield from (f"[{key[0]}] has no {key[1]}" for key, value in values.items() if value is None)
    ends = [values[section, "MAX_LIMIT"] or 0.0 for section in ("AXIS_X", slide)]
    if ends[0] <= 0.0 or not isclose(*ends):
        yield f"[AXIS_X] and [{slide}] have MAX_LIMIT {ends[0]:g} and {ends[1]:g}"
    if any(config.ini.get("AXIS_Y", key) for key in LIMIT_KEYS):
        yield "there is an [AXIS_Y]"
    files = [value.split()[0] for value in config.ini.all("HAL", "HALFILE") if value.strip()]
    for name in files:
        if not name.endswith(".hal") or not folder_from_ini(config.ini, name).is_file():
            yield f"[HAL] HALFILE = {name} is no HAL file beside the INI"


def replaced(config: Config) -> Iterator[tuple[str, str, str]]:
    """Yield section, key and new value of the entries that change."""
    values = limits(config)
    yield "KINS", "KINEMATICS", f"{FACE_KINEMATICS} coordinates={joints(config)}"
    yield "TRAJ", "COORDINATES", " ".join(coordinates_of(config.ini.get).replace("X", "XY"))
    yield "AXIS_X", "MIN_LIMIT", values["MIN_LIMIT"]
    yield "AXIS_X", "MAX_ACCELERATION", values["MAX_ACCELERATION"]
    if config.ini.get("G12", "POLAR_KINEMATICS"):
        yield "G12", "POLAR_KINEMATICS", "1"


def limits(config: Config) -> dict[str, str]:
    slide = f"JOINT_{joints(config).index('X')}"
    most = config.ini.number("AXIS_X", "MAX_LIMIT", 0.0)
    speed = config.ini.number("AXIS_X", "MAX_VELOCITY", 0.0)
    acceleration = SHARE * config.ini.number(slide, "MAX_ACCELERATION", 0.0)
    values = zip(LIMIT_KEYS, (-most, most, speed, acceleration))
    return {key: f"{value:.10g}" for key, value in values}


def added(config: Config) -> dict[str, list[str]]:
    """Return the lines that each section gets."""
    files = [GUARD_HAL, *([OFFSET_HAL] if config.ini.tool_beside else [])]
    return {
        "HAL": [f"HALFILE = {COPY}/{file}" for file in files],
        "G12": ["POLAR_KINEMATICS = 1"],
        "AXIS_Y": [f"{key} = {value}" for key, value in limits(config).items()],
    }


# Checks.


def kinematics_findings(config: Config) -> Iterator[ConfigFinding]:
    """Check a machine with ``[G12] POLAR_KINEMATICS = 1``, or with these in [KINS]."""
    if uses_face_kinematics(config) or face_joints(config.ini.get):
        for rule in (module_missing, axes_wrong, hal_wrong):
            yield from rule(config)


def module_file() -> Path | None:
    """Return the kinematics' module in the LinuxCNC on this computer, None without one."""
    folder = linuxcnc_folder("LINUXCNC_RTLIB_DIR")
    file = folder / f"{FACE_KINEMATICS}.so" if folder else None
    return file if file and file.exists() else None


def is_outdated(module: Path) -> bool:
    return NEWEST_PIN not in module.read_bytes()


def module_missing(config: Config) -> Iterator[ConfigFinding]:
    module = module_file()
    if not module or is_outdated(module):
        older = f"LinuxCNC's module {FACE_KINEMATICS} is older than this package: G12.1 is refused"
        yield problem(
            "no-kinematics",
            older if module else f"LinuxCNC has no module {FACE_KINEMATICS}",
            f"build it{' again' if module else ''}: make kinematics ({KINEMATICS_PAGE})",
        )


def axes_wrong(config: Config) -> Iterator[ConfigFinding]:
    letters, found = face_joints(config.ini.get), config.ini.get("KINS", "KINEMATICS")
    number = config.ini.get("KINS", "JOINTS", "0").strip()
    if not are_of_lathe(letters) or number != str(len(letters)):
        yield problem(
            "kins",
            f"[KINS] KINEMATICS = {found}, JOINTS = {number}: G12.1 needs {FACE_KINEMATICS} and a "
            "letter for each joint, X and C among them, Y not, each once",
            f"KINEMATICS = {FACE_KINEMATICS} coordinates=XZC (the letters of your joints)",
        )
        return
    missing = [letter for letter in f"{letters}Y" if letter not in config.ini.axes]
    if missing:
        yield problem(
            "coordinates",
            f"[TRAJ] COORDINATES = {' '.join(config.ini.axes)} lacks {' '.join(missing)}",
            "name every joint's letter, and Y, which no joint has",
        )
    else:
        yield from limits_wrong(config)


def limits_wrong(config: Config) -> Iterator[ConfigFinding]:
    """Find limits of X and Y with which the slide cannot follow, or that cut the face short."""
    try:
        x, y, slide, _ = face_of(config.ini.get)
    except Refusal as refusal:
        yield problem("face-axis", refusal.message, "correct the value")
        return
    both = f"[AXIS_X] and [AXIS_Y], against the slide: ({KINEMATICS_PAGE})"
    if max(x.velocity, y.velocity) > slide.velocity * LIMIT_SLACK:
        cure = f"MAX_VELOCITY = {slide.velocity:g} in both"
        yield problem("face-axis", f"{both} MAX_VELOCITY is more than it has", cure)
    if hypot(x.acceleration, y.acceleration) > slide.acceleration * LIMIT_SLACK:
        cure = f"MAX_ACCELERATION = {SHARE * slide.acceleration:g} in both"
        yield warning("face-axis", f"{both} MAX_ACCELERATION is more than it has in the diagonal: "
                      "G12.1 makes segments", cure)  # fmt: skip
    if max(x.low, y.low) > -slide.high or min(x.high, y.high) < slide.high:
        cure = f"MIN_LIMIT = {-slide.high:g} and MAX_LIMIT = {slide.high:g}: it keeps its own"
        yield warning("face-axis", f"{both} the limits are less of the face than it reaches", cure)


def hal_wrong(config: Config) -> Iterator[ConfigFinding]:
    lines = [*hal_files(config, "HALFILE")]
    guard = next((at for at, line in enumerate(lines) if REQUEST in line.text), None)
    if guard is None or names(lines[guard:], "motmod", "EMCMOT"):
        yield problem(
            "kinematics-hal",
            f"no HALFILE of [HAL] after the one that loads motion connects {FACE_KINEMATICS}",
            f"add HALFILE = …/{GUARD_HAL} after the file that loads motion",
        )
        return
    for text, location in all_hal(config):
        module = LOADS_KINEMATICS.match(text)
        if module and module[1] != FACE_KINEMATICS:
            wrong = f"{location}: {text}: loads {module[1]}, whatever [KINS] says"
            yield problem("kins", wrong, "loadrt [KINS]KINEMATICS")
