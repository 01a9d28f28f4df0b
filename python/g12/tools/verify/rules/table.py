# SPDX-License-Identifier: GPL-2.0-or-later
"""The table of rules: a rule is a function with a decorator, which has its code and its sentence.

A rule returns the values of its sentence, None where nothing is wrong; ``{}`` is "it applies". The
value ``at_line`` is the line in place of the cut's, ``place`` a point of the part. A rule of the
whole program may yield such values.
"""

from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from g12.tools.verify.model.cut import Cut
from g12.tools.verify.model.finding import Finding, Kind, kind
from g12.tools.verify.model.program import TracedProgram
from g12.tools.verify.model.solid import FACE, Solids

Values = Mapping[str, Any] | None
FIRST, EACH = "first", "each"  # which moves that belong to no cut: of a tool the first, or all


class Site(NamedTuple):
    """A cut in its program, or moves at feed that no code of the package makes (``cut`` None)."""

    program: TracedProgram
    solids: Solids
    moves: range
    cut: Cut | None = None
    radius: float = 0.0  # of a mill's plain moves, where what is solid is known

    @property
    def at(self) -> int:
        return self.moves.start

    @property
    def tool(self) -> int:
        return self.program.moves[self.at].tool

    @property
    def loaded(self) -> float:
        """The loaded tool's diameter, 0 if the table has none."""
        return self.program.trace.table_at(self.at).diameters.get(self.tool, 0.0)

    @property
    def lowest(self) -> tuple[int, np.ndarray]:
        """The move that goes deepest on the face, and the tip where it ends."""
        tips = {index: self.program.tip(index, FACE) for index in self.moves}
        index = min(tips, key=lambda index: tips[index][:, 2].min())
        return index, tips[index][-1]

    @property
    def own(self) -> Cut:
        """The cut, in a rule of cuts alone."""
        assert self.cut is not None
        return self.cut


class Rule(NamedTuple):
    kind: Kind
    judge: Callable[[Any], Any]
    once: bool
    plain: str


CUT_RULES: list[Rule] = []
PROGRAM_RULES: list[Rule] = []


def rule(
    code: str,
    severity: str,
    sentence: str,
    *,
    once: bool = False,
    plain: str = "",
    program: bool = False,
) -> Callable[[Callable[[Any], Any]], Callable[[Any], Any]]:
    """Add a rule to the table: of each cut, or of the whole ``program``.

    ``once``: only the first cut is reported. ``plain``: also of moves that belong to no cut, the
    FIRST of each tool or EACH.
    """

    def add(judge: Callable[[Any], Any]) -> Callable[[Any], Any]:
        rules = PROGRAM_RULES if program else CUT_RULES
        rules.append(Rule(kind(code, severity, sentence), judge, once, plain))
        return judge

    return add


def judge_rules(program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    reported: set[tuple[str, int]] = set()
    for site in sites(program, solids):
        for each in CUT_RULES if site.cut else filter(lambda rule: rule.plain, CUT_RULES):
            key = each.kind.code, 0 if each.once else site.tool
            if key in reported and (each.once or (not site.cut and each.plain == FIRST)):
                continue
            values = each.judge(site)
            if values is not None:
                reported.add(key)
                line, file = program.where(site.at)
                line = site.cut.line if site.cut else line
                side = site.cut.surface if site.cut else FACE
                values = {"place": program.tip(site.at, side)[-1], **values}
                yield found(each.kind, values, line, file)
    for each in PROGRAM_RULES:
        values = each.judge(program)
        own = [values] if isinstance(values, Mapping) else values or ()
        yield from (found(each.kind, one, 0, "") for one in own)


def found(of: Kind, values: Mapping[str, Any], line: int, file: str) -> Finding:
    own = {name: value for name, value in values.items() if name not in ("at_line", "place")}
    return Finding(of, values.get("at_line", line), own, values.get("place"), file)


def sites(program: TracedProgram, solids: Solids) -> Iterator[Site]:
    """Yield the cuts, and the other stretches at feed below the top, in order."""
    every = [Site(program, solids, cut.moves, cut) for cut in program.cuts if cut.at < cut.end]
    for stretch in program.stretches:
        if not stretch.is_rapid and not stretch.cut:
            solid = not program.turning and stretch.is_known and stretch.sides == {FACE}
            if program.tips(stretch.moves)[:, 2].min() < solids.top(FACE):
                every.append(Site(program, solids, stretch.moves, None, solid * stretch.radius))
    yield from sorted(every, key=lambda site: site.at)
