# SPDX-License-Identifier: GPL-2.0-or-later
"""The Cycles page in Qt: a tab of QtVCP's screens and of Probe Basic, or a window of its own."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

from qtpy.QtCore import QPoint, QPointF, QSize, Qt, Signal
from qtpy.QtGui import QColor, QIcon, QPainter, QPen, QPixmap, QPolygonF
from qtpy.QtWidgets import (
    QComboBox,
    QFileDialog,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QListWidget,
    QMenu,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
    QWidgetAction,
)

from g12.tools.cycles_page.page import Page, choice_of
from g12.tools.cycles_page.sketch import READY, Sketch, fitted
from g12.tools.cycles_page.steps import number_text
from g12.tools.cycles_page.view import (
    COLOURS,
    KEYS,
    StepButtons,
    hint_of,
    label_of,
    picture_of,
    pressed,
    tool_text,
)
from g12.tools.forms.table import CHOICE, Entry

THUMBNAIL = 120, 90  # pixels


class Drawing(QWidget):
    """The sketch of the form: the cutter's sweep, the toolpath, rapids dashed."""

    def __init__(self) -> None:
        super().__init__()
        self.sketch = Sketch(READY, "")
        self.setMinimumSize(200, 200)

    def paintEvent(self, _event) -> None:  # noqa: N802 - Qt's name
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(COLOURS["ground"]))
        painter.setRenderHint(QPainter.Antialiasing)
        scale = fitted(self.sketch, self.width(), self.height())
        swept = QPen(QColor(COLOURS["swept"]), 2 * self.sketch.radius * scale.factor)
        swept.setCapStyle(Qt.RoundCap)
        swept.setJoinStyle(Qt.RoundJoin)
        path, rapid = QPen(QColor(COLOURS["path"]), 1.4), QPen(QColor(COLOURS["rapid"]), 1)
        rapid.setStyle(Qt.DashLine)
        for pen, wants_rapid in ((swept, False), (rapid, True), (path, False)):
            painter.setPen(pen)
            for line in self.sketch.lines:
                if line.is_rapid == wants_rapid:
                    points = [QPointF(*point) for point in scale.pixels(line.points)]
                    painter.drawPolyline(QPolygonF(points))


