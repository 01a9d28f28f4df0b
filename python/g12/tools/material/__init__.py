# SPDX-License-Identifier: GPL-2.0-or-later
"""The remaining material of a part at any move of a program and any Z level."""
