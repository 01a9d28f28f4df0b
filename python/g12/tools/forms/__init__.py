# SPDX-License-Identifier: GPL-2.0-or-later
"""The forms of the cycles: the table that the Cycles page and `.ci/forms.py` read."""
