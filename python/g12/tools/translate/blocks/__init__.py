# SPDX-License-Identifier: GPL-2.0-or-later
"""One block of a foreign program: its text, the modes around it, the definitions of its control."""
