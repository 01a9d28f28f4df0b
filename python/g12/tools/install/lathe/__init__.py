# SPDX-License-Identifier: GPL-2.0-or-later
"""Additions to a lathe's config: kinematics of the face, a spindle that becomes C."""
