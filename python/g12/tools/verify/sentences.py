# SPDX-License-Identifier: GPL-2.0-or-later
"""Every sentence of verify, by its code. A finding is a fault; a note is what a user should know.

Braces name a value of the finding; what follows the colon says how ``finding`` formats it.
"""

FINDINGS = {
    "path-off": "the {what} is {size:fine} off the toolpath that the words ask for, at {at:xyz}",
    "path-missing": "the {what} is not cut: it should end at {at:xyz}",
    "path-extra": "a move to {at:xyz} that the words do not ask for",
    "rapid": "the {what} goes by rapid, not at a feed, to {at:xyz}",
    "not-rapid": "the {what} goes at a feed, not by rapid, to {at:xyz}",
    "feed": "the {what} is cut at {made:feed}, not at {expected:feed}",
    "feed-mode": "the {what} has its feed {made}, not {expected}",
    "not-cut": "nothing is cut",
}
NOTES: dict[str, str] = {}
