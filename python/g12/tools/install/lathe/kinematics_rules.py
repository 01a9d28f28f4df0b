# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks of the face's kinematics in a machine config (`configs/kinematics`).

They run where `[G12] POLAR_KINEMATICS = 1` or `[KINS] KINEMATICS` selects these kinematics. Every
step of the page has a rule here.
"""

import re
from collections.abc import Iterable, Iterator
from itertools import chain
from math import hypot
from pathlib import Path

from g12.errors import Refusal
from g12.machine_ini import ACCELERATION_PINS, FACE_KINEMATICS, face_joints, face_of, leading_number
from g12.tools.install.config.findings import ConfigFinding, note, problem, warning
from g12.tools.install.config.loaded import Config
from g12.tools.install.lathe.hal import (
    HalLine,
    all_hal,
    hal_files,
    later_hal,
    linuxcnc_folder,
    names,
    pins_taken,
    signals,
    substituted,
)

KINEMATICS_PAGE = "configs/kinematics/README.md"
GUARD_HAL = Path("configs/kinematics/polar_kinematics.hal")
OFFSET_HAL = Path("configs/kinematics/polar_tool_offset.hal")
OFFSET = "polar-xzc.tool-offset"
SETS_OFFSET = re.compile(rf"(?:setp\s+)?{re.escape(OFFSET)}\s*(?:=|\s)\s*(\S+)")
REQUEST = "polar-xzc.request"  # a pin that only a HAL file with the guard's lines names
GUARD_PINS = (
    "motion.analog-out-02",
    "motion.analog-out-03",
    "motion.digital-in-03",
    "motion.switchkins-type",
    "motion.jog-inhibit",
    "motion.adaptive-feed",
    "motion.feed-upm",
)
NEWEST_PIN = b".end-request"  # of the module
LEAST_PINS = {"num_aio": 4, "num_dio": 4}  # of motmod, whose default is four
LOADS_KINEMATICS = re.compile(r"loadrt\s+(\w*kins)\b")
LIMIT_SLACK = 1.001
SHARE = 0.7  # of the slide's acceleration, for X and Y each
SETS_PERIOD = re.compile(r"\b(traj|servo)_period_nsec=(\S+)")
SMOOTHED, SETTLED = 4, 6  # cycles: of LinuxCNC's interpolation, of polar_xzc.comp


def module_file() -> Path | None:
    """Return the kinematics' module in the LinuxCNC on this computer, None without one."""
    folder = linuxcnc_folder("LINUXCNC_RTLIB_DIR")
    file = folder / f"{FACE_KINEMATICS}.so" if folder else None
    return file if file and file.exists() else None


def is_outdated(module: Path) -> bool:
    return NEWEST_PIN not in module.read_bytes()


def selects_kinematics(config: Config) -> bool:
    return uses_face_kinematics(config) or bool(face_joints(config.ini.get))


def uses_face_kinematics(config: Config) -> bool:
    """Return whether G12.1 moves X and Y; another rule reports a wrong setting."""
    return bool(config.settings and config.settings.polar_kinematics)


def not_used(config: Config) -> Iterator[ConfigFinding]:
    if not uses_face_kinematics(config):
        yield warning(
            "kinematics-unused",
            f"[KINS] KINEMATICS = {FACE_KINEMATICS}, but G12.1 makes segments",
            "add POLAR_KINEMATICS = 1 to [G12]",
        )


def module_missing(config: Config) -> Iterator[ConfigFinding]:
    module = module_file()
    if not module or is_outdated(module):
        older = f"LinuxCNC's module {FACE_KINEMATICS} is older than this package: G12.1 is refused"
        yield problem(
            "no-kinematics",
            older if module else f"LinuxCNC has no module {FACE_KINEMATICS}",
            f"build it{' again' if module else ''}: make kinematics ({KINEMATICS_PAGE})",
        )


