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

from g12.tools.commands.arguments import (
    GOOD,
    Parser,
    checked_ini,
    one_line,
    report_line_numbers,
)
from g12.tools.commands.cut import cut_parser, samples_of_run, stock_of
from g12.tools.errors import UsageError
from g12.tools.machine.filter import opened_program
from g12.tools.machine.ini import Ini
from g12.tools.machine.stored_positions import offset_at_start
from g12.tools.plot import style
from g12.tools.plot.picture import picture_of
from g12.tools.plot.refused import with_refused_contour
from g12.tools.plot.scene import Scene, scene_of, scene_of_proof
from g12.tools.preview.ended import ended
from g12.tools.preview.moves import Trace, message_lines
from g12.tools.preview.source_lines import trace_in_source
from g12.tools.progress import working
from g12.tools.verify.commanded import Commanded
from g12.tools.verify.proof import Proof, moves_and_words, prove_subject
from g12.tools.verify.report import where_text
from g12.tools.verify.subject import subject_of

EXAMPLES = """\
examples:
  g12 plot pocket.ngc --ini mill.ini -o pocket.png
  g12 plot pocket.ngc --ini mill.ini -o pocket.pdf --run --override 500
  g12 plot flats.ngc --ini lathe.ini -o flats.svg --units inch --stock 1.5

exit code: 0 the picture is there, 2 the program has an error, or wrong use
"""
KIND_WORDS = {"finding": "is_finding", "note": "is_note", "not judged": "is_not_judged"}


def command_parser() -> Parser:
    run = "run the program headless and draw its real motion over the programmed path"
    parser = cut_parser("plot", __doc__, EXAMPLES, run)
    parser.add_argument("-o", "--output", type=Path, required=True, help="a .png, .svg or .pdf")
    parser.add_argument("--feeds", action="store_true", help="colour paths by feed, not by depth")
    return parser


@one_line("plot")
def main(arguments: list[str]) -> int:
    options = command_parser().parse_args(arguments)
    ini = checked_ini(options)
    style.check_format(options.output)
    _ = ini.settings  # wrong ones are reported before a picture is written
    with opened_program(options.program, ini) as opened:
        found, commanded = moves_to_draw(opened.path, ini, options)
        in_source = trace_in_source(found, opened)
        samples = samples_of_run(opened.path, options, found, ini)
        with working(f"drawing {options.output.name}"):
            subject = subject_of(opened.path, ini, found, samples, commanded)
            if found.error:
                subject = replace(subject, trace=in_source)
                proof, scene = None, scene_of(subject, options.units, options.feeds)
            else:
                proof = replace(prove_subject(subject, stock=stock_of(options)), opened=opened)
                scene = scene_of_proof(proof, options.override, options.units, options.feeds)
            style.save(picture_of(scene), options.output)
    x0 = f"program {scene.x0_text}" if scene.x0_text else ""
    notes = [f"note: {text}" for text in (offset_at_start(options.var, ini), x0) if text]
    judged = dict.fromkeys(judged_texts(proof, scene)) if proof else ()
    texts = [f"{options.output} written", *notes, *judged, *message_lines(in_source.messages)]
    print("\n".join(texts))
    report_line_numbers("plot", opened)
    ended(options.program, in_source)
    return GOOD


def moves_to_draw(program: Path, ini: Ini, options: argparse.Namespace) -> tuple[Trace, Commanded]:
    """Return the moves to draw, and what the words command; of a refused program nothing."""
    with working(f"interpreting {program.name}"):
        found, commanded = moves_and_words(program, ini, options.tools, options.var)
        if found.error and not options.run:
            found = with_refused_contour(program, ini, found, options.var)
    if options.run or not found.moves:
        ended(program, found)
    if not found.moves:
        raise UsageError(f"{options.program}: moves nothing, so there is nothing to draw")
    return found, commanded


def judged_texts(proof: Proof, scene: Scene) -> Iterator[str]:
    """Yield what ``verify`` says, by kind; a finding that the picture marks is "in red"."""
    marked = set(map(id, scene.marks.findings))
    for name, attribute in KIND_WORDS.items():
        for each in (each for each in proof.judged if getattr(each, attribute)):
            kind = "in red" if id(each) in marked else name
            where = ", ".join(filter(None, [kind, where_text(proof, each)]))
            yield f"{where}: {proof.text(each, scene.unit)}"
