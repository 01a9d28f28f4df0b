# SPDX-License-Identifier: GPL-2.0-or-later
"""The findings of `check` in a machine config, for which `install` refuses.

A problem prevents a code from working. A warning reports surprising behaviour. A note needs no
change.
"""

from collections.abc import Iterable
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


class Refused(Exception):
    """The installation is refused; ``args`` are the findings."""


problem = partial(ConfigFinding, PROBLEM)
warning = partial(ConfigFinding, WARNING)
note = partial(ConfigFinding, NOTE)


def refuse(kind: str, text: str, cure: str) -> Refused:
    """Return the refusal for one reason, for the caller to raise."""
    return Refused(problem(kind, text, cure))


def refuse_problems(findings: Iterable[ConfigFinding]) -> list[ConfigFinding]:
    """Return the warnings among the findings; refuse if there are problems."""
    found = list(findings)
    problems = [finding for finding in found if finding.level == PROBLEM]
    if problems:
        raise Refused(*problems)
    return found
