# SPDX-License-Identifier: GPL-2.0-or-later
"""What was made against what was expected: along the toolpath, and of the state around it."""
