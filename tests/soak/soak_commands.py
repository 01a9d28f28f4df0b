# SPDX-License-Identifier: GPL-2.0-or-later
"""Commands get random programs, valid ones with random damage: none ever shows a traceback."""

import json
import random
import shutil

from g12.tools.commands import main
from g12.tools.translate.blocks.control import shipped_controls
from soak import SEED, tries
from support.sim_machines import copy_of_machines
from support.valid_programs import MACHINES, machine_of, valid_program

ON = ["PROGRAM", "--ini", "INI"]
WORDS = {
    "trace": ["trace", *ON],
    "plot": ["plot", *ON, "--output", "FOLDER/picture.png"],
    "verify": ["verify", *ON],
    "verify json": ["verify", *ON, "--json"],
    "regress": ["regress", "record", *ON, "-d", "FOLDER/kept"],
    "regress check": ["regress", "check", "-d", "FOLDER/kept"],
    "regress json": ["regress", "check", "-d", "FOLDER/kept", "--json"],
    "translate": ["translate", "--control", "CONTROL", "PROGRAM"],
}
RUN = ["run", *ON, "--override", "1000", "--timeout", "30"]
CONTROLS = shipped_controls()
STARVED = "no end within"  # of an interpreter on a system with too much else to do
BLOCKS = (
    "G12.1|G13.1|G41|G41 G1 X5|G40|G12|G13 I5|G13 I9 K20 Q3 Z-1|G20|G12.2 X0 Y0 Z-1 I1 R9 H0|"
    "o<circle_mill> call|o<circle_mill> call [7] [1]|M2|%|G91|G90|G7|G95 F.1|G93|G18|T99 M6|"
    "T0 M6|G92 X1 Y2|G52 X1|M6|G10 L2 P1 R30|G54|G55|o1 if [1]|o1 endif|o9 sub|o9 endsub|"
    "o9 call|o<nowhere> call|M98 P1|M99|(PY, x)|(ABORT, over)|(MSG, here)|;py,1|M70|#1=2|"
    "#<a>=[1/0]|G1 X#<none>|G1 X[#1|M66 P0 L3 Q1|G4 P.1|M0|M1|M72|G2 X5 R1|G3 I1|G33 Z-1 K1|"
    "G38.2 Z-1|G81 Z-1 R1|G53 G0 Z0|F0|S0|G96|N5|/G0 X1|G0 C90|G0 X0|G1 X0 C0|U1 H1|G28|"
    "G43 H1|\N{DEGREE SIGN}|"
)
LINES = BLOCKS.split("|")
NUMBERS = ["0", "-1", "1e6", "99999", ".0001", "-.5", "[1/3]", "#5420", "", "1.2.3", "nan"]


def damaged(chance, text):
    """Return a program with some lines missing, changed, in another place or added."""
    lines = text.splitlines()
    for _ in range(chance.randint(0, 4)):
        at = chance.randrange(len(lines))
        line, any_line, own = lines[at], chance.choice(LINES), chance.choice(lines)
        instead = [[], [any_line, line], [own, line], [own], [changed(chance, line)]]
        lines[at : at + 1] = chance.choice(instead)
        if chance.random() < 0.15:
            del lines[chance.randrange(len(lines) // 2, len(lines) + 1) :]
        lines = lines or [""]
    return "\n".join(lines) + chance.choice(["\n", ""])


def changed(chance, line):
    """Return a line with a word's number changed, or without the word."""
    words = line.split(" ")
    at = chance.randrange(len(words))
    words[at] = words[at][:1] + chance.choice(NUMBERS) if chance.random() < 0.7 else ""
    return " ".join(words)


def check_said(capsys, code, what):
    """Check what a command printed: no traceback, and why it ended as it did. Return it."""
    said = capsys.readouterr()
    assert code in (0, 1, 2), what
    for shown in ("Traceback", "fault of the package"):
        assert shown not in said.out + said.err, f"{what}: {said}"
    if code == 2:  # after what a slow command says of its progress
        assert said.err.splitlines()[-1].startswith("g12 "), f"{what}: {said}"
    return said


def check_codes(codes, damage, what):
    """Check that the commands agree on a program."""
    if codes["trace"] == 2:  # the program has an error
        assert codes["verify"] == 2, what
    assert codes["plot"] in (codes["trace"], 2), what  # 2: it moves nothing
    assert codes["verify json"] == codes["verify"], what
    assert (codes["regress check"], codes["regress json"]) == (0, 0), what
    assert damage or codes["verify"] == 0, what


def test_programs(tmp_path, capsys):
    chance = random.Random(SEED)
    ini = copy_of_machines(tmp_path) / "machine.ini"
    named = {"INI": str(ini), "FOLDER": str(tmp_path)}
    for number in tries("programs, damaged or not, given to every command"):
        kind = chance.choice(list(MACHINES))
        ini.write_text(machine_of(kind).text)
        program, text = tmp_path / f"{kind} {number}.ngc", valid_program(kind, chance, 1)
        damage = number % 8 > 0
        program.write_text(damaged(chance, text) if damage else text)
        named.update(PROGRAM=str(program), CONTROL=chance.choice(CONTROLS))
        words = {**WORDS, "run": RUN} if number % 8 == 1 else WORDS
        what, codes = f"{number} of {SEED}\n{program.read_text()}", {}
        for command, pattern in words.items():
            codes[command] = main.main([filled(word, named) for word in pattern])
            said = check_said(capsys, codes[command], f"{command} {what}")
            if "--json" in pattern and codes[command] < 2 and said.out:
                json.loads(said.out)
            if command != "run" and STARVED in said.err:
                break
        else:
            check_codes(codes, damage, f"{codes} {what}")
        shutil.rmtree(tmp_path / "kept", ignore_errors=True)


def filled(word, named):
    """Return a word of a command with what its capitals stand for."""
    for name, value in named.items():
        word = word.replace(name, value)
    return word