class CyclesView(StepButtons, QWidget):
    """The page; ``opened`` is called with the path of a program to open."""

    arrived = Signal()

    def __init__(self, ini: str, opened: Callable[[str], None], parent=None) -> None:
        super().__init__(parent)
        self.opened = opened
        self.arrived.connect(self._show_sketch)
        self.page = Page(ini, self.arrived.emit)
        self._build()
        self._select(0)

    def closeEvent(self, event) -> None:  # noqa: N802 - Qt's name
        self.page.close()
        super().closeEvent(event)

    def _build(self) -> None:
        self.cycles, self.grid, self.form = QComboBox(), QGridLayout(), QWidget()
        self.said, self.drawing, self.steps = QLabel(wordWrap=True), Drawing(), QListWidget()
        self.tool_label = QLabel(wordWrap=True)
        self.cycles.setIconSize(QSize(*THUMBNAIL))
        for form in self.page.forms:
            self.cycles.addItem(QIcon(str(picture_of(form, self.page.unit))), form.title)
        self.cycles.currentIndexChanged.connect(self._select)
        self.steps.currentRowChanged.connect(self._edit)
        self.form.setLayout(self.grid)
        scrolled = QScrollArea(widgetResizable=True)
        scrolled.setWidget(self.form)
        left, right = QVBoxLayout(), QVBoxLayout()
        left.addWidget(self.cycles)
        left.addWidget(scrolled, 1)
        left.addWidget(self.tool_label)
        left.addWidget(self.said)
        left.addLayout(self._buttons((("Add", self._add), ("Replace", self._replace))))
        up, down = partial(self._move, -1), partial(self._move, 1)
        right.addWidget(self.drawing, 3)
        right.addWidget(self.steps, 1)
        right.addLayout(self._buttons((("▲", up), ("▼", down), ("Delete", self._delete))))
        files = ("Load", self._load), ("Save", self._save), ("Open", self._open)
        right.addLayout(self._buttons(files))
        box = QHBoxLayout(self)
        box.addLayout(left, 2)
        box.addLayout(right, 3)

    def _buttons(self, named) -> QHBoxLayout:
        row = QHBoxLayout()
        for name, action in named:
            button = QPushButton(name)
            button.setObjectName(name)
            button.clicked.connect(partial(self._try, action))
            row.addWidget(button)
        return row

    # The form.

    def _select(self, row: int) -> None:
        if 0 <= row < len(self.page.forms):
            self.page.select(self.page.forms[row])
            self._show_form()

    def _show_form(self) -> None:
        while self.grid.count():
            self.grid.takeAt(0).widget().deleteLater()
        self.widgets = {}
        for row, entry in enumerate(self.page.form.entries):
            self.grid.addWidget(QLabel(label_of(entry, self.page.unit)), row, 0)
            self.widgets[entry.name] = self._widget(entry)
            self.grid.addWidget(self.widgets[entry.name], row, 1)
        self._show_sketch()

    def _widget(self, entry: Entry) -> QWidget:
        text = self.page.texts[entry.name]
        if entry.kind == CHOICE:
            box = QComboBox()
            box.addItems([words for _, words in entry.choices])
            box.setCurrentIndex(choice_of(entry, text))
            box.currentIndexChanged.connect(
                lambda at: self.page.type(entry.name, number_text(entry.choices[at][0]))
            )
            return box
        line = QLineEdit(text)
        line.setObjectName(entry.name)
        line.setToolTip(hint_of(entry))
        opening = line.addAction(self._dots(), QLineEdit.LeadingPosition)
        opening.triggered.connect(partial(self._keypad, line))
        line.textChanged.connect(partial(self.page.type, entry.name))
        return line

    @staticmethod
    def _dots() -> QIcon:
        """Return the sign of a keypad."""
        pixmap = QPixmap(16, 16)
        pixmap.fill(Qt.transparent)
        painter = QPainter(pixmap)
        painter.setPen(QPen(QColor("#667"), 3))
        painter.drawPoints([QPoint(x, y) for x in (3, 8, 13) for y in (3, 8, 13)])
        painter.end()
        return QIcon(pixmap)

    def _keypad(self, line: QLineEdit, *_pressed) -> None:
        """Open a keypad at an entry, for a screen without a keyboard."""
        menu, keys, grid = QMenu(line), QWidget(), QGridLayout()
        for row, named in enumerate(KEYS):
            for column, key in enumerate(named):
                button = QPushButton(key)
                button.clicked.connect(partial(self._press, line, key))
                grid.addWidget(button, row, column)
        keys.setLayout(grid)
        holder = QWidgetAction(menu)
        holder.setDefaultWidget(keys)
        menu.addAction(holder)
        menu.popup(line.mapToGlobal(QPoint(0, line.height())))

    @staticmethod
    def _press(line: QLineEdit, key: str, *_clicked) -> None:
        line.setText(pressed(line.text(), key))

    def _show_sketch(self) -> None:
        self._say(self.page.sketch.state, self.page.sketch.text)
        self.tool_label.setText(tool_text(self.page))
        for entry in self.page.form.entries if self.page.forms else ():
            self.widgets[entry.name].setEnabled(self.page.shown(entry))
        self.drawing.sketch = self.page.sketch
        self.drawing.update()

    def _say(self, state: str, text: str) -> None:
        self.said.setText(text)
        self.said.setStyleSheet(f"background:{COLOURS[state]};color:white;padding:6px")

    # The steps.

    def _show_steps(self, row: int) -> None:
        self.steps.blockSignals(True)
        self.steps.clear()
        for number, step in enumerate(self.page.steps, 1):
            self.steps.addItem(f"{number}  {step.form.title}")
        self.steps.setCurrentRow(row)
        self.steps.blockSignals(False)
        self.edited = row if 0 <= row < len(self.page.steps) else None

    def _edit(self, row: int) -> None:
        if 0 <= row < len(self.page.steps):
            self.edited = row
            self.page.select(self.page.steps[row].form, self.page.steps[row])
            self._show_form()

    def _load(self) -> None:
        name, _ = QFileDialog.getOpenFileName(self, "Load", str(self.page.program_path().parent))
        if name:
            self.page.load(Path(name))
            self._show_steps(-1)

    def _save(self) -> None:
        name, _ = QFileDialog.getSaveFileName(self, "Save", str(self.page.program_path()))
        if name:
            self.page.save(Path(name))
