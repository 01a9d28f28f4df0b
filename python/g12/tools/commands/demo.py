# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 demo``: run the manuals' programs in headless LinuxCNC, draw and measure what they cut."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import NamedTuple

from g12.tools.commands.arguments import FINDING, GOOD, Parser, one_line
from g12.tools.errors import ProgramError, UsageError
from g12.tools.headless.machine import MachineError, Run, StartupError
from g12.tools.headless.run import run_program
from g12.tools.install.features import ROOT
from g12.tools.machine.ini import read_ini
from g12.tools.plot import style
from g12.tools.plot.picture import picture_of
from g12.tools.plot.scene import Scene, clock, scene_of_proof
from g12.tools.preview.tracer import TraceFailure
from g12.tools.units import Unit, plain
from g12.tools.verify.findings import SAME_AREA
from g12.tools.verify.pocket import PocketFacts
from g12.tools.verify.proof import Proof, prove
from g12.tools.verify.section import SectionFacts

FAILURES = (ProgramError, TraceFailure, StartupError, MachineError)
PROGRAMS = ROOT / "tests" / "programs"
MACHINES = ROOT / "configs" / "sim"


class Sample(NamedTuple):
    """A program to show: its file, its machine, and the feed override (%) of its run.

    The manuals' feeds are low: the runs are sped up to save time. ``own_tools`` maps numbers to
    diameters in machine units where the machine's tool table has others.
    """

    program: str
    machine: str
    override: float = 100.0
    own_tools: Mapping[int, float] | None = None

    @property
    def path(self) -> Path:
        """Return the program's file."""
        return PROGRAMS / self.program

    @property
    def ini(self) -> Path:
        """Return the machine's INI file."""
        return MACHINES / f"{self.machine}_headless.ini"

    @property
    def tools(self) -> Mapping[int, float] | None:
        """Return the program's own tools: those given, or in the file beside the program."""
        beside = self.path.with_suffix(".json")
        if self.own_tools or not beside.exists():
            return self.own_tools
        tools = json.loads(beside.read_text(encoding="utf-8"))["tools"]
        return {int(number): diameter for number, diameter in tools.items()}


SAMPLES = (
    Sample("haas/O60121.ngc", "mill_inch", 1500.0),
    Sample("haas/O60131.ngc", "mill_inch", 1500.0),
    Sample("circle_mill/sample.ngc", "mill_mm", 2000.0),
    Sample("polar/manual_a.ngc", "lathe_inch", 200.0),
    Sample("polar/manual_b.ngc", "lathe_inch", 200.0),
    Sample("polar/manual_sample.ngc", "lathe_inch", 200.0, {8: 0.0}),
    Sample("polar/hexagon.ngc", "lathe_mm"),
    Sample("polar/slot.ngc", "lathe_mm"),
    Sample("yasnac/example.ngc", "mill_yasnac_mm", 1500.0),
    Sample("mitsubishi/circle.ngc", "mill_mitsubishi_mm", 1000.0),
)
POCKET_HEADS = ("line", "code", "centre", "radius", "tool-centre rings", "Z", "off circles", "time")
SECTION_HEADS = ("lines", "pieces", "off contour", "allowed", "lowest feed", "C at most", "time")


def runs(samples: Sequence[Sample], workers: int) -> Iterator[tuple[Sample, Future]]:
    """Yield each sample with what has its run or why there is none, as they come to their end."""
    with ThreadPoolExecutor(workers) as pool:
        jobs: dict[Future, Sample] = {
            pool.submit(run_program, sample.path, sample.ini, sample.tools, sample.override): sample
            for sample in samples
        }
        try:
            for job in as_completed(jobs):
                yield jobs[job], job
        finally:
            pool.shutdown(cancel_futures=True)


def show(sample: Sample, run: Run, output: Path) -> tuple[str, bool]:
    """Draw a sample; return its table and whether its circles and contours came out right."""
    ini = read_ini(sample.ini)
    proof = prove(sample.path, ini, tools=sample.tools, samples=run.samples)
    scene = scene_of_proof(proof, sample.override)
    picture = output / f"{sample.path.parent.name}_{sample.path.stem}.png"
    style.save(picture_of(scene), picture)
    return describe(sample, run, proof, scene, picture), is_sound(proof)


