# SPDX-License-Identifier: GPL-2.0-or-later
"""The tool, D, the tool length and the feed where the program cuts.

LinuxCNC believes G43's H as the cycles believe D. A program that never commands G43 may have
touched off Z with its tool; any other works with the lengths of the table.
"""

import re
from collections.abc import Iterator

import numpy as np

from g12.cut_report import BY_D, BY_LAST_D, LOADED, NO_CUTTER, FrameCut, PocketCut, ThreadCut
from g12.tools.path.part import X, Z
from g12.tools.verify.model.cut import WEAR
from g12.tools.verify.model.finding import FINDING, WARNING
from g12.tools.verify.model.program import SIZE, TracedProgram
from g12.tools.verify.rules.table import FIRST, Site, Values, rule

SIDE = re.compile(r"G4[12](?![.\d]).*D(\d+)(?![.\d])|D(\d+)(?![.\d]).*G4[12](?![.\d])")
MOST_PER_TURN = 3.0  # mm, of a feed


@rule("no-tool", FINDING, "no tool is loaded: T and M6 are missing", once=True, plain=FIRST)
def no_tool(site: Site) -> Values:
    return {} if site.tool <= 0 else None


@rule("no-diameter", FINDING, "T{tool} has no diameter in the tool table")
def no_diameter(site: Site) -> Values:
    cut = site.own
    needs = not cut.is_section or any(each.side for each in cut.elements)
    return {"tool": site.tool} if site.tool > 0 and not site.loaded and needs else None


@rule("cutter", FINDING, "T{tool} is ⌀ {loaded:mm}, the path is that of ⌀ {used:mm} (D{d})")
def wrong_cutter(site: Site) -> Values:
    cut, loaded = site.own, site.loaded
    used, d = 2 * cut.cutter, cut.used.number
    by_d = cut.is_circle or isinstance(cut.plan, FrameCut)
    if not by_d or not used or not loaded or abs(used - loaded) <= WEAR * loaded or d == site.tool:
        return None
    return {"tool": site.tool, "loaded": loaded, "used": used, "d": d}


@rule("d-other", WARNING, "D{d} is ⌀ {used:mm}, T{tool} ⌀ {loaded:mm}: an allowance?", program=True)
def other_d(program: TracedProgram) -> Iterator[Values]:
    """Look for G41 and G42 outside of sections whose D is not the loaded tool's diameter."""
    sections = [range(cut.line, cut.last_line + 1) for cut in program.cuts if cut.is_section]
    blocks = np.array([move.block for move in program.moves])
    for number, text in enumerate(program.texts, 1):
        side = SIDE.search(text)
        if not side or any(number in lines for lines in sections) or not (blocks >= number).any():
            continue
        after = int((blocks >= number).argmax())
        table, d = program.trace.table_at(after).diameters, int(side[1] or side[2])
        tool = program.moves[after].tool
        used, loaded = table.get(d, 0.0), table.get(tool, 0.0)
        if d != tool and used and loaded and abs(used - loaded) > WEAR * loaded:
            values = {"d": d, "tool": tool, "used": used, "loaded": loaded}
            yield {**values, "at_line": number}


@rule(
    "d-stale", FINDING, "D{d} is ⌀ {used:mm} as commanded, in the table now {now:mm}: write D again"
)
def stale_d(site: Site) -> Values:
    cut, used = site.own, 2 * site.own.cutter
    now = site.program.trace.table_at(cut.at).diameters.get(cut.used.number, 0.0)
    stale = cut.used.source in (BY_D, BY_LAST_D) and now and abs(now - used) > SIZE
    return {"d": cut.used.number, "used": used, "now": now} if stale else None


@rule("d-unset", WARNING, "the program has no D: that of the program before may be cut", once=True)
def unset_d(site: Site) -> Values:
    cut = site.own
    by_d = isinstance(cut.plan, (PocketCut, ThreadCut, FrameCut))
    return {} if by_d and cut.used.source == LOADED else None


@rule("no-d", WARNING, "no D: the tool's centre runs on the circles (D0 if that is meant)")
def no_d(site: Site) -> Values:
    cut = site.own
    known = cut.used.source != NO_CUTTER or "D" in cut.report.words
    return None if known or not cut.is_circle else {}


@rule(
    "length",
    FINDING,
    "it cuts {off:fine} deeper: the length in force is not T{tool}'s (G43 H{tool}?)",
    plain=FIRST,
)
def length_deeper(site: Site) -> Values:
    off = _off_length(site)
    chosen = site.program.chosen_length(site.at)
    return {"tool": site.tool, "off": off} if off > SIZE and not chosen else None


@rule(
    "length-higher",
    WARNING,
    "it cuts {off:fine} {how}: the length in force is not T{tool}'s",
    plain=FIRST,
)
def length_higher(site: Site) -> Values:
    off, chosen = _off_length(site), site.program.chosen_length(site.at)
    if site.tool <= 0 or abs(off) <= SIZE or (off > 0 and not chosen):
        return None
    return {"tool": site.tool, "off": abs(off), "how": "higher" if off < 0 else "deeper"}


def _off_length(site: Site, axis: int = Z) -> float:
    """Return by how much the tool is longer than the length in force, 0 without any length."""
    return site.program.missing_length(site.at, axis) if site.program.uses_lengths else 0.0


@rule(
    "length-not-used",
    WARNING,
    "T{tool}'s length of {off:fine} is not used (G43): was Z touched off with it?",
    once=True,
    plain=FIRST,
)
def length_not_used(site: Site) -> Values:
    off = site.program.missing_length(site.at)
    missing = not site.program.uses_lengths and abs(off) > SIZE
    return {"tool": site.tool, "off": off} if missing else None


@rule(
    "length-mixed",
    FINDING,
    "T{tool} is {off:fine} {how} than T{first}, without G43: one Z0 cannot fit both",
    plain=FIRST,
)
def length_mixed(site: Site) -> Values:
    program, moves = site.program, site.program.moves
    if program.uses_lengths or site.tool <= 0:
        return None
    first = next(i for i, move in enumerate(moves) if move.kind != "rapid" and move.tool > 0)
    off = program.missing_length(site.at) - program.missing_length(first)
    if abs(off) <= SIZE or program.zero_at(first)[Z] != program.zero_at(site.at)[Z]:
        return None
    how = "longer" if off > 0 else "shorter"
    return {"tool": site.tool, "off": abs(off), "how": how, "first": moves[first].tool}


@rule("offset-beside", FINDING, "it cuts {off:fine} beside: the offset in X is not T{tool}'s")
def offset_beside(site: Site) -> Values:
    off, chosen = _off_length(site, X), site.program.chosen_length(site.at)
    beside = site.program.turning and abs(off) > SIZE and not chosen
    return {"tool": site.tool, "off": abs(off)} if beside else None


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
        speed = site.program.speed(cut.at)
        feeds += [each.feed * cut.mm / speed for each in cut.elements if speed]
    elif hasattr(cut.plan, "passes") and per_turn:
        feeds.append(cut.plan.passes.feed * cut.mm)
    return feeds
