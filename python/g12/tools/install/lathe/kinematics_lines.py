# SPDX-License-Identifier: GPL-2.0-or-later
"""Installation of the face's kinematics in the INI of a lathe of the usual form.

That is a lathe on trivkins whose HAL files load `[KINS]KINEMATICS` and whose X, Z and C are joints
of their own. Any other config is not changed: `configs/kinematics/README.md` has the steps.
"""

import re
from collections.abc import Iterator, Sequence
from itertools import chain
from math import isclose

from g12.machine_ini import FACE_KINEMATICS, coordinates_of, leading_number
from g12.tools.install.config import features
from g12.tools.install.config.findings import ConfigFinding, problem
from g12.tools.install.config.ini_edit import NEXT, NOW, IniText
from g12.tools.install.config.loaded import Config, folder_from_ini
from g12.tools.install.lathe.hal import hal_files
from g12.tools.install.lathe.kinematics_rules import (
    GUARD_HAL,
    KINEMATICS_PAGE,
    OFFSET_HAL,
    SHARE,
    are_of_lathe,
)

LIMIT_KEYS = ("MIN_LIMIT", "MAX_LIMIT", "MAX_VELOCITY", "MAX_ACCELERATION")
CHANGED_ENTRIES = (  # entries whose value changes
    ("KINS", "KINEMATICS"),
    ("TRAJ", "COORDINATES"),
    ("AXIS_X", "MIN_LIMIT"),
    ("AXIS_X", "MAX_ACCELERATION"),
    ("G12", "POLAR_KINEMATICS"),  # if it exists
)
LOADS_MODULE = re.compile(r"loadrt\s+\[KINS\]\(?KINEMATICS\)?(\s|$)")
ADDS_CONTROLLER = re.compile(r"addf\s+motion-controller\s+servo-thread(\s|$)")
KINEMATICS_LINE = re.compile(
    r"HALFILE = \S+/configs/kinematics/polar_(kinematics|tool_offset)\.hal"
    r"|POLAR_KINEMATICS = 1|(MIN_LIMIT|MAX_(LIMIT|VELOCITY|ACCELERATION)) = \S+"
)
CURE = f"by hand: the steps in {KINEMATICS_PAGE}, and check reports what is missing or wrong"


def obstacles(config: Config, text: IniText, requested: Sequence[str]) -> Iterator[ConfigFinding]:
    if not {*config.features, *requested}.intersection(features.POLAR_FEATURES):
        yield problem(
            "kinematics", "there is no G12.1 here", "install --with polar polar-kinematics"
        )
    rules = (wrong_joints(config), wrong_limits(config), wrong_entries(config, text))
    for reason in chain(*rules, wrong_hal(config)):
        alone = f"{reason}: install leaves the kinematics of this machine alone"
        yield problem("kinematics", alone, CURE)


def joints(config: Config) -> str:
    """Return the letters of a trivkins machine's joints, "" where they are not given."""
    module, *parameters = (config.ini.get("KINS", "KINEMATICS") or "").split() or [""]
    named = dict(parameter.partition("=")[::2] for parameter in parameters)
    known = module == "trivkins" and set(named) <= {"coordinates", "kinstype"}
    return named.get("coordinates", "").upper() if known else ""


def wrong_joints(config: Config) -> Iterator[str]:
    letters, found = joints(config), config.ini.get("KINS", "KINEMATICS", "nothing")
    axes = coordinates_of(config.ini.get)
    if not letters:
        yield f"[KINS] KINEMATICS = {found} is not trivkins coordinates=…"
    elif not are_of_lathe(letters):
        yield f"[KINS] coordinates={letters} is not X and C, each once, without Y"
    elif set(axes) != set(letters):
        yield f"[TRAJ] COORDINATES = {' '.join(axes)} is not coordinates={letters}"
    elif config.ini.get("KINS", "JOINTS", "").strip() != str(len(letters)):
        yield f"[KINS] JOINTS is not {len(letters)}"


def wrong_limits(config: Config) -> Iterator[str]:
    letters = joints(config)
    if "X" not in letters:
        return
    slide = f"JOINT_{letters.index('X')}"
    needed = [*(("AXIS_X", key) for key in LIMIT_KEYS), *((slide, key) for key in LIMIT_KEYS)]
    needed += [("AXIS_C", key) for key in LIMIT_KEYS[2:]]
    values = {key: leading_number(config.ini.get(*key) or "") for key in needed}
    yield from (f"[{key[0]}] has no {key[1]}" for key, value in values.items() if value is None)
    ends = [values[section, "MAX_LIMIT"] for section in ("AXIS_X", slide)]
    if None not in ends and (ends[0] <= 0.0 or not isclose(*ends)):
        yield f"[AXIS_X] and [{slide}] have MAX_LIMIT {ends[0]:g} and {ends[1]:g}"
    if any(config.ini.get("AXIS_Y", key) for key in LIMIT_KEYS):
        yield "there is an [AXIS_Y]"


def wrong_entries(config: Config, text: IniText) -> Iterator[str]:
    """Yield lines that would change in an included file."""
    for section, key in CHANGED_ENTRIES:
        for line, _ in text.entries(section, key)[:1]:
            if line.file != text.path:
                yield f"{line.location}: {key} is in an included file"


def wrong_hal(config: Config) -> Iterator[str]:
    names = [value.split()[0] for value in config.ini.all("HAL", "HALFILE") if value.strip()]
    for name in names:
        if not name.endswith(".hal") or not folder_from_ini(config.ini, name).is_file():
            yield f"[HAL] HALFILE = {name} is no HAL file beside the INI"
    if config.ini.get("HAL", "TWOPASS"):
        yield "[HAL] TWOPASS is set"
    texts = [line.text for line in chain(*hal_files(config))]
    if any(text.startswith("source ") for text in texts):
        yield "a HAL file has a source line"
    if not any(map(LOADS_MODULE.match, texts)):
        yield "no HAL file has loadrt [KINS]KINEMATICS"
    if not any(map(ADDS_CONTROLLER.match, texts)):
        yield "no HAL file has addf motion-controller servo-thread"


def in_place(config: Config) -> Iterator[tuple[str, str, str]]:
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


def added(config: Config, prefix: str) -> dict[str, list[str]]:
    """Return the lines that each section gets; ``prefix`` is the package's folder in the INI."""
    files = [GUARD_HAL, *([OFFSET_HAL] if config.ini.tool_beside else [])]
    face = [] if config.ini.get("G12", "POLAR_KINEMATICS") else ["POLAR_KINEMATICS = 1"]
    axis = [f"{key} = {value}" for key, value in limits(config).items()]
    return {
        "HAL": [f"HALFILE = {prefix}/{file}" for file in files],
        "G12": face,
        "AXIS_Y": [NOW + NEXT.join(axis), *axis],
    }
