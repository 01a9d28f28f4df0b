# SPDX-License-Identifier: GPL-2.0-or-later
"""The programmed contour in a plane, its compensation, and what is wrong with it.

How the plane lies on the machine, as a face or an unrolled cylinder, does not matter here.
"""
