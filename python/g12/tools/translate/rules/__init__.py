# SPDX-License-Identifier: GPL-2.0-or-later
"""The rules of the translation, one file each; `phases` has their order."""
