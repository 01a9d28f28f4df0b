# SPDX-License-Identifier: GPL-2.0-or-later
"""Preconditions of a cut and of a program: one small function each, its sentence beside it."""
