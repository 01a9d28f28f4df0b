# SPDX-License-Identifier: GPL-2.0-or-later
"""Type names for objects of LinuxCNC's interpreter, whose modules have no types."""

from __future__ import annotations

from typing import Any, TypeAlias

Interp: TypeAlias = Any  # interpreter.Interp, with the package's state on it
Block: TypeAlias = Any  # interpreter.block, as it was parsed
Canon: TypeAlias = Any  # the module emccanon, or a test's substitute
ToolEntry: TypeAlias = Any  # of the tool table
