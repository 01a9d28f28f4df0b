# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 regress`` as a shop uses it: record, change something, check; and every wrong use."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from g12.tools.commands import main as command_line
from g12.tools.regress.recorder import hash_of
from g12.tools.system import COMMAND
from support.processes import living, until
from support.sim_machines import PROGRAMS, ROOT, SIM, with_package
from support.small_configs import MILL

INI = SIM / "mill_inch.ini"
POCKET = """\
G20 G17 G40 G49 G54 G80 G90 G94
T1 M6
S1000 M3
M8
G0 X1 Y2 Z.1
G12 I.3 K1.5 Q.2 Z-.5 D1 F10
G0 Z.1
X5
M9
M2
"""
PLAIN = "G21 G90 F300\nG0 X0 Y0\nG1 X10\nG1 Y10\nG1 X0\nG1 Y0\nM2\n"


class Shop:
    """A folder with programs, a directory for recordings, and the command."""

    def __init__(self, folder, capsys):
        self.folder, self._capsys = folder, capsys
        self.programs, self.recordings = folder / "nc", folder / "regress"
        self.programs.mkdir()

    def write(self, name, text, folder=None):
        path = (folder or self.programs) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def change(self, name, old, new):
        path = self.programs / name
        text = path.read_text(encoding="utf-8")
        assert old in text
        path.write_text(text.replace(old, new), encoding="utf-8")

    def run(self, action, *words, jobs=1):
        """Run the command; return its exit code, its lines and its errors."""
        words = [action, *map(str, words), "-d", str(self.recordings), "--jobs", str(jobs)]
        self._capsys.readouterr()
        code = command_line.main(["regress", *words])
        said = self._capsys.readouterr()
        return code, said.out.splitlines(), said.err.splitlines()

    def record(self, *words, ini=INI):
        code, lines, errors = self.run("record", self.programs, "--ini", ini, *words)
        assert (code, errors) == (0, [])
        return lines

    def check(self, *words, **options):
        code, lines, errors = self.run("check", *words, **options)
        assert errors == []
        return code, lines

    def trace(self, name):
        return self.recordings / f"{name}.trace"


@pytest.fixture
def shop(tmp_path, capsys):
    return Shop(tmp_path, capsys)


@pytest.fixture
def pocket(shop):
    shop.write("pocket.ngc", POCKET)
    shop.write("sub/plain.ngc", PLAIN)
    shop.record()
    return shop


# ---------------------------------------------------------------- record, check, record


def test_what_was_recorded_is_as_recorded_and_recording_again_changes_no_file(shop):
    shop.write("pocket.ngc", POCKET)
    shop.write("sub/plain\n.ngc", PLAIN)
    new = ["pocket.ngc: new, 25 moves", "sub/plain", ".ngc: new, 5 moves", "2 programs: 2 new"]
    assert "\n".join(shop.record()).split("\n") == new
    assert shop.check() == shop.check(jobs=2) == (0, ["2 programs: 2 as recorded"])
    text = shop.trace("pocket.ngc").read_text(encoding="utf-8")
    program = f"g12 trace 1\nprogram pocket.ngc {hash_of(POCKET.encode())}\n"
    assert text.startswith(f"{program}machine mill_inch.ini sha256:")
    assert str(ROOT) not in text and str(shop.folder) not in text
    assert "\n6: G12 I.3 K1.5 Q.2 Z-.5 D1 F10\n  feed Z-0.5 F10\n" in text
    files = [path for path in shop.recordings.rglob("*") if path.is_file()]
    before = [path.read_bytes() for path in files]
    times = [path.stat().st_mtime_ns for path in files if path.suffix == ".trace"]
    shop.record()
    assert [path.read_bytes() for path in files] == before
    assert [path.stat().st_mtime_ns for path in files if path.suffix == ".trace"] == times


