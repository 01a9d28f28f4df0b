# SPDX-License-Identifier: GPL-2.0-or-later
"""A section of interpolation in the interpreter: reading ahead, planning, execution as motion."""
