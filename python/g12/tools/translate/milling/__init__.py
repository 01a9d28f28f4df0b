# SPDX-License-Identifier: GPL-2.0-or-later
"""What a mill's program needs worked out: patterns of holes, a turned pattern."""
