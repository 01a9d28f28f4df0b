# SPDX-License-Identifier: GPL-2.0-or-later
"""A machine's config: its lines, what the interpreter makes of it, what is found in it."""
