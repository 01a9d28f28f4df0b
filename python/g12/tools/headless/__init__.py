# SPDX-License-Identifier: GPL-2.0-or-later
"""A real LinuxCNC without a screen, in namespaces of its own."""
