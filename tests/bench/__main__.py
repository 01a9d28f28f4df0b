# SPDX-License-Identifier: GPL-2.0-or-later
"""Print every promised figure beside its limit; exit 1 if one is missed.

Words are the modules to measure, as ``kinematics``; without one all are.
"""

import importlib
import pkgutil
import subprocess
import sys

import bench


def main():
    """Measure and print, each module in a process of its own.

    Linux counts a process's memory from its parent's at the start, which samples make large.
    """
    names = [info.name for info in pkgutil.iter_modules(bench.__path__) if info.name[:2] != "__"]
    requested = sys.argv[1:] or sorted(names)
    if len(requested) == 1:
        return measure(requested[0])
    command = [sys.executable, "-m", "bench"]
    return max(subprocess.run([*command, name]).returncode for name in requested)


def measure(name):
    """Print the figures of a module; return 1 if one is missed."""
    missed = 0
    for figure in importlib.import_module(f"bench.{name}").figures():
        reached = figure.value <= figure.limit
        missed += not reached
        verdict = "reached" if reached else "MISSED"
        print(f"{figure.what}: {figure.value:.4g}{figure.unit}, limit {figure.limit:g}")
        print(f"    {verdict}; {figure.how}", flush=True)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