@pytest.mark.parametrize(
    ("old", "new", "words", "finding"),
    [
        ("G12 I.3", "(the pocket)\nN20 G12 (clockwise) I.3", [], ""),
        ("M8\n", "", [], "pocket.ngc:5 as recorded: missing: M8 on"),
        ("T1 M6", "T1 M6 G43", [], "pocket.ngc:5: new: G43"),
        ("M2", "M30", [], "pocket.ngc: modal state at the end: M2 → M30"),
        ("X5", "X5.0005", ["--tolerance", "0.0006"], ""),  # in machine units
        ("X5", "X5.0005", ["--tolerance", "0.0004"], "pocket.ngc:8: 1 move: X5 → X5.0005 (+0.0005"),
        ("Q.2", "Q.25", ["--picture", "changes"], "pocket.ngc:6: "),
    ],
)
def test_what_changed_is_reported_and_recording_again_accepts_it(
    pocket, monkeypatch, old, new, words, finding
):
    monkeypatch.chdir(pocket.folder)
    pocket.change("pocket.ngc", old, new)
    code, lines = pocket.check("pocket.ngc", *words)
    assert code == bool(finding) and lines[0].startswith(finding or "1 program: 1 as recorded")
    if "--picture" in words:
        assert "pocket.ngc: see changes/pocket.ngc.png" in lines
        (picture,) = (pocket.folder / "changes").iterdir()
        assert picture.read_bytes().startswith(b"\x89PNG")
    elif finding:
        again = pocket.run("record")
        assert (again[0], again[1][0]) == (0, lines[0]) and pocket.check()[0] == 0


def test_programs_named_one_by_one(shop):
    one, other = (shop.write(f"{name}.ngc", PLAIN) for name in "ab")
    assert shop.run("record", one, "--ini", INI)[1] == ["a.ngc: new, 5 moves", "1 program: 1 new"]
    assert shop.check() == (0, ["1 program: 1 as recorded"])
    assert shop.run("record", other)[0] == 0
    shop.change("b.ngc", "X10", "X11")
    assert shop.check("a.ngc") == (0, ["1 program: 1 as recorded"])
    assert shop.check(other)[0] == 1


def test_a_finding_for_other_programs_is_json(pocket):
    pocket.change("pocket.ngc", "X5", "X5.25")
    code, lines = pocket.check("--json")
    report = json.loads("\n".join(lines))
    assert (code, report["good"]) == (1, False)
    changed, same = report["programs"]
    assert (same["program"], same["verdict"], same["findings"]) == ("sub/plain.ngc", "same", [])
    (finding,) = changed["findings"]
    assert finding["lines"] == finding["recorded_lines"] == [8]
    assert (finding["kind"], finding["axis"], finding["by"]) == ("moved", "X", 0.25)
    assert finding["block"] == "X5.25"


# ---------------------------------------------------------------- refused, added, gone, failed


def test_a_refusal_can_be_what_is_expected(shop):
    shop.write("refused.ngc", POCKET.replace("I.3", "I-.3"))
    assert shop.record()[0].startswith("refused.ngc: new, refused at line 6: G12: I-0.3")
    assert shop.check() == (0, ["1 program: 1 as recorded"])
    shop.write("refused.ngc", POCKET)
    code, lines = shop.check()
    assert code == 1
    assert any("no longer refused, was at line 6: G12: I-0.3" in line for line in lines)


def test_programs_added_and_missing(pocket):
    (pocket.programs / "pocket.ngc").rename(pocket.programs / "other.ngc")
    code, lines = pocket.check()
    assert code == 1
    assert lines == [
        "other.ngc: added, it is not recorded",
        "pocket.ngc: missing, it was recorded",
        "3 programs: 1 as recorded, 1 added, 1 missing",
    ]
    code, lines, _ = pocket.run("record")
    assert code == 0
    assert lines[:2] == ["other.ngc: new, 25 moves", "pocket.ngc: missing, it was recorded"]
    assert not pocket.trace("pocket.ngc").exists()
    assert pocket.check() == (0, ["2 programs: 2 as recorded"])


