# SPDX-License-Identifier: GPL-2.0-or-later
"""One section of interpolation in a program: the meaning of its lines, blocks and modes.

Text and values only: the interpreter parses, this room decides what a section allows and what its
words mean.
"""
