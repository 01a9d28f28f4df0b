# SPDX-License-Identifier: GPL-2.0-or-later
"""A pytest plugin for regressions of programs: the fixture ``gcode_regression``.

::

    # conftest.py, with the package's folder on the Python path
    # (or: pytest -p g12.tools.regress.pytest_plugin)
    pytest_plugins = ["g12.tools.regress.pytest_plugin"]

    # test_programs.py, with: from g12.tools.regress.pytest_plugin import recorded_programs
    REGRESS = Path(__file__).with_name("regress")  # what g12 regress record made

    @pytest.mark.parametrize("program", recorded_programs(REGRESS))
    def test_program(gcode_regression, program):
        gcode_regression(REGRESS, program)
"""

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from g12.tools.errors import UsageError
from g12.tools.regress.differences import TOLERANCE, Tolerance
from g12.tools.regress.record_and_check import check
from g12.tools.regress.recorder import SAME, Terms
from g12.tools.regress.recordings import load
from g12.tools.regress.report import text_report
from g12.tools.system import COMMAND


def recorded_programs(directory: str | os.PathLike) -> list[str]:
    return load(Path(directory).absolute()).names()


@pytest.fixture
def gcode_regression(request: pytest.FixtureRequest) -> Callable[..., None]:
    """Compare programs with their recordings; the test fails with the differences.

    ``gcode_regression(directory, *programs, tolerance=, feed_tolerance=, programs_in=)``: the
    directory is relative to the test's file, without programs all are compared; tolerances as of
    ``g12 regress check``; ``programs_in`` is a folder with other versions of the programs.
    """
    here = request.path.parent

    def compare(
        directory: str | os.PathLike,
        *programs: str,
        tolerance: float = TOLERANCE.ends,
        feed_tolerance: float = TOLERANCE.feeds,
        programs_in: str | os.PathLike | None = None,
    ) -> None:
        folder = here / programs_in if programs_in else None
        terms = Terms(Tolerance(tolerance, feed_tolerance))
        try:
            results, notes = check(here / directory, programs, programs=folder, terms=terms)
        except UsageError as error:
            pytest.fail(str(error), pytrace=False)
        if any(result.verdict != SAME for result in results):
            advice = f"if that is right: {COMMAND} regress record -d {directory}"
            pytest.fail("\n".join([*text_report(results, notes), advice]), pytrace=False)

    return compare
