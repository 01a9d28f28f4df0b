# SPDX-License-Identifier: GPL-2.0-or-later
"""Machines of whose package one function does something else, inside the interpreter."""

import importlib
import inspect
import sys
from pathlib import Path
from types import SimpleNamespace

TESTS = Path(__file__).parents[1]
TOPLEVEL = """\
import sys
sys.path.append({tests!r})
import remap
from support.faulty_machines import put_in
put_in({function!r}, {does!r})
"""


def with_fault(ini, function, does, folder):
    """Return a machine, by a TOPLEVEL in a folder.

    ``function`` is a dotted name, ``does`` the body of a Python function, in which ``a`` has the
    arguments by name and ``original()`` calls the sound one with them.
    """
    toplevel = folder / "toplevel.py"
    toplevel.write_text(TOPLEVEL.format(tests=str(TESTS), function=function, does=does))
    return ini.replaced({"PYTHON": {"TOPLEVEL": str(toplevel)}})


def put_in(function, does):
    """Replace a function wherever a module holds it; LinuxCNC runs a TOPLEVEL more than once."""
    module, name = function.rsplit(".", 1)
    original = getattr(importlib.import_module(module), name)
    if hasattr(original, "sound"):
        return
    broken = faulty(original, does)
    broken.sound = original
    for module in list(sys.modules.values()):
        if vars(module).get(name) is original:
            setattr(module, name, broken)


def faulty(original, does):
    """Return a function that does something else."""
    names = dict(original.__globals__)
    body = does.replace("\n", "\n  ")
    exec(f"def fault(original, a):\n  {body}", names)
    signature = inspect.signature(original)

    def broken(*args, **kwargs):
        bound = signature.bind(*args, **kwargs)
        a = SimpleNamespace(**bound.arguments)

        def sound():
            bound.arguments.update(vars(a))
            return original(*bound.args, **bound.kwargs)

        return names["fault"](sound, a)

    return broken
