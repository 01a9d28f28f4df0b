# SPDX-License-Identifier: GPL-2.0-or-later
"""The Cycles page as a tab of Probe Basic, which looks for tabs in [DISPLAY] USER_TABS_PATH."""

import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[4] / "python"))

from g12.tools.cycles_page.machine import open_in_linuxcnc
from g12.tools.cycles_page.qt_view import CyclesView


class UserTab(CyclesView):
    """The tab; its object's name is the tab's."""

    def __init__(self, parent=None) -> None:
        super().__init__(os.environ["INI_FILE_NAME"], open_in_linuxcnc, parent)
        self.setObjectName("CYCLES")
