# SPDX-License-Identifier: GPL-2.0-or-later
"""The input of a cycle or shape: words of its block, modes, tools, the machine's travel."""
