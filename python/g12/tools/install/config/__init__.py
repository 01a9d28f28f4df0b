# SPDX-License-Identifier: GPL-2.0-or-later
"""A machine's config: its lines, its loaded interpreter, the findings in it."""
