# SPDX-License-Identifier: GPL-2.0-or-later
"""Which lines belong to sections: by where they stand, or as a sub that sections call."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from g12.tools.preview.executed_blocks import COMMENT, Text
from g12.tools.verify.reading.codes import Codes

BODY = re.compile(r"/?(?:n[0-9.]+)?o(?:<([^>]+)>|([0-9.]+))(sub|endsub)")


POSITION = "#<_", "#54"  # position parameters, which a copy without motion cannot follow


class SectionLine(NamedTuple):
    """A line of a file: what it says, as it is written, and the sub whose body it is in."""

    text: Text
    written: str
    sub: str

    @property
    def asks_position(self) -> bool:
        """Tell whether it asks where the tool is."""
        return any(name in self.written.replace(" ", "") for name in POSITION)


def section_lines(texts: Sequence[Text], written: Sequence[str]) -> list[SectionLine]:
    """Return the lines of a file."""
    found, sub = [], ""
    for text, line in zip(texts, written):
        body = BODY.match(re.sub(r"\s", "", COMMENT.sub("", line)).lower())
        sub = (body[1] or body[2]) if body and body[3] == "sub" else sub
        found.append(SectionLine(text, line, sub))
        sub = "" if body and body[3] == "endsub" else sub
    return found


def followed_subs(files: Sequence[Sequence[SectionLine]], codes: Codes) -> set[str]:
    """Return the subs that are called in sections and nowhere else, and ask for no position."""
    subs = {line.text.call for lines in files for line in lines if is_call(line)}
    subs -= {line.sub for lines in files for line in lines if line.asks_position}
    while True:
        flagged = [each for lines in files for each in with_flags(lines, codes, subs)]
        elsewhere = {line.text.call for line, within in flagged if not within}
        if not subs & elsewhere:
            return subs
        subs -= elsewhere


def with_flags(
    lines: Sequence[SectionLine], codes: Codes, subs: set[str]
) -> Iterator[tuple[SectionLine, bool]]:
    """Yield lines, each with whether it is in a section: its first one is, its last is not."""
    inside = False
    for line in lines:
        switch = codes.switch(line.text, inside)
        inside = inside if not switch else switch == "on"
        yield line, inside or line.sub in subs


def is_call(line: SectionLine) -> bool:
    """Tell whether a line calls a sub by an O-word."""
    return line.text.control and bool(line.text.call)
