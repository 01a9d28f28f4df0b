# SPDX-License-Identifier: GPL-2.0-or-later
"""The blocks that a program executes, with their words and the values of expressions.

This module reads the program's text. LinuxCNC's own interpreter supplies the order of execution,
the values of expressions and the tool's position: ``(DEBUG, …)`` lines around the blocks report
them, in a copy of the program that is traced. No code is shared with the planners, so that
``verify`` reads the program independently.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from g12.tools.preview.moves import Event, Trace

TAG = "g12-verify"
CLAMP = "clamp"  # printed by the sub of a clamp code; the first word of its event
CLAMP_TOLD = f"{TAG} {CLAMP} "
VALUE = "#<@>"  # short: a line that LinuxCNC reads has 252 characters at most
LONGEST_REPORT_LINE = 252  # characters
ENLARGED = 1_000_000  # factor: LinuxCNC 2.9 prints values below 0.0001 as 0
POSITION_NAMES = ("_x", "_y", "_z", "_c")
STATE_NAMES = (
    *(*POSITION_NAMES, "_metric", "_absolute", "_lathe_diameter_mode", "_feed"),
    *("_units_per_rev", "_rpm", "_motion_mode", "_plane", "_ijk_absolute_mode", "_selected_tool"),
)
FEED_UNKNOWN = 1.0  # F after the preview changed its units; see ``tracer``
POSITIONS_ENLARGED = " ".join(f"#<@{name}>=[#<{name}>*{ENLARGED}]" for name in POSITION_NAMES)
STATE_TEXT = " ".join(
    (
        "%.3f" + " ".join(f"#<@{name}>" for name in POSITION_NAMES),
        "%.9f" + " ".join(f"#<{name}>" for name in STATE_NAMES[len(POSITION_NAMES) :]),
    )
)
UNSIGNED_NUMBER = re.compile(r"[0-9]*\.?[0-9]*")
COMMENTS = re.compile(r"\([^)]*\)|;.*")
FUNCTION_NAME = re.compile(r"[a-z]+(?=\[)")
LETTER_O = re.compile(r"/?(n[0-9.]+)?o")
SUB_CALL = re.compile(r"/?(?:n[0-9.]+)?o(?:<([^>]+)>|([^<]+?))call")


class Text(NamedTuple):
    """One line as written: its words in order (letter, value text), its assignments."""

    number: int
    words: tuple[tuple[str, str], ...]
    assignments: tuple[str, ...] = ()
    deleted: bool = False  # block delete: begins with /
    control: bool = False  # an O-word line
    call: str = ""  # the sub that it calls; arguments of an O-word are words with the letter ""
    file: str = ""  # the name of a sub's own file, "" in the program

    @property
    def codes(self) -> list[float]:
        """The G codes whose numbers are written out."""
        return [float(text) for letter, text in self.words if letter == "G" and is_number(text)]

    @property
    def too_long(self) -> bool:
        """Whether the line that evaluates one of its values is longer than LinuxCNC reads."""
        expressions = (value for _, value in self.words if not is_number(value))
        own = len(f"/{VALUE}=") if self.deleted else len(f"{VALUE}=")
        return any(own + len(text) > LONGEST_REPORT_LINE for text in expressions)

    @property
    def hides_code(self) -> bool:
        return any(letter == "G" and not is_number(text) for letter, text in self.words)


@dataclass(frozen=True)
class Block:
    """One execution of a block.

    ``words`` maps letters to values in program units, without G and M words, which are ``codes``
    and ``m_codes``, and without the arguments of a call, ``arguments``. ``state`` maps the names
    of `STATE_NAMES` to their values before the block, ``state_after`` to those after it; that is
    empty where the program ended in the block. ``at`` is the index of its first move and ``end``
    that of the first move after it. ``events`` are those since the end of the previous block,
    including its own, ``own_events``.
    """

    text: Text
    words: dict[str, float]
    codes: tuple[float, ...]
    m_codes: tuple[float, ...]
    arguments: tuple[float, ...]
    state: dict[str, float]
    at: int
    end: int
    state_after: dict[str, float] = field(default_factory=dict)
    events: tuple[Event, ...] = ()
    own_events: tuple[Event, ...] = ()


def is_number(text: str) -> bool:
    return bool(re.fullmatch(r"[-+]?(\d+\.?\d*|\.\d+)", text))


def read_line(number: int, line: str) -> Text:
    """Return a line of G code as text; LinuxCNC refuses what cannot be read."""
    code = re.sub(r"\s", "", COMMENTS.sub("", line)).lower()
    deleted = code.startswith("/")
    if LETTER_O.match(code):
        return _control(number, code, deleted)
    words, assignments, at = [], [], 1 if deleted else 0
    while at < len(code):
        end = _value_end(code, at + 1)
        if code[at] == "#":
            end = _value_end(code, end + 1)
            assignments.append(code[at:end])
        elif code[at].isalpha():
            words.append((code[at].upper(), code[at + 1 : end]))
        at = max(end, at + 1)
    called = dict(words).get("P", "") if ("M", "98") in words else ""
    return Text(number, tuple(words), tuple(assignments), deleted, call=called)


def _control(number: int, code: str, deleted: bool) -> Text:
    called = SUB_CALL.match(code)
    if not called:
        return Text(number, (), (), deleted, control=True)
    words, at = [], called.end()
    while at < len(code) and code[at] == "[":
        end = _value_end(code, at)
        words.append(("", code[at:end]))
        at = end
    return Text(number, tuple(words), (), deleted, control=True, call=called[1] or called[2])


def _value_end(code: str, at: int) -> int:
    """Return the end of the value that starts at ``at``, as LinuxCNC reads values.

    The section's `value_end` does the same and is not shared: `verify` would not detect a fault in
    it.
    """
    if at >= len(code):
        return at
    if code[at] in "+-":
        return _value_end(code, at + 1)
    if code[at] == "[":
        return _bracket_end(code, at)
    if code[at] == "<":
        return code.find(">", at) + 1 or len(code)
    if code[at] == "#":
        return _value_end(code, at + 1)
    function = FUNCTION_NAME.match(code, at)
    if function:
        end = _bracket_end(code, function.end())
        return _bracket_end(code, end + 1) if code[end : end + 2] == "/[" else end
    return UNSIGNED_NUMBER.match(code, at).end()


def _bracket_end(code: str, at: int) -> int:
    depth = 0
    for index in range(at, len(code)):
        depth += {"[": 1, "]": -1}.get(code[index], 0)
        if not depth:
            return index + 1
    return len(code)


def read_lines(program: Path) -> list[Text]:
    return [
        read_line(number, line) for number, line in enumerate(lines_as_written(program), start=1)
    ]


def lines_as_written(path: Path) -> list[str]:
    return path.read_text(encoding="utf-8", errors="replace").splitlines()


def reports_before(text: Text, skip: int = 0) -> Iterator[str]:
    """Return the lines that report a block's start, the state before it and its words.

    ``skip`` is the number of lines of other files that precede it in the count of texts.
    """
    yield from _state_reports("begin", text, skip)
    slash = "/" if text.deleted else ""
    for index, (_, value) in enumerate(text.words):
        if not is_number(value):
            yield f"{slash}{VALUE}={value}"
            yield f"{slash}{VALUE}=[{VALUE}*{ENLARGED}]"
            yield f"{slash}(DEBUG,{TAG} value {index} %.9f{VALUE})"


def reports_after(text: Text, skip: int = 0) -> Iterator[str]:
    """Return the lines that report a block's end, and the state after it."""
    yield from _state_reports("end", text, skip)


