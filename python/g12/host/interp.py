# SPDX-License-Identifier: GPL-2.0-or-later
"""Names for LinuxCNC's interpreter: types, which its modules lack, and a value."""

from __future__ import annotations

from typing import Any, TypeAlias

Interp: TypeAlias = Any  # interpreter.Interp, with the package's state on it
Block: TypeAlias = Any  # interpreter.block, as it was parsed
Canon: TypeAlias = Any  # the module emccanon, or a test's substitute
ToolEntry: TypeAlias = Any  # of the tool table

NO_CODE = -1  # of a modal group without a code in a block
