# SPDX-License-Identifier: GPL-2.0-or-later
"""Pins that the HAL lines of a config name, and that none of its modules makes.

A realtime module names its pins by formats such as ``joint.%d.homed`` or ``%s.out``, which are in
its file, so nothing is loaded. Pins of other modules, of programs (``loadusr``) and of Tcl files
are not judged.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from difflib import get_close_matches
from functools import cache
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from g12.tools.install.config.findings import ConfigFinding, problem
from g12.tools.install.config.loaded import Config
from g12.tools.install.lathe.hal import ARROW, HalLine, all_hal, linuxcnc_folder, substituted

PIN_FORMAT = re.compile(rb"[%a-z][\w%-]*(?:\.[\w%-]+)+(?=\0)")
CONVERSION = re.compile(r"%[0-9]*l?[a-z]")
FITS = dict.fromkeys("diux", "[0-9a-f]+") | {"c": r"\w"}  # what a conversion writes
PIN_NUMBERS = re.compile(r"\d+|(?<=\.)[a-z](?=\.)")  # and letters of axes
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


class Module(NamedTuple):
    """A realtime module: the names given to its components, and its formats of pins."""

    name: str
    components: tuple[str, ...]
    formats: tuple[str, ...]

    @property
    def heads(self) -> set[str]:
        """The first parts of its pins' names, where its components have no names."""
        own = {form.split(".")[0] for form in self.formats if form[0] != "%"}
        return own | (set() if self.components else {self.name.replace("_", "-")})

    def component_of(self, pin: str) -> str:
        """Return the component whose pin that must be, "" without one."""
        return next((name for name in self.components if pin.startswith(f"{name}.")), "")

    def makes(self, pin: str, component: str) -> bool:
        """Return whether a component, or "" any, has a pin.

        A format may follow other text in the file.
        """
        head = f"{pin.split('.')[0]}."
        forms = {form[max(form.find(head), 0) :] for form in self.formats}
        return any(pattern_of(form, component).fullmatch(pin) for form in forms)

    def names_like(self, pin: str, component: str) -> Iterator[str]:
        """Yield the names that its pins could have, with the numbers of ``pin`` in their place."""
        component = component or pin.rpartition(".")[0]
        for form in self.formats:
            name = form.replace("%s", component, 1) if form.startswith("%s") else form
            numbers = iter(PIN_NUMBERS.findall(pin))
            yield CONVERSION.sub(lambda _: next(numbers, "0"), name)  # noqa: B023


@cache
def pattern_of(form: str, component: str) -> re.Pattern:
    """Return the pattern of the pins of a format."""
    form = form.replace("%s", component, 1) if component and form.startswith("%s") else form
    fitting = (FITS.get(each[-1], ".+") for each in CONVERSION.findall(form))
    first, *rest = map(re.escape, CONVERSION.split(form))
    return re.compile(first + "".join(chain(*zip(fitting, rest))))


@cache
def formats_in(file: Path) -> tuple[str, ...]:
    """Return the formats in a module's file."""
    return tuple(sorted({each.decode() for each in PIN_FORMAT.findall(file.read_bytes())}))


def modules_of(config: Config, lines: Iterable[HalLine]) -> list[Module]:
    """Return the modules that HAL lines load, and LinuxCNC itself, whose files are there."""
    folder = linuxcnc_folder("LINUXCNC_RTLIB_DIR")
    named: dict[str, tuple[str, ...]] = dict.fromkeys(OF_MOTION, ())
    for text, _ in lines:
        command, *words = [*substituted(text, config).split(), ""]
        if command == "loadrt":
            named[words[0]] = (*named.get(words[0], ()), *components_of(words))
    files = {name: folder / f"{name}.so" for name in named} if folder else {}
    return [Module(name, named[name], formats_in(file)) for name, file in files.items()
            if file.is_file()]  # fmt: skip


def components_of(words: list[str]) -> list[str]:
    """Return the names in ``loadrt and2 names=a,b``."""
    lists = (word.removeprefix("names=") for word in words if word.startswith("names="))
    return [name for names in lists for name in names.split(",") if name]


def pins_in(text: str) -> list[str]:
    """Return the pins that a HAL line names, without those that Tcl or a shell makes."""
    command, *words = ARROW.sub(" ", text).split() or [""]
    pins = words[PIN_WORDS.get(command, slice(0, 0))]
    return [pin for pin in pins if "." in pin and not ODD.intersection(pin)]


def owners_of(pin: str, modules: Sequence[Module]) -> list[tuple[Module, str]]:
    """Return the modules, with their component or "", one of which must make a pin; else none."""
    named = [(module, component) for module in modules if (component := module.component_of(pin))]
    return named + [(module, "") for module in modules if pin.split(".")[0] in module.heads]


def missing_pin(pin: str, modules: Sequence[Module]) -> str | None:
    """Return the nearest name if no module makes a pin that must be theirs, "" without a near one.

    A pin of a named component must be of its module. Any other may be of a module that shares the
    head of its name: the driver of a card names it, hostmot2 makes it.
    """
    owners = owners_of(pin, modules)
    is_named = any(component for _, component in owners)
    makers = owners if is_named else [(module, "") for module in modules]
    if not owners or OF_FUNCTIONS.fullmatch(pin) or any(m.makes(pin, name) for m, name in makers):
        return None
    names = {name for module, component in owners for name in module.names_like(pin, component)}
    return next(iter(get_close_matches(pin, sorted(names), 1)), "")


def pins_missing(config: Config) -> Iterator[ConfigFinding]:
    """Find pins that no module makes: LinuxCNC does not start."""
    lines = [line for line in all_hal(config) if ".tcl:" not in line.location]
    modules, aliases = modules_of(config, lines), names_by_alias(lines)
    for text, location in lines:
        for pin in pins_in(substituted(text, config)):
            nearest = None if pin in aliases else missing_pin(pin, modules)
            if nearest is not None:
                yield problem(
                    "hal-pin",
                    f"{location}: {text}: there is no pin {pin}: LinuxCNC does not start",
                    f"write {nearest}, if that is meant" if nearest else "correct its name",
                )


def names_by_alias(lines: Iterable[HalLine]) -> set[str]:
    words = (line.text.split() for line in lines)
    return {name for command, *names in words if command == "alias" for name in names}
