# SPDX-License-Identifier: GPL-2.0-or-later
"""The findings of `check` in a machine config.

A problem prevents a code from working. A warning reports surprising behaviour. A note needs no
change.
"""

from dataclasses import dataclass

PROBLEM, WARNING, NOTE = "problem", "warning", "note"


@dataclass(frozen=True)
class ConfigFinding:
    """A finding for the owner; ``kind`` is a short, stable name."""

    level: str
    kind: str
    text: str
    cure: str


def problem(kind: str, text: str, cure: str) -> ConfigFinding:
    """Return a finding that prevents a code from working."""
    return ConfigFinding(PROBLEM, kind, text, cure)


def warning(kind: str, text: str, cure: str) -> ConfigFinding:
    """Return a finding of surprising behaviour."""
    return ConfigFinding(WARNING, kind, text, cure)


def note(kind: str, text: str, cure: str) -> ConfigFinding:
    """Return a finding that needs no change, but that the owner should know."""
    return ConfigFinding(NOTE, kind, text, cure)
