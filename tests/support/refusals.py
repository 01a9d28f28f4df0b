# SPDX-License-Identifier: GPL-2.0-or-later
"""What the operator reads of a refused block."""


def at_line(message, line):
    """Return a block's refusal (``G12: …``) as it reads where its line is known."""
    code, _, rule = message.partition(":")
    return f"{code} line {line}:{rule}"