def joints_wrong(config: Config) -> Iterator[ConfigFinding]:
    letters, found = face_joints(config.ini.get), config.ini.get("KINS", "KINEMATICS")
    joints = config.ini.get("KINS", "JOINTS", "0").strip()
    if not letters:
        yield problem(
            "kins",
            f"[KINS] KINEMATICS = {found}: POLAR_KINEMATICS = 1 needs {FACE_KINEMATICS}",
            f"KINEMATICS = {FACE_KINEMATICS} coordinates=XZC (the letters of your joints)",
        )
    elif not are_of_lathe(letters):
        yield problem(
            "kins",
            f"[KINS] KINEMATICS: coordinates={letters}: X and C have to be there, Y may not, "
            "every letter once",
            "give each joint its letter: coordinates=XZC",
        )
    elif joints != str(len(letters)):
        yield problem(
            "kins",
            f"[KINS] JOINTS = {joints}, but coordinates={letters} has {len(letters)}",
            f"JOINTS = {len(letters)}, or one letter for each joint",
        )


def are_of_lathe(letters: str) -> bool:
    """Return whether the letters of joints are X and C, each once, without Y."""
    return {"X", "C"} <= set(letters) and "Y" not in letters and len({*letters}) == len(letters)


def axes_wrong(config: Config) -> Iterator[ConfigFinding]:
    letters = face_joints(config.ini.get)
    if not letters:
        return
    needed = {*letters, "Y"}
    missing = [letter for letter in "XYZABCUVW" if letter in needed - set(config.ini.axes)]
    if missing:
        yield problem(
            "coordinates",
            f"[TRAJ] COORDINATES = {' '.join(config.ini.axes)} lacks {' '.join(missing)}",
            "name every joint's letter, and Y, which no joint has",
        )
    for axis in "XY":
        if not config.ini.all(f"AXIS_{axis}", "MAX_LIMIT"):
            yield problem(
                "face-axis",
                f"[AXIS_{axis}] has no MAX_LIMIT: it is an axis of the face",
                f"[AXIS_{axis}] with MIN_LIMIT, MAX_LIMIT, MAX_VELOCITY and MAX_ACCELERATION "
                f"({KINEMATICS_PAGE})",
            )


def limits_wrong(config: Config) -> Iterator[ConfigFinding]:
    if "X" not in face_joints(config.ini.get) or any(axes_wrong(config)):
        return
    try:
        x, y, slide, _ = face_of(config.ini.get)
    except Refusal as refusal:
        yield problem("face-axis", refusal.message, "correct the value")
        return
    for letter, axis in (("X", x), ("Y", y)):
        if axis.low > -slide.high or axis.high < slide.high:
            yield warning(
                "face-limits",
                f"[AXIS_{letter}] MIN_LIMIT {axis.low:g} and MAX_LIMIT {axis.high:g} are less of "
                f"the face than the slide reaches, {slide.high:g}",
                f"MIN_LIMIT = {-slide.high:g} and MAX_LIMIT = {slide.high:g}: the slide keeps its "
                "own limits",
            )
        if axis.velocity > slide.velocity * LIMIT_SLACK:
            yield problem(
                "face-speed",
                f"[AXIS_{letter}] MAX_VELOCITY {axis.velocity:g} is more than the slide's "
                f"{slide.velocity:g}",
                f"MAX_VELOCITY = {slide.velocity:g}",
            )
    if hypot(x.acceleration, y.acceleration) > slide.acceleration * LIMIT_SLACK:
        yield warning(
            "face-acceleration",
            f"[AXIS_X] and [AXIS_Y] MAX_ACCELERATION {x.acceleration:g} and {y.acceleration:g}: "
            f"together more than the slide's {slide.acceleration:g}, so G12.1 makes segments",
            f"MAX_ACCELERATION = {SHARE * slide.acceleration:g} in both",
        )


def hal_wrong(config: Config) -> Iterator[ConfigFinding]:
    files = hal_files(config)
    guards = [number for number, lines in enumerate(files) if names(lines, REQUEST)]
    if not guards:
        yield problem(
            "kinematics-hal",
            f"no HALFILE of [HAL] connects {FACE_KINEMATICS}: it would never leave X, Z and C",
            f"add HALFILE = …/{GUARD_HAL} after the file that loads motion",
        )
        return
    loading = [number for number, lines in enumerate(files) if names(lines, "motmod", "EMCMOT")]
    if loading and guards[0] < loading[0]:
        yield problem(
            "kinematics-hal",
            f"the HALFILE with {FACE_KINEMATICS} comes before the one that loads motion",
            "move its HALFILE line after that one",
        )
    yield from accelerations_taken(all_hal(config))
    others = [line for number, lines in enumerate(files) if number not in guards for line in lines]
    guard = signals(config, chain(*(files[number] for number in guards)))  # of a copy as well
    yield from hal_in_the_way(config, [*others, *later_hal(config)], guard)