def _state_reports(kind: str, text: Text, skip: int) -> Iterator[str]:
    slash = "/" if text.deleted else ""
    yield f"{slash}{POSITIONS_ENLARGED}"
    yield f"{slash}(DEBUG,{TAG} {kind} {skip + text.number} {STATE_TEXT})"


def blocks_in(trace: Trace, texts: Sequence[Text]) -> list[Block]:
    """Return the blocks that a trace reports, each after those executed inside it."""
    found: list[Block] = []
    opened: list[_Opened] = []
    events: list[Event] = []
    done = 0  # number of events at the end of the last block
    for event in trace.events:
        if TAG not in event.text:
            events.append(event)
            continue
        if CLAMP_TOLD in event.text:
            events.append(_as_clamp_event(event))
            continue
        kind, number, *rest = event.text.split(f"{TAG} ", 1)[1].split()
        values = [float(value) for value in rest]
        if kind == "begin":
            state = reported_state(values)
            opened.append(_Opened(texts[int(number) - 1], event.at, state, len(events), {}))
        elif kind == "value":
            opened[-1].values[int(number)] = values[0] / ENLARGED
        else:
            block = _taken(opened, texts[int(number) - 1])
            if block:
                found.append(_block(block, event.at, reported_state(values), events, done))
                done = len(events)
    if opened:  # the program ended in it, with M2
        found.append(_block(opened[-1], len(trace.moves), {}, events, done))
    return found


def clamp_events(trace: Trace) -> list[Event]:
    """Return the codes of C's clamp that a trace reports, as ``clamp M10``."""
    return [_as_clamp_event(event) for event in trace.events if CLAMP_TOLD in event.text]


def _as_clamp_event(event: Event) -> Event:
    return event._replace(text=f"{CLAMP} {event.text.split(CLAMP_TOLD, 1)[1].strip()}")


def reported_state(values: Sequence[float]) -> dict[str, float]:
    """Return the state by names, from the values that ``STATE_TEXT`` prints."""
    position, others = values[: len(POSITION_NAMES)], values[len(POSITION_NAMES) :]
    return dict(zip(STATE_NAMES, (*(value / ENLARGED for value in position), *others)))


class _Opened(NamedTuple):
    """A begun block: the index of its first move, its state, the number of events so far."""

    text: Text
    at: int
    state: dict[str, float]
    events: int
    values: dict[int, float]


def _taken(opened: list[_Opened], text: Text) -> _Opened | None:
    """Remove and return the last begun block of a text; also remove those begun inside it."""
    for index in range(len(opened) - 1, -1, -1):
        if opened[index].text is text:
            block = opened[index]
            del opened[index:]
            return block
    return None


def _block(
    opened: _Opened, end: int, state_after: dict[str, float], events: Sequence[Event], done: int
) -> Block:
    """Return an executed block; the first ``done`` events came before the last block's end."""
    text, values = opened.text, opened.values
    words = [
        (letter, values.get(index, float(value) if is_number(value) else 0.0))
        for index, (letter, value) in enumerate(text.words)
    ]
    g, m, entries = (
        tuple(value for letter, value in words if letter == kind) for kind in ("G", "M", "")
    )
    return Block(
        text,
        {letter: value for letter, value in words if letter not in ("G", "M", "")},
        g,
        m,
        entries,
        opened.state,
        opened.at,
        end,
        state_after,
        tuple(events[min(done, opened.events) :]),
        tuple(events[opened.events :]),
    )
