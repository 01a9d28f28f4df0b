# SPDX-License-Identifier: GPL-2.0-or-later
"""The [PYTHON]TOPLEVEL module: the user's own, which [G12] TOPLEVEL names, and then the handlers.

LinuxCNC finds handlers in ``remap``: the user's module or class, else the one beside this file.
"""

from g12.host.machine import users_toplevel

if users_toplevel():
    with open(users_toplevel(), "rb") as users_file:
        exec(compile(users_file.read(), users_toplevel(), "exec"))
if "remap" not in globals():
    import remap

from g12 import remap as handlers

for name in handlers.__all__:
    if not hasattr(remap, name):
        setattr(remap, name, getattr(handlers, name))
