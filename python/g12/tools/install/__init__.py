# SPDX-License-Identifier: GPL-2.0-or-later
"""The package in a machine's config: state, problems, changes."""
