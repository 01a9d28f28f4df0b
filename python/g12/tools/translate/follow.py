# SPDX-License-Identifier: GPL-2.0-or-later
"""Every block in the modal state that it is reached in: through calls, returns, loops and skips.

A block that is reached again in another state is translated again in what both have in common, so
the last translation of each block holds on every way. A mode can only become unsure: it ends.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from typing import Any

from g12.tools.translate.blocks.control import Control
from g12.tools.translate.blocks.draft import Draft, SubprogramCall
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignBlock
from g12.tools.translate.blocks.modal import GROUP_OF, ModalState, merged
from g12.tools.translate.phases import translate_words
from g12.tools.translate.rules.codes import keep_modes
from g12.tools.translate.rules.milled import before_loop
from g12.tools.translate.rules.subprograms import STATEMENTS
from g12.tools.translate.structure import MAIN, OPENING, Structure, ways_from

Progress = Callable[[int], None]


class FollowedProgram:
    """The drafts of a program's blocks, None where a block is never reached.

    ``falls_off`` are the blocks after which a program is over without an end of its own, ``kinds``
    how each program is called, ``callers`` by which blocks.
    """

    def __init__(self, structure: Structure, control: Control, progress: Progress) -> None:
        self.structure, self.control, self._progress = structure, control, progress
        count = len(structure.blocks)
        self.drafts: list[Draft | None] = [None] * count
        self.falls_off: set[int] = set()
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
        except NotTranslated as refusal:
            draft.refusal = refusal
            keep_modes(draft)
        return draft

    def _translate_words(self, draft: Draft) -> None:
        """Apply the rules; write the head of a program, and the text of a return."""
        index, number = draft.index, self.structure.programs[draft.index]
        is_macro = self.kinds.get(number) == "macro"
        if is_macro:
            draft.return_text = f"o<macro_{number}> return"
        begins = index in self.structure.starts or "O" in {w.letter for w in draft.words[:1]}
        begun = self.structure.starts.get(index, MAIN)
        word = draft.take("O") if begins else None
        if begins and begun == MAIN and not word.value.isdigit():
            raise NotTranslated(f"{word.text}: the number of a program must be a whole number")
        if draft.words:
            translate_words(draft)
        if begins and begun == MAIN:
            draft.comments.insert(0, word.text)
        elif begins:
            draft.head = f"o<macro_{number}> sub" if is_macro else f"O{number}"

    def ends_of_macros(self) -> dict[int, str]:
        """Return the line that ends each macro, by the index of its last block."""
        macros = [number for number, kind in self.kinds.items() if kind == "macro"]
        ends = {n: self.structure.end_of(self.structure.entries[n]) for n in macros}
        return {end - 1: f"o<macro_{n}> endsub" for n, end in ends.items()}

    def _leave(self, index: int, draft: Draft) -> None:
        if draft.call:
            self._call(index, draft, draft.call)
        elif draft.returns:
            self._return(self.structure.programs[index], draft.state)
        elif draft.follows is not None:
            self._arrive(draft.follows - 1, draft.follows, draft.state)
        elif not draft.ends:
            self._go_on(index, draft.state)

    def _go_on(self, index: int, state: ModalState) -> None:
        for last, following in ways_from(self.structure, index):
            self._arrive(last, following, state)

    def _arrive(self, index: int, following: int, state: ModalState) -> None:
        if following == index + 1 and self.structure.is_over(following):
            self.falls_off.add(index)
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
        if entry is None and name.startswith("N"):
            return f"{name} is not in this program: M97 calls a block of it"
        if entry is None:
            return f"{name} is not in this file: put the subprogram into it, before its last %"
        if call.number in self.structure.doubled:
            return f"{name} is in this file twice: give one of them another number"
        if self.kinds.get(call.number, call.kind) != call.kind:
            return f"{name} is called by G65 and by M98: LinuxCNC needs a copy of it for each"
        return None

    def _return(self, number: int, state: ModalState) -> None:
        if number == MAIN:
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
