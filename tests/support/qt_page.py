# SPDX-License-Identifier: GPL-2.0-or-later
"""Open the Cycles page as Probe Basic does, add a step, draw it: qt_page.py INI PICTURE."""

import importlib.util
import os
import sys
import time
from pathlib import Path

from qtpy.QtWidgets import QApplication, QLineEdit

ini, picture = sys.argv[1:]
os.environ["INI_FILE_NAME"] = ini
folder = f"{Path(ini).resolve().parents[1]}/include/probe_basic/"  # USER_TABS_PATH
tab = os.listdir(folder)[0]
file = os.path.join(os.path.dirname(folder), tab, tab + ".py")
spec = importlib.util.spec_from_file_location("user_tab", file)
module = importlib.util.module_from_spec(spec)
spec.loader.exec_module(module)
app = QApplication([])
view = module.UserTab()
assert view.objectName() == "CYCLES"
view.resize(1100, 640)
view.show()


def wait(until):
    end = time.monotonic() + 240
    while not until() and time.monotonic() < end:
        app.processEvents()
        time.sleep(0.01)
    assert until()


wait(lambda: view.page.sketch.cut)
view.findChild(QLineEdit, "i").setText("5,5")
wait(lambda: view.page.texts["i"] == "5,5" and view.page.sketch.cut)
view._add()
assert view.steps.count() == 1
wait(lambda: view.said.text() == view.page.sketch.text)
assert view.grab().save(picture)
view.page.close()
