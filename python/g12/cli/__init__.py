# SPDX-License-Identifier: GPL-2.0-or-later
"""Commands that run outside LinuxCNC: traces, headless runs, plots, checks."""
