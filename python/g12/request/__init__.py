# SPDX-License-Identifier: GPL-2.0-or-later
"""What a cycle or shape starts from: words of its block, modes and tools, travel. Pure."""
