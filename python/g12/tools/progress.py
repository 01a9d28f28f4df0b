# SPDX-License-Identifier: GPL-2.0-or-later
"""What a command says while long work goes on."""

from __future__ import annotations

import contextlib
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TypeVar

TICK = 1.0  # s, on a terminal
LINE_TICK = 5.0  # s, elsewhere: every line stays
HIDDEN = "\r\033[K"

Item = TypeVar("Item")
Tell = Callable[[str], None]


def silent(_text: str) -> None:
    """Say nothing."""


@contextlib.contextmanager
def working(text: str, clock: bool = False) -> Iterator[Tell]:
    """Say what is being done on standard error if it takes long; yields what changes the text.

    An empty text says nothing. ``clock`` is for what takes long for sure: a terminal shows for
    how many seconds it goes on, elsewhere it is said at once.
    """
    now, done = [text], threading.Event()
    tick = _tick_on_terminal if sys.stderr.isatty() else _tick_in_lines
    ticker = threading.Thread(target=tick, args=(now, done, clock))
    ticker.start()
    try:
        yield lambda text: now.__setitem__(0, text)
    finally:
        done.set()
        ticker.join()


def counted(items: Sequence[Item], what: str, tell: Tell) -> Iterator[Item]:
    """Yield items, telling of each: ``what`` 37 of 300."""
    for number, item in enumerate(items, start=1):
        tell(f"{what} {number} of {len(items)}")
        yield item


def print_all(lines: Iterable[str]) -> None:
    """Print what a work tells as it goes on; it is done even if nobody reads that to its end."""
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
    said, pause = "", 0.0 if clock else LINE_TICK
    while not done.wait(pause):
        if now[0] != said:
            said = now[0]
            print(said, file=sys.stderr, flush=True)
        pause = LINE_TICK
