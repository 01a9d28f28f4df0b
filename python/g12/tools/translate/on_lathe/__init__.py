# SPDX-License-Identifier: GPL-2.0-or-later
"""A mill's program on a lathe: on the face of a bar, or round it."""
