# SPDX-License-Identifier: GPL-2.0-or-later
"""Files of every kind with random damage, in a shop, and the commands that read them."""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path
from random import Random

from g12.tools.commands import main
from g12.tools.translate.blocks.control import shipped_controls
from support.sim_machines import PROGRAMS, ROOT, SIM, copy_of_machines
from support.small_configs import TURNING, TURNING_HAL

PIECES = [
    b"", b"\0", b"\r", b"\n", b"\\", b"\\\n", b"\xff\xfe", b"\xe4", b"=", b"[", b"]", b"(", b"#",
    b'"', b"'", b"%", b"/", b";", b"-", b".", b"\t", b" ", b"e", b"nan", b"inf", b"1e400", b"-1e17",
    b"9" * 400, b"9" * 5000, b"0", b"-1", b"\xc2\x85", b"\xe2\x80\xa8", b"\xf4\x90\x80\x80",
    b"#INCLUDE ", b"#INCLUDE .\n", b"[RS274NGC]\n", b"[FILTER]\n", b"true", b"{}", b"[1, 2]",
    b"null", b"x" * 300, b"[" * 300, b"(" * 300, b"[" * 5000, b"$", b"~", b"..", b"/", b"\x1b[2J",
]  # fmt: skip
NUMBER = re.compile(rb"-?\d+(\.\d*)?|-?\.\d+")
NUMBERS = [
    b"9" * 5000, b"1e400", b"-1e17", b"nan", b"inf", b"0", b"-0", b"-1", b"1e-400", b"99999999999",
    b"4294967296", b"0x10", b"1_0", b"\xd9\xa3", b"1.2.3", b".", b"", b"1e9", b"0.0000001",
]  # fmt: skip
PINS = b"""\
velocity = "drive.velocity"
velocity_scale = 60
position = "drive.position"
holds = "drive.mode"
"""
VAR = b"5161\t1.0\n5220\t1.0\n5221\t10.0\n5222\t-3.5\n5230\t0.0\n5241\t0.0\n"
EVENTS = PROGRAMS / "dynapath" / "flange.dyn"
FOREIGN = sorted((PROGRAMS / "foreign").glob("*/*.nc"))
NATIVE = sorted(PROGRAMS.glob("haas/*.ngc"))
CONTROL_FILES = sorted(ROOT.glob("python/g12/tools/translate/controls/*.toml"))
ATTACK = "attack_"  # begins the names of the methods that damage a kind of file
CONTROLS = shipped_controls()


def damaged(chance: Random, content: bytes) -> bytes:
    """Return a file's content with some numbers or stretches replaced, repeated or lost."""
    for _ in range(chance.choice([0, 0, 1, 2])):
        numbers = [each.span() for each in NUMBER.finditer(content)]
        start, end = chance.choice(numbers or [(0, 0)])
        content = content[:start] + chance.choice(NUMBERS) + content[end:]
    for _ in range(chance.randint(0, 4)):
        at, length = chance.randint(0, len(content)), chance.choice([0, 0, 1, 4, 40])
        piece = chance.choice([*PIECES, chance.randbytes(6), content[at : at + 30]])
        content = content[:at] + piece + content[at + length :]
    return content[: chance.randint(0, len(content))] if chance.random() < 0.1 else content


def kinds() -> list[str]:
    return [name.removeprefix(ATTACK) for name in dir(Shop) if name.startswith(ATTACK)]


