# SPDX-License-Identifier: GPL-2.0-or-later
"""What a command says on standard error while long work goes on."""

from __future__ import annotations

import contextlib
import sys
import threading
from collections.abc import Iterator, Sequence
from typing import Callable, TypeVar

TICK = 1.0  # s, on a terminal
LINE_TICK = 5.0  # s, elsewhere: every tick is a line that stays
HIDDEN = "\r\033[K"

Item = TypeVar("Item")
Tell = Callable[[str], None]


def silent(_text: str) -> None:
    """Say nothing."""


@contextlib.contextmanager
def working(text: str) -> Iterator[Tell]:
    """Say what is being done if it takes long; yields what changes the text."""
    now, done = [text], threading.Event()
    ticker = threading.Thread(target=_tick, args=(now, done))
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


def _tick(now: list[str], done: threading.Event) -> None:
    terminal = sys.stderr.isatty()
    while not done.wait(TICK if terminal else LINE_TICK):
        before, after = (HIDDEN, "") if terminal else ("", "\n")
        print(f"{before}{now[0]}", end=after, file=sys.stderr, flush=True)
    if terminal:
        print(HIDDEN, end="", file=sys.stderr, flush=True)
