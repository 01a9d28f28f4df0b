# SPDX-License-Identifier: GPL-2.0-or-later
"""One line of a section: the text for the interpreter's parser, and the meaning of its words.

The parser reads every value, expression and parameter. It does not know G9, U, nor H
with a sign, nor Y or W on a lathe: `split_line` rewrites those (in polar mode U to X, H and Y to C)
and returns their meaning. A line of plain words, as most lines of a program are, matches
`SectionWords.plain` and needs none of it.
"""

import re
from collections.abc import Callable, Iterator
from typing import NamedTuple

from g12.errors import LONGEST_BLOCK, Refusal

_NUMBER = r"[-+]?[\d.]+"
_COMMENT = re.compile(r"\(([^()]*)\)|;.*")
_BLANKS = re.compile(r"\s+")
_CONTROL = re.compile(r"/?(?:n[\d.]+)?(?:o|m0*(98|99)(?![\d.]))")
_KEYWORD = re.compile(r"[a-z]*")
_BRACKET = re.compile(r"\[|\]|<[^>]*>")
_SIGNS = re.compile(r"[-+]*")
_FUNCTION = re.compile(r"[a-z]+(?=\[)")
_NAME = re.compile(r"<[^>]*>?")
_DIGITS = re.compile(r"[\d.]*")
_CODE = re.compile(r"\d+(?:\.\d*)?")
_NINE = re.compile(r"0*9(?:\.0*)?")
PYTHON_LINE = ";py,"  # Interp::read_semicolon (interp_read.cc): at the very start of a line alone


def plain_line_of(letters: str) -> Callable[[str], object]:
    """Return a pattern for lines of nothing but G1 to G3, and numbers after some letters."""
    either = letters + letters.lower()
    return re.compile(
        rf"(?:[Nn]\d+)?[ \t]*(?:(?:[{either}]{_NUMBER}|[Gg]0?[123](?![\d.]))[ \t]*)+\r?", re.ASCII
    ).fullmatch


class AxisLetters(NamedTuple):
    """The letters of a section's axes: a slide and a rotary axis make the plane."""

    slide: str
    turn: str
    height: str


class SectionWords(NamedTuple):
    """The words of a kind of section.

    ``plane`` are the letters of its contour: first axis, second, height. ``axes`` are the machine's
    for it. ``turn_is_length``: the rotary axis's word is a length in a plane through that axis, at
    its present angle; else it is the angle in degrees. ``letters`` are groups that move one axis; a
    block has one of each. ``centre`` are the letters of an arc's centre along the first and the
    second axis. ``foreign`` maps letters that the parser does not know to those it is given
    instead; ``relative`` are the letters for increments of an axis. ``plain`` matches a line that
    has nothing but numbers after a move's letters.

    ``planes`` are the G codes of planes that a section accepts. ``plane_name`` and ``centre_name``
    are for messages; ``refused`` are reasons by letter, ``own_block`` is that of a height which may
    not move together with the others, ``origin`` that of another work offset.
    """

    plane: str
    axes: AxisLetters
    plain: Callable[[str], object]
    planes: frozenset[int]
    plane_name: str
    refused: dict[str, str]
    own_block: str
    origin: str
    foreign: dict[str, str]
    relative: dict[str, str]
    centre: tuple[str, str] = ("I", "J")
    centre_name: str = "I and J"
    turn_is_length: bool = False
    letters: tuple[tuple[str, str], ...] = ()


class BlockLocation(NamedTuple):
    """The source location of a block: the section's code, and the line (0 in MDI)."""

    code: str
    line: int

    def refuse(self, rule: str) -> Refusal:
        return Refusal(rule, self.code, self.line)


