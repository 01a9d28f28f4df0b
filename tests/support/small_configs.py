# SPDX-License-Identifier: GPL-2.0-or-later
"""Small machine configs for the tests of check and install."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from g12.tools.install import installation, package_copy
from g12.tools.install.config import features
from g12.tools.install.config.findings import ConfigFinding, Refused
from g12.tools.install.config.ini_edit import IniText
from g12.tools.install.config.loaded import Config, Python
from g12.tools.install.lathe import kinematics
from g12.tools.install.lathe.spindle_c import Pins, pins_in_ini
from g12.tools.install.plan import make_plan

MILL = """\
[EMC]
VERSION = 1.1

[RS274NGC]
PARAMETER_FILE = mill.var

[TRAJ]
COORDINATES = X Y Z
LINEAR_UNITS = mm

[EMCIO]
TOOL_TABLE = mill.tbl
"""
LATHE = MILL.replace("X Y Z", "X Z C") + "\n[AXIS_C]\nWRAPPED_ROTARY = 1\n"
# A lathe of the usual form, whose spindle has an encoder.
TURNING_HAL = """\
loadrt [KINS]KINEMATICS
loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS
addf motion-command-handler servo-thread
addf motion-controller servo-thread
net x joint.0.motor-pos-cmd => joint.0.motor-pos-fb
net c joint.2.motor-pos-cmd => joint.2.motor-pos-fb
net turns encoder.position => spindle.0.revs
net rps encoder.velocity => spindle.0.speed-in
net index encoder.index-enable <=> spindle.0.index-enable
"""
TURNING = """\
[RS274NGC]
PARAMETER_FILE = lathe.var

[TRAJ]
COORDINATES =   X Z C
LINEAR_UNITS = mm

[KINS]
KINEMATICS = trivkins coordinates=xzc kinstype=B
JOINTS = 3

[HAL]
HALFILE = motion.hal
POSTGUI_HALFILE = later.hal

[AXIS_X]
MIN_LIMIT = -5.0
MAX_LIMIT = 200.0
MAX_VELOCITY = 100
MAX_ACCELERATION = 1000

[JOINT_0]
MIN_LIMIT = -5
MAX_LIMIT = 200
MAX_VELOCITY = 100
MAX_ACCELERATION = 1000

[AXIS_C]
MIN_LIMIT = -99999
MAX_LIMIT = 99999
MAX_VELOCITY = 360
MAX_ACCELERATION = 3600

[JOINT_2]
HOME_SEARCH_VEL = 0.0
"""
HAAS = """\
REMAP = G12 modalgroup=1 prolog=g12_haas ngc=g12_haas epilog=cycle_done
REMAP = G13 modalgroup=1 prolog=g13_haas ngc=g12_haas epilog=cycle_done
"""
TOOLS = "T1 P1 D6.0 ;end mill\nT2 P2 D10\n"


def write_config(folder: Path, text: str = MILL, name: str = "mill.ini", **files: str) -> Path:
    """Write an INI, a tool table and further files (``a__b_py`` is a/b.py); return the INI."""
    ini = folder / name
    ini.write_bytes(text.encode("utf-8", "surrogateescape"))
    (folder / "mill.tbl").write_text(TOOLS, encoding="utf-8")
    for key, content in files.items():
        stem, _, suffix = key.replace("__", "/").rpartition("_")
        path = folder / f"{stem}.{suffix}"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode())
    return ini


def with_lines(text: str, section: str, lines: str) -> str:
    """Return an INI with lines put at the head of a section."""
    return text.replace(f"[{section}]\n", f"[{section}]\n{lines}")


def config_of(ini: Path | IniText, *, failure=None, owned=(), version="2.9.0", **python) -> Config:
    """Return the config of an INI that no LinuxCNC has loaded."""
    text = ini if isinstance(ini, IniText) else IniText(ini)
    loaded = Python(**python)
    return Config(text, text.ini(), version, loaded, frozenset(owned), failure)


def content_of(folder: Path) -> dict[str, bytes]:
    """Return every file of a folder with its content."""
    files = (path for path in sorted(folder.rglob("*")) if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def planned(ini: Path, *names: str, pins: Pins | None = None, options: str = "", **python):
    """Return the lines of an INI that no LinuxCNC has loaded, with an installation planned."""
    text = IniText(ini)
    earlier, pins = text.words(), pins or pins_in_ini(text.ini())
    text.take_out()
    asked = [name for name in features.FEATURE_NAMES if name in (*earlier, *names)]
    return make_plan(config_of(text, **python), asked, pins, options)


def put_in(ini: Path, *names: str, **options) -> list[str]:
    """Install features in an INI that no LinuxCNC has loaded; return the lines to show."""
    text = planned(ini, *names, **options)
    copy = ini.parent / features.COPY
    files = {} if package_copy.is_current(copy) else package_copy.package_files()
    return list(installation.write_all(text.changes(), copy, files))


def refused(ini: Path, *names: str, **options) -> tuple[ConfigFinding, ...]:
    """Return the findings of a refusal, which writes nothing."""
    before = content_of(ini.parent)
    with pytest.raises(Refused) as caught:
        put_in(ini, *names, **options)
    assert content_of(ini.parent) == before
    return caught.value.args


def take_out(ini: Path) -> list[str]:
    """Uninstall; return the lines to show."""
    return list(installation.uninstall(IniText(ini), dry_run=False))


@contextmanager
def restored(ini: Path) -> Iterator[None]:
    """Uninstall in the end; every file of the INI's folder is as it was."""
    before = content_of(ini.parent)
    yield
    take_out(ini)
    assert content_of(ini.parent) == before


def files_of_package(*names: str) -> dict[str, bytes]:
    """Return files of the real package, for a small one."""
    return {name: (features.ROOT / name).read_bytes() for name in names}


def module_of_kinematics(autouse: bool = False):
    """Return a fixture: the file of the kinematics' module in this LinuxCNC."""

    @pytest.fixture(autouse=autouse)
    def module(tmp_path_factory, monkeypatch):
        file = tmp_path_factory.mktemp("modules") / "polar_xzc.so"
        file.write_bytes(b"%s" + kinematics.NEWEST_PIN)
        monkeypatch.setattr(kinematics, "module_file", lambda: file if file.exists() else None)
        return file

    return module


def package_of(files: dict[str, bytes]):
    """Return a fixture: install copies these files, not those of the real package."""

    @pytest.fixture(autouse=True)
    def small_package(monkeypatch):
        monkeypatch.setattr(package_copy, "package_files", lambda: dict(files))

    return small_package
