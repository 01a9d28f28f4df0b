# SPDX-License-Identifier: GPL-2.0-or-later
"""Hostile programs and hostile control files for `translate`, by coverage; run by hand.

    pip install atheris (into a virtual environment)
    python tests/soak/fuzz_translate.py CORPUS -max_total_time=3600 -timeout=20

CORPUS is a folder that starts empty or from programs; the first byte chooses what is tried. A text
is translated or refused, whatever it is, in less than SECONDS, with lines that LinuxCNC can read; a
control file is read or refused, and one that is read translates a program or refuses it.
"""

import os
import random
import sys
import tempfile
import time
from pathlib import Path

import atheris

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))

with atheris.instrument_imports(include=["g12"]):
    from g12.tools.translate.blocks.control import ControlError, read_control, shipped_controls
    from g12.tools.translate.blocks.lexer import program_text
    from g12.tools.translate.listing import listing_of
    from g12.tools.translate.program import translate_program

SECONDS = 5.0  # of the processor, instrumented, for 4,096 characters
CONTROLS = [read_control(name) for name in shipped_controls()]
PROGRAMS = ROOT / "tests" / "programs" / "foreign"
SAMPLE = "%\nO1 (A)\nT1 M6\nG20 G90 G0 X1 Y1.\nG43 H1 Z1.\nM31\nG1 F9. X2.\nG112\nG113\nM30\n%\n"
TOML = (  # ways to begin: based on another control, or from nothing
    'based_on = "haas-lathe"\n', 'machine = "mill"\naxes = "XYZ"\n[g_codes]\n[m_codes]\n', "",
)  # fmt: skip
WORDS = """
G0 G1 G2 G28 G53 G91 G90 G81 G83 G80 G10 L2 L10 L20 G154 G110 G52 G65 M98 M97 M99 M30 P1 P100 O1
O100 N100 X1. Y-1 Z.5 U1. W-2. H0 H1 T0101 G12.1 G13.1 G112 G113 G50 S100 G96 G97 #1=2 #100=[1+2]
#3000=1 #3006=1 WHILE[#1LT2]DO1 END1 IF[#1EQ1]THEN#2=3 GOTO5 K0 L0 L3 R.1 Q.1 D1 G41 G40 G43 G49 G4
N1 N2 N5 GOTO1 GOTO2 IF[#1GT2]GOTO5 IF[#1EQ#0]GOTO2 IF[#2NE#0]THEN#3=#2 WHILE[#2LT3]DO2 END2 M98Q5
M99P5 M99P2 M19 G9 CALL OSUB RTS #31=1 #33=#1 A5. #3000=1(X) G12 I1. G107 C5. G121 G137 G136 M6 Y0
R2. V1. ( ) [ ] % ; / # = {  } FIX[ ATAN[1]/[2] : SB=5 A1. B C . - +
""".split()  # noqa: SIM905


def tried(data: bytes) -> None:
    """Try one input."""
    start = time.process_time()
    kind, body = (data[0] if data else 0), data[1:]
    if kind < 224:
        translate_text(program_text(body), CONTROLS[kind % len(CONTROLS)])
    else:
        read_file(TOML[kind % len(TOML)].encode() + body)
    took = time.process_time() - start
    assert took < SECONDS, f"{took:.1f} s for {len(data)} bytes"


def translate_text(text: str, control) -> None:
    """Translate a text, and look at what comes of it."""
    result = translate_program(text, control)
    assert bool(result.text) != bool(result.refused)
    for line in result.text.splitlines():
        assert len(line) <= 254 and line.isascii(), line
    for block in result.refused:
        assert 0 < len(block.sentence) <= 255 and block.line >= 1, block


def read_file(content: bytes) -> None:
    """Read a control file, and use it."""
    path = Path(tempfile.gettempdir(), f"fuzz_{os.getpid()}.toml")
    path.write_bytes(content)
    try:
        control = read_control(str(path))
    except ControlError:
        return
    listing_of(control)
    translate_text(SAMPLE, control)


def mutated(data: bytes, max_size: int, seed: int) -> bytes:
    """Return an input with words of programs in it, or with its lines moved."""
    chance = random.Random(seed)
    if chance.random() < 0.3:
        return atheris.Mutate(data, max_size)
    kind, rows = data[:1] or b"\0", data[1:].split(b"\n")
    for _ in range(chance.randint(1, 4)):
        at = chance.randrange(len(rows))
        change = chance.random()
        if change < 0.5:
            cut = chance.randint(0, len(rows[at]))
            rows[at] = rows[at][:cut] + chance.choice(WORDS).encode() + rows[at][cut:]
        elif change < 0.7:
            rows.insert(at, rows[chance.randrange(len(rows))])
        elif change < 0.9 and len(rows) > 1:
            del rows[at]
        else:
            kind = bytes([chance.randrange(256)])
    return (kind + b"\n".join(rows))[:max_size]


def fill(corpus: Path) -> None:
    """Put the foreign programs and the control files into an empty folder."""
    corpus.mkdir(exist_ok=True)
    if any(corpus.iterdir()):
        return
    for number, path in enumerate(sorted(PROGRAMS.rglob("*.nc"))):
        (corpus / f"program_{number}").write_bytes(bytes([number % 224]) + path.read_bytes())
    for path in ROOT.glob("python/g12/tools/translate/controls/*.toml"):
        (corpus / path.name).write_bytes(b"\xe3" + path.read_bytes())


if __name__ == "__main__":
    fill(Path(sys.argv[1]))
    atheris.Setup(sys.argv, tried, custom_mutator=mutated)
    atheris.Fuzz()
