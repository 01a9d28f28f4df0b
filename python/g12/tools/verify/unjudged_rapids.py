# SPDX-License-Identifier: GPL-2.0-or-later
"""Which rapids can be held to the material: where the tool is, and what stands there, are known.

Without a stock the part is known where the program cuts, and as far as a wall is assumed round it.
"""

from collections.abc import Iterator

import numpy as np

from g12.tools.material.material import SAME_LEVEL, going, portions
from g12.tools.path.part import swept
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.workpiece import PartView, Program, Workpiece


def unjudged_rapids(workpiece: Workpiece) -> Iterator[Finding]:
    """Yield the rapids within the part that are not judged, once for each reason."""
    program, stock, known = workpiece.program, workpiece.stock, workpiece.known
    rapids = [i for i, move in enumerate(program.moves) if move.kind == "rapid" and i - 1 in known]
    leaving = [index for index in rapids if index not in known]
    for view in workpiece.views:
        cut = (i for i in rapids if i in known and i > view.until and view.judges(program.moves[i]))
        within = (i for i in cut if workpiece.touched(view, i))
        yield from told("rapid-after-cuts", program, within)
        if not (stock and (stock.diameter or stock.size)):
            beside = (i for i in rapids if i in known and goes_beside(program, view, i))
            yield from told("rapid-beside", program, beside)
        yield from told(
            "rapid-by-machine", program, (i for i in leaving if is_within(program, view, i))
        )


def told(code: str, program: Program, moves: Iterator[int]) -> Iterator[Finding]:
    """Yield one entry with the lines of moves, if there are any."""
    lines = sorted({program.line(index) for index in moves})
    if lines:
        yield Finding(code, lines[0], {"lines": ", ".join(map(str, lines))})


def goes_beside(program: Program, view: PartView, index: int) -> bool:
    """Tell whether a rapid goes, below the part's top, where nothing is cut or assumed."""
    radius, top = program.radius(index), view.material.top - SAME_LEVEL
    if not radius or not view.judges(program.moves[index]):
        return False
    points = program.points(index, view.part)
    if points[:, 2].min() > top:
        return False
    low = [each.line for each in portions(going(points)) if each.high <= top]
    return bool(low) and not view.material.covers(swept(low, radius))


def is_within(program: Program, view: PartView, index: int) -> bool:
    """Tell whether a move starts below the part's top."""
    move = program.moves[index]
    start = view.part.points(np.array(move.start))[0]
    return view.judges(move) and start[2] < view.material.top - SAME_LEVEL
