# SPDX-License-Identifier: GPL-2.0-or-later
"""Open the Cycles page in Qt, add a step, write its picture: qt_page.py INI PICTURE."""

import sys
import time

from qtpy.QtWidgets import QApplication, QLineEdit

from g12.tools.cycles_page.qt_view import CyclesView

ini, picture = sys.argv[1:]
app = QApplication([])
opened = []
view = CyclesView(ini, opened.append)
view.resize(1100, 640)
view.show()


def wait(until):
    end = time.monotonic() + 20
    while not until() and time.monotonic() < end:
        app.processEvents()
        time.sleep(0.01)
    assert until()


wait(lambda: view.page.sketch.lines)
view.findChild(QLineEdit, "i").setText("7,5")
wait(lambda: view.page.texts["i"] == "7,5" and view.page.sketch.lines)
view._add()
assert view.steps.count() == 1
wait(lambda: view.drawing.sketch is view.page.sketch)
assert view.grab().save(picture)
view.close()
