# SPDX-License-Identifier: GPL-2.0-or-later
"""The package in a machine's config: what is there, what is wrong, what to change."""
