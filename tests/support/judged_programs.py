# SPDX-License-Identifier: GPL-2.0-or-later
"""Programs as verify judges them on a machine of configs/sim, and the measures of their cuts."""

from functools import cached_property

from g12.tools.machine.ini import read_ini
from g12.tools.material.stock import StockText
from g12.tools.verify.judge import judge
from g12.tools.verify.measures import kind_of, measures
from support.sim_machines import SIM

# Tests of motion leave out what a user's program needs around it.
PREPARATION = ("spindle", "no-tool", "ends-in-part", "plunge-fast", "stop-in-part", "m-code")


class Measured:
    """A cut with its measures."""

    def __init__(self, cut, judgement):
        self.cut, self.line, self.code, self.file = cut, cut.line, cut.code, cut.file
        self.values = measures(cut, judgement)

    @property
    def deviation(self):
        return self.values["deviation"]


class Proof:
    """A judgement with its cuts by kind; ``findings`` are those of the motion."""

    def __init__(self, judgement):
        self.judgement, self.program = judgement, judgement.program

    @property
    def findings(self):
        return [(each.line, each.text()) for each in self._of_motion]

    @property
    def finding_codes(self):
        return [each.code for each in self._of_motion for _ in each.lines]

    @property
    def _of_motion(self):
        found = (each for each in self.judgement.found if each.severity == "finding")
        return [each for each in found if each.code not in PREPARATION]

    @cached_property
    def cuts(self):
        found = {"pockets": [], "sections": [], "holes": [], "shapes": []}
        for cut in self.program.cuts:
            found[kind_of(cut)].append(Measured(cut, self.judgement))
        return found

    @property
    def pockets(self):
        return self.cuts["pockets"]

    @property
    def sections(self):
        return self.cuts["sections"]

    @property
    def shapes(self):
        return self.cuts["shapes"]

    @property
    def codes(self):
        """Every code with its lines, in order."""
        found = sorted((line, each.code) for each in self.judgement.found for line in each.lines)
        return ", ".join(f"{code} {line}" for line, code in found)


def prove(program, ini, **options):
    return Proof(judge(program, ini, **options))


def prove_lines(folder, lines, machine, changed=None, stock="", **more):
    """Return the proof of a program that ends after some lines; its file is written to a folder.

    ``changed`` are values of the INI in place of the machine's.
    """
    program = folder / "program.ngc"
    program.write_text("\n".join([*lines, "M2", ""]))
    ini = read_ini(SIM / f"{machine}_headless.ini").replaced(changed or {})
    return prove(program, ini, stock=StockText(stock) if stock else None, **more)
