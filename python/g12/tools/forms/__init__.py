# SPDX-License-Identifier: GPL-2.0-or-later
"""The forms of the cycles: one table, ngcgui's files and the Cycles page made from it."""
