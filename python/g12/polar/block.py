# SPDX-License-Identifier: GPL-2.0-or-later
"""One line of a section: what the interpreter may parse of it, and what its words mean there.

The interpreter's parser reads every value, expression and parameter. It does not know G9, U, nor H
with a sign, nor Y on a lathe: `split_line` rewrites those (U to X, H and Y to C) and says what
they meant. A line of plain words, as most lines of a program are, is told by `is_plain` and needs
none of it.

Codes are the parser's: a G code times ten, by modal group.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import NamedTuple

from g12.errors import Refusal
from g12.words import LONGEST_BLOCK

NO_CODE = -1

# Modal groups of the G codes, as the parser numbers them, and two of the M codes.
NON_MODAL, MOTION, PLANE, DISTANCE, CENTRE = 0, 1, 2, 3, 4
FEED, UNITS, COMPENSATION, LENGTH, RETRACT = 5, 6, 7, 8, 10
WORK_OFFSET, PATH, SPINDLE, DIAMETER, SHIFT = 12, 13, 14, 15, 16
M_STOP, M_STATE = 4, 7

G0, G1, G2, G3, G4 = 0, 10, 20, 30, 40
M2, M30 = 2, 30
STATE_CODES = SAVE, FORGET, RESTORE, SAVE_FOR_SUB = 70, 71, 72, 73

KNOWN_G = {
    NON_MODAL: {G4},
    MOTION: {G0, G1, G2, G3},
    PLANE: {170, 180},
    DISTANCE: {900, 910},
    CENTRE: {911},
    FEED: {940, 950},
    COMPENSATION: {400, 410, 420},
    RETRACT: {980, 990},
    PATH: {610, 611, 640},
    SPINDLE: {970},
}
PASSED_ON = (NON_MODAL, CENTRE, PATH, SPINDLE)  # groups that the machine acts on
FEED_MODES = {940: False, 980: False, 950: True, 990: True}  # code: per revolution
AXES = ("X", "C", "Z")
MOVING_WORDS = (*AXES, "I", "J")
ARGUMENTS = ("S", "P", "Q", "L", "E")  # of the codes that are no motion

ORIGIN = "the origin must stay in the spindle's centre"
OTHER_AXES = "the section's words are X, C (or Y), Z, U and H"
TOOL = "the tool cannot change inside the section"
REASON_OF_GROUP = {
    NON_MODAL: ORIGIN,
    MOTION: "only G1, G2 and G3 move inside the section",
    PLANE: "the section's plane is X-C",
    CENTRE: "I and J are always incremental inside the section",
    FEED: "the feed of a section is G94 or G95 (G98 or G99)",
    UNITS: "the units cannot change inside the section",
    COMPENSATION: "the radius is that of the loaded tool: G41 or G42 without D",
    LENGTH: "the tool length offset cannot change inside the section",
    WORK_OFFSET: ORIGIN,
    SPINDLE: "the spindle keeps its speed inside the section (G97)",
    DIAMETER: "X cannot change between diameter and radius inside the section",
    SHIFT: ORIGIN,
}
REASON_OF_G = {
    G0: "a rapid leaves the contour. Is the section's end missing above? "
    "Else use G1 with a high F, or set [G12] POLAR_G0 = feed",
    100: "offsets cannot change inside the section",
    280: "the reference point is not in the plane",
    281: "the reference point is not in the plane",
    300: "the reference point is not in the plane",
    301: "the reference point is not in the plane",
    530: "machine coordinates are not those of the plane",
}
REASON_OF_M = {6: TOOL, 61: TOOL}
ORIENT = 19
NEEDED_WORD = {62: "P", 63: "P", 64: "P", 65: "P", 67: "E", 68: "E"}
WAIT_FOR_INPUT, AT_ONCE = 66, 0  # M66, and the L that does not wait
REASON_OF_WORD = {
    **dict.fromkeys("ABVW@^", OTHER_AXES),
    "T": TOOL,
    "D": "the radius is that of the loaded tool",
    "K": "the centre of an arc in the X-C plane is I and J",
}

_NUMBER = r"[-+]?[\d.]+"
is_plain: Callable[[str], object] = re.compile(
    rf"(?:[Nn]\d+)?[ \t]*(?:(?:[XCZIJRFxczijrf]{_NUMBER}|[Gg]0?[123](?![\d.]))[ \t]*)+\r?", re.ASCII
).fullmatch

_COMMENT = re.compile(r"\(([^()]*)\)|;.*")
_BLANKS = re.compile(r"\s+")
_CONTROL = re.compile(r"/?(?:n[\d.]+)?(?:o|m0*(98|99)(?![\d.]))")
_KEYWORD = re.compile(r"[a-z]*")
_BRACKET = re.compile(r"\[|\]|<[^>]*>")
_SIGNS = re.compile(r"[-+]*")
_FUNCTION = re.compile(r"[a-z]+(?=\[)")
_NAME = re.compile(r"<[^>]*>?")
_DIGITS = re.compile(r"[\d.]*")
_NINE = re.compile(r"0*9(?:\.0*)?")
_IN_REPORT = re.compile(r"%(d|f|\.\df)|#(\d+|<[^>]*>)")
_LINE_NAMED = re.compile(r" line (\d+):")
_REPORTS = ("debug,", "print,", "log,", "abort,")

FOREIGN = {"u": "x", "h": "c", "y": "c"}  # what the parser is given instead


class Place(NamedTuple):
    """Where something is refused: the section's code, and the line."""

    code: str
    line: int

    def refuse(self, reason: str) -> Refusal:
        """Return the refusal of this line."""
        return Refusal(f"{self.code} line {self.line}: {reason}")


