# SPDX-License-Identifier: GPL-2.0-or-later
"""Words that are most likely a mistake, or that a user should know of: rules of their own.

The cut may be made as its words command, and the words be wrong.
"""
