# SPDX-License-Identifier: GPL-2.0-or-later
"""Programs of other controls as LinuxCNC programs: text in, text out.

The steps of a program: `blocks.lexer` (blocks of words) → `structure` (which lines are the main
program and which its subprograms) → `follow` (every block with the modal state that it is reached
in, through calls and loops) → `rules` (one file each: words in, words out, or a refusal) → `output`
(lines). What a code means on a control is data: ``controls/*.toml``, read by `blocks.control`.
"""
