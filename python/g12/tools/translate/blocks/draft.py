# SPDX-License-Identifier: GPL-2.0-or-later
"""One block on its way through the rules: what is left of its words, and the lines it becomes."""

from collections.abc import Container, Mapping, Sequence
from typing import Any, NamedTuple

from g12.tools.translate.blocks.control import Control
from g12.tools.translate.blocks.errors import NotSure, NotTranslated
from g12.tools.translate.blocks.lexer import ForeignBlock, ForeignWord
from g12.tools.translate.blocks.modal import UNSURE, ModalState

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


class Draft:
    """A block that the rules rewrite.

    ``words`` are those that will be its own line; ``meanings`` the codes that a rule of the
    translation owns, by their meaning; ``before`` and ``after`` further lines; ``comments`` what is
    kept as text; ``state`` the modes before the block, which the rules carry on; ``call`` what it
    calls, ``returns`` whether a subprogram ends here, by ``return_text``, and ``jumps`` whether
    another block than the next one follows; ``head`` begins a program;
    ``around`` are lines before and behind its own; ``is_settled`` means that the block is written
    for the distance mode that LinuxCNC is in, ``has_motion`` that its motion code is written,
    ``has_feed`` that its feed is;
    ``start`` are the modes before the block, as it was read;
    ``programs`` are the numbers of the programs in the file, ``called_as`` that of the copy that a
    call is for, 0 if it is for none; ``asked`` has what each program compares with #0; ``index``
    tells the block from all others; ``program`` are the blocks of its program with their indices,
    ``follows`` is the index of the next one where a cycle has others go by; ``lines`` are those
    that it becomes; ``refusal`` is why it is not translated, None if it is; if that is why,
    ``unsure`` are the modes that are not the same on every way, ``setting`` the table and the line
    that the control's file lacks.
    """

    def __init__(
        self,
        block: ForeignBlock,
        state: ModalState,
        control: Control,
        machine_codes: frozenset[str] | None = None,
        programs: Container[int] = (),
        index: int = 0,
        called_as: int = 0,
    ) -> None:
        self.index, self.called_as = index, called_as
        self.block, self.state, self.control = block, state, control
        self.machine_codes = machine_codes
        self.words: list[ForeignWord] = list(block.words)
        self.meanings: dict[str, ForeignWord] = {}
        self.before: list[str] = []
        self.after: list[str] = []
        self.comments: list[str] = list(block.comments)
        self.call: SubprogramCall | None = None
        self.returns = False
        self.jumps = False
        self.return_text = "M99"
        self.head = ""
        self.around: tuple[str, str] | None = None
        self.is_settled = False
        self.has_motion = self.has_feed = False
        self.start = state
        self.programs = programs
        self.asked: Mapping[int, frozenset[int]] = {}
        self.lines: list[str] = []
        self.program: Sequence[tuple[int, ForeignBlock]] = ()
        self.follows: int | None = None
        self.refusal: str | None = None
        self.unsure: tuple[str, ...] = ()
        self.setting: tuple[str, str] | None = None

    def change(self, **modes: Any) -> None:
        """Carry the state on."""
        self.state = self.state._replace(**modes)

    def codes(self) -> list[str]:
        """Return the G codes of the block, as LinuxCNC's."""
        return [w.code for w in self.words if w.letter == "G" and w.kind == "number"]

    def m_codes(self) -> list[str]:
        """Return the M codes of the block, as LinuxCNC's."""
        return [w.code for w in self.words if w.letter == "M" and w.kind == "number"]

    @property
    def ends(self) -> bool:
        """Whether the program ends with the block, by M2, M30 or an alarm."""
        if self.block.kind == "stop" and self.block.label == "3000":
            return True
        return not ENDS.isdisjoint(self.m_codes())

    def letters(self) -> set[str]:
        """Return the letters of the words that are left."""
        return {word.letter for word in self.words if word.kind != "text"}

    def axis_words(self) -> list[ForeignWord]:
        """Return the words that name an axis."""
        return [word for word in self.words if word.letter in AXIS_NUMBERS]

    def take(self, letter: str) -> ForeignWord | None:
        """Return the word of a letter and take it out, None if there is none; two are refused."""
        found = [word for word in self.words if word.letter == letter]
        if len(found) > 1:
            raise NotTranslated(f"{letter} stands twice")
        self.words = [word for word in self.words if word.letter != letter]
        return found[0] if found else None

    def take_codes(self, codes: Container[str]) -> list[str]:
        """Take G codes out; return those that were there."""
        taken = [
            w for w in self.words if w.letter == "G" and w.kind == "number" and w.code in codes
        ]
        self.words = [word for word in self.words if word not in taken]
        return [word.code for word in taken]

    def replace(self, old: ForeignWord, *new: ForeignWord) -> None:
        """Put words in the place of one."""
        at = next(index for index, word in enumerate(self.words) if word is old)
        self.words[at : at + 1] = new

    def put_first(self, code: str) -> None:
        """Put a code before all other words but the block number."""
        self.words.insert(1 if self.words and self.words[0].letter == "N" else 0, word_of(code))

    def increments(self) -> list[ForeignWord]:
        """Return a lathe's words U V W and H; the H of G43 is none of them."""
        offset = "H" if "G43" in self.codes() else ""
        return [w for w in self.words if w.letter in PARTNERS and w.letter != offset]

    def sure(self, group: str, why: str) -> str:
        """Return a mode that must be the same on every way to the block."""
        value = getattr(self.state, group)
        if value == UNSURE:
            name = group.replace("_", " ")
            raise NotSure(f"{why}, but the {name} here is not the same on every way", group)
        return value

    def written(self) -> str:
        """Return the words that are left as one line."""
        return " ".join(word.text for word in self.words)

    def begins_program(self) -> bool:
        """Tell whether the block begins with the number of a program."""
        return bool(self.words) and self.words[0].letter == "O"

    def alone(self) -> bool:
        """Tell whether nothing but a block number is left of the words."""
        return all(word.letter == "N" and word.kind == "number" for word in self.words)


def word_of(text: str) -> ForeignWord:
    """Return the word of a text such as ``G90``."""
    return ForeignWord(text[0], text[1:])


def line_as_word(text: str) -> ForeignWord:
    """Return a whole line of LinuxCNC's in the place of a word."""
    return ForeignWord(text[0], text[1:], "text")
