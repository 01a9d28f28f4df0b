# SPDX-License-Identifier: GPL-2.0-or-later
"""What `check` tells of a machine config.

A problem keeps a code from working, a warning says what will surprise, a note is as it may be.
"""

from dataclasses import dataclass

PROBLEM, WARNING, NOTE = "problem", "warning", "note"


@dataclass(frozen=True)
class ConfigFinding:
    """Something the owner should know: ``kind`` is a short name that stays the same."""

    level: str
    kind: str
    text: str
    cure: str


def problem(kind: str, text: str, cure: str) -> ConfigFinding:
    """Return a finding that keeps a code from working."""
    return ConfigFinding(PROBLEM, kind, text, cure)


def warning(kind: str, text: str, cure: str) -> ConfigFinding:
    """Return a finding that will surprise."""
    return ConfigFinding(WARNING, kind, text, cure)


def note(kind: str, text: str, cure: str) -> ConfigFinding:
    """Return a finding that is as it may be, but that the owner should know of."""
    return ConfigFinding(NOTE, kind, text, cure)
