# SPDX-License-Identifier: GPL-2.0-or-later
"""Names for what LinuxCNC's interpreter hands to Python; its modules have no types."""

from __future__ import annotations

from typing import Any, TypeAlias

Interp: TypeAlias = Any  # interpreter.Interp, with what the package keeps on it
Block: TypeAlias = Any  # interpreter.block, as it was parsed
Canon: TypeAlias = Any  # the module emccanon, or what takes its place in a test
ToolEntry: TypeAlias = Any  # of the tool table
