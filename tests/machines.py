# SPDX-License-Identifier: GPL-2.0-or-later
"""Where the simulated machines and the manuals' programs are."""

from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SIM = ROOT / "configs" / "sim"
PROGRAMS = ROOT / "tests" / "programs"
