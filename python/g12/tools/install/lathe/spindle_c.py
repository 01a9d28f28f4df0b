# SPDX-License-Identifier: GPL-2.0-or-later
"""A spindle that becomes C in a lathe's INI: the lines of `install`, the checks.

`configs/include/spindle_c.hal` connects the signals of the spindle's encoder, which the machine's
HAL files have already, with the inputs of its drive. The owner names these in a TOML file of pins.
"""

import re
import tomllib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from g12.machine_ini import LONGEST_SPINDLE_C, SPINDLE_C_SECONDS, face_joints, leading_number
from g12.settings import INI_SECTION, LIVE_SPINDLE
from g12.tools.errors import UsageError
from g12.tools.install.config.features import COPY, KINEMATICS, ROOT
from g12.tools.install.config.findings import ConfigFinding, problem, warning
from g12.tools.install.config.loaded import Config
from g12.tools.install.lathe.hal import (
    HalLine,
    all_hal,
    hal_lines,
    names,
    signals,
    substituted,
)
from g12.tools.install.lathe.kinematics import GUARD_HAL, joints
from g12.tools.machine.files import existing
from g12.tools.machine.ini import Ini
from g12.tools.machine.tables import MAX_MEASURE

SPINDLE_C_PAGE = "configs/spindle_c.md"
SPINDLE_C_HAL = "configs/include/spindle_c.hal"
LIMITS_SCRIPT = "configs/include/spindle_c_limits.sh"
JOINT_INC = ROOT / "configs/include/spindle_c_joint.inc"  # its joint is 2
CONNECTS = "sc-orient.enable"  # a pin that only a HAL file with these lines names
PROLOG = "spindle_c_on"
SIGNALS = {  # key of [SPINDLE_C]: its pin, and the signal's name if the pin has none
    "TURNS": ("spindle.0.revs", ""),
    "RPS": ("spindle.0.speed-in", ""),
    "INDEX": ("spindle.0.index-enable", ""),
    "REACHED": ("spindle.0.at-speed", "spindle-c-always"),
    "ENABLED": ("motion.motion-enabled", "sc-enabled"),
    "HOMED": ("joint.{joint}.homed", "sc-homed"),
    "HOMING": ("joint.{joint}.homing", "sc-homing"),
    "ORIENT": ("spindle.0.orient", "sc-orienting"),
    "ANGLE": ("joint.{joint}.pos-cmd", "sc-c-angle"),
    "COMMAND": ("joint.{joint}.motor-pos-cmd", "sc-c-command"),
    "PLACE": ("axis.c.pos-cmd", "sc-c-position"),
    "SPEED": ("spindle.0.speed-out-rps", "sc-speed-out"),
    "ON": ("spindle.0.on", "sc-started"),
    "BRAKE": ("spindle.0.brake", "sc-brake-requested"),
}
ENCODER = ("TURNS", "RPS", "INDEX")
SIGNED = ("INDEX_SPEED", "VELOCITY_SCALE", "POSITION_SCALE")  # of NUMBERS, others are above 0
NUMBERS = {  # keys of [SPINDLE_C], each in the pins' file in lower case
    "TOLERANCE": 0.02,
    "ORIENT_SPEED": 0.5,
    "ORIENT_ACCELERATION": 1.0,
    "INDEX_SPEED": 0.25,
    "TIMEOUT": SPINDLE_C_SECONDS,
    "VELOCITY_SCALE": 1.0,
    "POSITION_SCALE": 1.0,
}
DRIVE = {  # names in the pins' file, and the signals that their pins get
    "velocity": "spindle-c-velocity",
    "position": "spindle-c-position",
    "holds": "spindle-c-holds",
    "clamp_open": "spindle-c-on",
    "brake": "spindle-c-brake",
}
REQUIRED_PINS = ("velocity", "position", "holds")
DRIVE_LINE = re.compile(rf"net ({'|'.join(DRIVE.values())}) => (\S+)")
LOADS_MOTION = re.compile(r"loadrt motmod\b(?:.*\bnum_spindles=(\d+))?")


class Pins(NamedTuple):
    """The owner's data of the drive: pins by their names in `DRIVE`, numbers by their key."""

    drive: dict[str, str]
    numbers: dict[str, float]


