# SPDX-License-Identifier: GPL-2.0-or-later
"""Faults of functions of the package, inside the interpreter that runs them.

A table names a ``function`` and what it ``does``: the body of a Python function, in which ``a`` has
the arguments by name and ``original()`` calls the sound one with them, or the G-code that the
interpreter executes ``before`` or ``after`` it.
"""

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
from support.function_faults import put_in
put_in({fault!r})
"""


def with_fault(ini, fault, folder):
    """Return a machine whose interpreter has a fault, by a TOPLEVEL in a folder."""
    toplevel = folder / "toplevel.py"
    toplevel.write_text(TOPLEVEL.format(tests=str(TESTS), fault=dict(fault)))
    return ini.replaced({"PYTHON": {"TOPLEVEL": str(toplevel)}})


def put_in(fault):
    """Replace a function wherever a module holds it; LinuxCNC runs a TOPLEVEL more than once."""
    holder, name = found(fault["function"])
    original = getattr(holder, name)
    if hasattr(original, "sound"):
        return
    broken = faulty(original, fault)
    broken.sound = original
    setattr(holder, name, broken)
    for module in list(sys.modules.values()):
        if vars(module).get(name) is original:
            setattr(module, name, broken)


def found(path):
    """Return the module or class that a dotted path's last name is in, and that name."""
    parts = path.split(".")
    at = next(k for k, part in enumerate(parts) if not module_named(".".join(parts[: k + 1])))
    holder = sys.modules[".".join(parts[:at])]
    for part in parts[at:-1]:
        holder = getattr(holder, part)
    return holder, parts[-1]


def module_named(name):
    """Tell whether there is a module of that name."""
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError:
        return None


def faulty(original, fault):
    """Return a function that does something else."""
    names = dict(original.__globals__)
    body = fault.get("does", "return original()").replace("\n", "\n  ")
    exec(f"def fault(original, a):\n  {body}", names)
    signature = inspect.signature(original)

    def broken(*args, **kwargs):
        bound = signature.bind(*args, **kwargs)
        a = SimpleNamespace(**bound.arguments)

        def sound():
            bound.arguments.update(vars(a))
            return original(*bound.args, **bound.kwargs)

        executed(args, fault.get("before"))
        value = names["fault"](sound, a)
        executed(args, fault.get("after"))
        return value

    return broken


def executed(args, code):
    """Let the interpreter, the first argument or what that holds, execute a block."""
    if code:
        getattr(args[0], "interp", args[0]).execute(code)
