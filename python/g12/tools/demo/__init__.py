# SPDX-License-Identifier: GPL-2.0-or-later
"""The manuals' programs: run on a headless LinuxCNC, drawn and measured."""
