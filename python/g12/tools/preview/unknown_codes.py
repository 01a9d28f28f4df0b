# SPDX-License-Identifier: GPL-2.0-or-later
"""Codes that LinuxCNC does not have, and the controls whose codes they are."""

from collections.abc import Container

from g12.tools.system import COMMAND
from g12.tools.translate.blocks.control import read_control, shipped_controls
from g12.tools.translate.blocks.lexer import blocks_of
from g12.tools.translate.whole_program import CODES

CONTROLS_NAMED = 3  # controls
COMMONEST = ("fanuc", "haas")


def unknown_code(block: str, remapped: Container[str]) -> str:
    """Return the first G code of a block that LinuxCNC lacks; "" if that is not certain."""
    words = [word for part in blocks_of(1, block) for word in part.words]
    codes = [word.code for word in words if word.code[:1] == "G" and word.code not in remapped]
    lacking = [code for code in codes if code not in CODES]
    return next(iter(lacking or codes * (len(codes) == 1)), "")


def of_other_controls(code: str, axes: str) -> str:
    """Return the end of a sentence about a code: the controls that have it, "" if none is known."""
    controls = (read_control(name) for name in shipped_controls())
    having = [c for c in controls if not c.onto and _is_known(c.meanings.get(code, ""))]
    fitting = [c for c in having if c.is_lathe == ("Y" not in axes)] or having
    names = sorted((c.name for c in fitting), key=_rank)
    if not names:
        return ""
    known = ", ".join(names[:CONTROLS_NAMED]) + " and others" * (len(names) > CONTROLS_NAMED)
    return f", a code of {known}: {COMMAND} translate --control NAME makes a LinuxCNC program of it"


def _is_known(meaning: str) -> bool:
    return meaning not in ("", "same", "machine") and not meaning.startswith("refuse: ")


def _rank(name: str) -> tuple[bool, int, str]:
    return not name.startswith(COMMONEST), len(name), name
