# SPDX-License-Identifier: GPL-2.0-or-later
"""The report of ``g12 regress``: a line per finding, like a compiler's, or JSON."""

import json
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import asdict

from g12.tools.regress.differences import Difference
from g12.tools.regress.recorder import ADDED, CHANGED, FAILED, MISSING, NEW, SAME, Result
from g12.tools.units import counted_as

VERDICTS = {verdict: verdict for verdict in (NEW, SAME, CHANGED, ADDED, MISSING, FAILED)}
VERDICTS[SAME] = "as recorded"
REASONS = {ADDED: "it is not recorded", MISSING: "it was recorded"}
MOST_FINDINGS = 20  # of a program, in text; JSON has every one
MOST_NAMED_LINES = 4


def text_report(results: Sequence[Result], notes: Sequence[str]) -> Iterator[str]:
    for note in notes:
        yield f"note: {note}"
    for result in results:
        yield from lines_of_result(result)
    counts = Counter(result.verdict for result in results)
    listed = [f"{counts[verdict]} {text}" for verdict, text in VERDICTS.items() if counts[verdict]]
    yield f"{counted_as(len(results), 'program')}: {', '.join(listed)}"


def lines_of_result(result: Result) -> Iterator[str]:
    reason = result.summary if result.verdict == NEW else REASONS.get(result.verdict)
    if reason:
        yield f"{result.program}: {result.verdict}, {reason}"
    for finding in result.findings[:MOST_FINDINGS]:
        yield from _finding(result.program, finding)
    if len(result.findings) > MOST_FINDINGS:
        yield f"{result.program}: and {len(result.findings) - MOST_FINDINGS} more findings"
    if result.picture:
        yield f"{result.program}: see {result.picture}"


def _finding(program: str, finding: Difference) -> Iterator[str]:
    counts = finding.kind in ("moved", "changed") and finding.moves
    moves = f"{counted_as(finding.moves, 'move')}: " if counts else ""
    yield f"{program}{_where(finding)} {moves}{finding.text}"
    if finding.block:
        yield f"    {finding.block}"


def _where(finding: Difference) -> str:
    """Return the lines: ``:14:``, with others of the same finding, or those recorded."""
    if not finding.lines and not finding.recorded_lines:
        return ":"
    first, *others = finding.lines or finding.recorded_lines
    shown = [*map(str, others[:MOST_NAMED_LINES]), *("…" for _ in others[MOST_NAMED_LINES:][:1])]
    also = f" (also {', '.join(shown)})" if others else ""
    return f":{first}{'' if finding.lines else ' as recorded'}:{also}"


def json_report(results: Sequence[Result], notes: Sequence[str], good: bool) -> str:
    programs = [asdict(result) for result in results]
    for program in programs:
        del program["notes"]
        for finding in program["findings"]:
            del finding["was"], finding["now"]
    return json.dumps({"good": good, "notes": list(notes), "programs": programs}, indent=2)
