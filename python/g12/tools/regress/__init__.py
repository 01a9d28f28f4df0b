# SPDX-License-Identifier: GPL-2.0-or-later
"""Recordings of what programs do, and what changed."""
