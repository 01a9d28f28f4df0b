# SPDX-License-Identifier: GPL-2.0-or-later
"""The flat contour: lines and arcs in a plane, their compensation, and what is wrong with them.

The plane is unrolled or turned onto the machine elsewhere; nothing here knows how.
"""