class TextLine(NamedTuple):
    """A raw line in parts.

    ``text`` is for the parser: lower case, no blanks, no comments; ``rewritten`` where the parser
    could not have read the line itself. ``control`` is the kind of an O-word ("sub", "call",
    "while", …; M98 is a "call" and M99 a "return"), "" on other lines. ``letters`` are the words
    as written, ``codes`` the G and M words with a plain number (letter, number times ten),
    ``relative`` the axes given by increments of their own (U, W, H). A parsed block shows neither
    ``assignments`` nor the $ word, ``spindle``. ``python`` is a whole line of it, which LinuxCNC
    runs.
    """

    text: str
    comments: tuple[str, ...] = ()
    control: str = ""
    letters: tuple[str, ...] = ()
    codes: tuple[tuple[str, int], ...] = ()
    rewritten: bool = False
    relative: str = ""
    exact_stop: bool = False
    assignments: str = ""
    spindle: str = ""
    python: str = ""

    @property
    def empty(self) -> bool:
        return not self.text.lstrip("/")

    @property
    def deletable(self) -> bool:
        return self.text[:1] == "/"


def split_line(raw: str, known: SectionWords) -> TextLine:
    """Return a raw line in its parts; ``known`` are the words of its section."""
    if raw.startswith(PYTHON_LINE):
        return TextLine("", python=raw)
    bare = _BLANKS.sub("", _COMMENT.sub("", raw)).lower()
    comments = tuple(match[1] for match in _COMMENT.finditer(raw) if match[1] is not None)
    control = _CONTROL.match(bare)
    if control:
        return TextLine(bare, comments, _kind(bare, control))
    if "(" in bare or len(bare) > LONGEST_BLOCK:  # the parser refuses it, and a nested comment
        return TextLine(bare)
    words = list(split_words(bare.lstrip("/")))
    letters = tuple(letter.upper() for letter, _ in words)
    kept = [word for word in words if not _is_exact_stop(word)]
    text = "".join(known.foreign.get(letter, letter) + value for letter, value in kept)
    return TextLine(
        "/" * (bare[:1] == "/") + text,
        comments,
        letters=letters,
        codes=tuple(_codes_of(kept)),
        rewritten=len(kept) < len(words) or any(letter in known.foreign for letter, _ in kept),
        relative="".join(known.relative.get(letter, "") for letter in letters),
        exact_stop=len(kept) < len(words),
        assignments=_words_of("#", words),
        spindle=_words_of("$", words),
    )


def _kind(bare: str, control: re.Match[str]) -> str:
    """Return the kind of an O-word, the keyword after a name, a number or an expression."""
    if control[1]:
        return {"98": "call", "99": "return"}[control[1]]
    name = _NAME.match(bare, control.end())
    after = name.end() if name else value_end(bare, control.end())
    keyword = _KEYWORD.match(bare, after)
    return (keyword and keyword[0]) or "program"


def _words_of(own: str, words: list[tuple[str, str]]) -> str:
    return "".join(letter + value for letter, value in words if letter == own)


def _codes_of(words: list[tuple[str, str]]) -> Iterator[tuple[str, int]]:
    for letter, value in words:
        if letter in "gm" and _CODE.fullmatch(value):
            yield letter.upper(), round(float(value) * 10)


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
    """Return the end of the value that begins at ``start``: number, parameter or expression."""
    at = _end(_SIGNS, text, start)
    if text[at : at + 2] == "#<":
        return _end(_NAME, text, at + 1)
    if text[at : at + 1] == "#":
        return value_end(text, at + 1)
    function = _FUNCTION.match(text, at)
    end = _bracket_end(text, function.end() if function else at)
    if function and text[end : end + 2] == "/[":  # atan[1]/[2]
        return _bracket_end(text, end + 1)
    return end


def _end(pattern: re.Pattern[str], text: str, start: int) -> int:
    match = pattern.match(text, start)
    return match.end() if match else start


def _bracket_end(text: str, start: int) -> int:
    """Return the end of the bracket that opens at ``start``, or of the number there."""
    if text[start : start + 1] != "[":
        return _end(_DIGITS, text, start)
    depth = 0
    for bracket in _BRACKET.finditer(text, start):
        depth += {"[": 1, "]": -1}.get(bracket[0], 0)
        if not depth:
            return bracket.end()
    return len(text)