def line_named(error: Exception) -> int | None:
    """Return the line of the section's file that a refusal names, None if it names none."""
    named = _LINE_NAMED.search(str(error))
    return int(named[1]) if named else None


class Line(NamedTuple):
    """A raw line in parts.

    ``text`` is for the parser: lower case, no blanks, no comments; ``rewritten`` where the parser
    could not have read the line itself. ``control`` is the kind of an O-word ("sub", "call",
    "while", …; M98 is a "call" and M99 a "return"), "" on other lines. ``letters`` are the words
    as written, ``relative`` the axes given by U and H. A parsed block shows neither
    ``assignments`` nor the $ word, ``spindle``.
    """

    text: str
    comments: tuple[str, ...] = ()
    control: str = ""
    letters: tuple[str, ...] = ()
    rewritten: bool = False
    relative: str = ""
    exact_stop: bool = False
    assignments: str = ""
    spindle: str = ""

    @property
    def empty(self) -> bool:
        """Tell whether the line holds no words."""
        return not self.text.lstrip("/")

    @property
    def deletable(self) -> bool:
        """Tell whether the line goes out with block delete."""
        return self.text[:1] == "/"


class Block(NamedTuple):
    """What the parser made of a line: codes by modal group, -1 is none, and word values."""

    g: tuple[int, ...]
    m: tuple[int, ...]
    motion: int
    words: dict[str, float]

    @property
    def moves(self) -> bool:
        """Tell whether the block is a piece of the contour."""
        return any(letter in self.words for letter in MOVING_WORDS)


class Modes(NamedTuple):
    """The modes of a section: they act as they are read, not when the tool gets there.

    ``feed`` is F in program units per minute, or per revolution; ``speed`` that of the spindle
    which turns the latter into the former; ``motion`` the code that bare words repeat.
    """

    incremental: bool
    per_revolution: bool
    feed: float
    speed: float
    motion: int


def split_line(raw: str) -> Line:
    """Return a raw line in its parts."""
    bare = _BLANKS.sub("", _COMMENT.sub("", raw)).lower()
    comments = tuple(match[1] for match in _COMMENT.finditer(raw) if match[1] is not None)
    control = _CONTROL.match(bare)
    if control:
        return Line(bare, comments, _kind(bare, control))
    if "(" in bare:  # an unclosed or nested comment: the parser says so
        return Line(bare)
    words = list(split_words(bare.lstrip("/")))
    letters = tuple(letter.upper() for letter, _ in words)
    kept = [word for word in words if not _is_exact_stop(word)]
    text = "".join(FOREIGN.get(letter, letter) + value for letter, value in kept)
    return Line(
        "/" * (bare[:1] == "/") + text,
        comments,
        letters=letters,
        rewritten=len(kept) < len(words) or not {"U", "H", "Y"}.isdisjoint(letters),
        relative="X" * ("U" in letters) + "C" * ("H" in letters),
        exact_stop=len(kept) < len(words),
        assignments=_words_of("#", words),
        spindle=_words_of("$", words),
    )


