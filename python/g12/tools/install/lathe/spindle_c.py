# SPDX-License-Identifier: GPL-2.0-or-later
"""A spindle that becomes C in a lathe's INI: the lines of `install`, the checks.

`configs/include/spindle_c.hal` connects the signals of the spindle's encoder, which the machine's
HAL files have already, with the inputs of its drive. The owner names these in a TOML file of pins.
"""

import re
import tomllib
from collections.abc import Iterator, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import Any, NamedTuple

from g12.machine_ini import LONGEST_SPINDLE_C, SPINDLE_C_SECONDS, face_joints, leading_number
from g12.settings import INI_SECTION, LIVE_SPINDLE
from g12.tools.errors import UsageError
from g12.tools.install.config.features import KINEMATICS, ROOT
from g12.tools.install.config.findings import ConfigFinding, problem, warning
from g12.tools.install.config.loaded import Config
from g12.tools.install.lathe.hal import (
    HalLine,
    all_hal,
    hal_files,
    hal_lines,
    names,
    pins_taken,
    signals,
    substituted,
)
from g12.tools.install.lathe.hal_pins import missing_pin, modules_of, owners_of, pins_in
from g12.tools.install.lathe.kinematics_lines import joints
from g12.tools.install.lathe.kinematics_rules import GUARD_HAL, uses_face_kinematics
from g12.tools.machine.files import existing
from g12.tools.machine.tables import MAX_MEASURE
from g12.tools.units import counted_as

SPINDLE_C_PAGE = "configs/spindle_c.md"
SPINDLE_C_HAL = "configs/include/spindle_c.hal"
LIMITS_SCRIPT = "configs/include/spindle_c_limits.sh"
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
OWN_PINS = (
    "motion.digital-out-02",
    "motion.digital-in-02",
    "spindle.0.is-oriented",
    "ini.c.min_limit",
    "ini.c.max_limit",
)
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
ALMOST_SAME = 0.9  # least similarity of a misspelt pin
NUMBER = re.compile(r"\d+")
LOADS_MOTION = re.compile(r"loadrt motmod\b")
LIVE_SPINDLE_CURE = (
    "SPINDLES = {}, num_spindles=[TRAJ]SPINDLES where HAL loads motion, and wire "
    "spindle.{}.speed-out"
)
NUM_SPINDLES = re.compile(r"\bnum_spindles=(\d+)")
MODULES = re.compile(r"^loadrt (\w+) names=(\S+)", re.MULTILINE)  # with their components
SPINDLE_C_LINE = re.compile(
    rf"HALFILE = \S+/{re.escape(SPINDLE_C_HAL)}"
    rf"|HALCMD = (unlinkp \S+|net spindle-c-\S+ => \S+|loadusr sh \S+/{re.escape(LIMITS_SCRIPT)})"
    rf"|({'|'.join(('JOINT', *SIGNALS, *NUMBERS))}) = \S+|\[SPINDLE_C\]"
)
PINS_EXAMPLE = """\
velocity = "…"     input of the drive for M3 and M4, revolutions per second times velocity_scale
position = "…"     input of the drive for C, revolutions times position_scale (360: degrees)
holds = "…"        input of the drive that makes it obey its position
clamp_open, brake  outputs, if there are any"""

AXIS_C = """\
MIN_LIMIT = -99999
MAX_LIMIT = 99999
MAX_VELOCITY = 360
MAX_ACCELERATION = 3600"""
JOINT_C = f"""\
TYPE = ANGULAR
{AXIS_C}
FERROR = 10
MIN_FERROR = 1
HOME = 0
HOME_SEQUENCE = 0"""


class Pins(NamedTuple):
    """The owner's data of the drive: pins by their names in `DRIVE`, numbers by their key."""

    drive: dict[str, str]
    numbers: dict[str, float]


