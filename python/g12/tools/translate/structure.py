# SPDX-License-Identifier: GPL-2.0-or-later
"""Which blocks of a file are its main program and which its subprograms, and who calls them."""

from collections.abc import Collection, Container, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from g12.tools.translate.blocks.control import Control
from g12.tools.translate.blocks.draft import ENDS
from g12.tools.translate.blocks.lexer import ForeignBlock

MAIN = -1  # the number of the main program
LOCAL_BLOCKS = 100_000_000  # a block called by M97 P100 is program O100000100
TEXT = ("words", "tape")  # kinds of blocks that do nothing if they have no words
LOCAL_SUBPROGRAM = "local subprogram"
CALLS = frozenset(("subprogram", "macro call"))
OPENING = ("while", "if")  # kinds of blocks that a partner closes


@dataclass
class Structure:
    """The blocks of a file up to its end, by index."""

    blocks: list[ForeignBlock]
    main: int = 0  # the block that is reached first
    entries: dict[int, int] = field(default_factory=dict)  # first block of each other program
    starts: dict[int, int] = field(default_factory=dict)  # the numbers of programs, by block
    doubled: set[int] = field(default_factory=set)  # numbers of several programs
    programs: list[int] = field(default_factory=list)  # the program of each block
    partners: dict[int, int] = field(default_factory=dict)  # WHILE and END, condition and end
    problems: dict[int, str] = field(default_factory=dict)

    def add_entry(self, number: int, index: int) -> None:
        if number in self.entries:
            self.doubled.add(number)
        else:
            self.entries[number] = index
            self.starts[index] = number

    def end_of(self, start: int) -> int:
        """Return the index after the last block of the program that begins at a block."""
        end = min((index for index in self.starts if index > start), default=len(self.blocks))
        return end - (self.blocks[end - 1].kind == "tape")

    def is_over(self, index: int) -> bool:
        """Whether a program is over before a block: after its last one."""
        return index >= len(self.blocks) or index in self.starts

    def name_of(self, number: int) -> str:
        """Return a program's number as in the file: O100, or N100 for a block that M97 calls."""
        return f"N{number - LOCAL_BLOCKS}" if number >= LOCAL_BLOCKS else f"O{number}"


def structure_of(blocks: Sequence[ForeignBlock], control: Control) -> Structure:
    structure = Structure(_on_tape(blocks))
    heads = _program_heads(structure.blocks)
    main = _start_of_main(structure, heads, control)
    for index, number in heads.items():
        if index != main:
            structure.add_entry(number, index)
        elif structure.entries:
            structure.starts[index], structure.main = MAIN, index
    _add_local_programs(structure, heads, control)
    _pair_loops(structure)
    structure.programs = _carried_on(structure.starts, len(structure.blocks), MAIN)
    return structure


def _carried_on(starts: Mapping[int, int], count: int, value: int) -> list[int]:
    """Return the value of the last start for each block, ``value`` before the first."""
    return [value := starts.get(index, value) for index in range(count)]


def ways_from(structure: Structure, index: int) -> Iterator[tuple[int, int]]:
    """Yield the ways on from a block that neither calls nor ends: the last block on it, the next.

    A WHILE leads to the block after its END, too, and an END to where its WHILE leads: what is
    written before a loop's head is run once. A condition leads to its end, too.
    """
    kind, partner = structure.blocks[index].kind, structure.partners.get(index)
    yield index, index + 1
    if partner is not None and kind in ("while", "end"):
        yield partner, partner + 1
    if partner is not None and kind == "if":
        yield index, partner


def _called_in(block: ForeignBlock, control: Control, numbers: Collection[int]) -> list[int]:
    """Return the numbers of the programs that a block calls, in the order of their words."""
    meanings = {control.meanings.get(word.code) for word in block.words}
    if LOCAL_SUBPROGRAM in meanings:
        return [LOCAL_BLOCKS + number for number in block.numbers("P")]
    if meanings.isdisjoint(CALLS):
        return []
    programs = [called_program(n, control, numbers)[0] for n in block.numbers("P")]
    return programs or [LOCAL_BLOCKS + number for number in block.numbers("Q")]


