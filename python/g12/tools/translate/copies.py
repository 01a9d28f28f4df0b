# SPDX-License-Identifier: GPL-2.0-or-later
"""Programs that are called in modes that differ: a copy for each, where a block hangs on the mode.

The holes that two drilling cycles share are the usual case: a subprogram of X and Y words alone.
"""

from collections.abc import Callable, Iterator

from g12.tools.translate.blocks.control import Control
from g12.tools.translate.blocks.modal import UNSURE
from g12.tools.translate.follow import FollowedProgram, Progress
from g12.tools.translate.structure import MAIN, Structure, find_ends

DEEPEST = 8  # calls within calls, each of which can need a round
MOST_COPIES = 100
MOST_BLOCKS = 200_000  # with the copies


def followed_program(
    structure: Structure,
    control: Control,
    machine_codes: frozenset[str] | None,
    progress: Progress,
) -> FollowedProgram:
    """Return the drafts of a program, with as many copies of subprograms as it needs."""
    follow: Callable[[], FollowedProgram] = lambda: FollowedProgram(  # noqa: E731
        structure, control, machine_codes, progress
    ).run()
    followed = follow()
    for _ in range(DEEPEST):
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
    wanted = [
        (followed.program_of(draft.index), draft.unsure)
        for draft in followed.drafts
        if draft and draft.unsure
    ]
    seen = {(MAIN, modes) for _, modes in wanted}
    while wanted:
        number, modes = wanted.pop()
        if (number, modes) in seen:
            continue
        seen.add((number, modes))
        groups: dict[tuple, list[int]] = {}
        for index in followed.callers_of(number):
            values = tuple(getattr(followed.drafts[index].state, mode) for mode in modes)
            groups.setdefault(values, []).append(index)
            if UNSURE in values:
                wanted.append((followed.program_of(index), modes))
        if len(groups) > 1:
            yield number, list(groups.values())
