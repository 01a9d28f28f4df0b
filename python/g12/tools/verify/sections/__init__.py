# SPDX-License-Identifier: GPL-2.0-or-later
"""Sections on a face or a cylinder: what is measured of them, and what is wrong with them."""
