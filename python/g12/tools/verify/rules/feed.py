# SPDX-License-Identifier: GPL-2.0-or-later
"""Feeds that were most likely meant otherwise."""

from g12.tools.verify.model.finding import WARNING
from g12.tools.verify.rules.table import Site, Values, rule

MOST_PER_TURN = 3.0  # mm


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
