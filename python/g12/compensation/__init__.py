# SPDX-License-Identifier: GPL-2.0-or-later
"""The programmed contour in a plane, its compensation, and what is wrong with it.

The plane is unrolled or turned onto the machine elsewhere; nothing here knows how.
"""