def test_a_program_without_an_end_fails_and_the_others_are_checked(pocket):
    pocket.write("endless.ngc", "o1 while [1]\no1 endwhile\nM2\n")
    code, lines, _ = pocket.run("record", "--timeout", "1")
    assert code == 1
    assert lines[0] == "endless.ngc: no trace: no end within 1 s"
    assert lines[-1] == "3 programs: 2 as recorded, 1 failed"
    assert not pocket.trace("endless.ngc").exists()


REMAP = """\
times = []


def again(self, **words):
    times.append(1)
    self.execute(f"G0 X{len(times)}")
    return 0
"""
REMAPPED = """
REMAP = M400 modalgroup=10 python=again
[PYTHON]
TOPLEVEL = own.py
PATH_PREPEND = .
"""


def test_no_program_leaves_anything_to_the_next(shop):
    """The machine's Python keeps state from one program to the next."""
    shop.write("own.py", "import remap\n", shop.folder)
    shop.write("remap.py", REMAP, shop.folder)
    for name in ("a.ngc", "b.ngc"):
        shop.write(name, "G21\nM400\nM400\nM2\n")
    shop.record(
        ini=shop.write("own.ini", MILL.replace("\n\n[TRAJ]", f"{REMAPPED}[TRAJ]"), shop.folder)
    )
    for name in ("a.ngc", "b.ngc"):
        text = shop.trace(name).read_text(encoding="utf-8")
        assert "\n  rapid X1\n" in text and "\n  rapid X2\n" in text
        assert "rapid X3" not in text


ALL_AT_WORK = 7  # the command, two interpreters of three processes each


@pytest.fixture
def endless(shop, start):
    """Start a recording whose programs come to no end; return it when all are at work."""
    for name in ("a.ngc", "b.ngc", "c.ngc"):
        shop.write(name, "o1 while [1]\no1 endwhile\nM2\n")
    words = ["regress", "record", "nc", "--ini", str(INI), "-d", "regress", "--jobs", "2"]
    command = [sys.executable, str(ROOT / "python" / "g12"), *words]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    process = start(*command, cwd=shop.folder, **pipes)
    assert until(lambda: len(living(process.pid)) >= ALL_AT_WORK, 240)
    time.sleep(2)
    return process


def test_an_interrupted_recording_ends_at_once(endless):
    os.killpg(endless.pid, signal.SIGINT)  # as a terminal does
    _, said = endless.communicate(timeout=120)
    assert (endless.returncode, said) == (130, "g12 regress: interrupted\n")
    assert living(endless.pid) == []


def test_interpreters_that_are_killed_are_reported_in_a_line_each(endless):
    while endless.poll() is None:
        for number in set(living(endless.pid)) - {endless.pid}:
            with contextlib.suppress(ProcessLookupError):
                os.kill(number, signal.SIGKILL)  # as a system without memory does
        time.sleep(1)
    out, errors = endless.communicate()
    assert (endless.returncode, "Traceback" in errors) == (1, False)
    died = [f"{name}.ngc: no trace: the interpreter died" for name in "abc"]
    assert out.splitlines() == [*died, "3 programs: 3 failed"]


# ---------------------------------------------------------------- other versions of things


def test_new_versions_of_the_programs_in_another_folder(pocket):
    new = pocket.folder / "post"
    pocket.write("pocket.ngc", POCKET.replace("K1.5", "K1.6"), new)
    pocket.write("more.ngc", PLAIN, new)
    code, lines = pocket.check("--programs", new)
    assert code == 1 and "sub/plain.ngc: missing, it was recorded" in lines
    assert lines[0] == "more.ngc: added, it is not recorded"
    assert lines[1].startswith("pocket.ngc:6: ")


