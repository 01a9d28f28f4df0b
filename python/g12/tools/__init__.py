# SPDX-License-Identifier: GPL-2.0-or-later
"""What runs outside LinuxCNC: commands, and the trades they are made of.

Nothing that cuts needs this folder.
"""
