# SPDX-License-Identifier: GPL-2.0-or-later
"""What the lines of the user's file say: blocks, words and codes, with expressions worked out."""
