# SPDX-License-Identifier: GPL-2.0-or-later
"""The Cycles page of a screen: cycles by picture, drawn by the interpreter as they are typed."""
