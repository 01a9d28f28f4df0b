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

from g12.tools.cycles_page.machine import open_in_linuxcnc
from g12.tools.cycles_page.page import Page
from g12.tools.cycles_page.view import COLOURS, KEYS, SENTENCES, View, pressed
from g12.tools.forms.table import CHOICE, TOOL, Entry

THUMBNAIL, FORM_WIDTH, STEPS, DRAWING = 56, 290, 66, 140  # pixels; the last two at least
WINDOW = 900, 560  # pixels, where it is no tab
LETTERS, SENTENCE = 7, 34  # of an entry, of a line of the sentence
DASH = (4, 3)  # of a rapid
STYLE = "entry, combobox button { min-height: 24px; padding: 0 4px; }" + "".join(
    f"#{state} {{ background: {COLOURS[state]}; color: white; padding: 4px; }}"
    for state in SENTENCES
)


def packed(vertical: bool, *parts: tuple[Gtk.Widget, bool]) -> Gtk.Box:
    """Return a row or a column of widgets, each with whether it grows."""
    box = Gtk.Box(orientation=Gtk.Orientation(vertical), spacing=3)
    for part, grows in parts:
        box.pack_start(part, grows, True, 0)
    return box


def scrolled(child: Gtk.Widget, width: int, height: int) -> Gtk.ScrolledWindow:
    window = Gtk.ScrolledWindow(overlay_scrolling=False, hscrollbar_policy=Gtk.PolicyType.NEVER)
    window.set_size_request(width, height)
    window.add(child)
    return window