def called_program(number: int, control: Control, programs: Container[int]) -> tuple[int, str]:
    """Return the program that M98 P calls and how often: P51001 can be O1001 five times."""
    digits = control.value("subprograms", "repeat_digits", False)
    if digits and number > 9999 and number not in programs:
        return number % 10000, str(number // 10000)
    return number, ""


def _program_heads(blocks: Sequence[ForeignBlock]) -> dict[int, int]:
    """Return the first block of each program, and its number; the first may have none (MAIN)."""
    heads: dict[int, int] = {}
    for index, block in enumerate(blocks):
        first = block.words[0] if block.words else None
        if first and first.letter == "O" and first.value.isdigit():
            heads[index] = int(first.value)
        elif not heads and (first or block.kind not in TEXT):
            heads[index] = MAIN
    return heads


def _start_of_main(structure: Structure, heads: dict[int, int], control: Control) -> int:
    """Return the first block of the main program: of the first, unless others call that one.

    Then it is the one that nobody calls; of several the one that has an end (M30).
    """
    first = next(iter(heads), 0)
    if len(heads) < 2:
        return first
    called, ended = _called_and_ended(structure.blocks, heads, control)
    free = [index for index, number in heads.items() if number not in called]
    if first in free and (first in ended or not ended.intersection(free)):
        return first
    found = [index for index in free if index in ended] or free
    if len(found) > 1 or first in free:
        numbers = [heads[index] for index in dict.fromkeys((*free[:1], *found))]
        names = " and ".join("what has no number" if n == MAIN else f"O{n}" for n in numbers)
        structure.problems[first] = (
            f"which program is to run, {names}? nobody calls them: put that one first"
        )
    return found[0] if len(found) == 1 and first not in free else first


def _called_and_ended(
    blocks: Sequence[ForeignBlock], heads: dict[int, int], control: Control
) -> tuple[set[int], set[int]]:
    """Return the numbers that are called, and the first blocks of programs with M30 or M2."""
    numbers = set(heads.values())
    called: set[int] = set()
    ended: set[int] = set()
    for head, block in zip(_carried_on({at: at for at in heads}, len(blocks), -1), blocks):
        if any(word.code in ENDS for word in block.words):
            ended.add(head)
        called.update(_called_in(block, control, numbers))
    return called, ended


def _add_local_programs(structure: Structure, heads: dict[int, int], control: Control) -> None:
    """Note the blocks that M97 or M98 Q calls, each in the program that the call is in."""
    starts = _carried_on({at: at for at in heads}, len(structure.blocks), -1)
    numbered: dict[tuple[int, int], int] = {}
    called: set[tuple[int, int]] = set()
    for index, (head, block) in enumerate(zip(starts, structure.blocks)):
        if block.number is not None:
            numbered.setdefault((head, LOCAL_BLOCKS + block.number), index)
        called |= {(head, number) for number in _called_in(block, control, ())}
    for local_call in sorted(called & numbered.keys()):
        structure.add_entry(local_call[1], numbered[local_call])


def _on_tape(blocks: Sequence[ForeignBlock]) -> list[ForeignBlock]:
    """Return the blocks up to the last ``%``; a program's name before the first as a comment."""
    tapes = [index for index, block in enumerate(blocks) if block.kind == "tape"]
    leader = blocks[: tapes[0]] if tapes else []
    words = [word for block in leader for word in block.words]
    is_name = all(b.kind == "words" and not b.problem for b in leader)
    if not (is_name and all(word.letter == "O" for word in words)):
        return list(blocks[: tapes[0] + 1])
    named = [
        b._replace(words=(), comments=(*(w.text for w in b.words), *b.comments)) for b in leader
    ]
    end = tapes[1] + 1 if len(tapes) > 1 else len(blocks)
    return [*named, *blocks[len(leader) : end]]


def _pair_loops(structure: Structure) -> None:
    """Pair WHILE and END; a loop ends in the program where it begins."""
    opened: list[int] = []
    for index, block in enumerate(structure.blocks):
        if index in structure.starts:
            _unclosed(structure, opened)
            opened = []
        if block.kind in OPENING:
            opened.append(index)
        elif block.kind in ("end", "endif"):
            label = block.label
            if opened and structure.blocks[opened[-1]].label == label:
                start = opened.pop()
                structure.partners[start], structure.partners[index] = index, start
            else:
                structure.problems[index] = f"END{label} without WHILE […] DO{label} before it"
    _unclosed(structure, opened)


def _unclosed(structure: Structure, opened: Sequence[int]) -> None:
    for index in opened:
        label = structure.blocks[index].label
        structure.problems[index] = f"WHILE […] DO{label} has no END{label}"
