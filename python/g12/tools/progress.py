# SPDX-License-Identifier: GPL-2.0-or-later
"""Progress messages of a command during long work."""

import contextlib
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator

TICK = 1.0  # s, on a terminal
LINE_TICK = 5.0  # s, not on a terminal, where every line remains
HIDDEN = "\r\033[K"

Report = Callable[[str], None]


def silent(_text: str) -> None:
    """Discard a report."""


@contextlib.contextmanager
def working(text: str, clock: bool = False) -> Iterator[Report]:
    """Report work on standard error if it takes long; yields the function that changes the text.

    An empty text is not printed. ``clock`` is for work that is known to take long: a terminal shows
    the seconds so far, any other output gets the text at once.
    """
    now, done = [text], threading.Event()
    tick = _tick_on_terminal if sys.stderr.isatty() else _tick_in_lines
    ticker = threading.Thread(target=tick, args=(now, done, clock))
    try:
        ticker.start()  # an interrupt may come before it returns
        yield lambda text: now.__setitem__(0, text)
    finally:
        done.set()
        if ticker.is_alive():
            ticker.join()


def print_all(lines: Iterable[str]) -> None:
    """Print the lines of some work as they come; finish it even if the reader closes the pipe."""
    unread = None
    for line in lines:
        try:
            print(line)
        except BrokenPipeError as problem:
            unread = problem
    if unread:
        raise unread


def _tick_on_terminal(now: list[str], done: threading.Event, clock: bool) -> None:
    started = time.monotonic()
    while not done.wait(TICK):
        seconds = f" {time.monotonic() - started:.0f} s" if clock else ""
        print(f"{HIDDEN}{now[0]}{seconds}", end="", file=sys.stderr, flush=True)
    print(HIDDEN, end="", file=sys.stderr, flush=True)


def _tick_in_lines(now: list[str], done: threading.Event, clock: bool) -> None:
    printed, pause = "", 0.0 if clock else LINE_TICK
    while not done.wait(pause):
        if now[0] != printed:
            printed = now[0]
            print(printed, file=sys.stderr, flush=True)
        pause = LINE_TICK
