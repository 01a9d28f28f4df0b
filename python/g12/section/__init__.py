# SPDX-License-Identifier: GPL-2.0-or-later
"""One section of interpolation in a program: what its lines, blocks and modes mean.

Pure text and values: the interpreter parses; this room decides what a section allows, and what it
means.
"""