def _kind(bare: str, control: re.Match[str]) -> str:
    """Return the kind of an O-word: its keyword stands behind a name, a number or an expression."""
    if control[1]:
        return {"98": "call", "99": "return"}[control[1]]
    name = _NAME.match(bare, control.end())
    behind = name.end() if name else value_end(bare, control.end())
    return _KEYWORD.match(bare, behind)[0] or "program"


def _words_of(wanted: str, words: list[tuple[str, str]]) -> str:
    return "".join(letter + value for letter, value in words if letter == wanted)


def _is_exact_stop(word: tuple[str, str]) -> bool:
    return word[0] == "g" and bool(_NINE.fullmatch(word[1]))


def split_words(text: str) -> Iterator[tuple[str, str]]:
    """Yield the (letter, value text) pairs of a bare line; ("#", "1=3") for an assignment."""
    at = 0
    while at < len(text):
        end = value_end(text, at if text[at] == "#" else at + 1)
        if text[end : end + 1] == "=":
            end = value_end(text, end + 1)
        yield text[at], text[at + 1 : end]
        at = max(end, at + 1)


def value_end(text: str, start: int) -> int:
    """Return where the value that begins at ``start`` ends: number, parameter or expression."""
    at = _SIGNS.match(text, start).end()
    if text[at : at + 2] == "#<":
        return _NAME.match(text, at + 1).end()
    if text[at : at + 1] == "#":
        return value_end(text, at + 1)
    function = _FUNCTION.match(text, at)
    end = _bracket_end(text, function.end() if function else at)
    if function and text[end : end + 2] == "/[":  # atan[1]/[2]
        return _bracket_end(text, end + 1)
    return end


def _bracket_end(text: str, start: int) -> int:
    """Where the bracket that opens at ``start`` closes, or the number there ends."""
    if text[start : start + 1] != "[":
        return _DIGITS.match(text, start).end()
    depth = 0
    for bracket in _BRACKET.finditer(text, start):
        depth += {"[": 1, "]": -1}.get(bracket[0], 0)
        if not depth:
            return bracket.end()
    return len(text)


def check_letters(line: Line, place: Place) -> None:
    """Refuse words that a section does not know, and two words for one axis."""
    for letter in line.letters:
        if letter in REASON_OF_WORD:
            raise place.refuse(f"{letter} is refused: {REASON_OF_WORD[letter]}")
    for axis, letters in (("X", "XU"), ("C", "CYH")):
        given = [letter for letter in letters if letter in line.letters]
        if len(given) > 1:
            raise place.refuse(f"{given[0]} and {given[1]} both move {axis}: only one of them")


def check_block(block: Block, rapid_allowed: bool, place: Place) -> None:
    """Refuse codes that have no place in a section, each with its reason."""
    for group, code in enumerate(block.g):
        if code != NO_CODE and (
            code not in KNOWN_G.get(group, ()) or (code == G0 and not rapid_allowed)
        ):
            reason = REASON_OF_G.get(code, REASON_OF_GROUP.get(group, "it is not known here"))
            raise place.refuse(f"G{code / 10:g} is refused: {reason}")
    for code in block.m:
        if code in REASON_OF_M:
            raise place.refuse(f"M{code} is refused: {REASON_OF_M[code]}")
    _check_arguments(block, place)
    if "P" in block.words and block.moves and block.motion in (G2, G3):
        raise place.refuse("P is refused: an arc inside the section has no turns")
    if len(_feed_modes(block)) > 1:
        raise place.refuse("G94 and G98 are feed per minute, G95 and G99 per revolution: not both")


def _check_arguments(block: Block, place: Place) -> None:
    """Refuse what LinuxCNC would find wrong with the words of an M code only between the moves."""
    words = block.words
    for code in block.m:
        needed = NEEDED_WORD.get(code)
        if needed and words.get(needed, -1.0) < 0.0:
            raise place.refuse(f"M{code} needs {needed}, the number of the output")
    if WAIT_FOR_INPUT in block.m:
        _check_waiting(words, place)


