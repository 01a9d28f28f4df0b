# SPDX-License-Identifier: GPL-2.0-or-later
"""The findings of `check` in a machine config.

A problem prevents a code from working. A warning reports surprising behaviour. A note needs no
change.
"""

from dataclasses import dataclass
from functools import partial

PROBLEM, WARNING, NOTE = "problem", "warning", "note"


@dataclass(frozen=True)
class ConfigFinding:
    """A finding for the owner; ``kind`` is a short, stable name."""

    level: str
    kind: str
    text: str
    cure: str


problem = partial(ConfigFinding, PROBLEM)
warning = partial(ConfigFinding, WARNING)
note = partial(ConfigFinding, NOTE)
