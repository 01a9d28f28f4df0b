# SPDX-License-Identifier: GPL-2.0-or-later
"""The HAL lines of a machine config: files and [HAL]'s commands, signals, pins that are wrong.

A realtime module names its pins by formats such as ``joint.%d.homed`` or ``%s.out``, which are in
its file, so nothing is loaded. Pins of other modules, of programs (``loadusr``) and of Tcl files
are not judged.
"""

import re
import shutil
from collections.abc import Iterable, Iterator
from functools import cache
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from g12.machine_ini import continued
from g12.tools.install.config.findings import ConfigFinding, problem
from g12.tools.install.config.loaded import Config, folder_from_ini

ARROW = re.compile(r"<?=>?")
FROM_INI = re.compile(r"\[(\w+)\]\(?(\w+)\)?")
LIBRARY = "LIB:"  # before the name of a file of LinuxCNC's own
PIN_FORMAT = re.compile(rb"[%a-z][\w%-]*(?:\.[\w%-]+)+(?=\0)")
CONVERSION = re.compile(r"%[0-9]*l?[a-z]")
FITS = dict.fromkeys("diux", "[0-9a-f]+") | {"c": r"\w"}  # what a conversion writes
OF_MOTION = ("motmod", "homemod", "tpmod")  # motmod's own names, and of what it loads
OF_FUNCTIONS = re.compile(r".+\.(time|tmax|tmax-increased)")  # HAL's own, of each function
ODD = frozenset("$[]\\{}")  # in a word that is not a pin's name yet
PIN_WORDS = {  # of a command: its words that are pins
    "net": slice(1, None),
    "linkpp": slice(0, 2),
    "linkps": slice(0, 1),
    "linksp": slice(1, 2),
    "setp": slice(0, 1),
    "getp": slice(0, 1),
    "unlinkp": slice(0, 1),
}


class HalLine(NamedTuple):
    """A line of a HAL file without its comment, and its location."""

    text: str
    location: str


def all_hal(config: Config) -> list[HalLine]:
    """Return all HAL lines, in LinuxCNC's order: files, HALCMD, files for after the screen."""
    commands = [HalLine(text, "HALCMD") for text in config.ini.all("HAL", "HALCMD")]
    return [*hal_files(config, "HALFILE"), *commands, *hal_files(config, "POSTGUI_HALFILE")]


def hal_files(config: Config, key: str) -> Iterator[HalLine]:
    """Yield the lines of the HAL files of a key; a missing one has none."""
    for value in filter(str.strip, config.ini.all("HAL", key)):
        yield from hal_lines(hal_file(config, value.split()[0]))


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


# Pins with which LinuxCNC does not start.


class Modules(NamedTuple):
    """The loaded modules whose files are there: the first parts of their pins, and all formats."""

    heads: frozenset[str]
    formats: tuple[str, ...]

    def lack(self, pin: str) -> bool:
        """Return whether a pin has to be of one of these modules, and none makes it.

        A format may follow other text in the file. The driver of a card names the pins, hostmot2
        makes them.
        """
        head = next((head for head in self.heads if pin.startswith(f"{head}.")), "")
        forms = (form[max(form.find(f"{head}."), 0) :] for form in self.formats)
        made = (pattern_of(form).fullmatch(pin) for form in forms)
        return bool(head) and not OF_FUNCTIONS.fullmatch(pin) and not any(made)


@cache
def pattern_of(form: str) -> re.Pattern:
    """Return the pattern of the pins of a format."""
    fitting = (FITS.get(each[-1], ".+") for each in CONVERSION.findall(form))
    first, *rest = map(re.escape, CONVERSION.split(form))
    return re.compile(first + "".join(chain(*zip(fitting, rest))))


@cache
def formats_in(file: Path) -> frozenset[str]:
    """Return the formats in a module's file."""
    return frozenset(each.decode() for each in PIN_FORMAT.findall(file.read_bytes()))


def modules_of(config: Config, lines: Iterable[HalLine]) -> Modules:
    """Return the modules that HAL lines load, and LinuxCNC itself."""
    folder = linuxcnc_folder("LINUXCNC_RTLIB_DIR")
    components: dict[str, list[str]] = {name: [] for name in OF_MOTION}
    for text, _ in lines:
        command, *words = [*substituted(text, config).split(), ""]
        if command == "loadrt":
            lists = (word.removeprefix("names=") for word in words if word.startswith("names="))
            components.setdefault(words[0], []).extend(",".join(lists).split(","))
    heads: set[str] = set()
    formats: set[str] = set()
    for name, named in components.items() if folder else ():
        file = folder / f"{name}.so"
        if file.is_file():
            own = [name.replace("_", "-")] * (not any(named))
            heads |= {*own, *named, *(each.split(".")[0] for each in formats_in(file)
                                      if each[0] != "%")}  # fmt: skip
            formats |= formats_in(file)
    return Modules(frozenset(heads - {""}), tuple(formats))


def pins_in(text: str) -> list[str]:
    """Return the pins that a HAL line names, without those that Tcl or a shell makes."""
    command, *words = words_of(text)
    pins = words[PIN_WORDS.get(command, slice(0, 0))]
    return [pin for pin in pins if "." in pin and not ODD.intersection(pin)]


def pins_missing(config: Config) -> Iterator[ConfigFinding]:
    """Find pins that no module makes."""
    lines = [line for line in all_hal(config) if ".tcl:" not in line.location]
    modules = modules_of(config, lines)
    aliases = {word for line in lines if line.text.startswith("alias ")
               for word in line.text.split()}  # fmt: skip
    for text, location in lines:
        for pin in pins_in(substituted(text, config)):
            if pin not in aliases and modules.lack(pin):
                yield problem(
                    "hal-pin",
                    f"{location}: {text}: there is no pin {pin}: LinuxCNC does not start",
                    "correct its name",
                )


def pins_taken(config: Config) -> Iterator[ConfigFinding]:
    """Find pins on two signals, and modules that are loaded twice."""
    found: dict[str, str] = {}
    loaded: set[str] = set()
    for line in all_hal(config):
        command, name, *_ = [*substituted(line.text, config).split(), "", ""]
        if command in ("unlinkp", "delsig"):
            found = {pin: signal for pin, signal in found.items() if name not in (pin, signal)}
        if command == "loadrt" and name in loaded and not config.ini.get("HAL", "TWOPASS"):
            yield problem(
                "hal-module",
                f"{line.location}: {line.text}: {name} is loaded already: LinuxCNC does not start",
                "name the components of both in one line, names=…, in a copy of the file",
            )
        loaded |= {name} if command == "loadrt" and name else set()
        for pin, signal in signals(config, [line]).items():
            if found.setdefault(pin, signal) != signal:
                yield problem(
                    "pin-taken",
                    f"{line.location}: {line.text}: {pin} is on {found[pin]} already, and HAL "
                    "connects a pin to one signal: LinuxCNC does not start",
                    f"call the signal {found[pin]} here too, or use another pin",
                )
