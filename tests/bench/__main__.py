# SPDX-License-Identifier: GPL-2.0-or-later
"""Print every promised figure beside its limit; exit 1 if one is missed.

Words are the modules to measure, as ``kinematics``; without one all are.
"""

import importlib
import pkgutil
import sys

import bench


def modules(requested):
    """Import the modules of this package that measure something, or those asked for."""
    found = [info.name for info in pkgutil.iter_modules(bench.__path__) if info.name[:2] != "__"]
    names = requested or found
    return [importlib.import_module(f"bench.{name}") for name in sorted(names)]


def main():
    """Measure and print, figure by figure."""
    missed = 0
    for module in modules(sys.argv[1:]):
        for figure in module.figures():
            reached = figure.value <= figure.limit
            missed += not reached
            verdict = "reached" if reached else "MISSED"
            print(f"{figure.what}: {figure.value:.4g}{figure.unit}, limit {figure.limit:g}")
            print(f"    {verdict}; {figure.how}", flush=True)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
