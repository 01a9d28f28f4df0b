# SPDX-License-Identifier: GPL-2.0-or-later
"""Feeds that were most likely meant otherwise."""

from g12.cut_report import HolesCut
from g12.tools.path.part import C, X, Z
from g12.tools.verify.model.finding import WARNING
from g12.tools.verify.model.program import TracedProgram
from g12.tools.verify.rules.table import Site, Values, rule

MOST_PER_TURN, LEAST_PER_MINUTE = 3.0, 1.0  # mm
CUT_DOWN = 0.98  # of the feed
TURNS = 1e-6  # degrees or mm


@rule("feed-per-turn", WARNING, "a feed or pitch of {feed:fine} a revolution: meant per minute?")
def feed_per_turn(site: Site) -> Values:
    most = max(_per_turn(site), default=0.0)
    return {"feed": most} if most > MOST_PER_TURN else None


def _per_turn(site: Site) -> list[float]:
    """Return the feeds per revolution of a cut in mm, as moved or as planned."""
    cut, report = site.own, site.own.reported.report
    moved = [m.feed for m in site.program.moves[cut.at : cut.end] if m.feed_mode == "G95"]
    if isinstance(cut.plan, HolesCut) and (cut.is_tap or report.per_revolution):
        return [*moved, cut.plan.feed * cut.mm]
    if not report.per_revolution or cut.is_circle:
        return moved
    if cut.is_section:
        speed = site.program.state(cut.at).speed
        return [*moved, *(each.feed * cut.mm / speed for each in cut.elements if speed)]
    return [*moved, cut.plan.passes.feed * cut.mm]


@rule("feed-per-minute", WARNING, "F is {feed:feed}: meant per revolution?", plain=True)
def feed_per_minute(site: Site) -> Values:
    least = min(_planned_feeds(site), default=LEAST_PER_MINUTE)
    return {"feed": least} if least < LEAST_PER_MINUTE else None


@rule(
    "feed-cut-down",
    WARNING,
    "a feed of {feed:feed}, the machine's limits allow {most:feed}",
    plain=True,
)
def feed_cut_down(site: Site) -> Values:
    feeds = _planned_feeds(site)
    most = 60.0 * min([site.program.limits.path, *_speeds(site)])
    return {"feed": max(feeds), "most": most} if most < CUT_DOWN * max(feeds, default=0.0) else None


def _speeds(site: Site) -> list[float]:
    """Return the speeds of the axes that move, mm/s."""
    axes, moves = site.program.limits.axes, [site.program.moves[index] for index in site.moves]
    moved = (n for n in range(X, Z + 1) if site.cut or any(m.start[n] != m.end[n] for m in moves))
    return [axes[axis] for axis in moved]


def _planned_feeds(site: Site) -> list[float]:
    """Return the feeds of a cut, mm/min: of a section those of its contour."""
    if site.cut and site.cut.is_section:
        return [each.feed * site.cut.mm for each in site.cut.elements if each.feed]
    moves = (site.program.moves[index] for index in site.moves)
    feeds = [m.feed for m in moves if m.kind != "rapid" and m.feed and m.feed_mode != "G95"]
    if site.cut and site.cut.is_tap:
        feeds.append(site.cut.plan.feed * site.cut.mm * site.program.state(site.at).speed)
    return feeds


@rule(
    "native-c",
    WARNING,
    "C turns together with X or Z outside of a section, where F counts for X and Z alone: the "
    "part's edge sees {feed:feed}",
    program=True,
)
def native_c(program: TracedProgram) -> Values:
    for index, move in enumerate(program.moves if program.turning else ()):
        change = [abs(end - start) > TURNS for start, end in zip(move.start, move.end)]
        both = move.kind == "feed" and change[C] and (change[X] or change[Z])
        if both and move.feed_mode != "G93" and not program.cut_at(index):
            feed = program.path.part_feed(index)
            return {"feed": feed, "at_line": program.where(index)[0]}
    return None
