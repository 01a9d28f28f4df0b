# SPDX-License-Identifier: GPL-2.0-or-later
"""Feed moves of a mill that no code of the package makes: stock, taps, D of G41 and G42."""

import re
from collections.abc import Iterator

from shapely.geometry import Point

from g12.tools.verify.model.finding import KINDS, WARNING, Finding, kind
from g12.tools.verify.model.program import WEAR, TracedProgram
from g12.tools.verify.model.solid import FACE, JUST_ABOVE, Solids
from g12.tools.verify.remains import BELOW, THROUGH
from g12.tools.verify.rules.contour import MIDDLE

POINT = 0.6  # of a drill's radius: how far its point goes below a hole
BESIDE = kind("beside-stock", WARNING, "it cuts beside the stock alone")
OTHER_D = kind("d-other", WARNING, "D{d} is ⌀ {used:mm}, T{tool} ⌀ {loaded:mm}: an allowance?")
SIDE = re.compile(r"G4[12](?![.\d]).*D(\d+)(?![.\d])|D(\d+)(?![.\d]).*G4[12](?![.\d])")


def judge_plain(program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    if program.turning:
        return
    yield from _other_d(program)
    for rapid, run in program.runs():
        known = program.sides[run[0]] == {FACE} and program.is_known(run[-1])
        if not rapid and not program.cut_at(run[0]) and known and program.cutter(run[0]) > 0:
            yield from _against_stock(run, program, solids)
            if program.moves[run[0]].block in program.tapping:
                yield from _undrilled(run, program, solids)


def _against_stock(run: range, program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Yield what goes through the stock's bottom, or meets nothing of a stock."""
    tips, radius = program.tips(list(run)), program.cutter(run[0])
    lowest = min(run, key=lambda index: program.tip(index, FACE)[:, 2].min())
    low = tips[:, 2].min()
    if solids.bottom - low > THROUGH + POINT * radius:
        place = program.tip(lowest, FACE)[-1]
        yield program.found(BELOW, lowest, place, below=solids.bottom - low)
    approach = program.cut_at(min(run[-1] + 1, len(program.moves) - 1))
    whole = solids.stock and solids.stock.is_whole and low < solids.top(FACE) - JUST_ABOVE
    if whole and not approach and not solids.of(FACE).is_under(tips[:, :2], radius):
        yield program.found(BESIDE, lowest, tips[0])


def _undrilled(run: range, program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Yield a tap that meets material in its middle."""
    tip = min((program.tip(index, FACE)[-1] for index in run), key=lambda tip: tip[2])
    standing = solids.standing(Point(tip[:2]).buffer(MIDDLE), tip[2], FACE, before=run[0])
    if standing.area > MIDDLE**2:
        yield program.found(KINDS["tap-undrilled"], run[0], tip)


def _other_d(program: TracedProgram) -> Iterator[Finding]:
    """Yield a G41 or G42 outside of sections whose D is not the loaded tool's diameter."""
    cuts = [range(cut.line, cut.last_line + 1) for cut in program.cuts if cut.is_section]
    for number, text in enumerate(program.texts, 1):
        side = SIDE.search(text)
        after = next((i for i, m in enumerate(program.moves) if m.block >= number), None)
        if not side or after is None or any(number in lines for lines in cuts):
            continue
        table, d = program.trace.table_at(after).diameters, int(side[1] or side[2])
        tool = program.moves[after].tool
        used, loaded = table.get(d, 0.0), table.get(tool, 0.0)
        if d != tool and used and loaded and abs(used - loaded) > WEAR * loaded:
            values = {"d": d, "tool": tool, "used": used, "loaded": loaded}
            yield Finding(OTHER_D, number, values)
