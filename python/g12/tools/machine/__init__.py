# SPDX-License-Identifier: GPL-2.0-or-later
"""The files of a machine as LinuxCNC reads them."""
