# SPDX-License-Identifier: GPL-2.0-or-later
"""The Cycles page's steps: what is typed, the program's text, and back."""

import runpy

import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.tools.cycles_page.steps import Step, number_text, program_text, read_entry, read_program
from g12.tools.cycles_page.view import pressed
from g12.tools.errors import UsageError
from g12.tools.forms.table import CHOICE, COUNT, FORMS, TOOL
from support.sim_machines import ROOT

ENTRIES = {entry.name: entry for entry in FORMS[0].entries}


def test_ngcgui_s_files_are_those_of_the_table():
    for name, text in runpy.run_path(str(ROOT / ".ci/forms.py"))["files"]().items():
        assert (ROOT / "ngc" / name).read_text() == text


@pytest.mark.parametrize(
    ("text", "value"), [("12.5", 12.5), ("12,5", 12.5), (" -.5 ", -0.5), ("3.", 3), ("+4", 4)]
)
def test_a_number_may_have_a_comma(text, value):
    assert read_entry(ENTRIES["i"], text) == value


@pytest.mark.parametrize(
    ("name", "text", "why"),
    [
        ("i", "", "first radius I: a number is missing"),
        ("i", "1e5", "first radius I: 1e5 is no number"),
        ("i", "1.2.3", "first radius I: 1.2.3 is no number"),
        ("i", "[1]", "first radius I: [1] is no number"),
        ("levels", "2.5", "levels: 2.5 must be a whole number"),
        ("code", "14", "direction: 14 is none of its choices"),
    ],
)
def test_what_is_no_number_is_refused_by_the_entry_s_label(name, text, why):
    with pytest.raises(UsageError, match="^" + why.replace("[", r"\[") + "$"):
        read_entry(ENTRIES[name], text)


def test_the_keypad_writes_a_number():
    text = ""
    for key in ("1", "2", ".", "5", "-", "7", "⌫"):
        text = pressed(text, key)
    assert (text, pressed(text, "-"), pressed(text, "C")) == ("-12.5", "12.5", "")


def entry_values(entry):
    if entry.kind == CHOICE:
        return st.sampled_from([value for value, _ in entry.choices])
    if entry.kind in (COUNT, TOOL):
        return st.integers(0, 999).map(float)
    return st.integers(-(10**9), 10**9).map(lambda micrometres: micrometres / 1e6)


@st.composite
def steps(draw):
    form = draw(st.sampled_from(FORMS))
    values = {entry.name: draw(entry_values(entry)) for entry in form.entries}
    return Step(form, draw(st.sampled_from(("mm", "inch"))), values)


@given(st.lists(steps(), max_size=4))
def test_any_program_of_the_page_is_read_back(made):
    assert read_program(program_text(made)) == made


@given(st.floats(-1e6, 1e6))
def test_a_number_has_no_exponent_and_keeps_six_decimals(value):
    text = number_text(value)
    assert "e" not in text and float(text) == pytest.approx(value, abs=1e-6)


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ("G0 X5", "line 2: G0 X5: is no step of the Cycles page"),
        ("o<form_hass_mm> call [1]", "line 2: form_hass_mm is no form"),
        ("o<form_haas_mm> call [1]", "line 2: form_haas_mm has 14 entries, not 1"),
    ],
)
def test_a_line_that_is_no_step_is_named(line, why):
    with pytest.raises(UsageError, match=why):
        read_program(f"\n{line}\n")
