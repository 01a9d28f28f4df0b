# SPDX-License-Identifier: GPL-2.0-or-later
"""Everything that runs outside LinuxCNC: the commands and the rooms that do their work.

A machine cuts without this folder.
"""