def read_pins(path: Path) -> Pins:
    """Return the data of a file of pins; refuse unknown and missing entries."""
    existing(path)
    try:
        entries = tomllib.loads(path.read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as error:
        raise UsageError(f"{path}: {error}") from None
    known = [*DRIVE, *map(str.lower, NUMBERS)]
    faults = [f"{key}: missing" for key in REQUIRED_PINS if key not in entries]
    for key, value in entries.items():
        if key not in known:
            faults.append(f"{key} is none of {', '.join(known)}")
        elif key not in DRIVE:
            fault = wrong_number(key.upper(), value)
            faults += [f"{key} = {value!r:.40}: {fault}"] if fault else []
        elif not isinstance(value, str):
            faults.append(f"{key} is the name of a pin, not {value!r:.40}")
    if faults:
        raise UsageError(f"{path}: {'; '.join(faults)}")
    numbers = {key: entries.get(key.lower(), default) for key, default in NUMBERS.items()}
    return Pins({key: entries[key] for key in DRIVE if key in entries}, numbers)


def pins_in_ini(ini: Ini) -> Pins | None:
    """Return the data that an earlier installation wrote, None without one."""
    pin_of = dict(DRIVE_LINE.findall("\n".join(ini.all("HAL", "HALCMD"))))
    drive = {name: pin_of[signal] for name, signal in DRIVE.items() if signal in pin_of}
    given = {key: leading_number(ini.get("SPINDLE_C", key) or "") for key in NUMBERS}
    numbers = {key: usual if given[key] is None else given[key] for key, usual in NUMBERS.items()}
    return Pins(drive, numbers) if drive else None


def wrong_number(key: str, value: object) -> str:
    """Return the rule that a value of `NUMBERS` breaks, "" if none."""
    if not isinstance(value, (int, float)) or isinstance(value, bool):
        return "must be a number"
    if not abs(value) <= MAX_MEASURE:  # nor is nan
        return f"must be {MAX_MEASURE:g} at most"
    if key in SIGNED:
        return "" if value else "must not be 0"
    if key == "TIMEOUT" and value > LONGEST_SPINDLE_C:
        return f"must be {LONGEST_SPINDLE_C:g} at most"
    return "" if value > 0.0 else "must be above 0"


# Installation.


def joint_of_c(config: Config) -> int:
    """Return the number of joint C, of trivkins or of the face's kinematics; -1 without one."""
    letters = joints(config) or face_joints(config.ini.get)
    return letters.index("C") if letters.count("C") == 1 else -1


def is_connected(config: Config) -> bool:
    return names(all_hal(config), CONNECTS)


def obstacles(config: Config, pins: Pins | None) -> Iterator[ConfigFinding]:
    if pins is None:
        yield problem(
            "pins",
            "install cannot know the inputs of your spindle's drive",
            f"name them in a file, as {SPINDLE_C_PAGE} shows, and name that: --pins spindle.toml",
        )
    if joint_of_c(config) < 0:
        yield problem("spindle-c", "no joint is C alone", lines_of_c(config))
    found = signals(config, all_hal(config))
    tcl = [name for name in config.ini.all("HAL", "HALFILE") if ".tcl" in name]
    for pin in (SIGNALS[key][0] for key in ENCODER):
        if pin not in found:
            unread = f" ({tcl[0]} is Tcl, which install does not read)" if tcl else ""
            yield problem(
                "spindle-c",
                f"no HAL file connects {pin}{unread}",
                f"connect the spindle's encoder first, G33 has to work: net SIGNAL => {pin} in a "
                f".hal file ({SPINDLE_C_PAGE})",
            )


def lines_of_c(config: Config) -> str:
    """Return what to write so that a lathe gets a joint C, or the page if its joints are unknown.

    C comes after the other joints, whose numbers stay. A section that is there already is the
    owner's: LinuxCNC reads the first of two.
    """
    letters = joints(config)
    if not letters or "C" in letters:
        return f"make C a joint of its own, as the steps in {SPINDLE_C_PAGE} say"
    present = config.ini.get("KINS", "KINEMATICS")
    kinematics = re.sub(r"coordinates=\w+", f"coordinates={letters}C", present)
    text = JOINT_INC.read_text(encoding="utf-8").replace("JOINT_2", f"JOINT_{len(letters)}")
    blocks = (block[block.index("[") :] for block in text.strip().split("\n\n"))
    missing = [block for block in blocks if not config.text.section(block[1 : block.index("]")])]
    return (
        f"change these lines ({SPINDLE_C_PAGE}):\n"
        f"[KINS] KINEMATICS = {kinematics}\n[KINS] JOINTS = {len(letters) + 1}\n"
        f"[TRAJ] COORDINATES = {' '.join(f'{letters}C')}\n"
        + "".join(f"\n{each}\n" for each in missing)
    ).rstrip()


def signals_wanted(config: Config, kinematics: bool) -> dict[str, str]:
    """Return the signal that each key has to name: the one that other HAL lines connect.

    HAL connects a pin to one signal. ``kinematics``: the HAL file of the face's will be there.
    """
    guard = hal_lines(ROOT / GUARD_HAL) if kinematics else []
    found = signals(config, [*other_lines(config), *guard])
    joint = joint_of_c(config)
    return {key: found.get(pin.format(joint=joint), own) for key, (pin, own) in SIGNALS.items()}


def lines_for(config: Config, features: Sequence[str], pins: Pins) -> dict[str, list[str]]:
    """Return the lines that each section gets."""
    drive = [
        line
        for name, pin in pins.drive.items()
        for line in (f"HALCMD = unlinkp {pin}", f"HALCMD = net {DRIVE[name]} => {pin}")
    ]
    wanted = signals_wanted(config, KINEMATICS in features)
    return {
        "HAL": [
            f"HALFILE = {COPY}/{SPINDLE_C_HAL}",
            *drive,
            f"HALCMD = loadusr sh {COPY}/{LIMITS_SCRIPT}",
        ],
        "SPINDLE_C": [
            f"JOINT = {joint_of_c(config)}",
            *(f"{key} = {signal}" for key, signal in wanted.items()),
            *(f"{key} = {value:g}" for key, value in pins.numbers.items()),
        ],
    }


# Checks.


def spindle_c_findings(config: Config) -> Iterator[ConfigFinding]:
    if becomes_c(config):
        yield from keys_wrong(config)
        yield from hal_wrong(config)


def becomes_c(config: Config) -> bool:
    return any(PROLOG in code.remap.handlers for code in config.remaps)


def keys_wrong(config: Config) -> Iterator[ConfigFinding]:
    """Find entries of [SPINDLE_C] that are missing, or not what the machine's HAL files need."""
    joint, find = joint_of_c(config), config.ini.get
    connected = signals(config, other_lines(config))
    for key, wanted in {"JOINT": str(joint), **signals_wanted(config, False)}.items():
        pin = SIGNALS[key][0].format(joint=joint) if key in SIGNALS else ""
        fixed = pin in connected or key in ENCODER or (key == "JOINT" and joint >= 0)
        value = find("SPINDLE_C", key)
        if not value or (fixed and value != wanted):
            yield problem(
                "spindle-c",
                f"[SPINDLE_C] {key} = {value or 'nothing'}: has to be {wanted or f'on {pin}'}",
                f"{key} = {wanted}" if wanted else f"net {value or 'SIGNAL'} … => {pin}",
            )
    for key, usual in NUMBERS.items():
        text = find("SPINDLE_C", key, f"{usual:g}" if key == "TIMEOUT" else "")
        fault = wrong_number(key, leading_number(text))
        if fault:
            yield problem(
                "spindle-c",
                f"[SPINDLE_C] {key} = {text:.40}: {fault}",
                f"usual is {key} = {usual:g} ({SPINDLE_C_PAGE})",
            )


def hal_wrong(config: Config) -> Iterator[ConfigFinding]:
    """Find lines that are missing in [HAL], and a C that shares the index."""
    others = other_lines(config)
    for name in (*map(DRIVE.get, REQUIRED_PINS), Path(LIMITS_SCRIPT).name, CONNECTS):
        if not names(all_hal(config) if name == CONNECTS else others, name):
            yield problem(
                "spindle-c-hal",
                f"nothing in [HAL] uses {name}: the spindle does not become C",
                f"the lines of [HAL] at the end of {SPINDLE_C_PAGE}",
            )
    pin = f"joint.{joint_of_c(config)}.index-enable"
    for text, location in others:
        if pin in text.split():
            yield problem(
                "spindle-c-index",
                f"{location}: {text}: {pin} shares the index: before LinuxCNC 2.10 G33 and G76 "
                "then move at once, without waiting for it (LinuxCNC issue 3556)",
                "take that pin out: C needs no homing to the index",
            )


def live_spindle_missing(config: Config) -> Iterator[ConfigFinding]:
    """Find a machine that has no such spindle as its live tool needs.

    One whose spindle becomes C may have no live tool.
    """
    named = int((config.settings and config.ini.get(INI_SECTION, LIVE_SPINDLE)) or 0)
    live = named or int(becomes_c(config))
    spindles = leading_number(config.ini.get("TRAJ", "SPINDLES") or "") or 1
    loading = (LOADS_MOTION.match(substituted(line.text, config)) for line in all_hal(config))
    loaded = next((int(found[1] or 1) for found in loading if found), spindles)
    if live and min(spindles, loaded) <= live:
        report = problem if named or spindles > live else warning
        yield report(
            "live-spindle",
            f"[TRAJ] SPINDLES is {spindles:g} and motion is loaded with {loaded:g}: LinuxCNC has "
            f"no spindle {live} for a live tool, and refuses S2000 M3 ${live}",
            f"SPINDLES = {live + 1}, num_spindles=[TRAJ]SPINDLES where HAL loads motion, and wire "
            f"spindle.{live}.speed-out; nothing, if there is no live tool",
        )


def other_lines(config: Config) -> list[HalLine]:
    """Return the lines of the HAL files other than spindle_c.hal, and those of HALCMD."""
    own = f"{Path(SPINDLE_C_HAL).name}:"
    return [line for line in all_hal(config) if not line.location.startswith(own)]
