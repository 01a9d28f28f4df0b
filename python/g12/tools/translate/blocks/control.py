# SPDX-License-Identifier: GPL-2.0-or-later
"""A control as data: its TOML file, checked, over that of the control that it is based on.

Every key is known, every value legal, no code has two meanings: whatever else is in a file is
refused with its line. What a code does is one of

- ``same``: LinuxCNC's own code of that number does the same
- ``comment``: no action, it stays as a comment; ``comment P E`` with its P and E words
- ``machine``: the builder's; the machine itself must know it (a REMAP line, an M1xx file)
- ``refuse: sentence``: refused, the sentence names the alternative
- a name of MEANINGS: a rule of the translation
- codes of LinuxCNC, ``M7`` or ``M3 $1``: written in its place; in ``M3 $1 S=P`` S is its P word
- what each machine has in its own way (PLACES): ``clamp C``, ``C axis on``; ``M3 $live`` starts the
  spindle that drives the tool, ``M5 $all`` stops each
"""

import re
import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from g12.tools.errors import UsageError
from g12.tools.translate.blocks.expressions import OWN

CONTROL_FOLDER = Path(__file__).parents[1] / "controls"
HOLE_MEANINGS = ("face hole", "face bore", "side hole", "side bore")  # cycles of a lathe
MEANINGS = {
    "G": (
        "dwell", "polar on", "polar off", "cylinder", "speed limit or origin",
        "numbered offset", "offset by program", "exact stop", "macro call", "cancel cycle",
        "drilling cycle", "roughing along Z", "roughing along X", "finishing",
        "pecking along Z", "pecking along X", "turning pass", "facing pass", "thread pass",
        "threading", "thread",
        *HOLE_MEANINGS,
        "radius or diameter",
    ),
    "M": ("subprogram", "local subprogram", "return", "thread chamfer",
        "no thread chamfer", "tool change",
    ),
}  # fmt: skip
PLACES = ("clamp C", "unclamp C", "C axis on", "C axis off")  # of M codes: `on_machine`
OWN_CODES = re.compile(r"[GMS][0-9.]+(?: (?:[GMSP][0-9.]+|\$(?:[0-9]+|live|all)|S=P))*")
CODE = re.compile(r"[GM][0-9]{1,3}(?:\.[0-9])?")
RANGE = re.compile(r"([GM])([0-9]{1,3})-([GM])([0-9]{1,3})")


KEYS = tomllib.loads(Path(__file__).with_name("keys.toml").read_text(encoding="utf-8"))
TOP, TABLES = KEYS["top"], KEYS["tables"]
CODE_TABLES = frozenset(("g_codes", "m_codes"))
REMARKS = frozenset(("sources", "readings"))  # for who reads the file
MAX_NUMBER = 1e9


TYPES: dict[str, tuple[Callable[[Any], object], str]] = {
    "text": (lambda value: isinstance(value, str), "a text"),
    "texts": (lambda value: isinstance(value, list), "a list of texts"),
    "flag": (lambda value: isinstance(value, bool), "true or false"),
    "number": (
        lambda value: type(value) in (int, float) and 0 < value <= MAX_NUMBER,
        f"a number above 0, {MAX_NUMBER:g} at most",
    ),
}


def _broken_rule(rule: Any, value: Any) -> str:
    """Return what a value must be by a rule of ``keys.toml``, "" if it is that."""
    if isinstance(rule, str):
        accepts, must = TYPES[rule]
        return "" if accepts(value) else must
    if "one_of" in rule:
        return "" if value in rule["one_of"] else f"one of {', '.join(rule['one_of'])}"
    is_list = isinstance(value, list)
    texts = value if is_list else [value]
    is_like = all(isinstance(one, str) and re.fullmatch(rule["like"], one) for one in texts)
    return "" if is_like and is_list == rule.get("each", False) else rule["must"]


OWNED = frozenset(  # M codes of LinuxCNC itself that a builder's code of that number is not
    f"M{n}" for n in (*range(10), 19, 30, *range(48, 54), *range(60, 74))
)
COMMENT = re.compile(r"comment( [A-Z])*")


class ControlError(UsageError):
    """A control file that cannot be used; the message names the file, the line and the rule."""