class Shop:
    """A folder with good files of every kind; `attack` damages one and names a command for it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.sim = copy_of_machines(folder)
        self.ini = self.sim / "mill_mm.ini"
        self.table, self.var = folder / "tool.tbl", folder / "shop.var"
        self.table.write_bytes((self.sim / "mill_mm.tbl").read_bytes())
        self.var.write_bytes(VAR)
        self.program = folder / "part.ngc"
        self.program.write_bytes(NATIVE[0].read_bytes())
        self.recordings = folder / "recordings"
        words = ["regress", "record", str(self.program), "--ini", str(self.ini)]
        assert main.main([*words, "--var", str(self.var), "-d", str(self.recordings)]) == 0
        self.lathe = folder / "lathe" / "lathe.ini"
        self.lathe.parent.mkdir()
        self.lathe.write_text(TURNING)
        (self.lathe.parent / "motion.hal").write_text(TURNING_HAL)
        self.pins = folder / "spindle.toml"
        self.pins.write_bytes(PINS)

    def attack(self, kind: str, chance: Random) -> tuple[list[str], Path]:
        """Return the words of a command, and the damaged file that it gets."""
        return getattr(self, ATTACK + kind)(chance)

    def _made(self, chance: Random, name: str | Path, content: bytes) -> Path:
        path = self.folder / name
        path.write_bytes(damaged(chance, content))
        return path

    def _read(self, chance: Random, program: Path, *more: str, ini: Path | None = None) -> list:
        """Return a command that reads a program."""
        shutil.rmtree(self.folder / "new", ignore_errors=True)
        read = [str(program), "--ini", str(ini or self.ini), *more]
        picture, recordings = str(self.folder / "part.svg"), str(self.folder / "new")
        return chance.choice([
            ["trace", *read],
            ["verify", *read],
            ["plot", *read, "-o", picture],
            ["regress", "record", *read, "-d", recordings],
        ])  # fmt: skip

    def _use(self, chance: Random, ini: Path) -> list[str]:
        """Return a command that reads a config, or a program on its machine."""
        dry = [str(ini), "--with", "circle-mill", "programs-haas-mill", "--dry-run"]
        on_it = self._read(chance, self.program, ini=ini)
        config = [["check", str(ini)], ["install", *dry], ["uninstall", str(ini)]]
        return chance.choice([on_it, chance.choice(config)])

    def _machine(self, text: str) -> Path:
        ini = self.sim / "with_bad.ini"
        ini.write_text(text)
        return ini

    def attack_program(self, chance):
        program = self._made(chance, "bad.ngc", chance.choice(NATIVE).read_bytes())
        return self._read(chance, program), program

    def attack_foreign(self, chance):
        program = self._made(chance, "bad.NC", chance.choice(FOREIGN).read_bytes())
        translate = ["translate", "--control", chance.choice(CONTROLS), str(program)]
        return chance.choice([translate, self._read(chance, program)]), program

    def attack_events(self, chance):
        events = self._made(chance, "bad.dyn", EVENTS.read_bytes())
        return chance.choice([["dynapath", str(events)], self._read(chance, events)]), events

    def attack_name(self, chance):
        name = chance.randbytes(chance.randint(1, 9)).translate(None, b"\0/") + b".ngc"
        program = Path(os.fsdecode(os.fsencode(self.folder) + b"/" + name))
        program.write_bytes(self.program.read_bytes())
        return self._read(chance, program), program

    def attack_ini(self, chance):
        ini = self._made(chance, self.sim / "bad.ini", self.ini.read_bytes())
        translate = ["translate", "--control", "haas-mill", "--ini", str(ini), str(FOREIGN[0])]
        return chance.choice([translate, self._use(chance, ini)]), ini

    def attack_include(self, chance):
        head, header, rest = self.ini.read_text().partition("[KINS]")
        part = self._made(chance, self.sim / "bad.inc", f"{header}{rest}".encode())
        return self._use(chance, self._machine(f"{head}#INCLUDE bad.inc\n")), part

    def attack_table(self, chance):
        table = self._made(chance, "bad.tbl", self.table.read_bytes())
        ini = self._machine(f"[EMCIO]\nTOOL_TABLE = {table}\n{self.ini.read_text()}")
        given = self._read(chance, self.program, "--tools", str(table))
        return chance.choice([given, self._use(chance, ini)]), table

    def attack_var(self, chance):
        var = self._made(chance, "bad.var", VAR)
        ini = self._machine(self.ini.read_text().replace("= mill_mm.var", f"= {var}"))
        given = self._read(chance, self.program, "--var", str(var))
        return chance.choice([given, self._use(chance, ini)]), var

    def attack_hal(self, chance):
        hal = self._made(chance, self.lathe.parent / "bad.hal", TURNING_HAL.encode())
        ini = self.lathe.parent / "with_bad.ini"
        ini.write_text(TURNING.replace("motion.hal", "bad.hal"))
        words = ["install", str(ini), "--with", "polar", "spindle-c", "--pins", str(self.pins)]
        return chance.choice([[*words, "--dry-run"], ["check", str(ini)]]), hal

    def attack_pins(self, chance):
        pins = self._made(chance, "bad.toml", PINS)
        words = ["install", str(self.lathe), "--with", "polar", "spindle-c", "--pins", str(pins)]
        return [*words, "--dry-run"], pins

    def attack_control(self, chance):
        control = self._made(chance, "own.toml", chance.choice(CONTROL_FILES).read_bytes())
        ini = self.lathe.parent / "with_filter.ini"
        command = f"python3 {ROOT}/python/g12 translate --control {control}"
        ini.write_text(f"{TURNING}\n[FILTER]\nnc = {command}\n")
        translate = ["translate", "--control", str(control), str(chance.choice(FOREIGN))]
        return chance.choice([translate, ["check", str(ini)]]), control

    def attack_run(self, chance):
        bad = self.sim / "bad_to_run.ini", self.folder / "bad_to_run.ngc"
        good = self.ini.read_bytes(), self.program.read_bytes()
        for path, content in zip(bad, good):
            path.write_bytes(content)
        hal = self.sim / "three_joints.hal"
        content = (SIM / hal.name).read_bytes()
        file, content = chance.choice([*zip(bad, good), (hal, content)])
        hal.write_bytes((SIM / hal.name).read_bytes())
        file.write_bytes(damaged(chance, content))
        words = ["run", str(bad[1]), "--ini", str(bad[0]), "--override", "1000", "--timeout", "20"]
        return words, file

    def attack_recording(self, chance):
        kept = self.folder / "kept"
        shutil.rmtree(kept, ignore_errors=True)
        shutil.copytree(self.recordings, kept)
        file = chance.choice(sorted(path for path in kept.rglob("*") if path.is_file()))
        file.write_bytes(damaged(chance, file.read_bytes()))
        more = chance.choice([[], ["--json"], ["--picture", str(self.folder / "pictures")]])
        return ["regress", "check", "-d", str(kept), *more], file


def answered(words: list[str]) -> int:
    """Return the exit code of a command."""
    try:
        return main.main(words)
    except SystemExit as end:
        return int(end.code or 0)


def check_answer(capfd, number: object, words: list[str], file: Path) -> None:
    """Run a command on a damaged file; it says why it ended, and nothing of a fault."""
    what = f"{number}: {words}\n{file.read_bytes()!r}"
    capfd.readouterr()
    try:
        code = answered(words)
    except Exception as problem:
        raise AssertionError(what) from problem
    said = capfd.readouterr()
    assert code in (0, 1, 2), what
    for shown in ("Traceback", "a fault of"):
        assert shown not in said.out + said.err, f"{what}\n{said}"
    if code == 2:
        assert said.err.splitlines()[-1].startswith("g12 "), f"{what}\n{said}"