def test_another_machine_and_linuxcnc_are_noted_and_their_effect_found(shop):
    """The var file is the recorded one."""
    ini = shop.write("own.ini", MILL, shop.folder)
    var = shop.write("mill.var", "100\t7.0\n5221\t3.0\n", shop.folder)
    shop.write("shift.ngc", "G90 G54\nG0 X#100\nM2\n")
    shop.record("--var", var, ini=ini)
    trace = shop.trace("shift.ngc")
    text = trace.read_text(encoding="utf-8")
    assert "\n  rapid X10\n" in text
    var.write_text("100\t8.0\n", encoding="utf-8")
    version = text.split("\n")[3]
    trace.write_text(text.replace(version, "linuxcnc 2.8.0"), encoding="utf-8")
    old = f"note: LinuxCNC 2.8.0 when recorded, {version.partition(' ')[2]} now"
    worn = "note: mill.var has changed since the recording, its recorded copy is used"
    assert shop.check() == (0, [old, worn, "1 program: 1 as recorded"])
    started = "[RS274NGC]\nRS274NGC_STARTUP_CODE = G20\n"
    ini.write_text(MILL.replace("[RS274NGC]\n", started), encoding="utf-8")
    code, lines = shop.check()
    assert code == 1 and "note: own.ini has changed since the recording" in lines
    assert any("X10 → X180.8 (+170.8 mm)" in line for line in lines)


def test_a_tool_that_wears_changes_no_recording_until_requested(shop):
    ini = shop.write("own.ini", MILL, shop.folder)
    table = shop.write("mill.tbl", "T1 P1 D6 Z10\n", shop.folder)
    comped = "G21 T1 M6\nG43\nG41 D1\nG1 X20 F100\nY20\nX40\nG40\nX50\nM2\n"
    shop.write("comped.ngc", comped)
    shop.record(ini=ini)
    table.write_text("T1 P1 D5.9 Z10.5\n", encoding="utf-8")
    note = "note: mill.tbl has changed since the recording, its recorded copy is used"
    assert shop.check() == (0, [note, "1 program: 1 as recorded"])
    code, lines = shop.check("--tools", table)
    assert code == 1
    assert any("tool offset Z10 → tool offset Z10.5" in line for line in lines)
    assert any("0.05 mm" in line for line in lines)
    assert shop.run("record")[0] == 0
    assert shop.check() == (0, ["1 program: 1 as recorded"])


# ---------------------------------------------------------------- wrong uses


def wrong(shop, *words):
    code, lines, errors = shop.run(*words)
    assert (code, lines, len(errors)) == (2, [], 1), (code, lines, errors)
    assert errors[0].startswith("g12 regress: ")
    return errors[0][len("g12 regress: ") :]


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        ("check", "REGRESS: nothing is recorded there (no regress.json)"),
        (f"record --ini {INI}", "REGRESS: nothing is recorded there; name the programs"),
        ("record PLAIN", "REGRESS: nothing is recorded there; name the machine, --ini"),
        (f"record no.ngc --ini {INI}", "no.ngc: no such file or folder"),
        ("record PLAIN --ini no.ini", "no.ini: no such file"),
        (f"record EMPTY --ini {INI}",
         "EMPTY: no programs in this folder (.ngc, .nc, .tap, .gcode, .min, .eia)"),
        (f"record PLAIN --ini {INI} --tools no.tbl", "no.tbl: no such file"),
        (f"record PLAIN --ini {INI} -d PLAIN", "PLAIN: not a directory"),
    ],
)  # fmt: skip
def test_wrong_uses_of_an_empty_directory(shop, words, problem):
    names = {"PLAIN": shop.write("plain.ngc", PLAIN), "EMPTY": shop.programs / "empty"}
    names["EMPTY"].mkdir()
    if words.endswith("-d PLAIN"):
        shop.recordings, words = names["PLAIN"], words.removesuffix(" -d PLAIN")
    said = wrong(shop, *(names.get(word, word) for word in words.split()))
    for name, path in {**names, "REGRESS": shop.recordings}.items():
        problem = problem.replace(name, str(path))
    assert said == problem and not (shop.folder / "regress").exists()