@dataclass(frozen=True)
class Control:
    """One control, on one machine."""

    name: str
    title: str
    machine: str  # ``mill`` or ``lathe``
    axes: str  # of the machine
    meanings: Mapping[str, str]  # by code
    start: tuple[str, ...] = ()  # codes that hold when a program begins
    decimals: str = ""  # numbers without a point: ``least`` increments, ``whole`` units, "" unknown
    feed_of_c: str = ""  # ``mm``: F is along the slides alone where C moves beside them
    at_zero: str = ""  # axes that the machine lacks and whose words may be 0
    extensions: tuple[str, ...] = ("nc",)  # of its programs' files, the usual one first
    remarks: bool = False  # text after ``;`` is a remark
    tables: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    machine_codes: frozenset[str] | None = None  # M codes of the machine itself, None: not known
    live_spindle: str = "1"  # LinuxCNC's spindle that drives the tool, "" unknown
    polar_codes: tuple[str, str] = ("G12.1", "G13.1")  # LinuxCNC's, on and off
    cylinder_code: tuple[str, str] = ("G7.1", "radius")  # and what its C is: radius or diameter
    notes: tuple[str, ...] = ()  # messages about a program, as lines
    c_axis_on: frozenset[str] = frozenset()  # codes that stop the main spindle and make it C

    @property
    def is_lathe(self) -> bool:
        """Whether X is programmed as a diameter, and U W H are increments."""
        return self.machine == "lathe"

    @property
    def on_machine(self) -> bool:
        """Whether the machine's INI has its say, `on_machine`."""
        return self.machine_codes is not None

    @property
    def turns_c(self) -> bool:
        """Whether its programs are for a lathe with C and a live tool."""
        return self.is_lathe or bool(self.onto)

    @property
    def onto(self) -> str:
        """Where a mill's flat program goes: ``face``, ``round``, "" for any other control."""
        return self.value("mill", "onto")

    def variables(self) -> dict[int, str]:
        """Return what is written for each variable that is the control's own."""
        found: dict[int, str] = {}
        variables: Mapping[str, Any] = self.tables.get("variables", {})
        for key, value in variables.items():
            first, _, last = key.partition("-")
            for offset, number in enumerate(range(int(first), int(last or first) + 1)):
                if value.startswith("#"):
                    found[number] = f"#{OWN}{int(value[1:]) + offset}"
                elif value != "own":
                    found[number] = value
        return found

    def is_machines(self, code: str) -> bool:
        """Whether the machine itself has an M code, by a REMAP line or an M1xx file."""
        return code in (self.machine_codes or ())

    def value(self, table: str, key: str, default: object = "") -> Any:
        return self.tables.get(table, {}).get(key, default)


def shipped_controls() -> list[str]:
    return sorted(path.stem for path in CONTROL_FOLDER.glob("*.toml"))


def read_control(name: str) -> Control:
    path = _path_of(name)
    data = _with_base(path, ())
    missing = [key for key in ("machine", "axes", "g_codes", "m_codes") if key not in data]
    if missing:
        raise ControlError(f"{path}: {missing[0]} is missing: say it, or based_on another control")
    given: dict[str, Any] = {k: v for k, v in data.items() if k in TOP.keys() - REMARKS}
    given |= {key: tuple(data[key].split()) for key in ("start", "extensions") if key in data}
    return Control(
        name=path.stem,
        **{"title": path.stem, **given},
        meanings={**data["g_codes"], **data["m_codes"]},
        c_axis_on=frozenset(code for code, as_ in data["m_codes"].items() if as_ == "C axis on"),
        tables={name: data[name] for name in TABLES if name in data},
    )


def _path_of(name: str) -> Path:
    if name.endswith(".toml"):
        return Path(name)
    if name not in shipped_controls():
        raise ControlError(f"no control {name}: translate --list names them; or give a .toml file")
    return CONTROL_FOLDER / f"{name}.toml"


def _with_base(path: Path, above: tuple[Path, ...]) -> dict:
    if path.resolve() in above:
        raise ControlError(f"{path}: is based on itself")
    data = _data(path)
    base = data.pop("based_on", "")
    if not base:
        return data
    if base.endswith(".toml"):
        base = str(path.parent / base)
    under = _with_base(_path_of(base), (*above, path.resolve()))
    tables = {k: {**under.get(k, {}), **v} for k, v in data.items() if isinstance(v, dict)}
    return {**under, **data, **tables}


