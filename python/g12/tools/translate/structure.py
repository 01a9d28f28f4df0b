# SPDX-License-Identifier: GPL-2.0-or-later
"""Which blocks of a file are its main program and which its subprograms, and who calls them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from g12.tools.translate.blocks.control import Control
from g12.tools.translate.blocks.lexer import ForeignBlock, ForeignWord
from g12.tools.translate.rules.subprograms import LOCAL_BLOCKS

MAIN = -1  # the number of the main program
LOCAL = "local subprogram"
CALLS = frozenset(("subprogram", LOCAL, "macro call"))


@dataclass
class Structure:
    """The blocks of a file up to its end, by index.

    ``tail`` are the blocks behind the closing ``%``. ``entries`` has the first block of each
    program by its number, ``starts`` the numbers by the block; the main program is none of them.
    ``partners`` joins each WHILE and its END, ``problems`` has what is wrong with a block,
    ``last_returns`` the block in which each program returns for the last time.
    """

    blocks: Sequence[ForeignBlock]
    tail: Sequence[ForeignBlock]
    entries: dict[int, int] = field(default_factory=dict)
    starts: dict[int, int] = field(default_factory=dict)
    partners: dict[int, int] = field(default_factory=dict)
    problems: dict[int, str] = field(default_factory=dict)
    last_returns: dict[int, int] = field(default_factory=dict)

    def add_entry(self, number: int, index: int) -> None:
        """Note that a program begins at a block."""
        if number in self.entries:
            self.problems[index] = f"O{number} stands twice in the file"
        else:
            self.entries[number] = index
            self.starts[index] = number


def structure_of(blocks: Sequence[ForeignBlock], control: Control) -> Structure:
    """Return the structure of a file's blocks."""
    end = end_of_tape(blocks)
    structure = Structure(blocks[:end], blocks[end:])
    codes = call_codes(control)
    numbered: dict[int, int] = {}
    local: set[int] = set()
    started = False
    for index, block in enumerate(structure.blocks):
        first = block.words[0] if block.words else None
        if first and first.letter == "O" and first.value.isdigit():
            if started:
                structure.add_entry(int(first.value), index)
        elif first and first.letter == "N" and first.value.isdigit():
            numbered.setdefault(int(first.value), index)
        started = started or bool(block.words) or block.kind not in ("words", "tape")
        if block.words:
            local |= local_targets(block.words, codes)
    for number in sorted(local & numbered.keys()):
        structure.add_entry(LOCAL_BLOCKS + number, numbered[number])
    pair_loops(structure)
    find_returns(structure, {c for c, m in control.meanings.items() if m == "return"})
    return structure


def end_of_tape(blocks: Sequence[ForeignBlock]) -> int:
    """Return the index behind the ``%`` that ends the program."""
    started = False
    for index, block in enumerate(blocks):
        if block.kind == "tape" and started:
            return index + 1
        started = started or bool(block.words) or block.kind not in ("words", "tape")
    return len(blocks)


def call_codes(control: Control) -> dict[str, str]:
    """Return the control's codes that call something, and what."""
    return {code: meaning for code, meaning in control.meanings.items() if meaning in CALLS}


def local_targets(words: Sequence[ForeignWord], codes: dict[str, str]) -> set[int]:
    """Return the block numbers that a block calls as local subprograms."""
    for word in words:
        local = word.letter == "M" and word.kind == "number" and codes.get(word.code) == LOCAL
        if local:
            return {int(w.value) for w in words if w.letter == "P" and w.value.isdigit()}
    return set()


def find_returns(structure: Structure, codes: set[str]) -> None:
    """Note where each program returns for the last time."""
    number = MAIN
    for index, block in enumerate(structure.blocks):
        number = structure.starts.get(index, number)
        if any(w.letter == "M" and w.kind == "number" and w.code in codes for w in block.words):
            structure.last_returns[number] = index


def pair_loops(structure: Structure) -> None:
    """Join WHILE and END; a loop must end in the program that it begins in."""
    opened: list[int] = []
    for index, block in enumerate(structure.blocks):
        if index in structure.starts:
            unclosed(structure, opened)
        if block.kind == "while":
            opened.append(index)
        elif block.kind == "end":
            pair(structure, opened, index)
    unclosed(structure, opened)


def pair(structure: Structure, opened: list[int], index: int) -> None:
    """Join an END with the WHILE that is open."""
    label = structure.blocks[index].label
    if not opened or structure.blocks[opened[-1]].label != label:
        structure.problems[index] = f"END{label} without WHILE […] DO{label} before it"
        return
    start = opened.pop()
    structure.partners[start], structure.partners[index] = index, start


def unclosed(structure: Structure, opened: list[int]) -> None:
    """Note the loops that have no END."""
    for index in opened:
        label = structure.blocks[index].label
        structure.problems[index] = f"WHILE […] DO{label} has no END{label}"
    opened.clear()
