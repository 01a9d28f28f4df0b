# SPDX-License-Identifier: GPL-2.0-or-later
"""What of a part stands while a program cuts it, at any of its moves and any Z level."""
