# SPDX-License-Identifier: GPL-2.0-or-later
"""The manuals' programs: run on a headless LinuxCNC, drawn, and judged by ``verify``."""

import json
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import NamedTuple

from g12.tools.headless.machine import Run, run_program
from g12.tools.install.config.features import ROOT
from g12.tools.machine.ini import read_ini
from g12.tools.plot import style
from g12.tools.plot.picture import picture_of
from g12.tools.plot.scene import scene_of_judgement
from g12.tools.units import clock
from g12.tools.verify.judge import judge
from g12.tools.verify.model.deviation import allowed_off
from g12.tools.verify.report import as_text

PROGRAM_FOLDER = ROOT / "tests" / "programs"
MACHINE_FOLDER = ROOT / "configs" / "sim"


class Sample(NamedTuple):
    """A program of the demo: its file, its machine, and the feed override (%) of its run.

    The manuals' feeds are low: the override saves time. ``own_tools`` maps numbers to
    diameters in machine units where the machine's tool table has others.
    """

    program: str
    machine: str
    override: float = 100.0
    own_tools: Mapping[int, float] | None = None

    @property
    def path(self) -> Path:
        return PROGRAM_FOLDER / self.program

    @property
    def ini(self) -> Path:
        return MACHINE_FOLDER / f"{self.machine}_headless.ini"

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
    Sample("cylinder/cam_groove.ngc", "lathe_mm", 300.0),
    Sample("yasnac/example.ngc", "mill_yasnac_mm", 1500.0),
    Sample("mitsubishi/circle.ngc", "mill_mitsubishi_mm", 1000.0),
)


def runs(samples: Sequence[Sample], workers: int) -> Iterator[tuple[Sample, Future]]:
    """Yield each sample with its run, or the reason why there is none, as the runs end."""
    with ThreadPoolExecutor(workers) as pool:
        jobs: dict[Future, Sample] = {
            pool.submit(
                run_program, sample.path, sample.ini, sample.tools, override=sample.override
            ): sample
            for sample in samples
        }
        try:
            for job in as_completed(jobs):
                yield jobs[job], job
        finally:
            pool.shutdown(cancel_futures=True)


def show(sample: Sample, run: Run, output: Path) -> tuple[str, bool]:
    """Draw a sample; return its report and whether its circles and contours are correct.

    Some of the manuals' programs leave material, or have rapids through it: that is only reported.
    """
    judgement = judge(sample.path, read_ini(sample.ini), tools=sample.tools, samples=run.samples)
    program, scene = judgement.program, scene_of_judgement(judgement, sample.override)
    picture = output / f"{sample.path.parent.name}_{sample.path.stem}.png"
    style.save(picture_of(scene), picture)
    slow = clock(scene.path.time[-1])
    faster = f" at {sample.override:g} % feed ({slow} at 100 %)" if sample.override != 100 else ""
    title = f"{scene.title}: {clock(run.seconds)} on {sample.machine}{faster}, {picture}"
    said = (f"LinuxCNC said: {message.text}" for message in run.messages)
    text = "\n".join([title, *said, as_text(judgement, scene.unit)])
    cuts = zip(program.cuts, judgement.deviations)
    return text, all(off.size <= allowed_off(cut, program, None) for cut, off in cuts)
