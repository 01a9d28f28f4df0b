# SPDX-License-Identifier: GPL-2.0-or-later
"""`check` and `install` with the stock interpreter: what it loads, refuses and says."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from g12.tools.commands import check, install, uninstall
from g12.tools.install.config import features
from g12.tools.install.config.findings import NOTE, PROBLEM
from g12.tools.install.lathe.hal_pins import pins_missing
from g12.tools.system import COMMAND
from support.kinematics import marked
from support.sample_configs import SAMPLES
from support.sim_machines import ROOT, SIM, trace_text
from support.small_configs import (
    HAAS,
    LATHE,
    MILL,
    config_of,
    content_of,
    restored,
    with_lines,
    write_config,
)

ABORT = "ON_ABORT_COMMAND = O <g12_on_abort> call\n"
REFERRED = f"SUBROUTINE_PATH = {ROOT}/ngc\n{ABORT}{HAAS}"
PYTHON = f"[PYTHON]\nTOPLEVEL = {ROOT}/python/toplevel.py\nPATH_PREPEND = {ROOT}/python\n"
GOOD = with_lines(MILL, "RS274NGC", REFERRED) + PYTHON
POCKET = ["G21 G17 G90 G94 G61 F600", "G13 I5 K9 Q3 Z-1 D1", "M2"]
OWN = "[PYTHON]\nPATH_PREPEND = mine\nTOPLEVEL = mine/toplevel.py\n"


def kinds(ini, capsys):
    """Return what check finds wrong, and that its exit code says so."""
    code = check.main([str(ini), "--json"])
    found = json.loads(capsys.readouterr().out)["findings"]
    wrong = [finding["kind"] for finding in found if finding["level"] != NOTE]
    assert code == any(finding["level"] == PROBLEM for finding in found)
    return wrong


# Configs set up by hand.


def test_a_good_config_is_good_and_left_alone(tmp_path, capsys):
    ini = write_config(tmp_path, GOOD)
    before = content_of(tmp_path)
    assert check.main([str(ini)]) == 0
    said = capsys.readouterr().out
    assert "loads in LinuxCNC 2." in said
    assert "G12    haas" in said
    assert said.endswith("nothing found\n")
    assert content_of(tmp_path) == before


@pytest.mark.parametrize(
    "ini", marked(ini for ini in sorted(SIM.glob("*.ini")) if "headless" not in ini.stem)
)
def test_every_machine_that_comes_with_the_package_is_good(ini, capsys):
    assert kinds(ini, capsys) == []


@pytest.mark.parametrize(
    ("table", "expected"),
    [
        ("T1 P1\nt2 p2 d+.25 ;x\n", []),
        ("T1 P1\nT2 P2 Z1\n", ["no-diameters"]),
        ("", ["no-diameters"]),
    ],
)
def test_the_tool_table_is_read_as_linuxcnc_reads_it(table, expected, tmp_path, capsys):
    assert kinds(write_config(tmp_path, GOOD, mill_tbl=table), capsys) == expected


def remap(text):
    return {"mine__toplevel_py": "import remap\n", "mine__remap_py": text}


@pytest.mark.parametrize(
    ("change", "files", "expected"),
    [
        (("TOPLEVEL = ", "TOPLEVEL = /nowhere"), {}, ["no-python"]),
        (("REMAP = G13", "REMAP = G33.1"), {}, ["owned"]),
        ((HAAS, HAAS + "REMAP = M400 modalgroup=10 python=mine\n"), {}, ["does-not-load"]),
        ((PYTHON, OWN), remap("from nowhere import x\n"), ["python-fails"]),
        ((PYTHON, OWN), remap("def f(:\n"), ["python-fails"]),
        ((PYTHON, OWN), remap("x = 1\n"), ["no-import"]),
        ((PYTHON, OWN), {"mine__toplevel_py": "import os\n"}, ["no-remap-module"]),
    ],
)
def test_what_is_wrong_is_found_and_linuxcnc_agrees(tmp_path, capsys, change, files, expected):
    assert change[0] in GOOD
    assert kinds(write_config(tmp_path, GOOD.replace(*change), **files), capsys) == expected


@pytest.mark.parametrize("length", [64, 68])
def test_a_python_that_fails_is_named_where_linuxcnc_crashes(length, capsys):
    """2.9.0~pre1 does so in the second program after that, if paths are about that long."""
    with TemporaryDirectory() as short:
        folder = Path(short) / ("x" * (length - len(short) - 1))
        folder.mkdir(exist_ok=True)
        config = write_config(folder, GOOD.replace(PYTHON, OWN), **remap("from nowhere import x\n"))
        assert kinds(config, capsys) == ["python-fails"]


def test_another_file_in_front_of_the_sub(tmp_path, capsys):
    prefix = "[DISPLAY]\nPROGRAM_PREFIX = programs\n"
    other = "o<g12_haas> sub\nG0 X99\no<g12_haas> endsub\n"
    ini = write_config(tmp_path, GOOD + prefix, programs__g12_haas_ngc=other)
    assert kinds(ini, capsys) == ["shadowed"]
    assert trace_text(POCKET, ini).moves[0].end[0] == 99


def test_a_python_oword_in_front_of_the_event(tmp_path, capsys):
    event = "".join(f"REMAP = {line.text}\n" for line in features.remaps_of("circle-mill"))
    own = "PATH_PREPEND = mine\n"
    text = with_lines(with_lines(GOOD, "RS274NGC", event), "PYTHON", own)
    ini = write_config(
        tmp_path,
        text.replace(f"{ROOT}/python/toplevel.py", "mine/toplevel.py"),
        mine__toplevel_py="import remap, oword\n",
        mine__oword_py="def circle_mill(self, *entries):\n    return 0.0\n",
    )
    assert kinds(ini, capsys) == ["shadowed"]
    assert trace_text(["F100", "o<circle_mill> call [7]", "M2"], ini).moves == []


def test_linuxcnc_finds_no_subs_below_a_blank(tmp_path, capsys):
    folder = tmp_path / "my mill"
    folder.mkdir()
    subs = {f"ngc__{name}_ngc": "" for name in ("g12_haas", "g12_on_abort")}
    ini = write_config(folder, GOOD.replace(f"{ROOT}/ngc", "ngc"), **subs)
    assert kinds(ini, capsys) == ["blank-in-path"]


# Installing.


def installed(ini, *arguments):
    return install.main([str(ini), "--with", *arguments])


@pytest.mark.parametrize(
    "names",
    [
        ("haas", "circle-mill", "programs-haas-mill"),
        ("yasnac",),
        ("mitsubishi",),
        ("polar", "polar-shapes", "cylinder"),
        ("polar-g12.3", "polar-shapes"),
    ],
)
def test_features_install_do_what_install_says_to_try_and_go(tmp_path, capsys, names):
    ini = write_config(tmp_path, LATHE if set(names) & set(features.AXES_NEEDED) else MILL)
    with restored(ini):
        assert installed(ini, *names) == 0
        said = capsys.readouterr().out
        assert "+REMAP = " in said
        assert said.endswith(f"\nto take it out again: {COMMAND} uninstall {ini}\n")
        said = said.partition("next: restart LinuxCNC, then try")[2].splitlines()[1:-1]
        assert len(said) == len(names)
        for line in said:
            assert tried(line, ini), line
        assert kinds(ini, capsys) == []
        settled = content_of(tmp_path)
        assert installed(ini, *names) == 0
        assert "nothing to do" in capsys.readouterr().out
        assert content_of(tmp_path) == settled


def tried(line, ini):
    """Tell whether LinuxCNC does what install says that a block does."""
    if line == "  open a .nc program of haas-mill":
        return True
    block, words = re.fullmatch(r"  (.*?) +((?:is refused|does nothing).*)", line).groups()
    traced = trace_text([block, "M2"], ini)
    answer = traced.error.text if traced.error else "nothing"
    first = re.sub(r"o<(.*)> call", r"\1", block) if "is refused" in words else "nothing"
    return traced.moves == [] and answer.startswith(first)


@pytest.mark.parametrize("own", [False, True])
def test_an_installed_pocket_is_that_of_the_simulated_mill(tmp_path, own):
    text = MILL + (OWN if own else "")
    files = remap("def mine(self, **words):\n    pass\n") if own else {}
    ini = write_config(tmp_path, text, **files)
    assert installed(ini, "haas") == 0
    tools = {1: 6.0}
    ends = [move.end for move in trace_text(POCKET, ini, tools=tools).moves]
    assert len(ends) > 5
    assert ends == [move.end for move in trace_text(POCKET, SIM / "mill_mm.ini", tools=tools).moves]


def test_a_toplevel_without_any_module_remap_gets_the_packages(tmp_path, capsys):
    files = {"mine__toplevel_py": "import os\n", "mine__other_py": ""}
    ini = write_config(tmp_path, MILL + OWN, **files)
    with restored(ini):
        assert installed(ini, "haas") == 0
        capsys.readouterr()
        assert kinds(ini, capsys) == []
        assert len(trace_text(POCKET, ini, tools={1: 6.0}).moves) > 5


@pytest.mark.parametrize(("own", "name"), [(False, ""), (True, "python/g12/cycles/haas.py")])
def test_a_damaged_copy_is_mended(tmp_path, capsys, own, name):
    ini = write_config(tmp_path, MILL + OWN * own, **(remap("x = 1\n") if own else {}))
    assert installed(ini, "haas") == 0
    whole = content_of(tmp_path)
    lost = tmp_path / "g12" / name
    lost.unlink() if name else shutil.rmtree(lost)
    assert installed(ini, "haas", "--dry-run") == 0
    assert not lost.exists()
    capsys.readouterr()
    assert installed(ini, "haas") == 0
    assert f"{tmp_path / 'g12'}: missing: {name or 'LICENSE, '}" in capsys.readouterr().out
    assert content_of(tmp_path) == whole


def test_a_path_as_long_as_linuxcnc_reads_is_installed(tmp_path, capsys):
    value = "/".join(["a" * 75] * 3)
    text = with_lines(MILL, "RS274NGC", f"SUBROUTINE_PATH = {value}\n")
    (tmp_path / value).mkdir(parents=True)
    ini = write_config(tmp_path, text)
    assert installed(ini, "haas") == 0
    (path,) = [line for line in ini.read_text().splitlines() if line.startswith("SUBR")]
    assert len(path) == 253
    capsys.readouterr()
    assert kinds(ini, capsys) == []


def test_a_bad_setting_does_not_hinder_uninstall(tmp_path, capsys):
    ini = write_config(tmp_path)
    before = content_of(tmp_path)
    installed(ini, "haas")
    wrong = ini.read_text() + "[G12]\nNONSENSE = 1\n"
    ini.write_text(wrong)
    capsys.readouterr()
    assert kinds(ini, capsys) == ["setting"]
    assert uninstall.main([str(ini)]) == 0
    ini.write_text(ini.read_text().removesuffix("[G12]\nNONSENSE = 1\n"))
    assert ini.read_bytes() == before["mill.ini"]


@pytest.mark.parametrize(
    ("text", "files", "feature", "says"),
    [
        (
            with_lines(MILL, "RS274NGC", "REMAP = g13 modalgroup=1 ngc=mine\n"),
            {"mine_ngc": "o<mine> sub\no<mine> endsub\n"},
            "haas",
            "G13 is remapped here already",
        ),
        (LATHE, {}, "haas", "haas needs axis Y"),
        (MILL + "[G12\n", {}, "haas", "[G12: begins no section"),
        (MILL + OWN, remap("import nowhere\n"), "haas", "No module named 'nowhere'"),
        (MILL + OWN, remap("def g12_haas(self): pass\n"), "haas", "has a function g12_haas"),
        (MILL + OWN, {"mine__toplevel_py": "class remap: f = len\n"}, "haas", "is no module"),
        (with_lines(MILL, "RS274NGC", "REMAP = M400 python=x\n"), {}, "haas", "does not load"),
    ],
)  # fmt: skip
def test_what_check_calls_a_problem_is_refused_and_nothing_is_touched(
    tmp_path, capsys, text, files, feature, says
):
    ini = write_config(tmp_path, text, **files)
    before = content_of(tmp_path)
    assert installed(ini, feature) == 1
    error = capsys.readouterr().err
    assert says in error
    assert all(line.startswith("g12 install: ") for line in error.splitlines())
    assert "; cure: " in error
    assert content_of(tmp_path) == before


def test_a_shared_include_is_tried_with_every_machine_that_has_it(tmp_path, capsys):
    base = "[RS274NGC]\nPARAMETER_FILE = x.var\n[EMCIO]\nTOOL_TABLE = mill.tbl\n[TRAJ]\n"
    text = "#INCLUDE base.inc\nCOORDINATES = X Y Z\n"
    ini = write_config(tmp_path, text, base_inc=base)
    other = write_config(tmp_path, text, "other.ini")
    assert installed(ini, "haas") == 0
    capsys.readouterr()
    assert kinds(other, capsys) == []
    assert uninstall.main([str(ini)]) == 0
    other.write_text(text.replace("X Y Z", "X Z"))
    before = content_of(tmp_path)
    assert installed(ini, "haas") == 1
    error = capsys.readouterr().err
    assert "other.ini includes base.inc too and gets the same lines: haas needs axis Y" in error
    assert "; cure: in other.ini: add the axis to the machine" in error
    assert content_of(tmp_path) == before


def test_what_is_wrong_in_another_machine_anyway_is_refused_by_its_name(tmp_path, capsys):
    base = "[RS274NGC]\nPARAMETER_FILE = x.var\nSUBROUTINE_PATH = .\n"
    text = "#INCLUDE base.inc\n[EMCIO]\nTOOL_TABLE = mill.tbl\n[TRAJ]\nCOORDINATES = X Y Z\n"
    ini = write_config(tmp_path, text, base_inc=base)
    other = write_config(tmp_path, f"{text}[PYTHON]\nTOPLEVEL = gone.py\n", "other.ini")
    assert check.main([str(other)]) == 1
    said = capsys.readouterr().out
    assert re.search(r"loads in LinuxCNC \S+ without its \[PYTHON\], axes X Y Z", said)
    assert "cure: correct the name in TOPLEVEL = gone.py" in said
    before = content_of(tmp_path)
    assert installed(ini, "haas") == 1
    error = capsys.readouterr().err
    assert "other.ini includes base.inc too" in error and "gone.py" in error
    assert content_of(tmp_path) == before


def test_a_filter_of_the_users_own_does_not_prevent_an_installation(tmp_path, capsys):
    line = "nc = python3 /gone/python/g12 translate --control haas-mill"
    ini = write_config(tmp_path, f"{MILL}[FILTER]\n{line}\n")
    assert installed(ini, "haas") == 0
    warned = [line for line in capsys.readouterr().out.splitlines() if "warning" in line]
    gone, no_upper_case = warned
    assert "/gone/python/g12 is not there" in gone and "run install" not in gone
    assert "NC is not" in no_upper_case


def test_machines_that_share_a_module_remap_still_load(tmp_path, capsys):
    ini = write_config(tmp_path, MILL + OWN, **remap("def mine(self, **words):\n    return 0\n"))
    own = "REMAP = M400 modalgroup=10 python=mine\n"
    other = write_config(tmp_path, with_lines(MILL + OWN, "RS274NGC", own), "other.ini")
    assert installed(ini, "haas") == 0
    assert trace_text(["M400", "M2"], other).error is None
    capsys.readouterr()
    assert kinds(other, capsys) == ["no-codes"]


def test_the_installed_copy_checks_and_uninstalls_itself(tmp_path):
    ini = write_config(tmp_path)
    before = content_of(tmp_path)
    assert installed(ini, "haas") == 0
    environment = {**os.environ, "HOME": str(tmp_path)}
    for command in ("check", "uninstall"):
        call = [sys.executable, "g12/python/g12", command, "mill.ini"]
        done = subprocess.run(
            call, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stdout + done.stderr
    assert content_of(tmp_path) == before


WRONG_SAMPLES = {  # that name pins of earlier versions of LinuxCNC: it does not start with them
    "rolfmill.ini",
    "3-axis-servo.ini",
    "3-axis-stepper.ini",
}


def test_the_pins_of_linuxcncs_own_samples_are_there():
    inis = sorted(SAMPLES.rglob("*.ini"))
    wrong = {ini.name for ini in inis if any(pins_missing(config_of(ini)))}
    assert inis
    assert wrong <= WRONG_SAMPLES
