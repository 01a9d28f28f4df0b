# SPDX-License-Identifier: GPL-2.0-or-later
"""The tool, D and the tool length where the program cuts.

LinuxCNC believes G43's H as the cycles believe D. A program that never commands G43 may have
touched off Z with its tool; any other works with the lengths of the table.
"""

from g12.cut_report import BY_D, BY_LAST_D, LOADED, NO_CUTTER, FrameCut, PocketCut, ThreadCut
from g12.tools.path.part import X, Z
from g12.tools.verify.model.finding import FINDING, NOT_JUDGED, WARNING
from g12.tools.verify.model.program import SIZE, WEAR, TracedProgram
from g12.tools.verify.rules.table import Site, Values, rule


@rule("no-tool", FINDING, "no tool is loaded: T and M6 are missing", once=True, plain=True)
def no_tool(site: Site) -> Values:
    return {} if site.tool <= 0 else None


@rule(
    "no-diameter",
    FINDING,
    "T{tool} has no diameter in the tool table: the wall or contour is unknown",
)
def no_diameter(site: Site) -> Values:
    cut = site.own
    needs = not cut.is_section or cut.compensated
    return {"tool": site.tool} if site.tool > 0 and not site.loaded and needs else None


@rule(
    "cutter",
    FINDING,
    "T{tool} (⌀ {loaded:mm}) is loaded, the path is that of a cutter of ⌀ {used:mm} (D{d})",
)
def wrong_cutter(site: Site) -> Values:
    values = _other_diameter(site)
    return values if values and values["off"] > WEAR * values["loaded"] else None


@rule("worn", WARNING, "D{d} (⌀ {used:mm}) is not quite the loaded T{tool} (⌀ {loaded:mm})")
def worn_cutter(site: Site) -> Values:
    values = _other_diameter(site)
    return values if values and values["off"] <= WEAR * values["loaded"] else None


def _other_diameter(site: Site) -> dict | None:
    used, loaded = 2 * site.own.cutter, site.loaded
    d = site.own.used.number
    if (
        not (site.own.is_circle or isinstance(site.own.plan, FrameCut))
        or not used
        or not loaded
        or abs(used - loaded) <= SIZE
        or d == site.tool
    ):
        return None
    return {"tool": site.tool, "loaded": loaded, "used": used, "d": d, "off": abs(used - loaded)}


@rule(
    "d-stale",
    FINDING,
    "D{d} still has the diameter {used:mm} as commanded, the table now {now:mm}: write D again",
)
def stale_d(site: Site) -> Values:
    cut = site.own
    if cut.used.source not in (BY_D, BY_LAST_D):
        return None
    table = site.program.trace.table_at(cut.at).diameters
    used, now = 2 * cut.cutter, table.get(cut.used.number, 0.0)
    return (
        {"d": cut.used.number, "used": used, "now": now} if now and abs(now - used) > SIZE else None
    )


@rule(
    "d-unset",
    WARNING,
    "the program has no D: at the machine the radius of the D of the program before may be cut",
    once=True,
)
def unset_d(site: Site) -> Values:
    cut = site.own
    by_d = isinstance(cut.plan, (PocketCut, ThreadCut, FrameCut))
    return {} if by_d and cut.used.source == LOADED else None


@rule(
    "no-d",
    WARNING,
    "no D: the tool's centre runs on the programmed circles (D0 where that is meant)",
)
def no_d(site: Site) -> Values:
    cut = site.own
    known = cut.used.source != NO_CUTTER or "D" in cut.reported.report.words
    return None if known or not cut.is_circle else {}


@rule(
    "length",
    FINDING,
    "the tool length in force, {offset:mm}, is not that of T{tool}: "
    "it cuts {off:fine} deeper than its words say (G43 H{tool} after M6?)",
    plain=True,
)
def length_deeper(site: Site) -> Values:
    off = site.program.missing_length(site.at)
    if not site.program.uses_lengths or off <= SIZE or _is_chosen(site):
        return None
    return {"offset": site.program.moves[site.at].tool_offset[Z], "tool": site.tool, "off": off}


@rule(
    "length-higher",
    WARNING,
    "the tool length in force is not that of T{tool} in the table: it cuts {off:fine} {how}",
    plain=True,
)
def length_higher(site: Site) -> Values:
    off = site.program.missing_length(site.at)
    if site.tool <= 0 or not site.program.uses_lengths or abs(off) <= SIZE:
        return None
    if off > 0 and not _is_chosen(site):
        return None
    return {"tool": site.tool, "off": abs(off), "how": "higher" if off < 0 else "deeper"}


@rule(
    "length-not-used",
    WARNING,
    "no tool length is in force: that of T{tool} in the table, {off:fine}, is not used (G43); "
    "right only where Z was touched off with this tool",
    once=True,
    plain=True,
)
def length_not_used(site: Site) -> Values:
    off = site.program.missing_length(site.at)
    if site.program.uses_lengths or abs(off) <= SIZE:
        return None
    return {"tool": site.tool, "off": off}


@rule(
    "length-mixed",
    FINDING,
    "T{tool} is {off:fine} {how} than T{first} in the table, and no tool length is in force: one "
    "Z0 cannot fit both (G43)",
    plain=True,
)
def length_mixed(site: Site) -> Values:
    program, moves = site.program, site.program.moves
    if program.turning or program.uses_lengths or site.tool <= 0:
        return None
    first = next(i for i, move in enumerate(moves) if move.kind != "rapid" and move.tool > 0)
    cuts = program.cut_near(first), program.cut_near(site.at)
    off = program.missing_length(site.at) - program.missing_length(first)
    if abs(off) <= SIZE or (cuts[0] and cuts[1] and cuts[0].zero[Z] != cuts[1].zero[Z]):
        return None
    how = "longer" if off > 0 else "shorter"
    return {"tool": site.tool, "off": abs(off), "how": how, "first": moves[first].tool}


@rule(
    "offset-beside",
    FINDING,
    "the tool offset in X is not that of T{tool}: it cuts {off:fine} beside its words",
)
def offset_beside(site: Site) -> Values:
    program = site.program
    off = program.missing_length(site.at, X)
    if not program.turning or not program.uses_lengths or abs(off) <= SIZE:
        return None
    return None if _is_chosen(site) else {"tool": site.tool, "off": abs(off)}


def _is_chosen(site: Site) -> bool:
    return site.program.chosen_length(site.at)


@rule(
    "tool-table-set",
    NOT_JUDGED,
    "cuts with the sizes of this G10 L1, L10 or L11: with a random tool changer a preview keeps "
    "those of the loaded tool",
    program=True,
)
def table_set(program: TracedProgram) -> Values:
    sets = (n for n, text in enumerate(program.texts, 1) if "G10" in text and "L1" in text)
    line = next(sets, 0) if program.ini.swaps_pockets else 0
    return {"at_line": line} if line else None
