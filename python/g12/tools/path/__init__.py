# SPDX-License-Identifier: GPL-2.0-or-later
"""Moves as paths in time, and the deviation of a run from them."""