def shown_or_failed(sample: Sample, job: Future, output: Path) -> tuple[str, bool]:
    """Draw a sample whose run has come to its end; return what is told of it, and whether good."""
    try:
        return show(sample, job.result(), output)
    except FAILURES as problem:
        return f"{sample.program}: FAILED: {problem}", False


def is_sound(proof: Proof) -> bool:
    """Tell whether every circle and contour came out right.

    The manuals leave material in some and have rapids through what was left: that is told.
    """
    off = [facts.deviation > proof.tolerances.pocket for facts in proof.pockets]
    off += [facts.deviation > proof.tolerances.polar for facts in proof.sections]
    return not any(off) and not any(
        facts.gouge > SAME_AREA for facts in (*proof.pockets, *proof.sections)
    )


def describe(sample: Sample, run: Run, proof: Proof, scene: Scene, picture: Path) -> str:
    """Return what is told of a program: its table, what LinuxCNC said, where the picture is."""
    slow = clock(scene.path.time[-1])
    faster = f" at {sample.override:g} % feed ({slow} at 100 %)" if sample.override != 100 else ""
    title = f"{scene.title}: {clock(run.seconds)} on {sample.machine}{faster}, {picture}"
    unit = scene.unit
    lines = [title, *(f"  LinuxCNC said: {message.text}" for message in run.messages)]
    if proof.pockets:
        lines += table(POCKET_HEADS, [pocket_row(facts, unit) for facts in proof.pockets])
    if proof.sections:
        allowed = proof.tolerances.polar
        rows = [section_row(facts, allowed, unit) for facts in proof.sections]
        lines += table(SECTION_HEADS, rows)
    lines += [f"  line {line}: {text}" for line, text in proof.findings_in(unit)]
    return "\n".join(lines)


def pocket_row(facts: PocketFacts, unit: Unit) -> tuple[str, ...]:
    """Return a pocket's row of the table; its time is that at the programmed feed."""
    x, y, _ = facts.target.wall.origin
    return (
        str(facts.target.source.line),
        facts.target.source.code,
        f"X{unit.text(x)} Y{unit.text(y)}",
        unit.text(facts.target.wall.radius),
        " ".join(unit.text(ring) for ring in facts.rings),
        unit.text(facts.target.wall.height(facts.depths[-1])),
        f"{unit.fine(facts.off_rings)} {unit.name}",
        f"{plain(facts.pace.expected, 1)} s",
    )


def section_row(facts: SectionFacts, allowed: float, unit: Unit) -> tuple[str, ...]:
    """Return a polar section's row of the table."""
    return (
        f"{facts.section.line}-{facts.section.last}",
        str(facts.pieces),
        f"{unit.fine(facts.deviation)} {unit.name}",
        f"{unit.fine(allowed)} {unit.name}",
        f"{plain(facts.pace.lowest / unit.mm, 1)} {unit.name}/min",
        f"{plain(facts.c_speed, 1)} of {plain(facts.c_limit, 1)} °/s",
        f"{plain(facts.pace.expected, 1)} s",
    )


def table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """Return a table as lines, columns as wide as needed."""
    widths = [max(map(len, column)) for column in zip(heads, *rows)]
    return [
        "  " + "  ".join(f"{text:{width}}" for text, width in zip(row, widths)).rstrip()
        for row in (heads, *rows)
    ]


def command_parser() -> Parser:
    """Return what reads the command line."""
    parser = Parser(prog="g12 demo", description=__doc__)
    parser.add_argument(
        "--output", type=Path, default=Path("build/demo"), help="folder of pictures"
    )
    return parser


@one_line("demo")
def main(arguments: list[str]) -> int:
    """Run the command."""
    options = command_parser().parse_args(arguments)
    if not PROGRAMS.is_dir():
        raise UsageError(f"{PROGRAMS}: the sample programs are not there")
    options.output.mkdir(parents=True, exist_ok=True)
    workers = os.cpu_count() or 1
    print(f"running {len(SAMPLES)} programs, {workers} at a time, in real time\n", flush=True)
    bad = []
    for count, (sample, job) in enumerate(runs(SAMPLES, workers), start=1):
        text, sound = shown_or_failed(sample, job, options.output)
        bad += [] if sound else [sample.program]
        print(f"[{count} of {len(SAMPLES)}] {text}\n", flush=True)
    verdict = f"NOT everything came out right: {', '.join(bad)}"
    print(verdict if bad else "every circle and contour came out right")
    return FINDING if bad else GOOD
