# SPDX-License-Identifier: GPL-2.0-or-later
"""`check` and `install` with the stock interpreter: what it loads, refuses and says."""

import os
import re
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from g12.tools.commands.main import main
from g12.tools.install.config import features
from g12.tools.install.lathe.hal import pins_missing, pins_taken
from g12.tools.system import COMMAND
from support.kinematics import marked
from support.sample_configs import SAMPLES
from support.sim_machines import ROOT, SIM, trace_text
from support.small_configs import (
    HAAS,
    LATHE,
    MILL,
    TURNING,
    TURNING_HAL,
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
PINS = "velocity = 'drive.velocity'\nposition = 'p'\nholds = 'h'\n"
OWN = "[PYTHON]\nPATH_PREPEND = mine\nTOPLEVEL = mine/toplevel.py\n"


def kinds(ini, capsys):
    """Return what check finds wrong, and that its exit code and its last line say so."""
    code = main(["check", str(ini)])
    said = capsys.readouterr().out
    found = re.findall(r"^(problem|warning) \[(.*?)\]: ", said, re.MULTILINE)
    assert code == any(level == "problem" for level, _ in found)
    assert found or (": loads in LinuxCNC 2." in said and said.endswith("nothing found\n"))
    return [kind for _, kind in found]


# Configs set up by hand.


@pytest.mark.parametrize(
    "ini", marked(ini for ini in sorted(SIM.glob("*.ini")) if "headless" not in ini.stem)
)
def test_every_machine_that_comes_with_the_package_is_good(ini, capsys):
    assert kinds(ini, capsys) == []


def remap(text):
    return {"mine__toplevel_py": "import remap\n", "mine__remap_py": text}


@pytest.mark.parametrize(
    ("change", "files", "expected"),
    [
        (("TOPLEVEL = ", "TOPLEVEL = /nowhere"), {}, ["python-fails"]),
        ((PYTHON, f"{PYTHON}[G12]\nTOPLEVEL = gone.py\n"), {}, ["python-fails"]),
        (("REMAP = G13", "REMAP = G33.1"), {}, ["owned"]),
        ((HAAS, HAAS + "REMAP = M400 modalgroup=10 python=mine\n"), {}, ["does-not-load"]),
        ((PYTHON, OWN), remap("def f(:\n"), ["python-fails"]),
        ((PYTHON, OWN), {"mine__toplevel_py": "import os\n"}, ["no-import"]),
    ],
)
def test_what_is_wrong_is_found_and_linuxcnc_agrees(tmp_path, capsys, change, files, expected):
    assert kinds(write_config(tmp_path, GOOD.replace(*change), **files), capsys) == expected


def test_a_python_that_fails_is_named_where_linuxcnc_crashes(capsys):
    """2.9.0~pre1 does so in the second program after that, if paths are about that long."""
    with TemporaryDirectory() as short:
        folder = Path(short) / ("x" * (64 - len(short) - 1))
        folder.mkdir(exist_ok=True)
        config = write_config(folder, GOOD.replace(PYTHON, OWN), **remap("from nowhere import x\n"))
        assert kinds(config, capsys) == ["python-fails"]


def test_another_file_in_front_of_the_sub(tmp_path, capsys):
    prefix = "[DISPLAY]\nPROGRAM_PREFIX = programs\n"
    other = "o<g12_haas> sub\nG0 X99\no<g12_haas> endsub\n"
    ini = write_config(tmp_path, GOOD + prefix, programs__g12_haas_ngc=other)
    assert kinds(ini, capsys) == ["shadowed"]
    assert trace_text(POCKET, ini).moves[0].end[0] == 99


# Installing.


def installed(ini, *arguments):
    return main(["install", "--with", *arguments, str(ini)])  # the INI may come last


@pytest.mark.parametrize(
    "names",
    [
        ("haas", "circle-mill", "bore", "thread", "frame", "programs-haas-mill"),
        ("yasnac",),
        ("mitsubishi",),
        ("polar", "polar-shapes", "cylinder"),
        ("polar-g12.3", "polar-shapes"),
    ],
)
def test_features_install_do_what_install_says_to_try_and_go(tmp_path, capsys, names):
    ini = write_config(tmp_path, LATHE if set(names) & set(features.ON_LATHE) else MILL)
    with restored(ini):
        before = content_of(tmp_path)
        assert installed(ini, *names, "--dry-run") == 0
        assert content_of(tmp_path) == before
        said = capsys.readouterr().out
        assert "+REMAP = " in said and "would get the package" in said
        assert said.endswith("dry run: nothing was written\n")
        assert installed(ini, *names) == 0
        said = capsys.readouterr().out
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


@pytest.mark.parametrize(
    "files",
    [
        remap("def mine(self, **words):\n    return 0\n"),
        {"mine__toplevel_py": "import os\nclass remap:\n    mine = len\n"},
        {"mine__toplevel_py": "import os\ndef other(): pass\n", "mine__other_py": ""},
    ],
)
def test_the_users_own_python_stays_in_charge_and_the_pocket_is_that_of_the_sim(
    tmp_path, capsys, files
):
    has_own = "mine" in "".join(files.values())
    own = "REMAP = M400 modalgroup=10 python=mine\n" if has_own else ""
    ini = write_config(tmp_path, with_lines(MILL + OWN, "RS274NGC", own), **files)
    with restored(ini):
        assert installed(ini, "haas") == 0
        capsys.readouterr()
        assert kinds(ini, capsys) == []
        ends = [move.end for move in trace_text(POCKET, ini, tools={1: 6.0}).moves]
        sim = trace_text(POCKET, SIM / "mill_mm.ini", tools={1: 6.0})
        assert len(ends) > 5 and ends == [move.end for move in sim.moves]
        if "def mine" in "".join(files.values()):
            assert trace_text(["M400", "M2"], ini).error is None


G13 = "REMAP = g13 modalgroup=1 ngc=mine\n"
REFUSED = [  # an INI, other files, the feature, what is said
    (with_lines(MILL, "RS274NGC", G13), {"mine_ngc": "o<mine> sub\no<mine> endsub\n"}, ["haas"],
     "G13 is remapped here already"),
    (MILL + OWN, remap("def g12_haas(self): pass\n"), ["haas"], "has no g12_haas of the package"),
    (MILL + "[PYTHON]\nTOPLEVEL = gone.py\n", {}, ["haas"], "can't resolve path to 'gone.py'"),
    (with_lines(MILL, "RS274NGC", "REMAP = M400 python=x\n"), {}, ["haas"], "does not load"),
    (MILL, {}, ["haas", "yasnac"], "haas and yasnac exclude each other"),
    (TURNING, {"motion_hal": f"{TURNING_HAL}loadrt pid names=drive\n", "pins_toml": PINS},
     ["spindle-c", "--pins", "pins.toml"], "there is no pin drive.velocity"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "files", "names", "says"), REFUSED)
def test_what_check_calls_a_problem_is_refused_and_nothing_is_touched(
    tmp_path, capsys, monkeypatch, text, files, names, says
):
    monkeypatch.chdir(tmp_path)
    ini = write_config(tmp_path, text, **files)
    before = content_of(tmp_path)
    assert installed(ini, *names) in (1, 2)
    error = capsys.readouterr().err
    assert says in error
    assert all(line.startswith("g12 install: ") for line in error.splitlines())
    assert content_of(tmp_path) == before


def test_a_shared_include_is_tried_with_every_machine_that_has_it(tmp_path, capsys):
    base = "[RS274NGC]\nPARAMETER_FILE = x.var\n[EMCIO]\nTOOL_TABLE = mill.tbl\n[TRAJ]\n"
    text = "#INCLUDE base.inc\nCOORDINATES = X Y Z\n"
    ini = write_config(tmp_path, text, base_inc=base)
    other = write_config(tmp_path, text, "other.ini")
    assert installed(ini, "haas") == 0
    capsys.readouterr()
    assert kinds(other, capsys) == []
    assert main(["uninstall", str(ini)]) == 0
    other.write_text(text.replace("X Y Z", "X Z"))
    before = content_of(tmp_path)
    assert installed(ini, "haas") == 1
    error = capsys.readouterr().err
    assert "other.ini includes base.inc too and gets the same lines: haas needs axis Y" in error
    assert "; cure: in other.ini: add the axis to the machine" in error
    assert content_of(tmp_path) == before


def test_what_was_wrong_before_does_not_prevent_an_installation(tmp_path, capsys):
    line = "nc = python3 /gone/python/g12 translate --control haas-mill"
    hal = "net a motion.in-position\nnet b motion.in-position\n"
    text = f"{MILL}[FILTER]\n{line}\n[HAL]\nHALFILE = own.hal\n"
    ini = write_config(tmp_path, text, own_hal=hal)
    assert installed(ini, "haas") == 0
    warned = [line for line in capsys.readouterr().out.splitlines() if "warning" in line]
    assert [re.search(r"\[(.*?)\]", line)[1] for line in warned] == [
        "filter",
        "filter",
        "pin-taken",
    ]


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


WRONG_SAMPLES = {  # of LinuxCNC, which does not start with them
    *("rolfmill.ini", "3-axis-servo.ini", "3-axis-stepper.ini"),  # pins of earlier versions
    "dallur-advanced.ini",  # a pin on two signals
}


def test_the_hal_files_of_linuxcncs_own_samples_are_in_order():
    inis = sorted(SAMPLES.rglob("*.ini"))
    found = {ini.name for ini in inis for rule in (pins_missing, pins_taken)
             if any(rule(config_of(ini)))}  # fmt: skip
    assert inis
    assert found <= WRONG_SAMPLES
