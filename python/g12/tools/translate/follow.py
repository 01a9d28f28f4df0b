# SPDX-License-Identifier: GPL-2.0-or-later
"""Every block in the modal state that it is reached in: through calls, returns, loops and skips.

A block that is reached again in another state is translated again in what both have in common, so
the last translation of each block holds on every way. A mode can only become unsure: it ends.

A program that is called in different modes is copied for each, where one of its blocks depends on
the mode. The usual case are the holes that two drilling cycles share: X and Y words alone.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from typing import Any

from g12.tools.translate.blocks.control import Control
from g12.tools.translate.blocks.draft import Draft, SubprogramCall
from g12.tools.translate.blocks.errors import NotSaid, NotSure, NotTranslated
from g12.tools.translate.blocks.lexer import ForeignBlock
from g12.tools.translate.blocks.modal import GROUP_OF, UNSURE, ModalState, merged
from g12.tools.translate.jumps import OPENING
from g12.tools.translate.on_lathe.sections import before_loop
from g12.tools.translate.rules.motion import is_plain
from g12.tools.translate.statements import STATEMENTS
from g12.tools.translate.structure import MAIN, Structure, find_ends, ways_from
from g12.tools.translate.word_rules import WORD_RULES

Progress = Callable[[int], None]


class FollowedProgram:
    """The drafts of a program's blocks, None where a block is never reached.

    ``falls_off`` are the blocks after which a program is over without an end of its own,
    ``has_end``: an end is reached, ``kinds`` how each program is called.
    """

    def __init__(
        self,
        structure: Structure,
        control: Control,
        machine_codes: frozenset[str] | None = None,
        progress: Progress = lambda index: None,
    ) -> None:
        self.structure, self.control = structure, control
        self._machine_codes, self._progress = machine_codes, progress
        count = len(structure.blocks)
        self.drafts: list[Draft | None] = [None] * count
        self.falls_off: set[int] = set()
        self.has_end = False
        self.kinds: dict[int, str] = {}
        self.calls: dict[int, list[Draft]] = {}
        self._states: list[ModalState | None] = [None] * count
        self._inside = structure.programs
        self._blocks_of: dict[int, list[tuple[int, ForeignBlock]]] = {}
        for at, number in enumerate(self._inside):
            self._blocks_of.setdefault(number, []).append((at, structure.blocks[at]))
        self._calls: dict[int, set[int]] = {}
        self._exits: dict[int, ModalState] = {}
        self._pending: list[tuple[int, ModalState]] = []

    def run(self) -> FollowedProgram:
        """Follow the main program from its first block until nothing new is found."""
        if self.drafts:
            self._pending.append((self.structure.main, _start_state(self.control)))
        while self._pending:
            self._reach(*self._pending.pop())
        return self

    @property
    def callers(self) -> dict[int, set[int]]:
        """The numbers of the programs that call each program."""
        return {n: {self._inside[index] for index in calls} for n, calls in self._calls.items()}

    def calls_of(self, numbers: Collection[int]) -> Iterator[tuple[int, int]]:
        """Yield each block between some programs that calls one of them, and the called number."""
        for number in numbers:
            for index in self.callers_of(number):
                if self._inside[index] in numbers:
                    yield index, number

    def callers_of(self, number: int) -> list[int]:
        """Return the blocks that call a program, in order."""
        return sorted(self._calls.get(number, ()))

    def program_of(self, index: int) -> int:
        """Return the number of the program that a block is in."""
        return self._inside[index]

    def _reach(self, index: int, state: ModalState) -> None:
        known = self._states[index]
        if known is not None:
            state = merged(known, state)
            if state == known:
                return
        self._states[index] = state
        self._progress(index)
        draft = self._translate(index, state)
        self.drafts[index] = draft
        if self.structure.blocks[index].skipped:
            self._arrive(index, index + 1, state)
        self._leave(index, draft)

    def _translate(self, index: int, state: ModalState) -> Draft:
        block = self.structure.blocks[index]
        draft = Draft(
            block,
            state,
            self.control,
            self._machine_codes,
            index=index,
            programs=self.structure.entries,
            program=self._blocks_of[self._inside[index]],
            called_as=self.structure.called_as.get(index, 0),
            compared=self.structure.compared,
            jumps=index in self.structure.jumps.targets,
        )
        try:
            problem = block.problem or self.structure.problems.get(index)
            if problem:
                raise NotTranslated(problem)
            statement = STATEMENTS.get(block.kind)
            if statement:
                if block.kind in OPENING:
                    before_loop(draft)
                statement(draft, self.structure)
            elif index in self.structure.starts or draft.begins_program():
                self._head(draft, index)
            else:
                self._end(draft, index)
                _apply_rules(draft)
            if not statement:
                draft.after += self.structure.jumps.at.get(index, ())
        except NotTranslated as refusal:
            draft.refusal = str(refusal)
            draft.unsure = refusal.modes if isinstance(refusal, NotSure) else ()
            draft.setting = refusal.setting if isinstance(refusal, NotSaid) else None
        return draft

    def _head(self, draft: Draft, index: int) -> None:
        """Write the first block of a program."""
        number = self.structure.starts.get(index, MAIN)
        word = draft.take("O")
        if number == MAIN and not word.value.isdigit():
            raise NotTranslated(f"{word.text}: the number of a program must be a whole number")
        name = f"O{number}" if self.kinds.get(number) != "macro" else f"o<macro_{number}> sub"
        self._end(draft, index)
        _apply_rules(draft)
        if number == MAIN:
            draft.comments.insert(0, word.text)
        else:
            draft.head = name

    def _end(self, draft: Draft, index: int) -> None:
        """Set the text of a return at a block."""
        number = self._inside[index]
        if self.kinds.get(number) == "macro":
            last = self.structure.last_returns.get(number) == index and not self._parted(index)
            draft.return_text = f"o<macro_{number}> {'endsub' if last else 'return'}"

    def _parted(self, index: int) -> bool:
        """Whether a block is in what jumps part or a condition rules: no program ends so."""
        ruled = [at for at in self.structure.partners.items() if at[0] < index < at[1]]
        return bool(ruled) or any(
            first <= index <= last for first, last in self.structure.jumps.spans
        )

    def ends_of_macros(self) -> dict[int, str]:
        """Return the end that a macro needs after its last block, if that is no return."""
        ends = {}
        for number in (n for n, kind in self.kinds.items() if kind == "macro"):
            last = self.structure.last_returns.get(number, -1)
            if self._parted(last):
                following = self.structure.end_of(self.structure.entries[number])
                ends[following - 1] = f"o<macro_{number}> endsub"
        return ends

    def _leave(self, index: int, draft: Draft) -> None:
        """Go on to the blocks that can follow."""
        if draft.call:
            self._call(index, draft, draft.call)
        elif draft.returns:
            self._return(self._inside[index], draft.state)
        elif draft.ends:
            self.has_end = True
        elif draft.follows is not None:
            self._arrive(draft.follows - 1, draft.follows, draft.state)
        else:
            self._go_on(index, draft.state)

    def _go_on(self, index: int, state: ModalState) -> None:
        for last, following in ways_from(self.structure, index):
            self._arrive(last, following, state)

    def _arrive(self, index: int, following: int, state: ModalState) -> None:
        if following == index + 1 and self.structure.is_over(following):
            self.falls_off.add(index)
            self.has_end = self.has_end or self._inside[index] == MAIN
        else:
            self._pending.append((following, state))

    def _call(self, index: int, draft: Draft, call: SubprogramCall) -> None:
        entry = self.structure.entries.get(call.number)
        problem = self._wrong_call(index, call, entry)
        if problem:
            draft.refusal = draft.refusal or problem
            self._go_on(index, draft.state)
            return
        if self.kinds.setdefault(call.number, call.kind) == call.kind:
            self.calls.setdefault(call.number, []).append(draft)
        self._calls.setdefault(call.number, set()).add(index)
        self._pending.append((entry, draft.state))
        if call.number in self._exits:
            self._go_on(index, self._exits[call.number])

    def _wrong_call(self, index: int, call: SubprogramCall, entry: int | None) -> str | None:
        name = self.structure.name_of(call.number)
        if entry is None and call.number in self.structure.behind_tape:
            return f"{name} is after the % that ends the program: take that % out"
        if entry is None and any(block.number == call.number for block in self.structure.blocks):
            return f"{name} is not in this file, but N{call.number} is: M97 P calls a block"
        if entry is None and name.startswith("N"):
            return f"{name} is not in this program: M97 calls a block of it"
        if entry is None:
            return f"{name} is not in this file: put the subprogram into it"
        if call.number in self.structure.doubled:
            return f"{name} stands twice in this file: give one of them another number"
        if self.kinds.get(call.number, call.kind) != call.kind:
            return f"{name} is called by G65 and by M98: LinuxCNC wants a copy of it for each"
        return None

    def _return(self, number: int, state: ModalState) -> None:
        if number == MAIN:
            self.has_end = True
            self._pending.append((self.structure.main, state))  # M99 there: from the top again
            return
        known = self._exits.get(number)
        state = merged(known, state) if known else state
        if state != known:
            self._exits[number] = state
            for index in self._calls.get(number, ()):
                self._go_on(index, state)


def _apply_rules(draft: Draft) -> None:
    if draft.words and not is_plain(draft):
        for rule in WORD_RULES:
            rule(draft)


def _start_state(control: Control) -> ModalState:
    known: dict[str, Any] = {GROUP_OF[code]: code for code in control.start if code in GROUP_OF}
    return ModalState(**known)


DEEPEST_CALLS = 8  # calls within calls, each of which can need a round
MOST_COPIES = 100
MOST_BLOCKS = 200_000  # with the copies


def followed_program(
    structure: Structure,
    control: Control,
    machine_codes: frozenset[str] | None,
    progress: Progress,
) -> FollowedProgram:
    """Return the drafts of a program, with as many copies of subprograms as it needs."""

    def follow() -> FollowedProgram:
        return FollowedProgram(structure, control, machine_codes, progress).run()

    followed = follow()
    for _ in range(DEEPEST_CALLS):
        if not _add_copies(followed):
            break
        find_ends(structure, control)
        followed = follow()
    return followed


def _add_copies(followed: FollowedProgram) -> bool:
    """Copy programs that are called in different modes; return whether there were any."""
    structure = followed.structure
    added = False
    for number, groups in list(_differing_calls(followed)):
        for calls in groups[1:]:
            if len(structure.copies) >= MOST_COPIES or len(structure.blocks) >= MOST_BLOCKS:
                return added
            structure.add_copy(number, calls)
            added = True
    return added


def _differing_calls(followed: FollowedProgram) -> Iterator[tuple[int, list[list[int]]]]:
    """Yield programs with an unsure block, and their calls grouped by those modes."""
    pending = [
        (followed.program_of(draft.index), draft.unsure)
        for draft in followed.drafts
        if draft and draft.unsure
    ]
    visited = {(MAIN, modes) for _, modes in pending}
    while pending:
        number, modes = pending.pop()
        if (number, modes) in visited:
            continue
        visited.add((number, modes))
        groups: dict[tuple, list[int]] = {}
        for index in followed.callers_of(number):
            values = tuple(getattr(followed.drafts[index].state, mode) for mode in modes)
            groups.setdefault(values, []).append(index)
            if UNSURE in values:
                pending.append((followed.program_of(index), modes))
        if len(groups) > 1:
            yield number, list(groups.values())
