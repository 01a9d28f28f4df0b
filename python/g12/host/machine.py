# SPDX-License-Identifier: GPL-2.0-or-later
"""The machine's values in the INI, each read at its first use."""

from __future__ import annotations

import contextlib
import ctypes
import functools
import os
from collections.abc import Iterator, Sequence
from pathlib import Path

import linuxcnc

from g12 import machine_ini
from g12.errors import Refusal
from g12.settings import INI_SECTION, TOPLEVEL, Settings, settings_from_ini


def ini_file() -> str | None:
    """Return the name of the INI file that LinuxCNC gives in ``INI_FILE_NAME``.

    `rs274 -i` does so after Python's start, which is when `os.environ` is made.
    """
    getenv = ctypes.CDLL(None).getenv
    getenv.restype = ctypes.c_char_p
    name = getenv(b"INI_FILE_NAME")
    return os.fsdecode(name) if name else None


def users_toplevel() -> str:
    """Return the file that [G12] TOPLEVEL names, as LinuxCNC finds it: in its working folder."""
    ini = ini_file()
    lines = list(machine_ini.with_included(Path(ini))) if ini else []
    return os.path.expanduser(machine_ini.value_in(lines, INI_SECTION, TOPLEVEL) or "")


class Values:
    """LinuxCNC's reader of the INI; of 2.9 it fails with a value that is no UTF-8."""

    def __init__(self, path: str) -> None:
        self._ini = linuxcnc.ini(path)

    def find(self, section: str, key: str) -> str | None:
        with refusing(section, key):
            return self._ini.find(section, key)

    def findall(self, section: str, key: str) -> Sequence[str]:
        with refusing(section, key):
            return self._ini.findall(section, key)


@contextlib.contextmanager
def refusing(section: str, key: str) -> Iterator[None]:
    try:
        yield
    except UnicodeDecodeError:
        raise Refusal(f"[{section}] {key}: has a byte that is no UTF-8") from None


class RunningMachine:
    def read(self, *parts: str) -> None:
        """Read properties now, so that a value that cannot be used raises its Refusal here."""
        for part in parts:
            getattr(self, part)

    @staticmethod
    def digital_input(number: int) -> bool:
        """Return an input of motion as it is now."""
        status = linuxcnc.stat()
        status.poll()
        return bool(status.din[number])

    @functools.cached_property
    def settings(self) -> Settings:
        return settings_from_ini(ini_file())

    @property
    def switches_kinematics(self) -> bool:
        """Whether sections on the face run by the machine's kinematics."""
        return self.settings.polar_kinematics

    @functools.cached_property
    def _ini(self) -> Values:
        return Values(ini_file() or os.devnull)

    @functools.cached_property
    def remaps(self) -> dict[str, machine_ini.Remap]:
        return {remap.code: remap for remap in machine_ini.remap_lines(self._ini.findall)}

    @functools.cached_property
    def m_codes(self) -> frozenset[int]:
        """The numbers of the M codes that the machine has besides LinuxCNC's."""
        return machine_ini.m_codes_of(self._ini.find, self.remaps.values())

    @functools.cached_property
    def coordinates(self) -> set[str]:
        return set(machine_ini.coordinates_of(self._ini.find))

    @functools.cached_property
    def axes(self) -> dict[str, machine_ini.Axis]:
        """The limits of the axes; raises Refusal for a value that no axis can have."""
        return machine_ini.axes_of(self._ini.find, self.coordinates | set("XZC"))

    @functools.cached_property
    def face(self) -> machine_ini.FaceAxes | None:
        """The axes of the part's face, None without the kinematics of the face."""
        return machine_ini.face_of(self._ini.find)

    @functools.cached_property
    def travel(self) -> dict[str, tuple[float, float]]:
        """The lowest and highest position of X, Y and Z in machine units."""
        return machine_ini.ranges_of(self._ini.find, "XYZ")

    @functools.cached_property
    def spindle_c_code(self) -> str:
        """The code that makes the spindle C, "" where none does."""
        return machine_ini.code_of_prolog(self.remaps.values(), "spindle_c_on")

    @functools.cached_property
    def spindle_c_timeout(self) -> float:
        """How long the spindle may take to become C, in seconds."""
        path = ini_file()  # LinuxCNC 2.9 hands out no empty value
        lines = list(machine_ini.with_included(Path(path))) if path else []
        return machine_ini.spindle_c_timeout(functools.partial(machine_ini.value_in, lines))


MACHINE = RunningMachine()
