# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 dynapath FILE``: print circle mill events as a LinuxCNC program (a [FILTER] program)."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from g12.dynapath import program_from_events
from g12.errors import Refusal


def main(arguments: list[str]) -> int:
    """Run the command; nothing is printed unless every line is good."""
    parser = argparse.ArgumentParser(prog="g12 dynapath", description=__doc__)
    parser.add_argument("file", help="event text")
    parser.add_argument("--units", choices=("inch", "mm"), help="of the events: adds G20 or G21")
    asked = parser.parse_args(arguments)
    try:
        text = Path(asked.file).read_text(encoding="latin-1")
        program = program_from_events(text, asked.units)
    except (Refusal, OSError) as error:
        print(f"g12 dynapath: {asked.file}: {error}", file=sys.stderr)
        return 1
    print(program, end="")
    return 0
