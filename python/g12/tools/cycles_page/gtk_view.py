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
from gi.repository import Gdk, GdkPixbuf, GdkX11, GLib, Gtk, Pango  # noqa: F401 - GdkX11: xid

from g12.tools.cycles_page.machine import open_in_linuxcnc
from g12.tools.cycles_page.page import Page
from g12.tools.cycles_page.view import COLOURS, KEYS, SENTENCES, View, pressed
from g12.tools.forms.table import CHOICE, TOOL, Entry

THUMBNAIL, KEY, DASH = 56, 44, (4, 3)  # pixels: of a picture, of a key, of a rapid's dashes
CAPTION, LETTERS = 22, 7  # letters of a line beside an entry, of an entry
STYLE = "entry, combobox button { min-height: 24px; padding: 0 4px; }" + "".join(
    f"#{state} {{ background: {COLOURS[state]}; color: white; padding: 4px; }}"
    for state in SENTENCES
)


class CyclesView(View):
    """The page in the widgets of `cycles.ui`, which names a button as the page does."""

    def __init__(self, builder: Gtk.Builder, ini: str, opened: Callable[[str], None]) -> None:
        self.opened, self.widgets = opened, {}
        self.page = Page(ini, lambda: GLib.idle_add(self._show_sketch))
        style = Gtk.CssProvider()
        style.load_from_data(STYLE.encode())
        Gtk.StyleContext.add_provider_for_screen(Gdk.Screen.get_default(), style, 600)
        cycles, forms = map(builder.get_object, ("cycles", "forms"))
        self.grid, self.said = map(builder.get_object, ("entries", "said"))
        self.drawing, self.steps = map(builder.get_object, ("drawing", "steps"))
        for form in self.page.forms:
            file = self._picture(form), THUMBNAIL, THUMBNAIL
            forms.append([GdkPixbuf.Pixbuf.new_from_file_at_size(*file), form.title])
        cycles.set_active(0)
        cycles.connect("changed", lambda cycles: self._select(cycles.get_active()))
        for name, action in self._buttons().items():
            builder.get_object(name).connect("clicked", partial(self._try, action))
        self.steps.connect("row-activated", lambda _, row: self._edit(row.get_index()))
        self.drawing.connect("draw", self._draw)
        self.drawing.connect("destroy", lambda _: self.page.close())
        self.tool_label = Gtk.Label(xalign=1, ellipsize=Pango.EllipsizeMode.END)
        self._show_form()

    def _show_form(self) -> None:
        self.grid.foreach(self.grid.remove)
        for row, entry in enumerate(self.page.entries):
            caption = entry.caption(self.page.unit)
            label = Gtk.Label(label=caption, xalign=0, wrap=True, max_width_chars=CAPTION)
            self.widgets[entry.name] = self._widget(entry, self.page.texts[entry.name])
            self.grid.attach(label, 0, 2 * row, 1, 1)
            self.grid.attach(self.widgets[entry.name], 1, 2 * row, 1, 1)
            if entry.kind == TOOL:
                self.grid.attach(self.tool_label, 0, 2 * row + 1, 2, 1)
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
        line.set_tooltip_text(entry.zero and f"0: {entry.zero}")
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
                button = Gtk.Button(label=key, width_request=KEY, height_request=KEY)
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
        self.said.set_properties(name=state, label=text)

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
        self.steps.foreach(self.steps.remove)
        for title in titles:
            self.steps.add(Gtk.Label(label=title, xalign=0))
        self.steps.show_all()
        if row >= 0:
            self.steps.select_row(self.steps.get_row_at_index(row))

    def _ask_file(self, name: str, path: Path) -> str | None:
        action = {"Load": Gtk.FileChooserAction.OPEN, "Save": Gtk.FileChooserAction.SAVE}[name]
        chooser = Gtk.FileChooserNative(action=action, transient_for=self.drawing.get_toplevel())
        chooser.set_current_folder(str(path.parent))
        if name == "Save":
            chooser.set_current_name(path.name)
        return chooser.get_filename() if chooser.run() == Gtk.ResponseType.ACCEPT else None


def rgb(name: str) -> tuple[float, float, float]:
    colour = Gdk.RGBA()
    colour.parse(COLOURS[name])
    return colour.red, colour.green, colour.blue


def get_handlers(_halcomp, builder, _useropts) -> list:
    """Fill in the window of GladeVCP, which asks for its handlers."""
    CyclesView(builder, os.environ["INI_FILE_NAME"], open_in_linuxcnc)
    window = builder.get_object("window1")
    window.show_all()
    if "QTVCP_FORWARD_EVENTS_TO" in os.environ:  # QtVCP waits for it, GladeVCP 2.10 is silent
        GLib.idle_add(lambda: print(window.get_window().get_xid(), flush=True))
    return []