def _data(path: Path) -> dict:
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as problem:
        raise ControlError(f"{path}: {problem}") from None
    try:
        data = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as problem:
        raise ControlError(f"{path}: {problem}") from None
    return _Checked(path, text).data(data)


class _Checked:
    """The checks of one file, which know the lines of its keys."""

    def __init__(self, path: Path, text: str) -> None:
        self._path, self._rows = path, text.splitlines()

    def data(self, data: dict) -> dict:
        """Return the data with every list and range of codes written out."""
        for key, value in data.items():
            if key in TOP:
                self._check(key, value, TOP[key])
            elif key not in TABLES and key not in CODE_TABLES:
                self._refuse(key, f"{key} is no key of a control")
            elif not isinstance(value, dict):
                self._refuse(key, f"{key} is a table: [{key}]")
            elif key in TABLES:
                self._check_table(key, value)
        codes = {key: self._codes(key[0].upper(), data[key]) for key in CODE_TABLES & data.keys()}
        return {**data, **codes}

    def _check_table(self, name: str, table: dict) -> None:
        rules = TABLES[name]
        for key, value in table.items():
            if "keys" in rules and not re.fullmatch(rules["keys"], key):
                self._refuse(key, f"{key} = {value!r} must be {rules['must']}")
            elif "keys" not in rules and key not in rules:
                self._refuse(key, f"{key} is no key of [{name}]: {', '.join(rules)}")
            self._check(key, value, rules if "keys" in rules else rules[key])

    def _check(self, key: str, value: Any, rule: Any) -> None:
        if must := _broken_rule(rule, value):
            self._refuse(key, f"{key} = {value!r} must be {must}")

    def _codes(self, letter: str, table: dict) -> dict[str, str]:
        """Return the meaning of every code; a code that is named twice is refused."""
        meanings: dict[str, str] = {}
        for key, code, meaning in self._rows_of(table):
            for one in self._each(letter, code, key):
                if one in meanings:
                    self._refuse(key, f"{one} has two meanings")
                if one in OWNED and meaning == "machine":
                    self._refuse(key, f"{one} is LinuxCNC's own: no machine can give it a meaning")
                meanings[one] = self._meaning(letter, key, meaning)
        return meanings

    def _rows_of(self, table: dict) -> Iterator[tuple[str, str, str]]:
        """Yield each code or range of a table, with its key before it and its meaning behind."""
        for key, value in table.items():
            listed = key in ("same", "comment", "machine")
            if isinstance(value, dict):
                self._refuse(
                    key, f'a code with a point is written in quotes: "{key}.{next(iter(value))}"'
                )
            if not isinstance(value, list if listed else str):
                self._refuse(key, f"{key} must be a {'list of codes' if listed else 'text'}")
            if not listed:
                yield key, key, value
                continue
            for entry in value:
                code, *words = str(entry).split(" ")
                yield key, code, " ".join([key, *words])

    def _each(self, letter: str, code: str, key: str) -> list[str]:
        """Return the codes of ``G110-G129``, or the one code."""
        span = RANGE.fullmatch(code)
        if span and span[1] == span[3] == letter and int(span[2]) < int(span[4]):
            return [f"{letter}{number}" for number in range(int(span[2]), int(span[4]) + 1)]
        if not CODE.fullmatch(code) or code[0] != letter:
            self._refuse(
                key, f"{code} is no {letter} code such as {letter}31, or {letter}31-{letter}33"
            )
        return [code]

    def _meaning(self, letter: str, key: str, value: str) -> str:
        places = PLACES if letter == "M" else ()
        known = value in ("same", "machine", *MEANINGS[letter], *places) or COMMENT.fullmatch(value)
        if not known and not value.startswith("refuse: ") and not OWN_CODES.fullmatch(value):
            names = ", ".join(("same", "comment", "machine", "refuse: …", *MEANINGS[letter]))
            self._refuse(key, f'{key} = "{value}" must be one of {names}, or codes of LinuxCNC')
        return value

    def _refuse(self, key: str, rule: str) -> None:
        """Raise the error of a key, with the line that it is in."""
        pattern = re.compile(rf'\s*\[?"?{re.escape(key)}"?(\.|\s*(=|\]|$))')
        rows = [number for number, row in enumerate(self._rows, 1) if pattern.match(row)]
        location = f":{rows[0]}" if rows else ""
        raise ControlError(f"{self._path}{location}: {rule}")
