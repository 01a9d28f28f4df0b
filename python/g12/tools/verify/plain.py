# SPDX-License-Identifier: GPL-2.0-or-later
"""Feed moves of a mill that no code of the package makes: stock, taps, D of G41 and G42."""

import re
from collections.abc import Iterator

import numpy as np
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
    whole = bool(solids.stock and solids.stock.is_whole)
    for rapid, run in program.runs():
        known = program.sides[run[0]] == {FACE} and program.is_known(run[-1])
        if not rapid and not program.cut_at(run[0]) and known and program.cutter(run[0]) > 0:
            if whole:
                yield from _against_stock(run, program, solids)
            if program.moves[run[0]].block in program.tapping:
                yield from _undrilled(run, program, solids)


def _against_stock(run: range, program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Yield what goes through a stock's bottom, or meets nothing of it."""
    levels = [program.tip(index, FACE)[:, 2].min() for index in run]
    low, radius = min(levels), program.cutter(run[0])
    lowest = run[levels.index(low)]
    place = program.tip(lowest, FACE)[-1]
    if solids.bottom - low > THROUGH + POINT * radius:
        yield program.found(BELOW, lowest, place, below=solids.bottom - low)
    approach = program.cut_at(min(run[-1] + 1, len(program.moves) - 1))
    deep, material = low < solids.top(FACE) - JUST_ABOVE, solids.of(FACE)
    if deep and not approach and not material.is_under(program.tips(run)[:, :2], radius):
        yield program.found(BESIDE, lowest, place)


def _undrilled(run: range, program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Yield a tap that meets material in its middle."""
    tip = min((program.tip(index, FACE)[-1] for index in run), key=lambda tip: tip[2])
    standing = solids.standing(Point(tip[:2]).buffer(MIDDLE), tip[2], FACE, before=run[0])
    if standing.area > MIDDLE**2:
        yield program.found(KINDS["tap-undrilled"], run[0], tip)


def _other_d(program: TracedProgram) -> Iterator[Finding]:
    """Yield a G41 or G42 outside of sections whose D is not the loaded tool's diameter."""
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
            yield Finding(OTHER_D, number, values)
