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
        fed = [moves[index] for index in cut.fed(moves) if moves[index].feed]
        per_turn = [] if cut.turning else [m.feed for m in fed if m.feed_mode == "G95"]
        asked = cut.feeds if cut.turning else [m.feed for m in fed if m.feed_mode != "G95"]
        most = 60.0 * min(limits.path, *limits.axes[X : Z + 1])
        if max(per_turn, default=0.0) > MOST_PER_TURN:
            values = {"feed": max(per_turn)}
            yield Finding("feed-per-revolution", cut.line, values, file=cut.file)
        if min(asked, default=LEAST_PER_MINUTE) < LEAST_PER_MINUTE:
            yield Finding("feed-per-minute", cut.line, {"feed": min(asked)}, file=cut.file)
        if most < CUT_DOWN * max(asked, default=0.0):
            values = {"feed": max(asked), "most": most}
            yield Finding("feed-cut-down", cut.line, values, file=cut.file)


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
