# SPDX-License-Identifier: GPL-2.0-or-later
"""The converter of Dynapath event text, and its command."""

import re
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.errors import Refusal
from g12.tools.dynapath import program_from_events
from g12.tools.machine.ini import read_ini
from support.sim_machines import PROGRAMS, ROOT, SIM

EXAMPLE = "N1800(4)G7X1.5Y2.Z-.5W.1O.5R1.5D0C2K.2J.3L.02P5F20V15$"
COMMAND = [sys.executable, str(ROOT / "python" / "g12"), "dynapath"]


def calls(*lines):
    """Return the arguments of each call."""
    program = program_from_events("\n".join(lines)).splitlines()
    assert (program[0], program[-1]) == ("G17 G40 G90 G94", "M2")
    return [re.findall(r"\[(.*?)\]", block) for block in program[1:-1]]


def test_w_o_and_f_are_carried_from_event_to_event():
    first, second, third = calls(
        "N1(4)X0Y0Z-1W.1R1C2F20P5O.5$", "N2(4)X5Y0Z/-1R1C2$", "N3(4)X9Y0Z/-1W.2R1C2F30$"
    )
    assert (first[4], first[13]) == ("0.1", "20")
    assert (second[3], second[4], second[13]) == ("-0.9", "0.1", "20")
    assert (third[3], third[4], third[13]) == ("-0.8", "0.2", "30")
    assert second[5] == third[5] == "0.5" and second[12] == "-9999"
    assert calls("N1(4)X0Y0Z-1W.1R1C2F20$")[0][5] == "-9999"


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ([""], "there is no event in the file"),
        ([EXAMPLE, "N2(1)X1Y1$"], "line 2: event type 1 is not the circle mill event, 4"),
        ([EXAMPLE[:-1]], f"line 1: {EXAMPLE[:40]} is not an event: N…(4)…$"),
        (["N1(4)X0Y0Z-1W.1RC2F20$"], "line 1: RC2F20 does not start with an entry"),
        (["N1(4)X0X1Y0Z-1W.1R1C2F20$"], "line 1: X stands twice"),
        (["N1(4)X0Y0Z-1W.1I.1R1C2F20$"], "line 1: W and I are the same entry: give one of them"),
        (["N1(4)X0Y0Z-1I/.1R1C2F20$"], "line 1: I/ cannot be incremental"),
        (["N1(4)X0Y0Z-1W.1R1H3F20$"], "line 1: H3 must be one of 0, 1, 2"),
        (["N1(4)Y0Z-1W.1R1C2F20$"], "line 1: X is missing"),
        ([EXAMPLE, "N1(4)X0Y0Z-1R1$"], "line 2: C is missing"),
        (["N1(4)X0Y0Z-1R1C2F20$"], "line 1: W is missing, and no event before has it"),
        (["N1(4)X٣Y0Z-1W.1R1C2F20$"], "line 1: X٣Y0Z-1W.1R1C2F20 does not start with an entry"),
        (["N١(4)X0$"], "line 1: N١(4)X0$ is not an event: N…(4)…$"),
        (
            [EXAMPLE, EXAMPLE.replace("X1.5", "X1.5" + "0" * 200)],
            "line 2: the call of the event has 305 characters, the most is 254",
        ),
    ],
)
def test_a_bad_file_is_refused_with_its_line(lines, message):
    with pytest.raises(Refusal) as refused:
        program_from_events("\n".join(lines))
    assert refused.value.message == message


LEAVES_OUT = "would be left out: -9999 in the call means no entry"


@pytest.mark.parametrize(
    ("entries", "rule"),
    [
        ("G3", "G3 must be one of 0, 7"),
        ("D1.5", "D1.5 must be one of 0, 1, 2, 3"),
        ("L0", "L0 must be greater than 0"),
        ("L/-.02", "L-0.02 must be greater than 0"),
        *((f"{letter}0", f"{letter}0 must be greater than 0") for letter in "RKJPFV"),
        ("X-9999", f"X-9999 {LEAVES_OUT}"),
        ("Z/-9999.1", f"Z-9999 {LEAVES_OUT}"),
        ("Z/1000000", "Z1000000.1 is beyond 1000000"),
        ("K1" + "0" * 400, "Kinf is beyond 1000000"),
    ],
)
def test_an_entry_that_could_only_fail_on_the_machine_is_refused(entries, rule):
    sound = {"X": "X0", "Y": "Y0", "Z": "Z-1", "W": "W.1", "R": "R1", "C": "C2", "F": "F20"}
    event = "".join({**sound, entries[0]: entries}.values())
    with pytest.raises(Refusal, match=f"^line 2: {re.escape(rule)}$"):
        program_from_events(f"{EXAMPLE}\nN2(4){event}$")


def test_entries_at_the_edge_of_what_can_be_cut_pass():
    (values,) = calls("N1(4)G0X1000000Y/-9999Z-9998W-.5R1D3C1.0L/.001F20$")
    assert values[:4] == ["0", "1000000", "#<_y> + -9999", "-9998"]
    assert (values[7], values[8], values[11]) == ("3", "1.0", "-0.001")


@given(text=st.text(st.sampled_from("NXYZWORDCHIKJLPFVG0123456789.-/()$ \n")))
def test_any_text_is_a_program_or_a_refusal(text):
    try:
        program = program_from_events(text)
    except Refusal as refusal:
        assert refusal.message
    else:
        assert program.count("o<circle_mill>") == text.count("$")


def test_the_filter_of_every_simulated_mill_reads_events():
    machines = [read_ini(ini) for ini in sorted(SIM.glob("mill_*.ini"))]
    for machine in machines:
        extensions = [line.split()[0] for line in machine.all("FILTER", "PROGRAM_EXTENSION")]
        assert ".dyn,.DYN" in extensions
    events = PROGRAMS / "dynapath" / "flange.dyn"
    filters = {(m.get("FILTER", "dyn"), m.get("TRAJ", "LINEAR_UNITS")) for m in machines}
    for command, units in filters:
        done = subprocess.run(
            ["sh", "-c", f"{command} '{events}'"], cwd=SIM, capture_output=True, text=True
        )
        assert (done.returncode, done.stdout) == (0, program_from_events(events.read_text(), units))


def test_the_command_prints_nothing_of_a_file_with_an_error(tmp_path):
    file = tmp_path / "bad.dyn"
    file.write_text(EXAMPLE + "\nN2(1)X1Y1$\n")
    done = subprocess.run([*COMMAND, str(file)], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == (
        f"g12 dynapath: {file}: line 2: event type 1 is not the circle mill event, 4\n"
    )
