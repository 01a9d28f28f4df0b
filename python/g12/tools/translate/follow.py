# SPDX-License-Identifier: GPL-2.0-or-later
"""Every block in the modal state that it is reached in: through calls, returns, loops and skips.

A block that is reached again in another state is translated again in what both have in common, so
the last translation of each block holds on every way. A mode can only become unsure: it ends.

A program that is called in different modes is copied for each, where one of its blocks depends on
the mode. The usual case are the holes that two drilling cycles share: X and Y words alone.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator
from typing import Any

from g12.tools.translate.blocks.control import Control
from g12.tools.translate.blocks.draft import Draft, SubprogramCall
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignBlock
from g12.tools.translate.blocks.modal import GROUP_OF, UNSURE, ModalState, merged
from g12.tools.translate.jumps import OPENING
from g12.tools.translate.on_lathe.sections import before_loop
from g12.tools.translate.phases import translate_words
from g12.tools.translate.rules.modes import keep_modes
from g12.tools.translate.rules.motion import is_plain
from g12.tools.translate.statements import STATEMENTS
from g12.tools.translate.structure import MAIN, Structure, find_ends, ways_from

Progress = Callable[[int], None]


class FollowedProgram:
    """The drafts of a program's blocks, None where a block is never reached.

    ``falls_off`` are the blocks after which a program is over without an end of its own,
    ``has_end``: an end is reached, ``kinds`` how each program is called, ``callers`` by which
    blocks.
    """

    def __init__(self, structure: Structure, control: Control, progress: Progress) -> None:
        self.structure, self.control, self._progress = structure, control, progress
        count = len(structure.blocks)
        self.drafts: list[Draft | None] = [None] * count
        self.falls_off: set[int] = set()
        self.has_end = False
        self.kinds: dict[int, str] = {}
        self.callers: dict[int, set[int]] = defaultdict(set)
        self._states: list[ModalState | None] = [None] * count
        self._blocks_of: dict[int, list[tuple[int, ForeignBlock]]] = defaultdict(list)
        for at, (number, block) in enumerate(zip(structure.programs, structure.blocks)):
            self._blocks_of[number].append((at, block))
        self._exits: dict[int, ModalState] = {}
        self._pending = [(structure.main, _start_state(control))] if self.drafts else []
        while self._pending:
            self._reach(*self._pending.pop())

    def _reach(self, index: int, state: ModalState) -> None:
        known = self._states[index]
        if known is not None:
            state = merged(known, state)
            if state == known:
                return
        self._states[index] = state
        self._progress(index)
        draft = self.drafts[index] = self._translate(index, state)
        if self.structure.blocks[index].skipped:
            self._arrive(index, index + 1, state)
        self._leave(index, draft)

    def _translate(self, index: int, state: ModalState) -> Draft:
        structure = self.structure
        block = structure.blocks[index]
        draft = Draft(
            block,
            state,
            self.control,
            index=index,
            programs=structure.entries,
            program=self._blocks_of[structure.programs[index]],
            called_as=structure.called_as.get(index, 0),
            compared=structure.compared,
            jumps=index in structure.jumps.targets,
        )
        try:
            problem = block.problem or structure.problems.get(index)
            if problem:
                raise NotTranslated(problem)
            if statement := STATEMENTS.get(block.kind):
                if block.kind in OPENING:
                    before_loop(draft)
                statement(draft, structure)
            else:
                self._translate_words(draft)
                draft.after += structure.jumps.at.get(index, ())
        except NotTranslated as refusal:
            draft.refusal = refusal
            keep_modes(draft)
        return draft

    def _translate_words(self, draft: Draft) -> None:
        """Apply the rules; write the head of a program, and the text of a return."""
        index, number = draft.index, self.structure.programs[draft.index]
        is_macro = self.kinds.get(number) == "macro"
        if is_macro:
            last = self.structure.last_returns.get(number) == index and not self._parted(index)
            draft.return_text = f"o<macro_{number}> {'endsub' if last else 'return'}"
        begins = index in self.structure.starts or draft.begins_program()
        begun = self.structure.starts.get(index, MAIN)
        word = draft.take("O") if begins else None
        if begins and begun == MAIN and not word.value.isdigit():
            raise NotTranslated(f"{word.text}: the number of a program must be a whole number")
        if draft.words and not is_plain(draft):
            translate_words(draft)
        if begins and begun == MAIN:
            draft.comments.insert(0, word.text)
        elif begins:
            draft.head = f"o<macro_{number}> sub" if is_macro else f"O{number}"

    def _parted(self, index: int) -> bool:
        """Whether a block is in what jumps part or a condition rules: no program ends so."""
        partners, spans = self.structure.partners.items(), self.structure.jumps.spans
        ruled = any(start < index < end for start, end in partners)
        return ruled or any(first <= index <= last for first, last in spans)

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
        if draft.call:
            self._call(index, draft, draft.call)
        elif draft.returns:
            self._return(self.structure.programs[index], draft.state)
        elif draft.ends:
            self.has_end = True
        elif draft.follows is not None:
            self._arrive(draft.follows - 1, draft.follows, draft.state)
        else:
            self._go_on(index, draft.state)

    def _go_on(self, index: int, state: ModalState) -> None:
        block = self.structure.blocks[index]
        condition = block.expression if block.kind in ("goto", *OPENING) else None
        for last, following in ways_from(self.structure, index):
            then = state
            if condition:
                is_true = (following == index + 1) == (block.kind in OPENING)
                then = state.giving(condition.set_if_true if is_true else condition.set_if_false)
            self._arrive(last, following, then)

    def _arrive(self, index: int, following: int, state: ModalState) -> None:
        if following == index + 1 and self.structure.is_over(following):
            self.falls_off.add(index)
            self.has_end = self.has_end or self.structure.programs[index] == MAIN
        else:
            self._pending.append((following, state))

    def _call(self, index: int, draft: Draft, call: SubprogramCall) -> None:
        entry = self.structure.entries.get(call.number)
        problem = self._wrong_call(index, call, entry)
        if problem:
            draft.refusal = draft.refusal or NotTranslated(problem)
            self._go_on(index, draft.state)
            return
        self.kinds.setdefault(call.number, call.kind)
        self.callers[call.number].add(index)
        state = draft.state
        if call.kind == "macro":
            given = frozenset(number for number, _ in call.arguments)
            state = state._replace(given=given, touched=given)
        self._pending.append((entry, state))
        if call.number in self._exits:
            self._go_on(index, self._returned(index, call.number))

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
            return f"{name} is in this file twice: give one of them another number"
        if self.kinds.get(call.number, call.kind) != call.kind:
            return f"{name} is called by G65 and by M98: LinuxCNC needs a copy of it for each"
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
            for index in self.callers[number]:
                self._go_on(index, self._returned(index, number))

    def _returned(self, index: int, number: int) -> ModalState:
        """Return the state after a call; a macro leaves its caller's local variables alone."""
        state, own = self._exits[number], self.drafts[index].state
        if self.kinds[number] == "macro":
            return state._replace(given=own.given, touched=own.touched)
        return state.giving(own.given)