def test_wrong_uses_of_a_recorded_directory(pocket):
    elsewhere = pocket.write("other.ngc", PLAIN, pocket.folder / "elsewhere")
    program, about = pocket.programs / "pocket.ngc", pocket.recordings / "regress.json"
    for words, problem in (
        (["record", elsewhere], "; use another -d for it"),
        (["record", program, "--ini", SIM / "mill_mm.ini"], ": name no programs to record it"),
        (["check", "no.ngc"], f"no.ngc: not recorded in {pocket.recordings}"),
        (["check", "--programs", "no"], "no: no such file or folder"),
        (["check", "--tools", "no.tbl"], "no.tbl: no such file"),
        (["check", "--ini", "no.ini"], "no.ini: no such file"),
    ):
        assert wrong(pocket, *words).endswith(problem)
    text = about.read_text(encoding="utf-8")
    without = (json.dumps({**json.loads(text), key: None}) for key in ("ini", "programs"))
    other = text.replace('"format": 1', '"format": 2')
    for damaged in ("<<<<<<<", text.replace("[", "null, ["), other, *without):
        about.write_text(damaged, encoding="utf-8")
        why = "not a file of g12 regress, or of another version"
        assert wrong(pocket, "check") == f"{about}: {why}"


def test_a_damaged_recording_is_named_and_can_be_recorded_again(pocket):
    path, other = pocket.trace("pocket.ngc"), pocket.trace("sub/plain.ngc")
    path.write_text("<<<<<<< mine\n", encoding="utf-8")
    assert wrong(pocket, "check") == (
        f"{path}: not a trace, or one that was edited: line 1: not 'g12 trace 1'"
    )
    other.write_text(other.read_text(encoding="utf-8") + "junk\n", encoding="utf-8")
    assert "something after the end" in wrong(pocket, "check", "sub/plain.ngc")
    assert pocket.run("record")[0] == pocket.check()[0] == 0


def test_a_machine_that_does_not_load_is_one_line(shop):
    ini = shop.write("own.ini", MILL + "[PYTHON]\nTOPLEVEL = own.py\n", shop.folder)
    shop.write("own.py", "import nothing_of_this_name\n", shop.folder)
    shop.write("plain.ngc", PLAIN)
    code, lines, errors = shop.run("record", shop.programs, "--ini", ini, jobs=2)
    assert (code, lines, len(errors)) == (2, [], 1)
    assert "No module named 'nothing_of_this_name' (own.py:1)" in errors[0]


# ---------------------------------------------------------------- pytest


TEST = """\
from pathlib import Path

import pytest

from g12.tools.regress.pytest_plugin import recorded_programs

REGRESS = Path(__file__).with_name("regress")


@pytest.mark.parametrize("program", recorded_programs(REGRESS))
def test_program(gcode_regression, program):
    gcode_regression(REGRESS, program)


def test_all(gcode_regression):
    gcode_regression("regress", tolerance=1e-4)
"""


def test_the_fixture_of_the_plugin(pocket):
    pocket.write("test_programs.py", TEST, pocket.folder)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    command += ["-p", "g12.tools.regress.pytest_plugin"]

    def run(*words):
        options = {"cwd": pocket.folder, "env": with_package(os.environ), "text": True}
        return subprocess.run([*command, *words], capture_output=True, **options).stdout

    assert "3 passed" in run()
    pocket.change("pocket.ngc", "X5", "X5.0002")
    bad = run()
    assert "2 failed, 1 passed" in bad
    assert "pocket.ngc:8: 1 move: X5 → X5.0002 (+0.0002 in)" in bad
    assert f"if that is right: {COMMAND} regress record -d" in bad
    recorded = pocket.folder / "regress" / "regress.json"
    recorded.write_text(recorded.read_text().replace('.ini"', '.gone"'))
    wrong = run("-k", "all")
    assert ".gone: no such file" in wrong
    assert "UsageError" not in wrong


# ---------------------------------------------------------------- the project's own recordings

pytest_plugins = ["g12.tools.regress.pytest_plugin"]
OWN = sorted(path.parent.relative_to(PROGRAMS) for path in PROGRAMS.glob("*/regress/regress.json"))


@pytest.mark.parametrize("directory", OWN, ids=lambda path: path.parts[0])
def test_the_manuals_programs_do_what_they_did(gcode_regression, directory):
    gcode_regression(Path(PROGRAMS, directory))
