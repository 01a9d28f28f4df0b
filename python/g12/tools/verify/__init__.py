# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether pockets, shapes and sections come out as programmed, judged from the words alone."""
