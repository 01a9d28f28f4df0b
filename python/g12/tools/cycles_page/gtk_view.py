# SPDX-License-Identifier: GPL-2.0-or-later
"""The Cycles page in GTK: a GladeVCP tab of AXIS, gmoccapy and Touchy, or a window of its own.

GladeVCP loads this file as the handler of `configs/include/cycles.ui`.
"""

import os
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3]))

import gi

gi.require_version("Gtk", "3.0")
from gi.repository import Gdk, GdkPixbuf, GLib, Gtk, Pango

from g12.tools.cycles_page.opening import open_in_linuxcnc
from g12.tools.cycles_page.page import Page, choice_of
from g12.tools.cycles_page.sketch import fitted
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

THUMBNAIL, FORM_WIDTH, DRAWING = 80, 200, (120, 150)  # pixels; the last two at least
CHOICE_WIDTH = 7  # letters
DASH = (4, 3)  # of a rapid


def rgb(name: str) -> tuple[float, float, float]:
    colour = Gdk.RGBA()
    colour.parse(COLOURS[name])
    return colour.red, colour.green, colour.blue


class CyclesView(StepButtons, Gtk.Box):
    """The page; ``opened`` is called with the path of a program to open."""

    def __init__(self, ini: str, opened: Callable[[str], None]) -> None:
        super().__init__(spacing=6)
        self.opened = opened
        self.widgets: dict[str, Gtk.Widget] = {}
        self.page = Page(ini, lambda: GLib.idle_add(self._show_sketch))
        self.connect("destroy", lambda *_: self.page.close())
        self._build()
        if self.page.forms:
            self.cycles.set_active(0)

    def _build(self) -> None:
        self.cycles, self.steps = Gtk.ComboBox(), Gtk.ListBox()
        self.grid = Gtk.Grid(column_spacing=6, row_spacing=1)
        self.tool_label = Gtk.Label(xalign=0, wrap=True)
        self.said = Gtk.Label(xalign=0, wrap=True, max_width_chars=30)
        self.drawing = Gtk.DrawingArea()
        self.drawing.set_size_request(*DRAWING)
        self.drawing.connect("draw", self._draw)
        self._offer_forms()
        self.steps.connect("row-activated", lambda _, row: self._edit(row.get_index()))
        form, right = (Gtk.Box(orientation=Gtk.Orientation.VERTICAL, spacing=4) for _ in "12")
        left = Gtk.Box(orientation=Gtk.Orientation.VERTICAL, spacing=4)
        for part in (self.grid, self.tool_label):
            form.pack_start(part, False, False, 0)
        left.pack_start(self.cycles, False, False, 0)
        left.pack_start(self._scrolled(form, width=FORM_WIDTH), True, True, 0)
        left.pack_start(self.said, False, False, 0)
        for (name, action), box in self._actions(left, right):
            button = Gtk.Button(label=name)
            button.connect("clicked", partial(self._try, action))
            box.pack_start(button, True, True, 0)
        right.pack_start(self.drawing, True, True, 0)
        right.pack_start(self._scrolled(self.steps, height=60), False, True, 0)
        self.pack_start(left, False, False, 0)
        self.pack_start(right, True, True, 0)

    def _offer_forms(self) -> None:
        """Fill the choice of cycles: a picture and a name each."""
        model, pictures, names = (
            Gtk.ListStore(GdkPixbuf.Pixbuf, str),
            Gtk.CellRendererPixbuf(),
            Gtk.CellRendererText(wrap_width=90),
        )
        for form in self.page.forms:
            picture = str(picture_of(form, self.page.unit))
            small = GdkPixbuf.Pixbuf.new_from_file_at_size(picture, THUMBNAIL, THUMBNAIL)
            model.append([small, form.title])
        self.cycles.set_model(model)
        for renderer, kind, column in ((pictures, "pixbuf", 0), (names, "text", 1)):
            self.cycles.pack_start(renderer, False)
            self.cycles.add_attribute(renderer, kind, column)
        self.cycles.connect("changed", self._selected)

    def _actions(self, left: Gtk.Box, right: Gtk.Box):
        """Yield each button's name, what it does, and the row that it stands in."""
        form, steps = Gtk.Box(), Gtk.Box()
        left.pack_end(form, False, False, 0)
        right.pack_end(steps, False, False, 0)
        yield from (
            ((name, do), form) for name, do in (("Add", self._add), ("Replace", self._replace))
        )
        files = Gtk.Box()
        right.pack_end(files, False, False, 0)
        yield ("▲", partial(self._move, -1)), steps
        yield ("▼", partial(self._move, 1)), steps
        yield ("✕", self._delete), steps
        yield ("Load", self._load), files
        yield ("Save", self._save), files
        yield ("Open", self._open), files

    @staticmethod
    def _scrolled(child: Gtk.Widget, width: int = -1, height: int = -1) -> Gtk.ScrolledWindow:
        window = Gtk.ScrolledWindow()
        window.set_size_request(width, height)
        window.set_policy(Gtk.PolicyType.NEVER, Gtk.PolicyType.AUTOMATIC)
        window.add(child)
        return window

    # The form.

    def _selected(self, _choice) -> None:
        self.page.select(self.page.forms[self.cycles.get_active()])
        self._show_form()

    def _show_form(self) -> None:
        for child in self.grid.get_children():
            self.grid.remove(child)
        for row, entry in enumerate(self.page.form.entries):
            label = Gtk.Label(label=label_of(entry, self.page.unit), xalign=0)
            self.widgets[entry.name] = self._widget(entry)
            self.grid.attach(label, 0, row, 1, 1)
            self.grid.attach(self.widgets[entry.name], 1, row, 1, 1)
        self.grid.show_all()
        self._show_sketch()

    def _widget(self, entry: Entry) -> Gtk.Widget:
        text = self.page.texts[entry.name]
        if entry.kind == CHOICE:
            box = Gtk.ComboBoxText()
            for _, words in entry.choices:
                box.append_text(words)
            (shown,) = box.get_cells()
            shown.set_properties(ellipsize=Pango.EllipsizeMode.END, width_chars=CHOICE_WIDTH)
            box.set_active(choice_of(entry, text))
            box.connect("changed", partial(self._chosen, entry))
            return box
        line = Gtk.Entry(text=text, width_chars=7, max_width_chars=7, xalign=1)
        line.set_tooltip_text(hint_of(entry))
        line.set_icon_from_icon_name(Gtk.EntryIconPosition.PRIMARY, "input-dialpad-symbolic")
        line.connect("icon-press", lambda widget, *_: self._keypad(widget))
        line.connect("changed", lambda widget: self.page.type(entry.name, widget.get_text()))
        return line

    def _keypad(self, line: Gtk.Entry) -> None:
        """Open a keypad at an entry, for a screen without a keyboard."""
        popover, keys = Gtk.Popover(relative_to=line), Gtk.Grid()
        for row, named in enumerate(KEYS):
            for column, key in enumerate(named):
                button = Gtk.Button(label=key)
                button.connect(
                    "clicked", lambda _, key: line.set_text(pressed(line.get_text(), key)), key
                )
                keys.attach(button, column, row, 1, 1)
        popover.add(keys)
        popover.show_all()

    def _chosen(self, entry: Entry, box: Gtk.ComboBoxText) -> None:
        self.page.type(entry.name, number_text(entry.choices[box.get_active()][0]))

    def _show_sketch(self) -> None:
        self._say(self.page.sketch.state, self.page.sketch.text)
        self.tool_label.set_text(tool_text(self.page))
        for entry in self.page.form.entries if self.page.forms else ():
            if entry.name in self.widgets:
                self.widgets[entry.name].set_sensitive(self.page.shown(entry))
        self.drawing.queue_draw()

    def _say(self, state: str, text: str) -> None:
        escaped = GLib.markup_escape_text(text or " ")
        colours = f'background="{COLOURS[state]}" foreground="white"'
        self.said.set_markup(f"<span {colours}> {escaped} </span>")

    def _draw(self, area: Gtk.DrawingArea, cairo) -> None:
        width, height = area.get_allocated_width(), area.get_allocated_height()
        sketch = self.page.sketch
        scale = fitted(sketch, width, height)
        cairo.set_source_rgb(*rgb("ground"))
        cairo.paint()
        cairo.set_line_cap(1)  # round, as the joins
        cairo.set_line_join(1)
        swept = max(2 * sketch.radius * scale.factor, 0.1)
        for name, pen, wants_rapid in (
            ("swept", swept, False),
            ("rapid", 1, True),
            ("path", 1.3, False),
        ):
            cairo.set_source_rgb(*rgb(name))
            cairo.set_line_width(pen)
            cairo.set_dash(DASH if wants_rapid else ())
            for line in sketch.lines:
                if line.is_rapid == wants_rapid:
                    first, *rest = scale.pixels(line.points)
                    cairo.move_to(*first)
                    for point in rest:
                        cairo.line_to(*point)
            cairo.stroke()

    # The steps.

    def _show_steps(self, row: int) -> None:
        for child in self.steps.get_children():
            self.steps.remove(child)
        for number, step in enumerate(self.page.steps, 1):
            self.steps.add(Gtk.Label(label=f"{number}  {step.form.title}", xalign=0))
        self.steps.show_all()
        self.edited = row if 0 <= row < len(self.page.steps) else None
        if self.edited is not None:
            self.steps.select_row(self.steps.get_row_at_index(row))

    def _edit(self, row: int) -> None:
        self.edited = row
        self.page.select(self.page.steps[row].form, self.page.steps[row])
        self._show_form()

    def _load(self) -> None:
        name = self._ask_file(Gtk.FileChooserAction.OPEN)
        if name:
            self.page.load(Path(name))
            self._show_steps(-1)

    def _save(self) -> None:
        name = self._ask_file(Gtk.FileChooserAction.SAVE)
        if name:
            self.page.save(Path(name))

    def _ask_file(self, action: Gtk.FileChooserAction) -> str | None:
        chooser = Gtk.FileChooserNative(action=action, transient_for=self.get_toplevel())
        chooser.set_current_folder(str(self.page.program_path().parent))
        if action == Gtk.FileChooserAction.SAVE:
            chooser.set_current_name(self.page.program_path().name)
        return chooser.get_filename() if chooser.run() == Gtk.ResponseType.ACCEPT else None


def get_handlers(_halcomp, builder, _useropts) -> list:
    """Put the page into the window of GladeVCP, which asks for its handlers."""
    window = builder.get_object("window1")
    window.remove(window.get_child())
    view = CyclesView(os.environ["INI_FILE_NAME"], open_in_linuxcnc)
    window.add(view)
    view.show_all()
    return []
