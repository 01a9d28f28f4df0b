# SPDX-License-Identifier: GPL-2.0-or-later
"""What is judged: the cuts, the traced program, the material, and a finding as data."""
