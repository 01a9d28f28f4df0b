# SPDX-License-Identifier: GPL-2.0-or-later
"""The HAL lines of a machine config: its files and [HAL]'s commands, their signals and pins."""

import re
import shutil
from collections.abc import Iterable
from functools import cache
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from g12.machine_ini import continued
from g12.tools.install.config.loaded import Config, folder_from_ini

ARROW = re.compile(r"<?=>?")
FROM_INI = re.compile(r"\[(\w+)\]\(?(\w+)\)?")
LIBRARY = "LIB:"  # before the name of a file of LinuxCNC's own


class HalLine(NamedTuple):
    """A line of a HAL file without its comment, and its location."""

    text: str
    location: str


def hal_files(config: Config, key: str = "HALFILE") -> list[list[HalLine]]:
    """Return the lines of each HAL file, in LinuxCNC's order; a missing one has none."""
    names = (value.split()[0] for value in config.ini.all("HAL", key) if value.strip())
    return [hal_lines(hal_file(config, name)) for name in names]


def hal_file(config: Config, name: str) -> Path:
    """Return a HAL file that the INI names: one in its folder, else one of LinuxCNC's own."""
    own, library = folder_from_ini(config.ini, name), linuxcnc_folder("HALLIB_DIR")
    if library and (name.startswith(LIBRARY) or not own.exists()):
        return library / name.removeprefix(LIBRARY)
    return own


@cache
def linuxcnc_folder(name: str) -> Path | None:
    """Return a folder of the LinuxCNC on this computer by its name in the script ``linuxcnc``."""
    script = shutil.which("linuxcnc")
    text = Path(script).read_text(encoding="utf-8", errors="replace") if script else ""
    folder = re.search(rf"^{name}=([^\s;]+)", text, re.MULTILINE)
    return Path(folder[1]) if folder else None


def hal_lines(path: Path) -> list[HalLine]:
    """Return the lines of a HAL file that are not blank, without comments."""
    if not path.is_file():
        return []
    texts = path.read_text(encoding="utf-8", errors="replace").splitlines()
    found, number = [], 1
    for rows in continued([text.partition("#")[0].strip() for text in texts]):
        text = " ".join(row.rstrip("\\ ") for row in rows).strip()
        found += [HalLine(text, f"{path.name}:{number}")] if text else []
        number += len(rows)
    return found


def later_hal(config: Config) -> list[HalLine]:
    """Return the lines of HALCMD, and of the HAL files for after the screen's start."""
    commands = [HalLine(text, "HALCMD") for text in config.ini.all("HAL", "HALCMD")]
    return [*commands, *chain(*hal_files(config, "POSTGUI_HALFILE"))]


def all_hal(config: Config) -> list[HalLine]:
    """Return all HAL lines, in LinuxCNC's order."""
    return [*chain(*hal_files(config)), *later_hal(config)]


def substituted(text: str, config: Config) -> str:
    """Return a HAL line with the INI's values in it."""
    return FROM_INI.sub(lambda named: config.ini.get(named[1], named[2]) or "", text)


def names(lines: list[HalLine], *words: str) -> bool:
    return any(word in line.text for line in lines for word in words)


def words_of(text: str) -> list[str]:
    """Return the words of a HAL line, its command first, without arrows."""
    return [word for word in text.split() if not ARROW.fullmatch(word)] or [""]


def signals(config: Config, lines: Iterable[HalLine]) -> dict[str, str]:
    """Return the signal of each pin that HAL lines connect, with the INI's values in both."""
    found = {}
    for text, _ in lines:
        command, *words = words_of(substituted(text, config))
        if command == "linkps":
            words.reverse()
        if command in ("net", "linkps", "linksp") and words:
            found.update(dict.fromkeys(words[1:], words[0]))
    return found