class CyclesView(View, Gtk.Box):
    """The page; ``opened`` is called with the path of a program to open."""

    def __init__(self, ini: str, opened: Callable[[str], None]) -> None:
        super().__init__(spacing=6)
        self.opened = opened
        self.widgets = {}
        self.page = Page(ini, lambda: GLib.idle_add(self._show_sketch))
        self.connect("destroy", lambda *_: self.page.close())
        style = Gtk.CssProvider()
        style.load_from_data(STYLE.encode())
        Gtk.StyleContext.add_provider_for_screen(Gdk.Screen.get_default(), style, 600)
        self.cycles, self.grid = self._choice_of_cycles(), Gtk.Grid(column_spacing=6)
        self.tool_label = Gtk.Label(xalign=1, ellipsize=Pango.EllipsizeMode.END)
        self.said = Gtk.Label(xalign=0, wrap=True, max_width_chars=SENTENCE)
        self.steps, self.drawing = Gtk.ListBox(), Gtk.DrawingArea()
        self.steps.connect("row-activated", lambda _, row: self._edit(row.get_index()))
        self.drawing.set_size_request(DRAWING, DRAWING)
        self.drawing.connect("draw", self._draw)
        adding, moving, files = map(self._row, self._buttons())
        form, steps = scrolled(self.grid, FORM_WIDTH, -1), scrolled(self.steps, -1, STEPS)
        left = (self.cycles, False), (form, True), (self.said, False), (adding, False)
        right = (self.drawing, True), (steps, False), (moving, False), (files, False)
        column = packed(True, *left)
        column.set_hexpand(False)  # whatever the entries ask for
        self.pack_start(column, False, False, 0)
        self.pack_start(packed(True, *right), True, True, 0)
        self._show_form()

    def _choice_of_cycles(self) -> Gtk.ComboBox:
        """Return the choice of cycles: a picture and a name each."""
        model = Gtk.ListStore(GdkPixbuf.Pixbuf, str)
        for form in self.page.forms:
            file = self._picture(form), THUMBNAIL, THUMBNAIL
            model.append([GdkPixbuf.Pixbuf.new_from_file_at_size(*file), form.title])
        box = Gtk.ComboBox(model=model)
        cells = (Gtk.CellRendererPixbuf(), "pixbuf"), (Gtk.CellRendererText(wrap_width=140), "text")
        for column, (cell, kind) in enumerate(cells):
            box.pack_start(cell, False)
            box.add_attribute(cell, kind, column)
        box.set_active(0)
        box.connect("changed", lambda box: self._select(box.get_active()))
        return box

    def _row(self, actions: dict[str, Callable[[], None]]) -> Gtk.Box:
        buttons = [Gtk.Button(label=name) for name in actions]
        for button, action in zip(buttons, actions.values()):
            button.connect("clicked", partial(self._try, action))
        return packed(False, *((button, True) for button in buttons))

    def _show_form(self) -> None:
        for child in self.grid.get_children():
            self.grid.remove(child)
        row = 0
        for entry in self.page.entries:
            label = Gtk.Label(label=self._label(entry), xalign=0)
            self.widgets[entry.name] = self._widget(entry, self.page.texts[entry.name])
            self.grid.attach(label, 0, row, 1, 1)
            self.grid.attach(self.widgets[entry.name], 1, row, 1, 1)
            row += 1
            if entry.kind == TOOL:
                self.grid.attach(self.tool_label, 0, row, 2, 1)
                row += 1
        self.grid.show_all()
        self._show_sketch()

    def _widget(self, entry: Entry, text: str) -> Gtk.Widget:
        if entry.kind == CHOICE:
            box = Gtk.ComboBoxText(hexpand=True)
            for _, words in entry.choices:
                box.append_text(words)
            box.get_cells()[0].set_property("ellipsize", Pango.EllipsizeMode.END)
            box.set_active(self._place(entry))
            box.connect("changed", lambda box: self._choose(entry, box.get_active()))
            return box
        line = Gtk.Entry(text=text, width_chars=LETTERS, xalign=1, halign=Gtk.Align.END)
        line.set_tooltip_text(self._hint(entry))
        line.set_icon_from_icon_name(Gtk.EntryIconPosition.PRIMARY, "input-dialpad-symbolic")
        line.connect("icon-press", lambda line, *_: self._keypad(line))
        line.connect("changed", lambda line: self.page.type(entry.name, line.get_text()))
        return line

    @staticmethod
    def _keypad(line: Gtk.Entry) -> None:
        """Open a keypad at an entry, for a screen without a keyboard."""
        popover, keys = Gtk.Popover(relative_to=line), Gtk.Grid()
        for row, named in enumerate(KEYS):
            for column, key in enumerate(named):
                button = Gtk.Button(label=key, width_request=44, height_request=40)
                button.connect(
                    "clicked", lambda _, key: line.set_text(pressed(line.get_text(), key)), key
                )
                keys.attach(button, column, row, 1, 1)
        popover.add(keys)
        popover.show_all()

    def _show_sketch(self) -> None:
        self._say(self.page.sketch.state, self.page.sketch.text)
        self.tool_label.set_text(self._tool())
        for entry in self.page.entries:
            self.widgets[entry.name].set_sensitive(self.page.shown(entry))
        self.drawing.queue_draw()

    def _say(self, state: str, text: str) -> None:
        self.said.set_name(state)
        self.said.set_text(text)

    def _draw(self, area: Gtk.DrawingArea, cairo) -> None:
        size = area.get_allocated_width(), area.get_allocated_height()
        cairo.set_source_rgb(*rgb("ground"))
        cairo.paint()
        cairo.set_line_cap(1)  # round, as the joins
        cairo.set_line_join(1)
        for name, pen, lines in self.page.sketch.strokes(*size):
            cairo.set_source_rgb(*rgb(name))
            cairo.set_line_width(pen)
            cairo.set_dash(DASH if name == "rapid" else ())
            for points in lines:
                cairo.new_sub_path()
                for point in points:
                    cairo.line_to(*point)
            cairo.stroke()

    def _list_steps(self, titles: list[str], row: int) -> None:
        for child in self.steps.get_children():
            self.steps.remove(child)
        for title in titles:
            self.steps.add(Gtk.Label(label=title, xalign=0))
        self.steps.show_all()
        if row >= 0:
            self.steps.select_row(self.steps.get_row_at_index(row))

    def _ask_file(self, name: str, path: Path) -> str | None:
        action = {"Load": Gtk.FileChooserAction.OPEN, "Save": Gtk.FileChooserAction.SAVE}[name]
        chooser = Gtk.FileChooserNative(action=action, transient_for=self.get_toplevel())
        chooser.set_current_folder(str(path.parent))
        if name == "Save":
            chooser.set_current_name(path.name)
        return chooser.get_filename() if chooser.run() == Gtk.ResponseType.ACCEPT else None


def rgb(name: str) -> tuple[float, float, float]:
    colour = Gdk.RGBA()
    colour.parse(COLOURS[name])
    return colour.red, colour.green, colour.blue


def get_handlers(_halcomp, builder, _useropts) -> list:
    """Put the page into the window of GladeVCP, which asks for its handlers."""
    window = builder.get_object("window1")
    window.remove(window.get_child())
    window.add(CyclesView(os.environ["INI_FILE_NAME"], open_in_linuxcnc))
    window.set_default_size(*WINDOW)
    window.show_all()
    return []
