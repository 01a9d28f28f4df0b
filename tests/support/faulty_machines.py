# SPDX-License-Identifier: GPL-2.0-or-later
"""Machines whose package has a fault, inside the interpreter.

A table names a ``function`` and what it ``does``: the body of a Python function, in which ``a`` has
the arguments by name and ``original()`` calls the sound one with them, or the G-code that the
interpreter executes ``before`` or ``after`` it. Or it names a ``sub`` and a ``word`` in the place
of which another ``becomes`` part of each of its blocks.
"""

import importlib
import inspect
import re
import sys
from pathlib import Path
from types import SimpleNamespace

TESTS = Path(__file__).parents[1]
SUBS = TESTS.parent / "ngc"
TOPLEVEL = """\
import sys
sys.path.append({tests!r})
import remap
from support.faulty_machines import put_in
put_in({fault!r})
"""


def with_fault(ini, fault, folder):
    """Return a machine with a fault, by a TOPLEVEL or a sub in a folder."""
    if "sub" in fault:
        text = (SUBS / f"{fault['sub']}.ngc").read_text()
        text = re.sub(rf"\b{fault['word']}\b", fault["becomes"], text)
        (folder / f"{fault['sub']}.ngc").write_text(text)
        path = ini.get("RS274NGC", "SUBROUTINE_PATH")
        return ini.replaced({"RS274NGC": {"SUBROUTINE_PATH": f"{folder}:{path}"}})
    toplevel = folder / "toplevel.py"
    toplevel.write_text(TOPLEVEL.format(tests=str(TESTS), fault=dict(fault)))
    return ini.replaced({"PYTHON": {"TOPLEVEL": str(toplevel)}})


def put_in(fault):
    """Replace a function wherever a module holds it; LinuxCNC runs a TOPLEVEL more than once."""
    holder, name = found(fault["function"])
    original = vars(holder)[name]
    own = getattr(original, "fget", original)
    if hasattr(own, "sound"):
        return
    broken = faulty(own, fault)
    broken.sound = own
    setattr(holder, name, property(broken) if own is not original else broken)
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
