# SPDX-License-Identifier: GPL-2.0-or-later
"""Pictures of a program's toolpath and cut."""
