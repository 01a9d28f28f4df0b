# SPDX-License-Identifier: GPL-2.0-or-later
"""What a lathe's program needs worked out: contours, turning cycles, holes with C."""