def _check_waiting(words: dict[str, float], place: Place) -> None:
    """Refuse an M66 that LinuxCNC would refuse."""
    waits = words.get("L", AT_ONCE) != AT_ONCE
    for wrong, reason in (
        (("P" in words) == ("E" in words), "either P or E, the number of the input"),
        (waits and "E" in words, "L0 with E: only a digital input can be waited for"),
        (waits and words.get("Q", 0.0) <= 0.0, "Q above zero, the longest wait in seconds"),
        (words.get("L", 0.0) not in range(5), "L from 0 to 4"),
    ):
        if wrong:
            raise place.refuse(f"M{WAIT_FOR_INPUT} needs {reason}")


def _feed_modes(block: Block) -> set[bool]:
    """Return the feed modes that a block commands; True is per revolution."""
    return {FEED_MODES[code] for code in (block.g[FEED], block.g[RETRACT]) if code in FEED_MODES}


def alone(block: Block, m_code: int = NO_CODE) -> bool:
    """Tell whether the block holds only a motion code, or ``m_code`` and its arguments."""
    if m_code == NO_CODE:
        others = [*block.g[:MOTION], *block.g[MOTION + 1 :], *block.m]
        return not block.words and max(others) == NO_CODE
    codes = [code for code in (*block.g, *block.m) if code != NO_CODE]
    return codes == [m_code] and set(block.words) <= set("PQLE")


def modes_after(modes: Modes, block: Block, speed: float) -> Modes:
    """Return the modes once the codes and F of ``block`` have acted, and S has made the speed."""
    words = block.words
    distance, feed_modes = block.g[DISTANCE], _feed_modes(block)
    per_revolution = feed_modes.pop() if feed_modes else modes.per_revolution
    feed = modes.feed if per_revolution == modes.per_revolution else 0.0  # F in the other unit
    return Modes(
        incremental=modes.incremental if distance == NO_CODE else distance == 910,
        per_revolution=per_revolution,
        feed=words.get("F", feed),
        speed=speed,
        motion=modes.motion if block.g[MOTION] == NO_CODE else block.g[MOTION],
    )


def action_text(block: Block, line: Line) -> str:
    """Return the block without its motion, every value read; "" if nothing is left."""
    codes = [f"G{block.g[group] / 10:g}" for group in PASSED_ON if block.g[group] != NO_CODE]
    codes += [
        f"M{code}"
        for group, code in enumerate(block.m)
        if code != NO_CODE and group != M_STOP and code not in STATE_CODES
    ]
    letters = (*ARGUMENTS, "R") if ORIENT in block.m else ARGUMENTS
    codes += [letter + decimal(block.words[letter]) for letter in letters if letter in block.words]
    return "".join(codes) + line.spindle if codes else ""


def stop_text(block: Block) -> str:
    """Return the block's M0, M1 or M60, which acts behind its motion; "" if there is none."""
    return "" if block.m[M_STOP] == NO_CODE else f"M{block.m[M_STOP]}"


def decimal(value: float) -> str:
    """Return a value the way the parser reads one: the language has no exponents."""
    return f"{value:.10f}".rstrip("0").rstrip(".")


def may_fail(comment: str) -> bool:
    """Tell whether a comment may stop the program: (ABORT,), (PY,) and their like."""
    return comment.lstrip().lower().startswith(("abort,", "py"))


def comment_text(comment: str, value_of: Callable[[str], float | None]) -> str:
    """Return a comment with the parameters of (DEBUG,), (PRINT,), (LOG,) and (ABORT,) filled in.

    It is cut to a line that LinuxCNC can read. ``value_of`` gives a parameter by number or name ("12", "_x"), None if it does not exist.
    """
    if not comment.lstrip().lower().startswith(_REPORTS):
        return f"({comment})"
    decimals = 6

    def filled(match: re.Match[str]) -> str:
        nonlocal decimals
        if match[1]:
            decimals = {"d": 0, "f": 4}.get(match[1]) if match[1] in "df" else int(match[1][1])
            return ""
        value = value_of("".join(match[2].split()).strip("<>").lower())
        return "######" if value is None else f"{value:.{decimals}f}"

    text = _IN_REPORT.sub(filled, comment)[: LONGEST_BLOCK - len("( )")]
    return f"({text} )" if text.endswith("#") else f"({text})"  # no parameter may begin there
