# SPDX-License-Identifier: GPL-2.0-or-later
"""The queue of a user's runs where there are no namespaces."""

import os

import pytest

from g12.tools.headless import namespaces
from g12.tools.headless.errors import StartupError


def test_a_run_that_does_not_end_is_not_waited_for_without_end(tmp_path, monkeypatch):
    monkeypatch.setattr(namespaces, "TURNS", str(tmp_path / "turns-{}"))
    monkeypatch.setattr(namespaces, "LONGEST_QUEUE", 0.2)
    first = namespaces.next_turn()
    with pytest.raises(StartupError, match=r"another run of yours has not ended in 0\.2 s"):
        namespaces.next_turn()
    os.close(first)
    os.close(namespaces.next_turn())
