# SPDX-License-Identifier: GPL-2.0-or-later
"""Recordings of programs' motion, and differences from them."""
