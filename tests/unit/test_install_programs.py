# SPDX-License-Identifier: GPL-2.0-or-later
"""``install --with programs-…``: the [FILTER] lines, what `check` says of them, taking them out."""

import pytest

from g12.tools.install.config.bare_numbers import question_of
from g12.tools.install.plan import Refused, make_plan
from g12.tools.install.rules import installed_programs, wrong_filters
from g12.tools.translate.blocks.control import read_control
from support.small_configs import (
    LATHE,
    MILL,
    config_of,
    package_of,
    put_in,
    restored,
    with_lines,
    write_config,
)

FILTER = """\
PROGRAM_EXTENSION = .nc Programs of haas-mill
nc = python3 g12/python/g12 translate --control haas-mill
"""


small_package = package_of({"python/g12/__init__.py": b""})


def test_a_section_of_its_own(tmp_path):
    ini = write_config(tmp_path)
    with restored(ini):
        put_in(ini, "programs-haas-mill")
        text = ini.read_text()
        assert f"[FILTER]\n{FILTER}" in text
        assert "TOPLEVEL" not in text and "REMAP" not in text
        assert installed_programs(config_of(ini)) == ["haas-mill"]


def test_a_filter_of_the_users_own_for_the_suffix_is_refused(tmp_path):
    ini = write_config(tmp_path)
    ini.write_text(f"{ini.read_text()}\n[FILTER]\nnc = mine\n")
    with pytest.raises(Refused) as refused:
        make_plan(config_of(ini), ["programs-haas-mill"])
    assert refused.value.args[0].text == "[FILTER] nc = mine is there already"


@pytest.mark.parametrize(
    ("control", "text"),
    [
        ("haas-mill", "g12/python/g12 is not there"),
        ("own.toml", "own.toml:1: colour is no key of a control"),
    ],
)
def test_what_is_wrong_with_a_filter(tmp_path, control, text):
    ini = write_config(tmp_path)
    folder = tmp_path / "package"
    (folder / "python" / "g12").mkdir(parents=True)
    (tmp_path / "own.toml").write_text("colour = 1\n")
    command = "g12/python/g12" if control == "haas-mill" else f"{folder}/python/g12"
    ini.write_text(
        f"{ini.read_text()}\n[FILTER]\nnc = python3 {command} translate --control {control}\n"
    )
    (finding,) = wrong_filters(config_of(ini))
    assert text in finding.text


@pytest.mark.parametrize(
    ("spindles", "control", "settings"),
    [
        (2, "doosan-lathe", "POLAR_Z = allow\nLIVE_SPINDLE = 1\n"),
        (1, "mill-round-part", "[G12]\nCYLINDER_X = allow\nLIVE_SPINDLE = 0\n"),
    ],
)
def test_programs_on_a_lathe_need_settings(tmp_path, spindles, control, settings):
    ini = write_config(tmp_path, LATHE.replace("[TRAJ]\n", f"[TRAJ]\nSPINDLES = {spindles}\n"))
    with restored(ini):
        for _ in range(2):
            put_in(ini, f"programs-{control}")
            assert settings in ini.read_text()
            assert ini.read_text().count("LIVE_SPINDLE") == 1


def test_what_numbers_are_is_written_into_the_filter(tmp_path):
    ini = write_config(tmp_path)
    numbers = " --decimals least --units inch"
    with restored(ini):
        put_in(ini, "programs-haas-mill", numbers=numbers)
        assert f"[FILTER]\n{FILTER.rstrip()}{numbers}\n" in ini.read_text()
        put_in(ini, "programs-haas-mill")
        with pytest.raises(Refused) as refused:
            make_plan(config_of(ini), ["programs-haas-mill"], numbers=" --decimals whole")
        assert (
            refused.value.args[0].cure == "write --decimals whole behind --control haas-mill in it"
        )


@pytest.mark.parametrize(
    ("program", "asked"),
    [
        ("G21\n(X5000)G0 X0 Y2.;Z7\nX-0250 (A)\n", "X-0250 (part.NC, line 3) has no decimal point. "
         "With --decimals least it is -0.25 mm or -0.025 in, with --decimals whole -250 mm or in."),
        ("G0 X1.\n", "X1500 has no decimal point. With --decimals least it is 1.5 mm or 0.15 in"),
    ],
)  # fmt: skip
def test_numbers_without_a_point_are_asked_for_with_one_of_the_users(tmp_path, program, asked):
    ini = write_config(
        tmp_path, with_lines(f"{MILL}\n[DISPLAY]\n", "DISPLAY", "PROGRAM_PREFIX = .")
    )
    (tmp_path / "part.NC").write_text(program)
    (question,) = question_of(read_control("fanuc-lathe"), config_of(ini))
    assert question.startswith(f"asked: {asked}")
    assert list(question_of(read_control("mill-on-face"), config_of(ini))) == []
