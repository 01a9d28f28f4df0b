# SPDX-License-Identifier: GPL-2.0-or-later
"""A trace of a filtered program, with the line numbers of the user's file."""

from dataclasses import replace

from g12.tools.machine.filter import OpenedProgram
from g12.tools.preview.moves import Trace


def trace_in_source(found: Trace, opened: OpenedProgram) -> Trace:
    """Return a trace whose blocks, messages, events and error have the user's line numbers."""
    if not opened.is_filtered:
        return found
    line, error = opened.source_line, found.error
    return replace(
        found,
        moves=[move._replace(block=line(move.block)) for move in found.moves],
        events=[event._replace(line=line(event.line)) for event in found.events],
        error=error and error._replace(text=opened.in_source(error.text), line=line(error.line)),
    )
