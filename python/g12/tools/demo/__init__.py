# SPDX-License-Identifier: GPL-2.0-or-later
"""The manuals' programs shown: run on a headless LinuxCNC, drawn and measured."""
