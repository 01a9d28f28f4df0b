# SPDX-License-Identifier: GPL-2.0-or-later
"""Variables that LinuxCNC lacks: empty local ones of macros, and the control's clocks.

A local variable that no call gives and no line sets is empty on the control, and its word vanishes;
LinuxCNC takes 0. Such a macro is refused, unless it compares the variable with #0 first. All
programs that no G65 calls share their local variables: a word of one that nothing sets before it is
refused.

Many programs measure the time of a cycle. A variable that a clock, or another such variable, gives
a value may stand in assignments of its kind alone. Those become comments; where such a variable
decides or moves, it is refused.
"""

from collections import defaultdict
from collections.abc import Callable, Collection, Iterator, Sequence
from functools import partial

from g12.tools.translate.blocks.expressions import CLOCK, LOCAL_VARIABLES, SHARED
from g12.tools.translate.blocks.lexer import ForeignBlock
from g12.tools.translate.follow import FollowedProgram
from g12.tools.translate.jumps import OPENING
from g12.tools.translate.rules.subprograms import ARGUMENTS
from g12.tools.translate.structure import MAIN, ways_from

ARGUMENT_LETTERS = {number: letter for letter, number in ARGUMENTS.items()}


def unset_locals(followed: FollowedProgram) -> Iterator[tuple[int, str]]:
    """Yield line and sentence for each block that reads a variable which may be empty."""
    macros = {number for number, kind in followed.kinds.items() if kind == "macro"}
    given: dict[int, frozenset[int]] = {}
    for number in macros:
        given.update(_given_in(followed, number))
    for index, block in enumerate(followed.structure.blocks):
        number = followed.structure.programs[index]
        if index in given:
            for variable in sorted(block.read.intersection(LOCAL_VARIABLES) - given[index]):
                yield block.line, _unset_sentence(number, variable)
            for variable in sorted(block.compared - ARGUMENT_LETTERS.keys()):
                yield block.line, f"#{variable} EQ #0: no letter of G65 gives #{variable} a value"
        elif number not in macros and followed.drafts[index] and block.compared:
            yield block.line, "#0, the empty variable, is translated in a program of G65 only"
    yield from _reads_never_set(followed, macros)
    yield from _shared_locals(followed)


def _reads_never_set(
    followed: FollowedProgram, macros: Collection[int]
) -> Iterator[tuple[int, str]]:
    """Yield the blocks outside macros where a word is a local variable that nothing sets before."""
    if not any(word.read for block in followed.structure.blocks for word in block.words):
        return
    called = [
        block
        for index, block in enumerate(followed.structure.blocks)
        if followed.structure.programs[index] not in (MAIN, *macros)
    ]
    set_by_calls = frozenset().union(*map(_set_by, called))

    def onward(index: int, known: frozenset[int]) -> Iterator[tuple[int, frozenset[int]]]:
        draft = followed.drafts[index]
        entry = followed.structure.entries.get(draft.call.number) if draft and draft.call else None
        if entry is not None and draft.call.kind == "sub":
            yield entry, known
            known |= set_by_calls
        yield from _onward_from(followed, index, known)

    known = _flow({followed.structure.main: frozenset()}, onward, frozenset.union)
    for index, values in known.items():
        block = followed.structure.blocks[index]
        for word in block.words:
            for number in word.read.intersection(LOCAL_VARIABLES) - values:
                if word.value.lstrip("-") == f"#{number}":
                    sentence = f"{word.text}: nothing sets #{number} before, LinuxCNC takes 0"
                    yield block.line, sentence


def _given_in(followed: FollowedProgram, number: int) -> dict[int, frozenset[int]]:
    calls = [followed.drafts[index].call for index in followed.callers[number]]
    macro_calls = [dict(call.arguments) for call in calls if call.kind == "macro"]
    given = frozenset(macro_calls[0]).intersection(*macro_calls)
    start = {followed.structure.entries[number]: given}
    return _flow(start, partial(_onward_from, followed), frozenset.intersection)


def _flow(
    given: dict[int, frozenset[int]],
    onward: Callable[[int, frozenset[int]], Iterator[tuple[int, frozenset[int]]]],
    merge: Callable[[frozenset[int], frozenset[int]], frozenset[int]],
) -> dict[int, frozenset[int]]:
    """Return the variables before each block that is reached; ``merge`` joins two ways to it."""
    pending = [*given]
    while pending:
        index = pending.pop()
        for following, values in onward(index, given[index]):
            merged = merge(given.get(following, values), values)
            if given.get(following) != merged:
                given[following] = merged
                pending.append(following)
    return given


def _onward_from(
    followed: FollowedProgram, index: int, given: frozenset[int]
) -> Iterator[tuple[int, frozenset[int]]]:
    """Yield the blocks after one, and the variables that have a value there."""
    draft, block = followed.drafts[index], followed.structure.blocks[index]
    over = draft is None or draft.returns or draft.ends
    ways = set() if over else {following for _, following in ways_from(followed.structure, index)}
    condition = block.expression if block.kind in ("goto", *OPENING) else None
    for following in ways | ({index + 1} if block.skipped else set()):
        known = given | _set_by(block)
        if condition:
            onward = (following == index + 1) == (block.kind in OPENING)
            known |= condition.set_if_true if onward else condition.set_if_false
        if not followed.structure.is_over(following):
            yield following, known


def _set_by(block: ForeignBlock) -> frozenset[int]:
    """Return the variables to which a block surely gives a value."""
    sets = block.kind == "assign" and not block.skipped
    return frozenset((block.variable,)) if sets else frozenset()


def _unset_sentence(number: int, variable: int) -> str:
    letter = ARGUMENT_LETTERS.get(variable)
    name = f"#{variable} ({letter} of the call)" if letter else f"#{variable}"
    return f"O{number} reads {name}, which not every G65 P{number} gives: it would be 0 on LinuxCNC"


def _shared_locals(followed: FollowedProgram) -> Iterator[tuple[int, str]]:
    """Yield the blocks that use #31 to #33, where several programs do: LinuxCNC has them once."""
    users: dict[int, set[int]] = defaultdict(set)
    for index, block in enumerate(followed.structure.blocks):
        for variable in SHARED & {*block.read, *block.compared, block.variable}:
            users[variable].add(followed.structure.programs[index])
            if len(users[variable]) > 1:
                yield block.line, f"#{variable} is used in two programs: LinuxCNC has it once"


def without_clocks(blocks: Sequence[ForeignBlock]) -> list[ForeignBlock]:
    """Return the blocks with the assignments of times as comments."""
    timed, known = {CLOCK}, 0
    while len(timed) > known:
        known = len(timed)
        timed.update(b.variable for b in blocks if b.kind == "assign" and timed & b.read)
    return [_without_time(block, timed) for block in blocks]


def _without_time(block: ForeignBlock, timed: set[int]) -> ForeignBlock:
    """Return a block: a time is a comment, what depends on one is refused."""
    if block.kind == "assign" and block.variable in timed:
        comments = ("a time: LinuxCNC has no clock", *block.comments)
        return block._replace(kind="words", variable=0, expression=None, comments=comments)
    if timed & block.read:
        problem = "this depends on the control's clock, which LinuxCNC lacks: take it out"
        return block._replace(problem=block.problem or problem)
    return block
