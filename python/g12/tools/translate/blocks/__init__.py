# SPDX-License-Identifier: GPL-2.0-or-later
"""One block of a foreign program: its text, the modes around it, what its control says of it."""
