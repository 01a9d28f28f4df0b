# SPDX-License-Identifier: GPL-2.0-or-later
"""What runs inside LinuxCNC's interpreter; the only room that imports its modules there."""
