# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 plot``: a picture of a program's cut, for any LinuxCNC program and machine.

A mill program is shown from above and from the side, with the area its cutters sweep; a program
that turns C on the face of the part, one whose sections and holes are all on a cylinder on its
unrolled surface, both over time too; a turning program in Z and X. A refused program is drawn up
to the refused line; of a section that line's contour is shown without compensation.
"""

import argparse
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from g12.tools.commands.arguments import GOOD, Parser, program_of
from g12.tools.commands.cut import cut_parser, samples_of_run, stock_of
from g12.tools.errors import UsageError
from g12.tools.machine.ini import Ini
from g12.tools.machine.stored_positions import offset_at_start, stored_values
from g12.tools.plot import style
from g12.tools.plot.picture import picture_of
from g12.tools.plot.refused import with_refused_contour
from g12.tools.plot.scene import Scene, scene_of, scene_of_judgement
from g12.tools.preview.ended import ended
from g12.tools.preview.moves import Trace, message_lines
from g12.tools.progress import working
from g12.tools.verify.judge import Judgement, judge_trace, traced
from g12.tools.verify.model.finding import SEVERITIES
from g12.tools.verify.model.program import TracedProgram
from g12.tools.verify.report import sentence_in, where_text

EXAMPLES = """\
examples:
  g12 plot pocket.ngc --ini mill.ini -o pocket.png
  g12 plot pocket.ngc --ini mill.ini -o pocket.pdf --run --override 500
  g12 plot flats.ngc --ini lathe.ini -o flats.svg --units inch --stock 1.5

exit code: 0 the picture is there, 2 the program has an error, or wrong use
"""


def command_parser() -> Parser:
    run = "run the program headless and draw its real motion over the programmed path"
    parser = cut_parser("plot", __doc__, EXAMPLES, run)
    parser.add_argument("-o", "--output", type=Path, required=True, help="a .png, .svg or .pdf")
    return parser


def main(options: argparse.Namespace) -> int:
    style.check_format(options.output)
    with program_of(options) as (opened, ini):
        _ = ini.settings  # wrong ones are reported before a picture is written
        found = moves_to_draw(opened.path, ini, options)
        in_source = found.in_source(opened)
        samples = samples_of_run(opened.path, options, found, ini)
        with working(f"drawing {options.output.name}"):
            stored = stored_values(options.var)
            program = TracedProgram(opened.path, ini, found, samples, stored)
            if found.error:
                program = replace(program, trace=in_source)
                judgement, scene = None, scene_of(program, options.units)
            else:
                judgement = judge_trace(program, stock=stock_of(options), opened=opened)
                scene = scene_of_judgement(judgement, options.override, options.units)
            style.save(picture_of(scene), options.output)
    x0 = f"program {scene.x0_text}" if scene.x0_text else ""
    notes = [f"note: {text}" for text in (offset_at_start(options.var, ini), x0) if text]
    judged = dict.fromkeys(judged_texts(judgement, scene)) if judgement else ()
    texts = [f"{options.output} written", *notes, *judged, *message_lines(in_source.messages)]
    print("\n".join(texts))
    ended(options.program, in_source)
    return GOOD


def moves_to_draw(program: Path, ini: Ini, options: argparse.Namespace) -> Trace:
    """Return the moves to draw, of a refused program those up to there."""
    with working(f"interpreting {program.name}"):
        found = traced(program, ini, options.tools, options.var)
        if found.error and not options.run:
            found = with_refused_contour(program, ini, found, options.var)
    if options.run or not found.moves:
        ended(program, found)
    if not found.moves:
        raise UsageError(f"{options.program}: moves nothing, so there is nothing to draw")
    return found


def judged_texts(judgement: Judgement, scene: Scene) -> Iterator[str]:
    """Yield what ``verify`` says, by kind; a finding that the picture marks is "in red"."""
    marked = set(map(id, scene.findings))
    for severity in SEVERITIES:
        for each in judgement.of(severity):
            kind = "in red" if id(each) in marked else severity
            where = ", ".join(filter(None, [kind, where_text(each, judgement)]))
            yield f"{where}: {sentence_in(each, judgement, scene.unit)}"
