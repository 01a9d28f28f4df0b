# SPDX-License-Identifier: GPL-2.0-or-later
"""What a mill's program needs worked out: holes, their patterns, rigid taps."""
