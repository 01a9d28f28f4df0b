# SPDX-License-Identifier: GPL-2.0-or-later
"""The command line: ``python3 python/g12 COMMAND``."""

import sys
from pathlib import Path

if __package__ in (None, ""):
    sys.path[0] = str(Path(__file__).resolve().parents[1])

from g12.cli.main import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
