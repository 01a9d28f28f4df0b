# SPDX-License-Identifier: GPL-2.0-or-later
"""Programs given as lines, as verify judges them on a machine of configs/sim."""

from g12.tools.machine.ini import read_ini
from g12.tools.material.stock import StockText
from g12.tools.verify.proof import prove
from support.sim_machines import SIM


def prove_lines(folder, lines, machine, changed=None, stock="", **more):
    """Return the proof of a program that ends after some lines; its file is written to a folder.

    ``changed`` are values of the INI in place of the machine's.
    """
    program = folder / "program.ngc"
    program.write_text("\n".join([*lines, "M2", ""]))
    ini = read_ini(SIM / f"{machine}_headless.ini").replaced(changed or {})
    return prove(program, ini, stock=StockText(stock) if stock else None, **more)
