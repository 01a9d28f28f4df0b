# SPDX-License-Identifier: GPL-2.0-or-later
"""What LinuxCNC calls for each code: words and state in, a plan made, its motion handed over."""
