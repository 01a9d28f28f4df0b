# SPDX-License-Identifier: GPL-2.0-or-later
"""Judge one program: the rules, the four questions to its material, its deviations."""

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from g12.tools.machine.filter import OpenedProgram
from g12.tools.machine.ini import Ini
from g12.tools.machine.stored_positions import stored_values
from g12.tools.material.stock import StockText, read_stock
from g12.tools.path.follow import Samples
from g12.tools.preview.ended import ended, explained
from g12.tools.preview.moves import Trace
from g12.tools.preview.tracer import Parameters, Tools, Tracer
from g12.tools.progress import Report, silent
from g12.tools.units import unit_of
from g12.tools.verify.in_part import judge_in_part, judge_rapids
from g12.tools.verify.model.cut import Cut
from g12.tools.verify.model.deviation import Deviation, deviation_of, judge_deviations
from g12.tools.verify.model.finding import (
    KINDS,
    WARNING,
    Finding,
    kind,
    once_a_line,
)
from g12.tools.verify.model.program import TracedProgram
from g12.tools.verify.model.solid import Solids
from g12.tools.verify.remains import judge_cuts
from g12.tools.verify.rules import contour, spindle, tool, whole  # noqa: F401  # the table
from g12.tools.verify.rules.table import judge_rules

CAUSES = {  # a finding of one code is the cause of those of others at the same cut
    "length": {"rapid", "uncut", "air", "bar-remains"},
    "length-higher": {"uncut", "air", "cut-before", "bar-remains"},
    "cutter": {"uncut", "wall", "core"},
    "d-stale": {"wall", "uncut", "cutter"},
    "air": {"uncut", "bar-remains"},
    "no-stock-met": {"uncut", "bar-remains"},
    "surface": {"rapid"},
    "side": {"overcut", "bar-remains"},
    "place-unknown": {"deep-pass"},
    "no-tool": {"no-diameter"},
    "offset-beside": {"off"},
}
EXPECT = re.compile(r"\(\s*g12:\s*expect\s+([^()]*)\)", re.IGNORECASE)
UNMET = kind("expect", WARNING, "{code} is accepted here, and nothing of it is found{hint}")
EVERYWHERE = 0  # as a line
Accepted = tuple[str, int]
NEVER = ": only a warning can be accepted"


@dataclass(frozen=True)
class Judgement:
    """What was found of a program, and what was ``accepted``; ``opened`` is the user's file."""

    program: TracedProgram
    solids: Solids
    found: Sequence[Finding]
    accepted: Sequence[Finding]
    deviations: Sequence[Deviation]  # of each cut
    tolerance: float | None = None
    opened: OpenedProgram | None = None

    def of(self, severity: str) -> list[Finding]:
        return [each for each in self.found if each.severity == severity]

    def user_line(self, line: int, file: str = "") -> int:
        """Return a line in the user's file; one in a sub's own ``file`` stays."""
        return self.opened.source_line(line) if self.opened and not file else line


def judge(
    program: Path,
    ini: Ini,
    *,
    tools: Tools = None,
    parameters: Path | None = None,
    samples: Samples | None = None,
    **options,
) -> Judgement:
    """Trace and judge a program; see ``judge_trace``."""
    trace = ended(program, traced(program, ini, tools, parameters))
    stored = stored_values(parameters)
    return judge_trace(TracedProgram(program, ini, trace, samples, stored), **options)


def traced(program: Path, ini: Ini, tools: Tools = None, parameters: Parameters = None) -> Trace:
    with Tracer(ini, tools=tools, reports=True) as tracer:
        found = tracer.trace(program, parameters=parameters)
        return explained(found, ini.path, program)


def judge_trace(
    program: TracedProgram,
    *,
    stock: StockText | None = None,
    tolerance: float | None = None,
    accept: Sequence[str] = (),
    opened: OpenedProgram | None = None,
    tell: Report = silent,
) -> Judgement:
    """Return the judgement of a traced program; ``tolerance`` in mm replaces the usual ones.

    ``accept`` are codes of warnings, ``opened`` is the user's file where a filter changed it.
    """
    unit = unit_of(program.trace.modes.gcodes, stock.units if stock else None)
    given = read_stock(stock.text, program.turning or program.is_round, unit) if stock else None
    tell("looking for material")
    solids = Solids(program, given)
    deviations = [deviation_of(cut, program) for cut in program.cuts]
    found = [*judge_rules(program, solids)]
    tell("looking for rapids through material")
    found += judge_rapids(program, solids)
    tell("looking for what remains")
    found += judge_cuts(program, solids)
    found += judge_in_part(program, solids)
    found += judge_deviations(deviations, program, tolerance)
    expected = [*expectations(program.file), *((code, EVERYWHERE) for code in accept)]
    kept, taken = accepted(once_a_cause(found, program), program.cuts, expected)
    both = once_a_line(kept), once_a_line(taken)
    return Judgement(program, solids, *both, deviations, tolerance, opened)


def once_a_cause(found: Sequence[Finding], program: TracedProgram) -> Iterator[Finding]:
    """Yield what is found, but for what another finding of the same cut causes."""
    effects: dict[int, set[str]] = {}
    for each in found:
        effects.setdefault(_cut_of(each, program), set()).update(CAUSES.get(each.code, ()))
    yield from (each for each in found if each.code not in effects[_cut_of(each, program)])


def _cut_of(found: Finding, program: TracedProgram) -> int:
    """Return the index of the cut that a finding is of, or of a rapid the following one's."""
    for cut in program.cuts:
        if cut.file == found.file and cut.line <= found.line <= cut.last_line:
            return cut.index
    after = (cut.index for cut in program.cuts if cut.line > found.line)
    return next(after, -1) if found.code == "rapid" else -1 - found.line


# ------------------------------------------------------------ what is accepted


def acceptable() -> set[str]:
    return {each.code for each in KINDS.values() if each.severity == WARNING and each is not UNMET}


def expectations(program: Path) -> list[Accepted]:
    """Return the codes that the comments of a program accept, with their lines."""
    lines = program.read_text(encoding="utf-8", errors="replace").splitlines()
    return [
        (code.lower(), number)
        for number, line in enumerate(lines, 1)
        for comment in EXPECT.finditer(line)
        for code in re.split(r"[\s,]+", comment[1].strip())
        if code
    ]


def accepted(
    found: Iterable[Finding], cuts: Sequence[Cut], expected: Sequence[Accepted]
) -> tuple[list[Finding], list[Finding]]:
    """Return what remains, with a warning for each unmet acceptance, and what is accepted."""
    pairs = [(each, [one for one in expected if _meets(each, one, cuts)]) for each in found]
    met = {one for _, ones in pairs for one in ones}
    rest = [each for each, ones in pairs if not ones]
    for code, line in [one for one in expected if one not in met]:
        hint = "" if code in acceptable() else NEVER
        rest.append(Finding(UNMET, line, {"code": code, "hint": hint}))
    return rest, [each for each, ones in pairs if ones]


def _meets(found: Finding, accepts: Accepted, cuts: Sequence[Cut]) -> bool:
    code, line = accepts
    if (found.code, found.severity) != (code, WARNING):
        return False
    own = [cut for cut in cuts if cut.line == line and not found.file]
    inside = any(cut.line <= found.line <= cut.last_line for cut in own)
    return inside or line in (EVERYWHERE, found.line)
