# SPDX-License-Identifier: GPL-2.0-or-later
"""Traces for the oracle: with reports, and the modal state before and after each cut."""

from pathlib import Path
from unittest import mock

from g12.tools.preview import tracer
from g12.tools.preview.tracer import Tracer

TESTS = Path(__file__).parents[2]
LAUNCH = (
    f"import sys; sys.path[0] = {{folder!r}}; import worker; sys.path[0] = {str(TESTS)!r};"
    "from support.oracle.modal_worker import put_in; sys.path.pop(0); put_in(worker);"
    "worker.serve({descriptor})"
)


class ModalTracer(Tracer):
    """A Tracer whose traces the oracle can judge."""

    def __init__(self, ini, **more):
        super().__init__(ini, reports=True, **more)

    def _start(self):
        with mock.patch.object(tracer, "LAUNCH", LAUNCH):
            super()._start()
