# SPDX-License-Identifier: GPL-2.0-or-later
"""``install --with programs-…``: the [FILTER] lines, what `check` says of them, taking them out."""

import pytest

from g12.tools.install.config.bare_numbers import question_of
from g12.tools.install.config.filters import filter_findings, installed_programs, wrong_filters
from g12.tools.install.plan import Refused, make_plan
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

COMMAND = "python3 g12/python/g12 translate --control"
FILTER = f"""\
PROGRAM_EXTENSION = .nc,.NC Programs of haas-mill
nc = {COMMAND} haas-mill
NC = {COMMAND} haas-mill
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


@pytest.mark.parametrize(
    ("control", "suffixes"),
    [
        ("fanuc-mill", "nc NC tap TAP"),
        ("doosan-lathe", "nc NC tap TAP"),
        ("okuma-lathe", "min MIN nc NC"),
        ("mazak-integrex", "eia EIA nc NC"),
        ("haas-lathe", "nc NC"),
    ],
)
def test_each_usual_extension_is_opened_in_both_cases(tmp_path, control, suffixes):
    ini = write_config(tmp_path)
    with restored(ini):
        put_in(ini, f"programs-{control}")
        filters = ini.read_text().partition("[FILTER]\n")[2].partition("# <<<")[0]
        shown = ",".join(f".{suffix}" for suffix in suffixes.split())
        assert filters.splitlines() == [
            f"PROGRAM_EXTENSION = {shown} Programs of {control}",
            *(f"{suffix} = {COMMAND} {control}" for suffix in suffixes.split()),
        ]


def test_an_older_installation_gets_the_missing_lines_with_its_own_command(tmp_path):
    ini = write_config(tmp_path)
    with restored(ini):
        put_in(ini, "programs-fanuc-mill")
        old = f"{COMMAND} fanuc-mill --decimals least"
        newer = ini.read_text()
        lines = [line for line in newer.splitlines(True) if not line.startswith(("NC", "ta", "TA"))]
        older = "".join(lines).replace(f"nc = {COMMAND} fanuc-mill", f"nc = {old}")
        ini.write_text(older)
        put_in(ini, "programs-fanuc-mill")
        text = ini.read_text()
        assert [line for line in text.splitlines() if line.endswith("least")] == [
            f"{suffix} = {old}" for suffix in ("nc", "NC", "tap", "TAP")
        ]
        assert "PROGRAM_EXTENSION = .NC,.tap,.TAP Programs of fanuc-mill\n" in text
        assert list(filter_findings(config_of(ini))) == []


@pytest.mark.parametrize("suffix", ["nc", "NC", "TAP"])
def test_a_filter_of_the_users_own_for_a_suffix_is_refused(tmp_path, suffix):
    ini = write_config(tmp_path)
    ini.write_text(f"{ini.read_text()}\n[FILTER]\n{suffix} = mine\n")
    with pytest.raises(Refused) as refused:
        make_plan(config_of(ini), ["programs-fanuc-mill"])
    assert refused.value.args[0].text == f"[FILTER] {suffix} = mine is there already"


CASES = [  # the lines of [FILTER], what `check` says of them
    ("nc = {haas}\nNC = {haas}\n", []),
    ("nc = {haas}\n", ["[FILTER] nc is there, NC is not: LinuxCNC would run PART.NC as it is"]),
    ("NC = {haas}\n", ["[FILTER] NC is there, nc is not: LinuxCNC would run PART.nc as it is"]),
    ("nc = {haas}\nNC = {fanuc}\n", [
        "[FILTER] nc and NC differ: .NC files are opened by", "[FILTER] NC and nc differ"]),
    ("dyn = {events}\n", ["[FILTER] dyn is there, DYN is not"]),
    ("py = python3\n", []),
]  # fmt: skip


@pytest.mark.parametrize(("lines", "says"), CASES)
def test_a_suffix_that_lacks_its_other_case_is_found(tmp_path, lines, says):
    (tmp_path / "python" / "g12").mkdir(parents=True)
    package = f"python3 {tmp_path}/python/g12"
    commands = {
        "haas": f"{package} translate --control haas-mill",
        "fanuc": f"{package} translate --control fanuc-mill",
        "events": f"{package} dynapath --units mm",
    }
    ini = write_config(tmp_path)
    ini.write_text(f"{ini.read_text()}\n[FILTER]\n{lines.format(**commands)}")
    found = list(filter_findings(config_of(ini)))
    assert len(found) == len(says)
    assert all(finding.text.startswith(text) for finding, text in zip(found, says))


def test_programs_that_no_filter_takes_are_named(tmp_path):
    (tmp_path / "python" / "g12").mkdir(parents=True)
    programs = tmp_path / "programs"
    programs.mkdir()
    for name in ("a.nc", "B.TAP", "c.Nc", "own.ngc", "d", "e.min"):
        (programs / name).write_text("")
    command = f"python3 {tmp_path}/python/g12 translate --control fanuc-mill"
    ini = write_config(tmp_path)
    ini.write_text(
        f"{ini.read_text()}\n[DISPLAY]\nPROGRAM_PREFIX = programs\n[FILTER]\n"
        f"nc = {command}\nNC = {command}\n"
    )
    (finding,) = filter_findings(config_of(ini))
    assert (finding.level, finding.text) == (
        "warning",
        "[DISPLAY] PROGRAM_PREFIX = programs: B.TAP, c.Nc: no [FILTER] takes these programs of "
        "fanuc-mill: LinuxCNC would run them as they are",
    )


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
    (finding, *_) = wrong_filters(config_of(ini))
    assert text in finding.text


@pytest.mark.parametrize(
    ("spindles", "control", "settings"),
    [
        (2, "doosan-lathe", "POLAR_Z = allow\nLIVE_SPINDLE = 1\n"),
        (1, "mill-on-face", "[G12]\nPOLAR_Z = allow\nLIVE_SPINDLE = 0\n"),
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
        command = f"{COMMAND} haas-mill{numbers}"
        assert f"nc = {command}\nNC = {command}\n" in ini.read_text()
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
