# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 demo``: run the manuals' programs in headless LinuxCNC, draw and measure their cuts."""

import argparse
import os
from pathlib import Path

from g12.tools.commands.arguments import FAILURES, FINDING, GOOD, Parser, sentence_of
from g12.tools.demo import PROGRAM_FOLDER, SAMPLES, runs, show
from g12.tools.errors import UsageError
from g12.tools.headless.namespaces import has_namespaces


def command_parser() -> Parser:
    parser = Parser(prog="g12 demo", description=__doc__)
    parser.add_argument(
        "--output", type=Path, default=Path("build/demo"), help="folder of pictures"
    )
    return parser


def main(options: argparse.Namespace) -> int:
    if not PROGRAM_FOLDER.is_dir():
        raise UsageError(f"{PROGRAM_FOLDER}: the sample programs are not there")
    options.output.mkdir(parents=True, exist_ok=True)
    workers = (os.cpu_count() or 1) if has_namespaces() else 1
    print(f"running {len(SAMPLES)} programs, {workers} at a time, in real time\n", flush=True)
    bad = []
    for count, (sample, job) in enumerate(runs(SAMPLES, workers), start=1):
        try:
            text, sound = show(sample, job.result(), options.output)
        except FAILURES as problem:
            text, sound = f"{sample.program}: FAILED: {sentence_of(problem)}", False
        bad += [] if sound else [sample.program]
        print(f"[{count} of {len(SAMPLES)}] {text}\n", flush=True)
    verdict = f"NOT everything came out right: {', '.join(bad)}"
    print(verdict if bad else "every circle and contour came out right")
    return FINDING if bad else GOOD
