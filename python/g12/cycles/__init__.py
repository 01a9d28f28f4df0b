# SPDX-License-Identifier: GPL-2.0-or-later
"""The planners of the cycles: words and modes in, a request for the NGC sub out."""
