# SPDX-License-Identifier: GPL-2.0-or-later
"""Names for the types and values of LinuxCNC's interpreter, which its modules lack."""

from __future__ import annotations

from typing import Any, TypeAlias

from g12.request.context import XY, XZ, YZ

Interp: TypeAlias = Any  # interpreter.Interp, with the package's state on it
ParsedBlock: TypeAlias = Any  # interpreter.block, as it was parsed
CanonModule: TypeAlias = Any  # the module emccanon, or a test's substitute
ToolTableEntry: TypeAlias = Any  # of the tool table

PER_MINUTE, INVERSE_TIME, PER_REVOLUTION = 0, 1, 2  # feed_mode
PLANE_CODES = {1: XY, 2: YZ, 3: XZ}  # plane
