# SPDX-License-Identifier: GPL-2.0-or-later
"""Every reader gets files with random damage: it reads them or refuses them in its own words."""

import json
import re

from hypothesis import given
from hypothesis import strategies as st

from g12.errors import Refusal
from g12.tools.dynapath import program_from_events
from g12.tools.errors import UsageError
from g12.tools.machine.ini import IniError, read_machine_ini
from g12.tools.machine.tables import tool_table, var_file
from g12.tools.regress.recording_text import TraceTextError, read_recording, text_of
from g12.tools.translate.blocks.control import ControlError, read_control, shipped_controls
from g12.tools.translate.blocks.lexer import program_text
from g12.tools.translate.program import translate_program
from support.sim_machines import PROGRAMS, ROOT, SIM

COMMENTS = re.compile(r"\([^)]*\)|;.*")
INI = (SIM / "lathe_mm.ini").read_bytes()
TABLE = (SIM / "mill_mm.tbl").read_bytes()
VAR = b"5220\t1.0\n5221\t10.0\n5222\t-3.5\n5241\t0.0\n"
RECORDING = (PROGRAMS / "haas" / "regress" / "O60121.ngc.trace").read_bytes()
EVENTS = (PROGRAMS / "dynapath" / "flange.dyn").read_bytes()
CONTROLS = [read_control(name) for name in shipped_controls()]
CONTROL_FILES = sorted(ROOT.glob("python/g12/tools/translate/controls/*.toml"))
FOREIGN = sorted(PROGRAMS.glob("foreign/**/*.nc"))
WORDS = ["GOTO1", "N1", "WHILE[#1LT2]DO1", "END1", "IF[#1EQ1]THEN", "#1=2", "#3000=1", "M98P100L2",
         "G65P100A1.", "O100", "M99", "M30", "G83R1.Q1.", "G12.1", "G113", "G41D1", "G28U0", "CALL",
         "FIX[", "%", "/", "("]  # fmt: skip
PIECES = st.one_of(
    st.binary(max_size=12),
    st.sampled_from([b"\0", b"\r", b"\n", b"=", b"[", b"#INCLUDE ", b"\xff\xfe", b"1e999", b"-"]),
    st.sampled_from([b"nan", b"9" * 400, *(f"{word}\n".encode() for word in WORDS)]),
)


def damaged(content):
    """Return what draws a file with some stretches replaced."""
    place = st.integers(0, len(content))
    edit = st.tuples(place, st.integers(0, 40), PIECES)
    return st.lists(edit, max_size=6).map(lambda edits: with_edits(content, edits))


def with_edits(content, edits):
    for start, length, piece in edits:
        content = content[:start] + piece + content[start + length :]
    return content


def read(reader, folder, content, refusals):
    """Give a file to a reader, which may refuse it with one line of text."""
    file = folder / "file.toml"
    file.write_bytes(content)
    try:
        return reader(file)
    except refusals as refusal:
        assert str(refusal).strip()
        return None


@given(content=damaged(INI))
def test_any_ini_is_read_or_refused(tmp_path_factory, content):
    ini = read(read_machine_ini, tmp_path_factory.getbasetemp(), content, (IniError, UsageError))
    if ini:
        ini.text.encode("utf-8", "surrogateescape")


@given(content=damaged(TABLE))
def test_any_tool_table_is_read_or_refused(tmp_path_factory, content):
    read(tool_table, tmp_path_factory.getbasetemp(), content, UsageError)


@given(content=damaged(VAR))
def test_any_var_file_is_read_or_refused(tmp_path_factory, content):
    read(var_file, tmp_path_factory.getbasetemp(), content, UsageError)


@given(content=damaged(RECORDING))
def test_any_recording_is_read_whole_or_refused(content):
    try:
        recording = read_recording(content.decode("utf-8", "replace"))
    except TraceTextError as refusal:
        assert str(refusal)
    else:
        assert read_recording(text_of(recording)).steps == recording.steps


@given(content=damaged(EVENTS))
def test_any_dynapath_text_is_read_or_refused(content):
    try:
        json.dumps(program_from_events(content.decode("utf-8", "replace"), "mm"))
    except Refusal as refusal:
        assert str(refusal)


@given(
    control=st.sampled_from(CONTROLS),
    content=st.sampled_from(FOREIGN).flatmap(lambda path: damaged(path.read_bytes())),
)
def test_any_foreign_program_is_translated_or_refused(control, content):
    result = translate_program(program_text(content), control)
    assert bool(result.text) != bool(result.refused)
    for line in result.text.splitlines():
        assert len(line.encode()) <= 254 and COMMENTS.sub("", line).isascii(), line
    for block in result.refused:
        assert 0 < len(block.sentence) <= 255 and block.line >= 1, block


@given(content=st.sampled_from(CONTROL_FILES).flatmap(lambda path: damaged(path.read_bytes())))
def test_any_control_file_is_read_or_refused(tmp_path_factory, content):
    folder = tmp_path_factory.getbasetemp()
    control = read(lambda file: read_control(str(file)), folder, content, ControlError)
    if control:
        translate_program(program_text(FOREIGN[0].read_bytes()), control)
