# SPDX-License-Identifier: GPL-2.0-or-later
"""Jumps, GOTO and M99 P, as O-words: LinuxCNC has none.

The blocks from the first to the last that has to do with a jump are parted where jumps arrive. A
loop runs the parts in order; a jump notes the part that is next and begins the loop again:

    #<jump_5>=0
    o<jump_5> do
    o<jump_5_0> if [#<jump_5> LE 0]
    …                                    blocks up to N10; among them the lines of GOTO 10:
    #<jump_5>=1
    o<jump_5> continue
    …
    o<jump_5_0> endif
    o<jump_5_1> if [#<jump_5> LE 1]
    N10 …
    o<jump_5_1> endif
    #<jump_5>=-1
    o<jump_5> while [#<jump_5> GE 0]

The body of a loop (WHILE DO END) has parts of its own: a jump can leave it, none leads into it.
"""

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from g12.tools.translate.blocks.lexer import ForeignBlock

MOST_LOOPS = 8  # that one jump may leave
NO_LOOP = -1
OPENING = ("while", "if")  # kinds of blocks that a partner closes


@dataclass
class Jumps:
    """Additions of jumps to a program, by the index of a block."""

    targets: dict[int, int] = field(default_factory=dict)  # the block where each jump arrives
    problems: dict[int, str] = field(default_factory=dict)
    spans: list[tuple[int, int]] = field(default_factory=list)  # first and last divided block
    before: dict[int, list[str]] = field(default_factory=lambda: defaultdict(list))
    after: dict[int, list[str]] = field(default_factory=lambda: defaultdict(list))
    at: dict[int, list[str]] = field(default_factory=lambda: defaultdict(list))  # of the jump


class _Loops:
    """The loops of a program: which is the innermost one about a block."""

    def __init__(self, blocks: Sequence[ForeignBlock], partners: Mapping[int, int]) -> None:
        self._partners = partners
        self.about: list[int] = []
        opened = [NO_LOOP]
        for index, block in enumerate(blocks):
            self.about.append(opened[-1])
            if index in partners and block.kind in OPENING:
                opened.append(index)
            elif index in partners:
                opened.pop()

    def span_within(self, index: int, loop: int) -> tuple[int, int] | None:
        """Return first and last block of what holds a block as a part of a loop's body."""
        span = (index, index)
        for _ in range(MOST_LOOPS):
            inner = self.about[span[0]]
            if inner == loop:
                return span
            if inner == NO_LOOP:
                break
            span = (inner, self._partners[inner])
        return None


def find_jumps(
    blocks: Sequence[ForeignBlock],
    programs: Sequence[int],
    partners: Mapping[int, int],
    numbers: Mapping[int, int],
) -> Jumps:
    """Return the jumps of a file's blocks.

    ``programs`` has the number of the program that each block is in, ``partners`` joins WHILE and
    END, ``numbers`` has the N number that each block jumps to.
    """
    jumps = Jumps()
    if not numbers:
        return jumps
    numbered = _numbered(blocks, programs)
    loops = _Loops(blocks, partners)
    bodies: dict[tuple[int, int], list[tuple[int, tuple[int, int]]]] = defaultdict(list)
    for index, number in numbers.items():
        target = _found(numbered.get((programs[index], number), []), index)
        loop = loops.about[target] if target is not None else NO_LOOP
        span = loops.span_within(index, loop)
        if target is None:
            jumps.problems[index] = f"there is no N{number} in this program"
        elif span is None:
            jumps.problems[index] = f"N{number} is in a loop: no jump leads into WHILE […] DO … END"
        else:
            jumps.targets[index] = target
            bodies[programs[index], loop].append((index, span))
    for body in bodies.values():
        _part(jumps, body)
    return jumps


def _numbered(
    blocks: Sequence[ForeignBlock], programs: Sequence[int]
) -> dict[tuple[int, int], list[int]]:
    found: dict[tuple[int, int], list[int]] = defaultdict(list)
    for index, block in enumerate(blocks):
        if block.number is not None:
            found[programs[index], block.number].append(index)
    return found


def _found(numbered: Sequence[int], index: int) -> int | None:
    """Return where a jump arrives: controls look onwards first, then from the top."""
    if not numbered:
        return None
    return numbered[bisect_left(numbered, index + 1) % len(numbered)]


def _part(jumps: Jumps, body: Sequence[tuple[int, tuple[int, int]]]) -> None:
    """Write the lines of the parts of one body; ``body`` has its jumps and what holds each."""
    arrivals = sorted({jumps.targets[index] for index, _ in body})
    first = min(arrivals[0], *(span[0] for _, span in body))
    last = max(span[1] for _, span in body)
    cuts = sorted({first, *arrivals})
    parts = {at: part for part, at in enumerate(cuts)}
    name = f"jump_{first}"
    jumps.spans.append((first, max(last, cuts[-1] - 1)))
    jumps.before[first] += [f"#<{name}>=0", f"o<{name}> do"]
    for at, part in parts.items():
        if part:
            jumps.before[at].append(f"o<{name}_{part - 1}> endif")
        if at <= last or at < cuts[-1]:
            jumps.before[at].append(f"o<{name}_{part}> if [#<{name}> LE {part}]")
    ends = [f"#<{name}>=-1", f"o<{name}> while [#<{name}> GE 0]"]
    if cuts[-1] > last:
        jumps.before[cuts[-1]] += ends
    else:
        jumps.after[last] += [f"o<{name}_{len(cuts) - 1}> endif", *ends]
    for index, _ in body:
        part = parts[jumps.targets[index]]
        jumps.at[index] += [f"#<{name}>={part}", f"o<{name}> continue"]