def read_pins(path: Path) -> Pins:
    """Return the data of a file of pins; refuse unknown and missing entries."""
    try:
        entries = tomllib.loads(existing(path).read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as error:
        raise UsageError(f"{path}: {error}") from None
    known: dict[str, Any] = dict.fromkeys(DRIVE, str)
    known |= {key.lower(): (int, float) for key in NUMBERS}
    for key, value in entries.items():
        if key not in known:
            raise UsageError(f"{path}: {key} is none of {', '.join(known)}")
        if not isinstance(value, known[key]) or isinstance(value, bool):
            kind = "the name of a pin" if key in DRIVE else "a number"
            raise UsageError(f"{path}: {key} is {kind}, not {value!r:.40}")
        fault = wrong_number(key.upper(), value) if key not in DRIVE else ""
        if fault:
            raise UsageError(f"{path}: {key} = {value!s:.40}: {fault}")
    missing = [key for key in REQUIRED_PINS if key not in entries]
    if missing:
        raise UsageError(f"{path}: {', '.join(missing)}: missing")
    numbers = {key: entries.get(key.lower(), default) for key, default in NUMBERS.items()}
    return Pins({key: entries[key] for key in DRIVE if key in entries}, numbers)


def spindle_obstacles(config: Config, pins: Pins | None) -> Iterator[ConfigFinding]:
    if pins is None:
        yield problem(
            "pins",
            "install cannot know the inputs of your spindle's drive",
            "write them into a file and name it, --pins spindle.toml "
            f"({SPINDLE_C_PAGE}):\n{PINS_EXAMPLE}",
        )
    if letters_of_joints(config).count("C") != 1:
        yield problem("spindle-c", "no joint is C alone", lines_of_c(config))
    lines = all_hal(config)
    yield from encoder_unconnected(config, signals(config, lines))
    yield from drive_missing(config, pins, lines)
    if not config.ini.get("SPINDLE_C", "JOINT"):  # a file of the user's may have our file's name
        yield from in_the_way(lines)


def lines_of_c(config: Config) -> str:
    """Return what to write so that a lathe gets a joint C, or the page if its joints are unknown.

    C comes after the other joints, whose numbers stay. A section that is there already is the
    owner's: LinuxCNC reads the first of two.
    """
    letters, ini = joints(config), config.ini
    if not letters or "C" in letters:
        return f"make C a joint of its own, as the steps in {SPINDLE_C_PAGE} say"
    module = (ini.get("KINS", "KINEMATICS") or "").split()
    parameters = (word for word in module[1:] if not word.startswith("coordinates="))
    changed = [
        f"[KINS] KINEMATICS = {' '.join((module[0], f'coordinates={letters}C', *parameters))}",
        f"[KINS] JOINTS = {len(letters) + 1}",
        f"[TRAJ] COORDINATES = {' '.join(f'{letters}C')}",
    ]
    new = {"AXIS_C": AXIS_C, f"JOINT_{len(letters)}": JOINT_C}
    missing = (name for name in new if not config.text.headers(name))
    blocks = (f"\n[{name}]\n{new[name]}" for name in missing)
    return "\n".join((f"change these lines ({SPINDLE_C_PAGE}):", *changed, *blocks))


def encoder_unconnected(config: Config, found: dict[str, str]) -> Iterator[ConfigFinding]:
    """Find pins of the spindle's encoder that no HAL file connects, or one in Tcl may connect."""
    missing = [pin for pin in (SIGNALS[key][0] for key in ENCODER) if pin not in found]
    tcl = [name for name in config.ini.all("HAL", "HALFILE") if ".tcl" in name]
    if missing and tcl:
        yield problem(
            "spindle-c",
            f"[HAL] HALFILE = {tcl[0]} is Tcl, which install does not read: it cannot know the "
            f"signals of {', '.join(missing)}",
            "name them in a HAL file of your own, with a HALFILE line after that one: "
            f"{'; '.join(f'net SIGNAL => {pin}' for pin in missing)}; in a running LinuxCNC "
            "`halcmd show pin spindle.0` shows the signals",
        )
        return
    for pin in missing:
        yield problem(
            "spindle-c",
            f"no HAL file connects {pin}",
            f"connect the spindle's encoder first: G33 has to work ({SPINDLE_C_PAGE})",
        )


def drive_missing(
    config: Config, pins: Pins | None, lines: Sequence[HalLine]
) -> Iterator[ConfigFinding]:
    """Find inputs of the drive that no module of the HAL files makes."""
    modules = modules_of(config, lines)
    for name, pin in pins.drive.items() if pins else ():
        nearest = missing_pin(pin, modules)
        if nearest is not None:
            yield problem(
                "pins",
                f'{name} = "{pin}": there is no such pin: LinuxCNC would not start',
                f"write {nearest}, if that is meant" if nearest else "correct its name",
            )


def letters_of_joints(config: Config) -> str:
    """Return the letters of the joints, of trivkins or of the face's kinematics."""
    return joints(config) or face_joints(config.ini.get)


def shared_with_kinematics(config: Config) -> dict[str, str]:
    """Return the signals, by their keys, that the HAL file of the face's kinematics names.

    HAL connects a pin to one signal.
    """
    found = signals(config, hal_lines(ROOT / GUARD_HAL))
    return {key: found[pin] for key, (pin, _) in SIGNALS.items() if pin in found}


def spindle_sections(
    config: Config, requested: Sequence[str], pins: Pins, prefix: str
) -> dict[str, list[str]]:
    """Return the lines that each section gets; ``prefix`` is the package's folder in the INI."""
    joint, found = letters_of_joints(config).index("C"), signals(config, all_hal(config))
    named = {key: found.get(pin.format(joint=joint), own) for key, (pin, own) in SIGNALS.items()}
    new_face = KINEMATICS in requested and not uses_face_kinematics(config)
    named |= shared_with_kinematics(config) if new_face else {}
    drive = [
        line
        for name, pin in pins.drive.items()
        for line in (f"HALCMD = unlinkp {pin}", f"HALCMD = net {DRIVE[name]} => {pin}")
    ]
    return {
        "HAL": [
            f"HALFILE = {prefix}/{SPINDLE_C_HAL}",
            *drive,
            f"HALCMD = loadusr sh {prefix}/{LIMITS_SCRIPT}",
        ],
        "SPINDLE_C": [
            f"JOINT = {joint}",
            *(f"{key} = {signal}" for key, signal in named.items()),
            *(f"{key} = {value:g}" for key, value in pins.numbers.items()),
        ],
    }


# Checks.


def spindle_c_findings(config: Config) -> Iterator[ConfigFinding]:
    if any(PROLOG in remap.handlers for _, remap in config.remaps):
        for rule in SPINDLE_C_RULES:
            yield from rule(config)


def keys_missing(config: Config) -> Iterator[ConfigFinding]:
    needed = ("JOINT", *SIGNALS, *(key for key in NUMBERS if key != "TIMEOUT"))
    missing = [key for key in needed if not config.ini.get("SPINDLE_C", key)]
    if missing:
        yield problem("spindle-c", f"[SPINDLE_C] lacks {', '.join(missing)}: LinuxCNC does not "
                      "start", f"each key is in {SPINDLE_C_PAGE}")  # fmt: skip
        return
    joint, found = config.ini.get("SPINDLE_C", "JOINT"), signals(config, other_lines(config))
    for key, (pin, _) in SIGNALS.items():
        pin, signal = pin.format(joint=joint), config.ini.get("SPINDLE_C", key)
        if found.get(pin, "" if key in ENCODER else signal) != signal:
            yield problem(
                "spindle-c-signal",
                f"[SPINDLE_C] {key} = {signal}, but {pin} is on {found.get(pin, 'no signal')}",
                f"{key} = {found[pin]}" if pin in found else f"net {signal} … => {pin}",
            )


def joint_wrong(config: Config) -> Iterator[ConfigFinding]:
    """Find another joint than C's, whose feedback and homing the HAL file would take."""
    text, joint = config.ini.get("SPINDLE_C", "JOINT", ""), letters_of_joints(config).find("C")
    if text and joint >= 0 and leading_number(text) != joint:
        yield problem(
            "spindle-c",
            f"[SPINDLE_C] JOINT = {text:.40}: C is joint {joint}",
            f"JOINT = {joint}",
        )


def numbers_wrong(config: Config) -> Iterator[ConfigFinding]:
    """Find numbers that HAL or the code refuse, or with which the spindle cannot become C."""
    for key, usual in NUMBERS.items():
        text = config.ini.get("SPINDLE_C", key, f"{usual:g}")
        value = leading_number(text)
        fault = "must be a number" if value is None else wrong_number(key, value)
        if fault and (text or key == "TIMEOUT"):  # `keys_missing` has the other empty ones
            yield problem(
                "spindle-c",
                f"[SPINDLE_C] {key} = {text:.40}: {fault}",
                f"usual is {key} = {usual:g} ({SPINDLE_C_PAGE})",
            )


def wrong_number(key: str, value: float) -> str:
    """Return the rule that a value of `NUMBERS` breaks, "" if none."""
    if not abs(value) <= MAX_MEASURE:  # nor is nan
        return f"must be {MAX_MEASURE:g} at most"
    if key in SIGNED:
        return "" if value else "must not be 0"
    if key == "TIMEOUT" and value > LONGEST_SPINDLE_C:
        return f"must be {LONGEST_SPINDLE_C:g} at most"
    return "" if value > 0.0 else "must be above 0"


def not_connected(config: Config) -> Iterator[ConfigFinding]:
    if not any(names(lines, CONNECTS) for lines in hal_files(config)):
        yield problem(
            "spindle-c-hal",
            "no HALFILE of [HAL] lets the spindle become C: its code would wait in vain",
            f"add HALFILE = …/{SPINDLE_C_HAL} after the files that wire the spindle",
        )
    lines = all_hal(config)
    text = "\n".join(line.text for line in other_lines(config))
    for signal in (DRIVE[name] for name in REQUIRED_PINS):
        if signal not in text:
            yield problem("spindle-c-drive", f"nothing reads {signal}", f"net {signal} => the "
                          f"drive's input ({SPINDLE_C_PAGE})")  # fmt: skip
    if not any(Path(LIMITS_SCRIPT).name in line.text for line in lines):
        yield problem(
            "spindle-c-limits",
            "C's travel is not connected: a C word while the spindle is no C would move nothing",
            f"add HALCMD = loadusr sh …/{LIMITS_SCRIPT} to [HAL]",
        )


def feedback_wrong(config: Config) -> Iterator[ConfigFinding]:
    """Find a joint C whose feedback is not the one that follows while the spindle turns."""
    joint = config.ini.get("SPINDLE_C", "JOINT")
    pin = f"joint.{joint}.motor-pos-fb"
    for text, location in after_own(config):
        if pin in text.split() and not text.startswith("unlinkp"):
            yield problem(
                "spindle-c-feedback",
                f"{location}: {text}: joint {joint} would not follow while the spindle turns",
                f"take the line out: {SPINDLE_C_HAL} has joint C's feedback",
            )


def index_shared(config: Config) -> Iterator[ConfigFinding]:
    found = signals(config, all_hal(config))
    index = found.get(SIGNALS["INDEX"][0])
    for pin, signal in found.items():
        if index and signal == index and re.fullmatch(r"joint\.\d+\.index-enable", pin):
            yield problem(
                "spindle-c-index",
                f"{pin} and spindle.0.index-enable are both on {signal}: before LinuxCNC 2.10 G33 "
                "and G76 then move at once, without waiting for the index (LinuxCNC issue 3556)",
                f"take {pin} off {signal}: C needs no homing to the index",
            )


def axis_c_wrong(config: Config) -> Iterator[ConfigFinding]:
    """Find an axis C without travel, and a joint that would move to be homed."""
    missing = [key for key in ("MIN_LIMIT", "MAX_LIMIT") if not config.ini.get("AXIS_C", key)]
    if missing:
        yield problem(
            "spindle-c-travel",
            f"[AXIS_C] lacks {' and '.join(missing)}, which spindle_c.hal reads",
            "MIN_LIMIT = -99999 and MAX_LIMIT = 99999 for a C that turns without an end",
        )
    joint = f"JOINT_{letters_of_joints(config).find('C')}"
    for key in ("HOME_SEARCH_VEL", "HOME_LATCH_VEL"):
        value = config.ini.get(joint, key)
        if value and value.strip("0.- "):
            yield problem(
                "spindle-c-homing",
                f"[{joint}] {key} = {value}: while it is homed the spindle is no C, nothing turns",
                f"{key} = 0: C is homed where it stands, and C0 is the index by itself",
            )


def drive_misspelt(config: Config) -> Iterator[ConfigFinding]:
    """Find inputs of the drive, of modules unknown here, that other HAL lines name nearly so."""
    lines, modules = other_lines(config), modules_of(config, all_hal(config))
    ours = [line for line in lines if line.text.startswith("net spindle-c-")]
    others = [line for line in lines if line not in ours and not line.text.startswith("unlinkp")]
    named = {pin for line in others for pin in pins_in(substituted(line.text, config))}
    for text, location in ours:
        for pin in set(pins_in(substituted(text, config))) - named:
            near = get_close_matches(pin, named, 1, ALMOST_SAME)
            is_known = owners_of(pin, modules)
            if near and not is_known and NUMBER.sub("", near[0]) != NUMBER.sub("", pin):
                yield warning(
                    "hal-pin",
                    f"{location}: {text}: no other HAL line names {pin}, but one names {near[0]}",
                    f"write {near[0]}, if that is meant",
                )


def live_spindle_missing(config: Config) -> Iterator[ConfigFinding]:
    """Find a machine that has no such spindle as its live tool needs."""
    said = int((config.settings and config.ini.get(INI_SECTION, LIVE_SPINDLE)) or 0)
    live = said or int(any(PROLOG in remap.handlers for _, remap in config.remaps))
    spindles = leading_number(config.ini.get("TRAJ", "SPINDLES") or "") or 1
    loaded = loaded_spindles(config)
    if said and spindles <= said:
        yield problem(
            "live-spindle",
            f"[{INI_SECTION}] LIVE_SPINDLE = {said}, but [TRAJ] SPINDLES is {spindles:g}: "
            f"LinuxCNC refuses S2000 M3 ${said}",
            LIVE_SPINDLE_CURE.format(said + 1, said),
        )
    elif live and spindles <= live:
        yield warning(
            "live-spindle",
            f"[TRAJ] SPINDLES is {spindles:g}: LinuxCNC has no spindle {live} for a live tool, and "
            f"refuses S2000 M3 ${live}",
            f"{LIVE_SPINDLE_CURE.format(live + 1, live)}; nothing, if there is no live tool",
        )
    elif live and loaded and loaded[0] <= live:
        count, (text, location) = loaded
        yield problem(
            "live-spindle",
            f"{location}: {text}: motion has {counted_as(count, 'spindle')}, and no answer to "
            f"S2000 M3 ${live}",
            "add to the line: num_spindles=[TRAJ]SPINDLES",
        )


def loaded_spindles(config: Config) -> tuple[int, HalLine] | None:
    """Return how many spindles motion is loaded with, and the line."""
    for line in all_hal(config):
        text = substituted(line.text, config)
        if LOADS_MOTION.match(text):
            given = NUM_SPINDLES.search(text)
            return int(given[1]) if given else 1, line
    return None


def others_in_the_way(config: Config) -> Iterator[ConfigFinding]:
    yield from in_the_way(other_lines(config))


def in_the_way(lines: Sequence[HalLine]) -> Iterator[ConfigFinding]:
    """Find modules and pins of spindle_c.hal in other HAL lines."""
    own = dict(MODULES.findall((ROOT / SPINDLE_C_HAL).read_text(encoding="utf-8")))
    for text, location in lines:
        command, module, *_ = [*text.split(), "", ""]
        if command == "loadrt" and module in own:
            yield problem(
                "spindle-c-module",
                f"{location}: {text}: LinuxCNC loads a module once, and spindle_c.hal loads "
                f"{module} too",
                f"name its components here as well, names=…,{own[module]}, and take "
                "the line out of a copy of spindle_c.hal",
            )
    owner = "is what the spindle becomes C by"
    yield from pins_taken(lines, OWN_PINS, owner, "use another pin here")


def other_lines(config: Config) -> list[HalLine]:
    """Return the lines of the HAL files other than spindle_c.hal, and those of HALCMD."""
    return [line for line in all_hal(config) if not is_of_spindle_c(line)]


def is_of_spindle_c(line: HalLine) -> bool:
    return line.location.startswith(f"{Path(SPINDLE_C_HAL).name}:")


def after_own(config: Config) -> list[HalLine]:
    """Return the lines after those of spindle_c.hal."""
    lines = all_hal(config)
    own = [number for number, line in enumerate(lines) if is_of_spindle_c(line)]
    own = own or [number for number, line in enumerate(lines) if CONNECTS in line.text]
    return lines[own[-1] + 1 :] if own else []


SPINDLE_C_RULES = (
    keys_missing,
    joint_wrong,
    numbers_wrong,
    not_connected,
    feedback_wrong,
    index_shared,
    axis_c_wrong,
    others_in_the_way,
    drive_misspelt,
)
