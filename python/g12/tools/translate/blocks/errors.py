# SPDX-License-Identifier: GPL-2.0-or-later
"""What the translation refuses: a rule about a block, with the block's line added outside."""

LONGEST_EXCERPT = 24


class NotTranslated(ValueError):
    """A word or a code that is not understood; the message is a sentence without the line."""


def excerpt(text: str) -> str:
    return text if len(text) <= LONGEST_EXCERPT else f"{text[: LONGEST_EXCERPT - 1]}…"
