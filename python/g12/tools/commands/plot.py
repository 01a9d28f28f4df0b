# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 plot``: a picture of what a program cuts, for any LinuxCNC program and machine.

A mill program is shown from above and from the side, with the area its cutters sweep; a program
that turns C on the face of the part, and over time; a turning program in Z and X.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from matplotlib.figure import Figure

from g12.tools.commands.arguments import (
    GOOD,
    Parser,
    add_program,
    add_run,
    check_run,
    checked_ini,
    one_line,
)
from g12.tools.errors import UsageError
from g12.tools.headless.run import run_program
from g12.tools.plot import style
from g12.tools.plot.face import draw_face
from g12.tools.plot.mill import draw_mill
from g12.tools.plot.scene import Scene, scene_of, with_run
from g12.tools.plot.turning import draw_turn
from g12.tools.preview.ended import traced
from g12.tools.progress import working
from g12.tools.units import UNITS
from g12.tools.verify.proof import collisions_in

EXAMPLES = """\
examples:
  g12 plot pocket.ngc --ini mill.ini -o pocket.png
  g12 plot pocket.ngc --ini mill.ini -o pocket.pdf --run --override 500
  g12 plot flats.ngc --ini lathe.ini -o flats.svg --units inch

exit code: 0 the picture is there, 1 the program has an error, 2 wrong use
"""


def draw(scene: Scene) -> Figure:
    """Return the picture that fits machine and program."""
    if scene.path.part.turning:
        return draw_face(scene)
    lathe = "Y" not in scene.ini.axes
    return draw_turn(scene) if lathe else draw_mill(scene)


def parser() -> Parser:
    """Return the command's words."""
    words = Parser(prog="g12 plot", description=__doc__, epilog=EXAMPLES)
    add_program(words)
    words.add_argument("-o", "--output", type=Path, required=True, help="a .png, .svg or .pdf")
    words.add_argument("--units", choices=sorted(UNITS), help="default: the program's")
    words.add_argument("--feeds", action="store_true", help="colour paths by feed, not by depth")
    add_run(words, "run the program headless and draw its real motion over the programmed path")
    return words


@one_line("plot")
def main(arguments: list[str]) -> int:
    """Run the command."""
    asked = parser().parse_args(arguments)
    check_run(asked)
    ini = checked_ini(asked.program, asked.ini, asked.tools)
    try:
        style.check_format(asked.output)
    except style.PictureError as problem:
        raise UsageError(str(problem)) from None
    with working(f"interpreting {asked.program.name}"):
        trace = traced(asked.program, asked.ini, asked.tools)
        if not trace.moves:
            raise UsageError(f"{asked.program}: moves nothing, so there is nothing to draw")
        chosen = {"tools": asked.tools, "units": asked.units, "feed_colours": asked.feeds}
        scene = scene_of(asked.program, ini, trace, **chosen)
    if asked.run:
        with working(f"running {asked.program.name}, real time", clock=True):
            run = run_program(asked.program, asked.ini, asked.tools, asked.override)
        scene = with_run(scene, run, asked.override)
    with working(f"drawing {asked.output.name}"):
        hits = collisions_in(asked.program, ini, trace, scene.path, asked.tools, scene.real)
        style.save(draw(replace(scene, collisions=tuple(hits))), asked.output)
    print(f"{asked.output} written")
    return GOOD
