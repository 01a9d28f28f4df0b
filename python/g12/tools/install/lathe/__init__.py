# SPDX-License-Identifier: GPL-2.0-or-later
"""What a lathe's config needs besides: kinematics of the face, a spindle that becomes C."""
