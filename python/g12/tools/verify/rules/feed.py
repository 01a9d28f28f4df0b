# SPDX-License-Identifier: GPL-2.0-or-later
"""Feeds that were most likely meant otherwise."""

from g12.tools.path.part import X, Z
from g12.tools.verify.model.finding import WARNING
from g12.tools.verify.rules.table import Site, Values, rule

MOST_PER_TURN, LEAST_PER_MINUTE = 3.0, 1.0  # mm
CUT_DOWN = 0.98  # of the feed


@rule("feed-per-turn", WARNING, "{feed:fine} a revolution: meant per minute?")
def feed_per_turn(site: Site) -> Values:
    most = max(_per_turn(site), default=0.0)
    return {"feed": most} if most > MOST_PER_TURN else None


def _per_turn(site: Site) -> list[float]:
    """Return the feeds per revolution of a cut in mm, as moved or as planned."""
    cut, per_turn = site.own, site.own.report.per_revolution
    feeds = [m.feed for m in site.program.moves[cut.at : cut.end] if m.feed_mode == "G95"]
    if cut.is_tap or (cut.places and per_turn):
        feeds.append(cut.plan.feed * cut.mm)
    elif cut.is_section and per_turn:
        speed = site.program.state(cut.at).speed
        feeds += [each.feed * cut.mm / speed for each in cut.elements if speed]
    elif hasattr(cut.plan, "passes") and per_turn:
        feeds.append(cut.plan.passes.feed * cut.mm)
    return feeds


@rule("feed-per-minute", WARNING, "F is {feed:feed}: meant per revolution?", plain=True)
def feed_per_minute(site: Site) -> Values:
    least = min(_planned_feeds(site), default=LEAST_PER_MINUTE)
    return {"feed": least} if least < LEAST_PER_MINUTE else None


@rule("feed-cut-down", WARNING, "{feed:feed}, the machine's limits allow {most:feed}", plain=True)
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
