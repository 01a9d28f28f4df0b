# SPDX-License-Identifier: GPL-2.0-or-later
"""Feeds that no cut means, feeds that the machine cuts down, and feeds of X or Z beside C."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby

from g12.tools.path.part import C, X, Z
from g12.tools.path.track import Limits, Track
from g12.tools.preview.moves import Move
from g12.tools.verify.mistakes.cut import ProgramCut
from g12.tools.verify.result.finding import Finding

MOST_PER_TURN = 3.0  # mm per revolution: above it the number was meant per minute
LEAST_PER_MINUTE = 1.0  # mm/min: below it the number was meant per revolution
CUT_DOWN = 0.98  # of the feed
TURNS = 1e-6  # degrees or mm


def judge_feeds(
    cuts: Sequence[ProgramCut], moves: Sequence[Move], limits: Limits
) -> Iterator[Finding]:
    """Yield what to know of the feeds of cuts."""
    for cut in cuts:
        fed = [index for index in cut.fed(moves) if moves[index].feed]
        yield from unlikely(cut, [moves[index] for index in fed])
        if not cut.turning:
            yield from cut_down(cut, [moves[index] for index in fed], limits)


def unlikely(cut: ProgramCut, fed: Sequence[Move]) -> Iterator[Finding]:
    """Yield a feed whose number belongs to the other feed mode."""
    for move in fed:
        per_turn = move.feed_mode == "G95"
        if per_turn and move.feed > MOST_PER_TURN:
            yield Finding("feed-per-revolution", cut.line, {"feed": move.feed}, file=cut.file)
            return
        if not per_turn and not cut.turning and move.feed < LEAST_PER_MINUTE:
            yield Finding("feed-per-minute", cut.line, {"feed": move.feed}, file=cut.file)
            return


def cut_down(cut: ProgramCut, fed: Sequence[Move], limits: Limits) -> Iterator[Finding]:
    """Yield that the machine's speeds do not allow a feed per minute."""
    asked = max((move.feed for move in fed if move.feed_mode == "G94"), default=0.0)
    most = 60.0 * min(limits.path, *limits.axes[X : Z + 1])
    if most < CUT_DOWN * asked:
        yield Finding("feed-cut-down", cut.line, {"feed": asked, "most": most}, file=cut.file)


def judge_native_c(moves: Sequence[Move], known: set[int], path: Track) -> Iterator[Finding]:
    """Yield feed moves of X or Z together with C outside of cuts; ``known`` are the cuts' moves."""
    found = [
        index
        for index, move in enumerate(moves)
        if index not in known and move.kind == "feed" and turns_and_goes(move)
    ]
    for _, group in groupby(enumerate(found), lambda pair: pair[1] - pair[0]):
        indices = [index for _, index in group]
        speeds = [path.part_feed(index) for index in indices]
        values = {"least": min(speeds), "most": max(speeds)}
        yield Finding("native-c", moves[indices[0]].block, values, moves[indices[0]].end[:3])


def turns_and_goes(move: Move) -> bool:
    """Tell whether C turns together with X or Z."""
    change = [abs(end - start) > TURNS for start, end in zip(move.start, move.end)]
    return change[C] and (change[X] or change[Z]) and move.feed_mode != "G93"
