# SPDX-License-Identifier: GPL-2.0-or-later
"""What verify reports: findings and notes as data, their sentences, the tolerances."""
