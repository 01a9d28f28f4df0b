# SPDX-License-Identifier: GPL-2.0-or-later
"""Exact traces of programs, by LinuxCNC's own preview."""