def _start_state(control: Control) -> ModalState:
    known: dict[str, Any] = {GROUP_OF[code]: code for code in control.start if code in GROUP_OF}
    return ModalState(**known)


DEEPEST_CALLS = 8  # calls within calls, each of which can need a round
MOST_COPIES = 100
MOST_BLOCKS = 200_000  # with the copies


def followed_program(structure: Structure, control: Control, progress: Progress) -> FollowedProgram:
    for _ in range(DEEPEST_CALLS):
        followed = FollowedProgram(structure, control, progress)
        if not _add_copies(followed):
            return followed
        find_ends(structure, control)
    return FollowedProgram(structure, control, progress)


def _add_copies(followed: FollowedProgram) -> bool:
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
    programs = followed.structure.programs
    pending = [
        (programs[draft.index], draft.refusal.modes)
        for draft in followed.drafts
        if draft and draft.refusal and draft.refusal.modes
    ]
    visited = {(MAIN, modes) for _, modes in pending}
    while pending:
        number, modes = pending.pop()
        if (number, modes) in visited:
            continue
        visited.add((number, modes))
        groups: dict[tuple, list[int]] = {}
        for index in sorted(followed.callers[number]):
            values = tuple(getattr(followed.drafts[index].state, mode) for mode in modes)
            groups.setdefault(values, []).append(index)
            if UNSURE in values:
                pending.append((programs[index], modes))
        if len(groups) > 1:
            yield number, list(groups.values())
