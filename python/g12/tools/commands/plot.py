# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 plot``: a picture of a program's cut, for any LinuxCNC program and machine.

A mill program is shown from above and from the side, with the area its cutters sweep; a program
that turns C on the face of the part, one whose sections are all on a cylinder on its unrolled
surface, both over time too; a turning program in Z and X. A refused program is drawn up to the
refused line; of a section that line's contour is shown without compensation.
"""

import argparse
from dataclasses import replace
from pathlib import Path

from g12.tools.commands.arguments import (
    FINDING,
    GOOD,
    Parser,
    check_run,
    checked_ini,
    cut_parser,
    one_line,
    report_line_numbers,
    samples_of_run,
    stock_of,
)
from g12.tools.errors import UsageError, print_error
from g12.tools.machine.filter import OpenedProgram, opened_program
from g12.tools.machine.ini import Ini
from g12.tools.plot import style
from g12.tools.plot.picture import picture_of
from g12.tools.plot.refused import with_refused_contour
from g12.tools.plot.scene import Scene, scene_of
from g12.tools.plot.side_holes import drilled_surface
from g12.tools.preview.ended import ended, ended_text, explained
from g12.tools.preview.moves import Trace, message_lines
from g12.tools.preview.source_lines import trace_in_source
from g12.tools.preview.tracer import Tracer, trace
from g12.tools.progress import working
from g12.tools.units import Unit
from g12.tools.verify.commanded import Commanded, commanded_by
from g12.tools.verify.proof import prove_subject
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.seen import seen_of_proof
from g12.tools.verify.subject import subject_of

EXAMPLES = """\
examples:
  g12 plot pocket.ngc --ini mill.ini -o pocket.png
  g12 plot pocket.ngc --ini mill.ini -o pocket.pdf --run --override 500
  g12 plot flats.ngc --ini lathe.ini -o flats.svg --units inch --stock 1.5

exit code: 0 the picture is there, 1 the program has an error, 2 wrong use
"""


def command_parser() -> Parser:
    """Return the command's parser."""
    run = "run the program headless and draw its real motion over the programmed path"
    parser = cut_parser("plot", __doc__, EXAMPLES, run)
    parser.add_argument("-o", "--output", type=Path, required=True, help="a .png, .svg or .pdf")
    parser.add_argument("--feeds", action="store_true", help="colour paths by feed, not by depth")
    return parser


@one_line("plot")
def main(arguments: list[str]) -> int:
    """Run the command."""
    options = command_parser().parse_args(arguments)
    check_run(options)
    ini = checked_ini(options)
    try:
        style.check_format(options.output)
    except style.PictureError as problem:
        raise UsageError(str(problem)) from None
    with opened_program(options.program, ini) as opened:
        scene = write_picture(opened.path, ini, options)
    print(f"{options.output} written")
    for line in texts_beside(scene, opened):
        print(line)
    if scene.refusal:
        text = ended_text(options.program, trace_in_source(scene.subject.trace, opened).error)
        print_error("g12 plot", text)
        report_line_numbers("plot", opened)
    return FINDING if scene.refusal else GOOD


def texts_beside(scene: Scene, opened: OpenedProgram) -> list[str]:
    """Return the texts of the picture's red signs, notes and messages, with the user's lines."""
    findings = (f"in red, {said(each, scene.unit, opened)}" for each in scene.seen.findings)
    notes = (f"note, {said(each, scene.unit, opened)}" for each in scene.seen.notes)
    x0 = [f"note: program {scene.x0_text}"] if scene.x0_text else []
    trace = trace_in_source(scene.subject.trace, opened)
    return [*dict.fromkeys(findings), *x0, *dict.fromkeys(notes), *message_lines(trace.messages)]


def said(finding: Finding, unit: Unit, opened: OpenedProgram) -> str:
    """Return the line and the sentence of a finding, with the user's lines."""
    text = finding.text(unit)
    if finding.file:
        return f"line {finding.line} of {finding.file}: {text}"
    return f"line {opened.source_line(finding.line)}: {opened.in_source(text)}"


def words_of(program: Path, ini: Ini, options: argparse.Namespace, found: Trace) -> Commanded:
    """Return what the words of a traced program command."""
    with Tracer(ini, tools=options.tools) as tracer:
        return commanded_by(tracer, program, found, options.tools, options.var)


def write_picture(program: Path, ini: Ini, options: argparse.Namespace) -> Scene:
    """Draw a program as LinuxCNC reads it; return its scene."""
    with working(f"interpreting {program.name}"):
        found = explained(
            trace(program, options.ini, tools=options.tools, parameters=options.var), options.ini
        )
        if found.error and not options.run:
            found = with_refused_contour(program, ini, found, options.var)
        if options.run or not found.moves:
            ended(program, found)
        if not found.moves:
            raise UsageError(f"{options.program}: moves nothing, so there is nothing to draw")
    samples = samples_of_run(program, options, found, ini)
    with working(f"drawing {options.output.name}"):
        commanded = Commanded() if found.error else words_of(program, ini, options, found)
        subject = subject_of(program, ini, found, samples, commanded)
        scene = scene_of(subject, options.units, options.feeds)
        if not found.error:
            seen = seen_of_proof(prove_subject(subject, stock=stock_of(options)))
            surface = seen.surface or drilled_surface(subject, options.tools, options.var)
            seen = seen._replace(surface=surface)
            scene = replace(scene, override=options.override, seen=seen)
        style.save(picture_of(scene), options.output)
    return scene
