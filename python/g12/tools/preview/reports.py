# SPDX-License-Identifier: GPL-2.0-or-later
"""Reports of cuts, read from the comments that `g12.cut_report` writes."""

from __future__ import annotations

import json
from collections.abc import Sequence
from itertools import chain
from typing import Any

from g12.cut_report import (
    CUT,
    KINDS,
    MORE,
    SCHEMA,
    CutElement,
    CutReport,
    ProgramFrame,
    SectionCut,
    ShapePasses,
    UsedCutter,
)

INNER = {"frame": ProgramFrame, "cutter": UsedCutter, "passes": ShapePasses}  # records in fields


def read_report(text: str, *further: str) -> CutReport:
    """Return the report of a comment and of those with further elements, or raise ValueError."""
    data = json.loads(text.removeprefix(CUT))
    schema, kind = data.pop("schema"), KINDS.get(data.pop("kind"))
    if schema != SCHEMA or not kind:
        raise ValueError(
            f"the g12 of this machine reports its cuts by schema {schema}, this one reads {SCHEMA}:"
            " let the INI load this one, or use that one's tools"
        )
    cut = data["cut"]
    if kind is SectionCut:
        rows = chain(cut["elements"], *(json.loads(more.removeprefix(MORE)) for more in further))
        cut["elements"] = tuple(map(_element, rows))
    return _record(CutReport, {**data, "cut": _record(kind, cut)})


def _element(row: Sequence[Any]) -> CutElement:
    line, side, radius, feed, z0, z1, *points, sweep = row
    start, end, centre = (complex(*point) if point else None for point in points)
    return CutElement(line, side, radius, feed, z0, z1, start, end, centre, sweep)


def _record(kind: Any, data: dict[str, Any]) -> Any:
    inner = {name: _record(INNER[name], value) for name, value in data.items() if name in INNER}
    return kind(**{name: _frozen(value) for name, value in data.items()} | inner)


def _frozen(value: Any) -> Any:
    return tuple(map(_frozen, value)) if isinstance(value, list) else value