def accelerations_taken(lines: Iterable[HalLine]) -> Iterator[ConfigFinding]:
    """Find signals connected to the pins that G12.1 sets; LinuxCNC allows one writer."""
    nets = [line for line in lines if line.text.split()[:1] in (["net"], ["linksp"], ["linkps"])]
    cure = "take that pin out of the line: G12.1 sets it for each section and restores it"
    yield from pins_taken(nets, ACCELERATION_PINS, "is set by G12.1, which is refused then", cure)


def periods_differ(config: Config) -> Iterator[ConfigFinding]:
    """Find a motion module that plans more slowly than the guard counts."""
    for text, location in all_hal(config):
        values = dict(SETS_PERIOD.findall(substituted(text, config)))
        periods = {key: leading_number(value) or 0.0 for key, value in values.items()}
        trajectory, servo = periods.get("traj", 0.0), periods.get("servo", 0.0)
        if servo and SMOOTHED * trajectory > SETTLED * servo:
            yield note(
                "traj-period",
                f"{location}: traj_period_nsec is {trajectory / servo:g} times servo_period_nsec: "
                f"LinuxCNC smooths the axes over {SMOOTHED} of the former, {FACE_KINEMATICS} "
                f"waits {SETTLED} of the latter before it switches",
                "take traj_period_nsec out of the line: it is the servo period then",
            )


def hal_in_the_way(
    config: Config, lines: list[HalLine], guard: dict[str, str]
) -> Iterator[ConfigFinding]:
    cure = "use another pin here, or change it in a copy of polar_kinematics.hal"
    yield from pins_taken(lines, GUARD_PINS, "is the kinematics'", cure)
    for line in lines:
        for pin, signal in signals(config, [line]).items():
            if pin not in GUARD_PINS and guard.get(pin, signal) != signal:
                yield problem(
                    "pin-taken",
                    f"{line.location}: {line.text}: {pin} is {guard[pin]} to the kinematics, and "
                    "HAL connects a pin to one signal: LinuxCNC does not start",
                    f"call the signal {guard[pin]} in your HAL files, not {signal}",
                )
    for text, location in lines:
        module = LOADS_KINEMATICS.match(text)
        if module and module[1] != FACE_KINEMATICS:
            yield problem(
                "kins",
                f"{location}: {text}: loads {module[1]}, whatever [KINS] says",
                "loadrt [KINS]KINEMATICS",
            )
        for key, least in LEAST_PINS.items():
            limit = re.search(rf"\b{key}=(\d+)", text)
            if limit and int(limit[1]) < least:
                yield problem(
                    "few-pins",
                    f"{location}: {text}: motion has too few inputs and outputs for the kinematics",
                    f"{key}={least}, or take {key} out",
                )


def offset_wrong(config: Config) -> Iterator[ConfigFinding]:
    """Find kinematics with another distance of the tool from the X line than G12.1's."""
    matches = (SETS_OFFSET.fullmatch(substituted(line.text, config)) for line in all_hal(config))
    *_, found = 0.0, *(leading_number(match[1]) or 0.0 for match in matches if match)
    offset = config.settings.polar_tool_offset if config.settings else found
    if found != offset:
        yield problem(
            "tool-offset",
            f"[G12] POLAR_TOOL_OFFSET = {offset:g}, but {OFFSET} is {found:g}: G12.1 is refused",
            f"HALFILE = …/{OFFSET_HAL} after the file that loads motion, and nothing else for it",
        )


KINEMATICS_RULES = (
    module_missing,
    not_used,
    joints_wrong,
    axes_wrong,
    limits_wrong,
    hal_wrong,
    periods_differ,
    offset_wrong,
)


def kinematics_findings(config: Config) -> Iterator[ConfigFinding]:
    for rule in KINEMATICS_RULES if selects_kinematics(config) else ():
        yield from rule(config)
