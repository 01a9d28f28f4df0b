# SPDX-License-Identifier: GPL-2.0-or-later
"""The Cycles page in Qt: a tab of Probe Basic, or a widget of any screen in Qt."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from qtpy import QtGui, QtWidgets
from qtpy.QtCore import QPoint, QPointF, QSize, Qt, Signal
from qtpy.QtWidgets import (
    QHBoxLayout,
    QLabel,
    QLayout,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from g12.tools.cycles_page.page import Page
from g12.tools.cycles_page.view import COLOURS, KEYS, View, pressed
from g12.tools.forms.table import CHOICE, TOOL, Entry

THUMBNAIL, DRAWING, ENTRY = QSize(80, 60), (200, 200), 110  # pixels; the second at least
LETTERS, SHORTENED = 3, QtWidgets.QComboBox.AdjustToMinimumContentsLengthWithIcon
ROWS = ("Add", "Replace"), ("▲", "▼", "✕"), ("Load", "Save", "Open")
KEYPAD = QtWidgets.QStyle.SP_FileDialogListView  # its icon


def packed(box: QLayout, *parts: tuple[QWidget | QLayout, int]) -> QLayout:
    """Return a row or a column with widgets and layouts, each with its share of what is left."""
    for part, share in parts:
        add = box.addWidget if isinstance(part, QWidget) else box.addLayout
        add(part, share)
    return box


class Drawing(QWidget):
    """The sketch of the form: the cutter's sweep, the toolpath, rapids dashed."""

    def __init__(self, page: Page) -> None:
        super().__init__()
        self.page = page
        self.setMinimumSize(*DRAWING)

    def paintEvent(self, _event) -> None:  # noqa: N802 - Qt's name
        painter = QtGui.QPainter(self)
        painter.fillRect(self.rect(), QtGui.QColor(COLOURS["ground"]))
        painter.setRenderHint(QtGui.QPainter.Antialiasing)
        for name, width, lines in self.page.sketch.strokes(self.width(), self.height()):
            style = Qt.DashLine if name == "rapid" else Qt.SolidLine
            painter.setPen(
                QtGui.QPen(QtGui.QColor(COLOURS[name]), width, style, Qt.RoundCap, Qt.RoundJoin)
            )
            for points in lines:
                painter.drawPolyline(QtGui.QPolygonF([QPointF(*point) for point in points]))


class CyclesView(View, QWidget):
    """The page; ``opened`` is called with the path of a program to open."""

    arrived = Signal()

    def __init__(self, ini: str, opened: Callable[[str], None], parent=None) -> None:
        super().__init__(parent)
        self.opened, self.widgets = opened, {}
        self.arrived.connect(self._show_sketch)
        self.page = Page(ini, self.arrived.emit)
        self.destroyed.connect(self.page.close)
        self.cycles, self.grid, form = QtWidgets.QComboBox(), QtWidgets.QGridLayout(), QWidget()
        self.cycles.setIconSize(THUMBNAIL)
        for each in self.page.forms:
            self.cycles.addItem(QtGui.QIcon(self._picture(each)), each.title)
        self.cycles.currentIndexChanged.connect(self._select)
        form.setLayout(self.grid)
        scrolled = QtWidgets.QScrollArea(widgetResizable=True)
        scrolled.setWidget(form)
        self.tool_label, self.said = QLabel(wordWrap=True), QLabel(wordWrap=True)
        self.drawing, self.steps = Drawing(self.page), QtWidgets.QListWidget()
        self.steps.itemClicked.connect(lambda item: self._edit(self.steps.row(item)))
        adding, moving, files = (self._row(names) for names in ROWS)
        left = (self.cycles, 0), (scrolled, 1), (self.said, 0), (adding, 0)
        right = (self.drawing, 3), (self.steps, 1), (moving, 0), (files, 0)
        columns = (packed(QVBoxLayout(), *left), 2), (packed(QVBoxLayout(), *right), 3)
        packed(QHBoxLayout(self), *columns)
        self._show_form()

    def _row(self, names: Sequence[str]) -> QLayout:
        buttons = [QPushButton(name, objectName=name) for name in names]
        for button in buttons:
            button.clicked.connect(partial(self._try, self._buttons()[button.text()]))
        return packed(QHBoxLayout(), *((button, 1) for button in buttons))

    def _show_form(self) -> None:
        while self.grid.count():
            self.grid.takeAt(0).widget().setParent(None)
        for row, entry in enumerate(self.page.entries):
            self.widgets[entry.name] = self._widget(entry, self.page.texts[entry.name])
            self.grid.addWidget(QLabel(entry.caption(self.page.unit)), 2 * row, 0)
            self.grid.addWidget(self.widgets[entry.name], 2 * row, 1)
            if entry.kind == TOOL:
                self.grid.addWidget(self.tool_label, 2 * row + 1, 0, 1, 2)
        self._show_sketch()

    def _widget(self, entry: Entry, text: str) -> QWidget:
        if entry.kind == CHOICE:
            box = QtWidgets.QComboBox(minimumContentsLength=LETTERS, sizeAdjustPolicy=SHORTENED)
            box.addItems([words for _, words in entry.choices])
            box.setCurrentIndex(self._place(entry))
            box.currentIndexChanged.connect(partial(self._choose, entry))
            return box
        line = QLineEdit(text, objectName=entry.name, maximumWidth=ENTRY, alignment=Qt.AlignRight)
        line.setToolTip(entry.zero and f"0: {entry.zero}")
        opening = line.addAction(self.style().standardIcon(KEYPAD), QLineEdit.LeadingPosition)
        opening.triggered.connect(partial(self._keypad, line))
        line.textChanged.connect(partial(self.page.type, entry.name))
        return line

    @staticmethod
    def _keypad(line: QLineEdit, *_pressed) -> None:
        """Open a keypad at an entry, for a screen without a keyboard."""
        menu, keys, grid = QtWidgets.QMenu(line), QWidget(), QtWidgets.QGridLayout()
        for row, named in enumerate(KEYS):
            for column, key in enumerate(named):
                button = QPushButton(key)
                button.clicked.connect(lambda _, key=key: line.setText(pressed(line.text(), key)))
                grid.addWidget(button, row, column)
        keys.setLayout(grid)
        holder = QtWidgets.QWidgetAction(menu)
        holder.setDefaultWidget(keys)
        menu.addAction(holder)
        menu.popup(line.mapToGlobal(QPoint(0, line.height())))

    def _show_sketch(self) -> None:
        self._say(self.page.sketch.state, self.page.sketch.text)
        self.tool_label.setText(self._tool())
        for entry in self.page.entries:
            self.widgets[entry.name].setEnabled(self.page.shown(entry))
        self.drawing.update()

    def _say(self, state: str, text: str) -> None:
        self.said.setText(text)
        self.said.setStyleSheet(f"background:{COLOURS[state]};color:white;padding:6px")

    def _list_steps(self, titles: list[str], row: int) -> None:
        self.steps.clear()
        self.steps.addItems(titles)
        self.steps.setCurrentRow(row)

    def _ask_file(self, name: str, path: Path) -> str | None:
        ask = {
            "Load": QtWidgets.QFileDialog.getOpenFileName,
            "Save": QtWidgets.QFileDialog.getSaveFileName,
        }[name]
        return ask(self, name, str(path))[0]
