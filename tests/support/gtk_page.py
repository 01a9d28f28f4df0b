# SPDX-License-Identifier: GPL-2.0-or-later
"""Open the Cycles page in GTK, add a step, write its picture: gtk_page.py INI PICTURE."""

import sys
from pathlib import Path

import gi

gi.require_version("Gtk", "3.0")
from gi.repository import Gdk, GLib, Gtk  # noqa: E402

from g12.tools.cycles_page.gtk_view import CyclesView  # noqa: E402

ini, picture = sys.argv[1:]
builder = Gtk.Builder.new_from_file(f"{Path(ini).parents[1]}/include/cycles.ui")
view = CyclesView(builder, ini, print)
window = builder.get_object("window1")
window.show_all()


def step():
    if not view.page.sketch.cut:
        return True
    view.widgets["i"].set_text("5,5")
    GLib.timeout_add(100, add)
    return False


def add():
    if view.page.texts["i"] != "5,5" or not view.page.sketch.cut:
        return True
    view._add()
    assert len(view.steps.get_children()) == 1
    GLib.timeout_add(200, save)
    return False


def save():
    shown = window.get_window()
    size = shown.get_width(), shown.get_height()
    Gdk.pixbuf_get_from_window(shown, 0, 0, *size).savev(picture, "png", [], [])
    window.destroy()
    Gtk.main_quit()
    return False


GLib.timeout_add(100, step)
GLib.timeout_add(240_000, Gtk.main_quit)
Gtk.main()
