# SPDX-License-Identifier: GPL-2.0-or-later
"""Shapes on a face: what their calls ask for, what is measured of them, what is wrong with them."""
