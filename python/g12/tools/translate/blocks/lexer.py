# SPDX-License-Identifier: GPL-2.0-or-later
"""The text of a program as blocks: words, comments and macro statements, nothing of their meaning.

Blanks do not count outside comments, letters are read as capitals, a line ends as it likes, ``;``
ends a block. Comments may be nested; what LinuxCNC would obey in a comment is disarmed.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from types import MappingProxyType
from typing import NamedTuple

from g12.tools.translate.blocks.errors import NotTranslated, excerpt
from g12.tools.translate.blocks.expressions import (
    OWN,
    Expression,
    bracketed_from,
    expression_from,
    value_from,
    variable_number,
)

PLAIN_WORDS = re.compile(r"(?:[A-Z][-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+))*")
PLAIN_WORD = re.compile(r"([A-Z])([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+))")
MAYBE_WORDS = re.compile(
    r"\s*[/#%:]|\s*(?:[A-Z]\s*[-+.0-9#[=]|IF|WHILE|GOTO|DO|END|RTS|CALL)", re.I
)
CORNERS = (",A", ",C", ",R")  # words of direct drawing
CODE_NUMBER = re.compile(r"([0-9]+)\.?([0-9]*)")
NAMED_WORD = re.compile(r"([A-Z]{2})=")
OWN_NAME = "(?:VC[0-9]+|V[A-Z]{3,}[0-9]*)"  # of an Okuma
MOTION = re.compile(r"G0*([0-3])(?![0-9.])")  # of a block that cannot be read
HEADER = re.compile(r"\$.*%")  # of a file of an Okuma
LEADING_N = re.compile("N[0-9]+")
SKIP = re.compile(r"/([0-9]?)")
STATEMENT = re.compile(r"(IF|WHILE|END|CALL)(?=[\[0-9O#])|RTS$")
CALLED_PROGRAM = re.compile(r"O([0-9]{1,8})(?:Q([0-9]{1,4}))?")
NO_JUMPS = "LinuxCNC has no jumps: write IF […] before each block, or WHILE […] DO and END"
ASSIGNMENT = re.compile(f"#({OWN}?[0-9]+)=")
VARIABLE = re.compile("#([0-9]{1,9})")
OBEYED_COMMENT = re.compile(
    r"\s*(MSG|DEBUG|PRINT|LOG\w*|PROBE\w*|PY\w*|ABORT|AXIS|PREVIEW)\s*,", re.I
)
BRACKET = re.compile("[()]")  # of a comment
OTHER_CHARACTERS = str.maketrans("\N{MINUS SIGN}", "-", "\ufeff\u200b\0")
MOST_DIGITS = 24
OTHER_TEXTS = {
    re.compile(r"^\$.*"): "begins the program of one of two channels: translate one channel's "
    "blocks, in a file of its own",
    re.compile("^(N[0-9]+)?DO[0-9]+$"): "without WHILE never ends: LinuxCNC needs WHILE […] DO",
    re.compile("^[A-Z_][A-Z0-9_]*:"): "is a label, which these controls do not have: take out the "
    "colon",
    re.compile("^O[A-Z][A-Z0-9]*$"): "is a name: programs have numbers here, as O1",
    re.compile("[0-9],[0-9]+"): "has a decimal comma: write a point",
    re.compile(rf"(?<![A-Z]){OWN_NAME}="): "sets a variable of the control's own: set it on the "
    "machine, and take this out",
    re.compile(
        rf"(?<=[=[]){OWN_NAME}(?!\[)"
    ): "is a variable of the control's own: write its value",
    re.compile(r"(?<![A-Z])GOTO[\[0-9#].*"): f"is a jump, and {NO_JUMPS}",
}
ALL_PLANES = frozenset(("G17", "G18", "G19"))


REMARKS = "if what is after ; is a remark there, say remarks = true in a control of your own"
BLOCKS, LINES, ALL = range(3)  # what ; begins: blocks; remarks, as its lines show; remarks always


@lru_cache(maxsize=1024)
def code_of(letter: str, value: str) -> str:
    """Return a code by one name; one that is no code at all as it is written."""
    match = CODE_NUMBER.fullmatch(value)
    if not match:
        return letter + value
    part = match[2].rstrip("0")
    return f"{letter}{int(match[1])}{'.' + part if part else ''}"


class ForeignWord(NamedTuple):
    """A word: its letter and its value as LinuxCNC can read it.

    ``kind`` is ``number``, ``expression``, ``bare`` (a letter alone beside a plane code) or
    ``text`` (a line of LinuxCNC's that a rule has written); ``read`` holds the variables of an
    expression.
    """

    letter: str
    value: str
    kind: str = "number"
    read: frozenset[int] = frozenset()

    @property
    def text(self) -> str:
        return self.letter + self.value

    @property
    def number(self) -> float:
        return float(self.value)

    @property
    def is_zero(self) -> bool:
        return self.kind == "number" and float(self.value) == 0

    @property
    def lacks_point(self) -> bool:
        return self.kind == "number" and "." not in self.value

    @property
    def code(self) -> str:
        """A G or M word by one name, whatever zeros it has: ``G1``, ``G12.1``; "" of another."""
        is_code = self.letter in ("G", "M") and self.kind == "number"
        return code_of(self.letter, self.value) if is_code else ""


class ForeignBlock(NamedTuple):
    """One block of a program, or a statement in its place.

    ``kind`` is ``words``, ``tape`` (a ``%``), ``assign``, ``while``, ``end``, or ``if`` and
    ``endif`` around the blocks that a condition rules.
    """

    line: int  # from 1
    kind: str = "words"
    words: tuple[ForeignWord, ...] = ()
    comments: tuple[str, ...] = ()
    skipped: bool = False
    expression: Expression | None = None  # the condition, or the value of ``assign``
    variable: int = 0  # that ``assign`` sets
    label: str = ""  # the number of DO and END
    problem: str | None = None  # why it could not be read

    @property
    def number(self) -> int | None:
        """The number after the N that a block begins with, an O before it aside, if it is whole."""
        first = next((word for word in self.words if word.letter != "O"), None)
        return int(first.value) if first and first.letter == "N" and first.value.isdigit() else None

    @property
    def read(self) -> frozenset[int]:
        own = self.expression.read if self.expression else frozenset()
        return own.union(*(word.read for word in self.words))

    def numbers(self, letter: str) -> set[int]:
        return {int(w.value) for w in self.words if w.letter == letter and w.value.isdigit()}


def program_text(content: bytes) -> str:
    """Return the characters of a file: UTF-8, or else Latin-1, which takes any bytes."""
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError:
        return content.decode("latin-1")


def source_lines(text: str) -> list[str]:
    """Return the lines of a text; CR, LF and both together end a line."""
    return re.split(r"\r\n|\r|\n", text.removesuffix("\n").removesuffix("\r"))


def blocks_of(
    line: int, text: str, remarks: int = BLOCKS, variables: Mapping[int, str] = MappingProxyType({})
) -> Iterator[ForeignBlock]:
    """Yield the blocks of one line, at least one.

    ``remarks`` is what ``;`` begins in the program, one of BLOCKS, LINES and ALL. ``variables`` has
    what is written for variables of the control's own.
    """
    comments: tuple[str, ...] = ()
    try:
        parts, comments = _without_comments(text, remarks)
    except NotTranslated as problem:
        yield ForeignBlock(line, problem=str(problem))
        return
    for number, part in enumerate(parts):
        if variables and "#" in part:
            part = VARIABLE.sub(lambda found: variables.get(int(found[1]), found[0]), part)
        try:
            blocks = _parsed(line, part)
        except NotTranslated as problem:
            sentence = str(problem).replace(OWN, "") + (f"; {REMARKS}" if number else "")
            motion = tuple(ForeignWord("G", code) for code in MOTION.findall(part))
            blocks = [ForeignBlock(line, words=motion, problem=sentence)]
        if number == 0:
            blocks[0] = blocks[0]._replace(comments=blocks[0].comments + comments)
        yield from blocks


def remarks_of(rows: Iterable[str]) -> int:
    """Return LINES where a line of a program begins with ``;`` and cannot be words, else BLOCKS."""
    begun = (row.lstrip() for row in rows)
    remarks = (row[1:].strip() for row in begun if row.startswith(";"))
    return LINES if any(text and not _can_be_words(text) for text in remarks) else BLOCKS


def _can_be_words(text: str) -> bool:
    try:
        parts, _ = _without_comments(text, ALL)
        return bool(MAYBE_WORDS.match(text)) and bool(_parsed(0, parts[0]))
    except NotTranslated:
        return False


def _without_comments(text: str, remarks: int) -> tuple[list[str], tuple[str, ...]]:
    """Return the blocks of a line without blanks, and its comments."""
    code, comments = _split_comments(text)
    code, *rest = code.split(";")
    blocks = [] if remarks == ALL else [part for part in rest if MAYBE_WORDS.match(part)]
    if remarks == LINES:
        blocks = [part for part in blocks if code.strip() and _can_be_words(part)]
    if blocks and remarks == LINES:
        raise NotTranslated(
            f"{excerpt(blocks[0].strip())} is a block or a remark: lines of ; are remarks here; "
            f"write a block on a line of its own; {REMARKS}"
        )
    comments += [part.strip() for part in rest if part.strip() and part not in blocks]
    code = "".join(";".join([code, *blocks]).upper().split()).translate(OTHER_CHARACTERS)
    parts = [part for part in code.split(";") if part] or [""]
    return parts, tuple(printable(comment) for comment in comments)


def _split_comments(text: str) -> tuple[str, list[str]]:
    code: list[str] = []
    comments: list[str] = []
    depth = start = 0
    for bracket in BRACKET.finditer(text):
        at, before = bracket.start(), depth
        depth += 1 if bracket[0] == "(" else -1
        if depth < 0:
            raise NotTranslated(") without its opening bracket before it")
        if not before or not depth:
            (comments if before else code).append(text[start:at])
            start = at + 1
    if depth:
        raise NotTranslated("a comment is not closed: ) is missing")
    return "".join([*code, text[start:]]), comments


def printable(comment: str) -> str:
    """Return a comment that LinuxCNC only keeps: accents too, no brackets, no command."""
    comment = unicodedata.normalize("NFC", comment).encode("utf-8", "replace").decode("utf-8")
    comment = comment.replace("(", "[").replace(")", "]").replace(";", ",")
    comment = "".join(c if c.isprintable() else " " for c in comment)
    return f"- {comment.strip()}" if OBEYED_COMMENT.match(comment) else comment


def _parsed(line: int, text: str) -> list[ForeignBlock]:
    """Return the block of a text, and with a condition those that it rules and its end."""
    if HEADER.fullmatch(text):
        return [ForeignBlock(line, comments=(text,))]
    if text.startswith("%"):
        return [ForeignBlock(line, "tape", label=printable(text[1:]))]
    if text.startswith(":"):
        text = f"O{text[1:]}"
    skip = SKIP.match(text)
    if skip:
        if skip[1] not in ("", "1"):
            raise NotTranslated(f"{skip[0]}: LinuxCNC has one switch to skip blocks, / alone")
        return _skipped(line, text[skip.end() :])
    if PLAIN_WORDS.fullmatch(text):
        words = tuple(_plain_word(*pair) for pair in PLAIN_WORD.findall(text))
        return [ForeignBlock(line, words=words)]
    _refuse_other_texts(text)
    return _statement(line, text)


def _skipped(line: int, text: str) -> list[ForeignBlock]:
    return [block._replace(skipped=True) for block in _parsed(line, text)]


def _refuse_other_texts(text: str) -> None:
    for pattern, rule in OTHER_TEXTS.items():
        if found := pattern.search(text):
            raise NotTranslated(f"{excerpt(found[0])} {rule}")


def _statement(line: int, text: str) -> list[ForeignBlock]:
    number = LEADING_N.match(text)
    words = (ForeignWord("N", number[0][1:]),) if number else ()
    rest = text[number.end() :] if number else text
    if number and rest.startswith("/"):
        return _skipped(line, rest[1:])
    statement = STATEMENT.match(rest)
    if statement:
        block, *ruled = STATEMENT_READERS[statement[0]](line, rest[statement.end() :])
    elif match := ASSIGNMENT.match(rest):
        block, ruled = _assignment(line, match), []
        if end := rest[block.expression.end :]:
            raise NotTranslated(f"{excerpt(end)} is no part of an expression")
    else:
        block, ruled = ForeignBlock(line, words=_words(rest)), []
    return [block._replace(words=words + block.words), *ruled]


def _assignment(line: int, match: re.Match[str]) -> ForeignBlock:
    variable = variable_number(match[1])
    value = expression_from(match.string, match.end())
    return ForeignBlock(line, "assign", variable=variable, expression=value)


def _if(line: int, text: str) -> list[ForeignBlock]:
    """Return a condition with the rest of its block, which a Haas obeys with THEN or without."""
    condition = bracketed_from(text, 0)
    rest = text[condition.end :].removeprefix("THEN")
    head = ForeignBlock(line, "if", expression=condition)
    return [head, *_ruled(line, rest), ForeignBlock(line, "endif")]


def _ruled(line: int, text: str) -> Iterator[ForeignBlock]:
    """Yield the blocks after a condition: an assignment, words, or both."""
    match = ASSIGNMENT.match(text)
    if match:
        assignment = _assignment(line, match)
        yield assignment
        text = text[assignment.expression.end :]
    if text:
        block, *_ = _parsed(line, text)
        if block.kind != "words" or block.skipped:
            raise NotTranslated("after IF […] only #… = … and words are translated")
        yield block


def _while(line: int, text: str) -> list[ForeignBlock]:
    condition = bracketed_from(text, 0)
    rest = re.fullmatch(r"DO([0-9]+)", text[condition.end :])
    if not rest:
        raise NotTranslated("WHILE […] needs DO and a number after it")
    return [ForeignBlock(line, "while", expression=condition, label=rest[1])]


def _end(line: int, text: str) -> list[ForeignBlock]:
    if not text.isdigit():
        raise NotTranslated(f"END{excerpt(text)} needs a number alone")
    return [ForeignBlock(line, "end", label=text)]


def _call(line: int, text: str) -> list[ForeignBlock]:
    """Read CALL of an Okuma control, with Q how often, as M98."""
    match = CALLED_PROGRAM.fullmatch(text)
    if not match:
        raise NotTranslated(f"CALL{excerpt(text)}: only a program and Q, how often, are translated")
    words = [ForeignWord("M", "98"), ForeignWord("P", match[1])]
    words += [ForeignWord("L", match[2])] if match[2] else []
    return [ForeignBlock(line, words=tuple(words))]


def _return(line: int, text: str) -> list[ForeignBlock]:
    """Read RTS of an Okuma control as M99."""
    return [ForeignBlock(line, words=(ForeignWord("M", "99"),))]


STATEMENT_READERS = {
    "IF": _if,
    "WHILE": _while,
    "END": _end,
    "CALL": _call,
    "RTS": _return,
}


def _words(text: str) -> tuple[ForeignWord, ...]:
    words: list[ForeignWord] = []
    at = 0
    while at < len(text):
        word, at = _word(text, at)
        words.append(word)
    named = "XYZUVWCH" if any(word.code in ALL_PLANES for word in words) else ""  # a plane's axes
    for word in words:
        if word.kind == "bare" and word.letter not in named:
            raise NotTranslated(f"{word.letter} has no value")
    return tuple(words)


def _word(text: str, at: int) -> tuple[ForeignWord, int]:
    plain = PLAIN_WORD.match(text, at)
    if plain:
        return _plain_word(*plain.groups()), plain.end()
    named = NAMED_WORD.match(text, at)
    letter, start = (named[1], named.end()) if named else (text[at], at + 1)
    if text[at : at + 2] in CORNERS:
        raise NotTranslated(
            f"{excerpt(text[at:])} draws a corner: write its line or arc as a block"
        )
    if not ("A" <= letter[0] <= "Z"):
        raise NotTranslated(f"{excerpt(text[at:])} does not start with a word")
    if start >= len(text) or "A" <= text[start] <= "Z":
        return ForeignWord(letter, "", "bare"), start
    try:
        value = value_from(text, start)
    except NotTranslated as problem:
        raise NotTranslated(f"{letter} has no value: {problem}") from None
    if "ROUND[" in value.text:
        raise NotTranslated(
            f"{letter}: ROUND in a word rounds to the least increment there, to whole numbers on "
            "LinuxCNC: take it out, nothing needs it"
        )
    kind = "number" if re.fullmatch(r"-?[0-9.]+", value.text) else "expression"
    return ForeignWord(letter, value.text, kind, value.read), value.end


def _plain_word(letter: str, value: str) -> ForeignWord:
    if len(value) > MOST_DIGITS:
        raise NotTranslated(f"{excerpt(letter + value)} has {len(value)} digits")
    return ForeignWord(letter, value)
