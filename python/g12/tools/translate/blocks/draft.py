# SPDX-License-Identifier: GPL-2.0-or-later
"""One block while the rules process it: its remaining words, and the lines that it becomes."""

from collections.abc import Container, Iterable, Sequence
from dataclasses import KW_ONLY, dataclass, field
from typing import Any, NamedTuple

from g12.tools.translate.blocks.control import Control
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignBlock, ForeignWord
from g12.tools.translate.blocks.modal import MOVES, UNSURE, ModalState

AXIS_NUMBERS = {"X": 1, "Y": 2, "Z": 3, "A": 4, "B": 5, "C": 6}
ENDS = frozenset(("M2", "M30"))
PARTNERS = {"U": "X", "V": "Y", "W": "Z", "H": "C"}  # a lathe's increments


class SubprogramCall(NamedTuple):
    """A call: the called program's number, its ``kind`` (``sub``, ``macro``), what it is given.

    ``repeats`` is how often, "" for once; ``arguments`` are variables' numbers and values.
    """

    number: int
    kind: str
    repeats: str = ""
    arguments: tuple[tuple[int, str], ...] = ()


@dataclass(eq=False)
class Draft:
    """A block while the rules process it: words that are its own line, further lines, modes."""

    block: ForeignBlock
    state: ModalState  # the modes, carried on by the rules
    control: Control
    _: KW_ONLY
    index: int = 0  # of the block, unique in the file
    programs: Container[int] = ()  # numbers of the file's programs
    program: Sequence[tuple[int, ForeignBlock]] = ()  # the blocks of its program, with indices
    return_text: str = "M99"
    head: str = ""  # the line that begins a program
    before: list[str] = field(default_factory=list)  # further lines
    after: list[str] = field(default_factory=list)
    meanings: dict[str, ForeignWord] = field(default_factory=dict)  # codes that rules still own
    call: SubprogramCall | None = None
    returns: bool = False  # a subprogram ends here, by ``return_text``
    follows: int | None = None  # index of the next block where a cycle skips its contour
    is_settled: bool = False  # written for the distance mode that LinuxCNC is in
    has_motion: bool = False  # its motion code is written
    has_feed: bool = False  # its feed is written
    lines: list[str] = field(default_factory=list)  # the result
    refusal: NotTranslated | None = None

    def __post_init__(self) -> None:
        self.start = self.state
        self.words: list[ForeignWord] = list(self.block.words)
        self.comments: list[str] = list(self.block.comments)

    def change(self, **modes: Any) -> None:
        self.state = self.state._replace(**modes)

    def codes(self) -> list[str]:
        """Return the G codes of the block, as LinuxCNC's."""
        return [w.code for w in self.words if w.code[:1] == "G"]

    def m_codes(self) -> list[str]:
        return [w.code for w in self.words if w.code[:1] == "M"]

    @property
    def ends(self) -> bool:
        """Whether the program ends with the block."""
        return not ENDS.isdisjoint(self.m_codes())

    def letters(self) -> set[str]:
        return {word.letter for word in self.words if word.kind != "text"}

    def axis_words(self) -> list[ForeignWord]:
        return [word for word in self.words if word.letter in AXIS_NUMBERS]

    def word(self, letter: str) -> ForeignWord | None:
        """Return the first word of a letter; it stays."""
        return next((word for word in self.words if word.letter == letter), None)

    def motion(self) -> str:
        """Return the motion mode of the block: its own code, or the one before it."""
        codes = (code for code in self.codes() if code in MOVES)
        return next(codes, self.state.motion)

    def drop(self, words: Iterable[ForeignWord]) -> None:
        """Take out these words themselves, not equal ones."""
        dropped = {id(word) for word in words}
        self.words = [word for word in self.words if id(word) not in dropped]

    def write(self, lines: Iterable[str]) -> None:
        """Write lines after the block's words; the first is its own where no words remain."""
        lines = [*lines]
        if lines and self.is_empty():
            self.words.append(line_as_word(lines.pop(0)))
        self.after += lines

    def take(self, letter: str) -> ForeignWord | None:
        """Return the word of a letter and take it out, None if there is none; two are refused."""
        found = [word for word in self.words if word.letter == letter]
        if len(found) > 1:
            raise NotTranslated(f"{letter} is given twice in this block")
        self.words = [word for word in self.words if word.letter != letter]
        return found[0] if found else None

    def take_each(self, letters: str) -> list[ForeignWord]:
        """Take the words of some letters out and return them, in the order of the letters."""
        return [word for letter in letters if (word := self.take(letter))]

    def comment_out(self, letter: str, note: str = "") -> None:
        """Keep the word of a letter as a comment, if there is one."""
        word = self.take(letter)
        self.comments += [f"{word.text}{note}"] if word else []

    def take_codes(self, codes: Container[str]) -> list[str]:
        """Take codes out; return those that were there."""
        taken = [word.code for word in self.words if word.code in codes]
        self.words = [word for word in self.words if word.code not in codes]
        return taken

    def replace(self, old: ForeignWord, *new: ForeignWord) -> None:
        at = next(index for index, word in enumerate(self.words) if word is old)
        self.words[at : at + 1] = new

    def put_first(self, code: str) -> None:
        """Put a code before all other words but the block number."""
        self.words.insert(1 if self.words and self.words[0].letter == "N" else 0, word_of(code))

    def increments(self) -> list[ForeignWord]:
        """Return a lathe's words U V W and H; the H of G43 is none of them."""
        offset = "H" if "G43" in self.codes() else ""
        return [w for w in self.words if w.letter in PARTNERS and w.letter != offset]

    def sure(self, group: str, why: str) -> Any:
        """Return a mode that must be the same on every way to the block."""
        value = getattr(self.state, group)
        if value == UNSURE:
            name = group.replace("_", " ")
            raise NotTranslated(f"{why}, but the {name} here is not the same on every way")
        return value

    def written(self) -> str:
        return " ".join(word.text for word in self.words)

    def is_empty(self) -> bool:
        """Whether no word but a block number remains."""
        return all(word.letter == "N" and word.kind == "number" for word in self.words)


def position(axis: str) -> str:
    return f"#{5419 + AXIS_NUMBERS[axis]}"


def word_of(text: str) -> ForeignWord:
    return ForeignWord(text[0], text[1:])


def line_as_word(text: str) -> ForeignWord:
    return ForeignWord(text[0], text[1:], "text")
