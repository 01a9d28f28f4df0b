# SPDX-License-Identifier: GPL-2.0-or-later
"""What is said while long work goes on, on a terminal and elsewhere."""

import threading
import time

import pytest

from g12.tools import progress


def until_told(capsys, text):
    """Return what is said until a text is in it, within a minute."""
    said, end = "", time.monotonic() + 60
    while text not in said and time.monotonic() < end:
        time.sleep(0.01)
        said += capsys.readouterr().err
    return said


@pytest.mark.parametrize(("terminal", "between"), [(False, "\n"), (True, progress.HIDDEN)])
def test_long_work_is_told_of(terminal, between, capsys, monkeypatch):
    monkeypatch.setattr("sys.stderr.isatty", lambda: terminal)
    monkeypatch.setattr(progress, "TICK" if terminal else "LINE_TICK", 0.05)
    with progress.working("reading") as tell:
        err = until_told(capsys, "reading")
        tell("measuring")
        err += until_told(capsys, "measuring")
    err += capsys.readouterr().err
    said = [text for text in dict.fromkeys(err.split(between)) if text]
    assert said == ["reading", "measuring"]
    assert err.endswith(between)


def test_short_work_and_what_an_error_ended_are_not(capsys, monkeypatch):
    with progress.working("reading"):
        pass
    monkeypatch.setattr(progress, "LINE_TICK", 0.05)
    with pytest.raises(ValueError, match="wrong"), progress.working("reading"):
        raise ValueError("wrong")
    assert capsys.readouterr().err == ""


def test_an_interrupt_as_the_telling_starts_ends_it(monkeypatch):
    class Interrupted(threading.Thread):
        def start(self):
            super().start()
            raise KeyboardInterrupt

    before = threading.active_count()
    monkeypatch.setattr(threading, "Thread", Interrupted)
    with pytest.raises(KeyboardInterrupt), progress.working("running", clock=True):
        pass
    assert threading.active_count() == before
