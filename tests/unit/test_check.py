# SPDX-License-Identifier: GPL-2.0-or-later
"""What `check` finds in a config, rule by rule; without LinuxCNC."""

import json

import pytest

from g12.machine_ini import remap_from_value
from g12.tools.commands import check
from g12.tools.install import package_copy
from g12.tools.install.checking import check_report, lines_of_check
from g12.tools.install.config import features
from g12.tools.install.config.findings import NOTE, PROBLEM, WARNING, ConfigFinding
from g12.tools.install.rules import findings_of
from g12.tools.preview.loading import python_error
from support.small_configs import HAAS, LATHE, MILL, config_of, with_lines, write_config

HANDLERS = {name: "g12.remap" for f in features.REMAP_FILES for name in features.functions_of(f)}
HANDLERS |= {"g12_on_abort": "g12.remap"}
PYTHON = "[PYTHON]\nTOPLEVEL = toplevel.py\n"
SUBS = "SUBROUTINE_PATH = ngc\n"
ABORT = "ON_ABORT_COMMAND = O <g12_on_abort> call\n"
GOOD = with_lines(MILL, "RS274NGC", f"{SUBS}{HAAS}{ABORT}") + PYTHON


@pytest.fixture
def found(tmp_path):
    """Return a function: the findings about an INI with everything else in order."""

    def find(text, remap=HANDLERS, remap_file="remap.py", files=(), **facts):
        names = {name for feature in features.REMAP_FILES for name in features.names_of(feature)}
        subs = {f"ngc__{name}_ngc": "" for name in (*names, "g12_on_abort")}
        in_order = {"toplevel_py": "", "mill_var": "5161\t50.0\n", **dict(files)}
        ini = write_config(tmp_path, text, **in_order, **subs)
        package = tmp_path / "python" / "g12"
        config = config_of(ini, remap=remap, remap_file=remap_file, package=package, **facts)
        return findings_of(config)

    return find


def lines_of(feature):
    return "".join(f"REMAP = {remap.text}\n" for remap in features.remaps_of(feature)) + ABORT


def kinds(findings):
    return [finding.kind for finding in findings]


def test_what_was_changed_in_the_copy_is_named(found, tmp_path):
    assert found(GOOD) == []
    copy = tmp_path / "g12"
    listed = {f"ngc/{name}.ngc": b"one\ntwo\n" for name in ("g12_haas", "form_slot_mm", "lost")}
    package_copy.write_files(copy, listed)
    lines = [f"{package_copy.digest(text)}  {name}\n" for name, text in listed.items()]
    (copy / package_copy.MANIFEST).write_text("".join(lines))
    assert found(GOOD) == []
    for name in ("g12_haas", "form_slot_mm"):
        (copy / "ngc" / f"{name}.ngc").write_text("one\n")
    (copy / "ngc" / "lost.ngc").unlink()
    changed = "was changed after it was installed"
    assert {(finding.level, finding.text) for finding in found(GOOD)} == {
        (PROBLEM, f"{copy}: missing: ngc/lost.ngc"),
        (WARNING, f"{copy}/ngc/g12_haas.ngc: {changed}"),
        (NOTE, f"{copy}/ngc/form_slot_mm.ngc: {changed}"),  # its M codes are the owner's to write
    }
    (copy / package_copy.MANIFEST).write_text("no list\n")
    (damaged,) = found(GOOD)
    assert "MANIFEST:1: not a line that install wrote" in damaged.text


FIRST, SECOND = HAAS.splitlines()
OWN_G13 = "REMAP = g13 modalgroup=1 ngc=mine"
POLAR = "".join(
    f"REMAP = G1{n}.1 modalgroup=1 python=polar_{x}\n" for n, x in ((2, "on"), (3, "off"))
)
ON_LATHE = with_lines(LATHE, "RS274NGC", SUBS + POLAR + ABORT) + PYTHON
MINE = {**HANDLERS, "mine": "remap"}
NO_ABORT = {name: "g12.remap" for name in HANDLERS if name != "g12_on_abort"}
SHADOW = {"circle_mill": "oword", "g12_haas": "oword"}
NO_TABLE = "TOOL_TABLE = mill.tbl\n"

ONE_FINDING = [  # an INI, what else is there, what is found and a part of what is said
    (MILL, {}, "no-codes", ""),
    (with_lines(GOOD, "RS274NGC", f"{OWN_G13}\n"), {}, "taken",
     f"mill.ini:5: G13 is remapped here already: {OWN_G13}"),
    (ON_LATHE, {"owned": {"G12.1"}}, "owned", "polar-g12.3"),
    (with_lines(LATHE, "RS274NGC", lines_of("polar")) + PYTHON, {}, "no-sub",
     "g12_skipped_over.ngc and g12_on_abort.ngc are in none of the folders"),
    (GOOD.replace(ABORT, ""), {}, "on-abort", "ON_ABORT_COMMAND is missing: after an abort"),
    (GOOD.replace(ABORT, ABORT.upper().replace("O <", "o<")), {"remap": NO_ABORT}, "no-import",
     "remap.py has no g12_on_abort"),
    (GOOD.replace("O <g12_on_abort> call", "O <mine> call"), {}, "on-abort",
     "O <g12_on_abort> call, and [G12] ON_ABORT_COMMAND = O <mine> call"),
    (GOOD.replace(f"{SECOND}\n", ""), {}, "half",
     "haas: G13 is missing, though its other code is there"),
    (GOOD.replace(SECOND, "REMAP = G13 modalgroup=1 python=mine"), {"remap": MINE}, "half",
     "G13 means something else here (REMAP = G13 modalgroup=1 python=mine)"),
    (GOOD.replace(SUBS, ""), {}, "no-sub",
     "g12_haas.ngc and g12_on_abort.ngc are in none of the folders"),
    (GOOD + "[DISPLAY]\nPROGRAM_PREFIX = programs\n", {"files": {"programs__g12_haas_ngc": ""}},
     "shadowed", "before the package's g12_haas.ngc"),
    (with_lines(GOOD, "RS274NGC", lines_of("circle-mill")), {"oword": SHADOW}, "shadowed",
     "o<circle_mill>"),
    (GOOD.replace(PYTHON, ""), {"remap": {}, "remap_file": None}, "no-python", ""),
    (GOOD.replace("= toplevel.py", "= typo.py"), {"error": "can't resolve path"}, "no-python",
     "typo.py: there is no such file"),
    (GOOD, {"error": "No module named 'g12' (remap.py:1)"}, "python-fails", "PATH_APPEND"),
    (GOOD, {"remap": {}, "remap_file": None}, "no-remap-module", "import remap"),
    (GOOD, {"remap": {"mine": "remap"}, "remap_file": "/machine/remap.py"}, "no-import",
     "/machine/remap.py has no cycle_done, g12_haas, g12_on_abort, g13_haas"),
    (GOOD, {"remap": {**HANDLERS, "cycle_done": "remap"}}, "hidden", "cycle_done"),
    (GOOD.replace(HAAS, f"{HAAS}REMAP = M400 modalgroup=10 python=mine\n"), {}, "does-not-load",
     "mill.ini:8: 'mine' is not a Python callable function"),
    (GOOD + "[G12]\nCLEARING = squares\n", {}, "setting",
     "[G12] CLEARING = squares: must be rings or spiral"),
    (GOOD + "[G12]\nC_CLAMP = M8 M9\nC_CLAMP_SHAPES = M110\n", {"files": {"nc_files__M110": ""}},
     "setting", "[G12] C_CLAMP_SHAPES: M110 is no code of this machine: an executable file M110?"),
    *((GOOD + line, {}, "value", says) for line, says in (
        ("[AXIS_X]\nMAX_VELOCITY = abc\n", "[AXIS_X] MAX_VELOCITY = abc: must be a number"),
        ("[AXIS_Y]\nMIN_LIMIT = abc\n", "[AXIS_Y] MIN_LIMIT = abc: must be a number"),
    )),
    (GOOD.replace("X Y Z", "X Z"), {}, "no-axis", "haas needs axis Y; [TRAJ] COORDINATES has X Z"),
    (GOOD, {"diameters": {}}, "no-diameters", ""),
    (GOOD + "[TASK]\nINTERPRETER = libcanterp.so\n", {}, "interpreter", ""),
    (GOOD, {"version": "2.8.4"}, "too-old", ""),
    (GOOD, {"version": ""}, "no-linuxcnc", ""),
    (GOOD + "#INCLUDE more.inc\n", {"files": {"more_inc": "\n[G12\n"}}, "header",
     "more.inc:2: [G12: "),
    (GOOD.replace("= ngc\n", f"= ngc:{'x' * 250}\n"), {}, "long-line", ""),
    (GOOD + "#INCLUDE nowhere.inc\n", {}, "include",
     "nowhere.inc: there is no such file to read"),
    (GOOD + "#INCLUDE more.inc\n", {"files": {"more_inc": "#INCLUDE deeper.inc\n"}}, "include",
     "more.inc:1"),
    *((GOOD.replace(NO_TABLE, line), {"files": {"empty_tbl": ""}}, kind, says)
      for line, kind, says in (
          ("TOOL_TABLE = no.tbl\n", "no-tool-table", "TOOL_TABLE = no.tbl: there is no such file"),
          ("TOOL_TABLE = ngc\n", "no-tool-table", "TOOL_TABLE = ngc: there is no such file"),
          ("", "no-tool-table", "TOOL_TABLE is missing"),
          ("DB_PROGRAM = ./tools\n", "tool-database", "DB_PROGRAM = ./tools: the tools of that"),
          ("DB_PROGRAM = x\nTOOL_TABLE = empty.tbl\n", "tool-database", "were not looked at"),
      )),
]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "facts", "kind", "says"), ONE_FINDING, ids=[kind for _, _, kind, _ in ONE_FINDING]
)
def test_one_thing_that_is_wrong_is_one_finding(found, text, facts, kind, says):
    (finding,) = found(text, **facts)
    assert finding.kind == kind
    assert says in f"{finding.text}\n{finding.cure}"


def test_a_tool_table_that_is_a_link_to_nothing_is_reported_as_one(found, tmp_path):
    (tmp_path / "no.tbl").symlink_to("gone.tbl")
    (finding,) = found(GOOD.replace(NO_TABLE, "TOOL_TABLE = no.tbl\n"))
    assert "TOOL_TABLE = no.tbl: a link to gone.tbl, which is not there" in finding.text


@pytest.mark.parametrize(
    "facts",
    [
        {},
        {"version": "2.9.0~pre1+git"},
        {"version": "2.10.0"},
        {"diameters": {1: 0.0, 2: 0.25}},
        {"diameters": None},
    ],
)
def test_what_is_in_order_is_no_finding(found, facts):
    assert found(GOOD, **facts) == []


def test_shapes_need_their_subs_and_polar_interpolation(found):
    shapes = lines_of("polar-shapes")
    for pair in ("polar", "polar-g12.3"):
        lines = SUBS + lines_of(pair) + shapes
        assert found(with_lines(LATHE, "RS274NGC", lines) + PYTHON) == []
    (alone,) = found(with_lines(LATHE, "RS274NGC", SUBS + shapes) + PYTHON)
    assert (alone.kind, "needs polar or polar-g12.3" in alone.text) == ("no-polar", True)
    lost = found(with_lines(LATHE, "RS274NGC", lines_of("polar") + shapes) + PYTHON)
    assert set(kinds(lost)) == {"no-sub"} and "polar_slot.ngc" in str(lost)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (("prolog=g12_haas", "prolog=g12_hass"), "should have prolog=g12_haas"),
        (("modalgroup=1", "modalgroup=1 argspec=I"), "should have no argspec="),
        (("prolog=g12_haas ngc=g12_haas", "prolog=g12_hass ngc=g12_has"), "have prolog=g12_haas, "),
    ],
)
def test_a_line_that_is_nearly_right(found, change, says):
    first = HAAS.splitlines()[0]
    (wrong,) = found(GOOD.replace(first, first.replace(*change)))
    assert wrong.kind == "wrong-line"
    assert says in wrong.text
    assert wrong.cure == first


def test_only_the_first_ten_folders_count(found, tmp_path):
    for number in range(10):
        (tmp_path / f"f{number}").mkdir()
    ten = ":".join(f"f{number}" for number in range(10))
    assert kinds(found(GOOD.replace("= ngc\n", f"= {ten}:ngc\n"))) == ["no-sub"]
    nine = f"nowhere:{ten[3:]}"
    assert kinds(found(GOOD.replace("= ngc\n", f"= {nine}:ngc\n"))) == []


def test_lines_that_linuxcnc_does_not_read(found):
    second = MILL + f"[RS274NGC]\n{HAAS}"
    assert kinds(found(second)) == ["no-codes", "not-read", "not-read"]
    assert kinds(found(GOOD + "[G12]\nCLEARING = rings\n[G12]\nPOLAR_Z = allow\n")) == ["not-read"]


@pytest.mark.parametrize("header", ["[G12", "[]", "[g12]"])
def test_a_header_that_begins_no_section(found, header):
    (broken,) = found(GOOD + f"{header}\nCLEARING = spiral\n")
    assert (broken.level, broken.kind) == (PROBLEM, "header")
    begins = f"mill.ini:{GOOD.count(chr(10)) + 1}: {header}: begins no section: "
    assert broken.text == f"{begins}what is below it does not act"
    unread = "LinuxCNC does not read it: Invalid section. Missing ']': [G12"
    (broken,) = found(GOOD + f"{header}\nCLEARING = spiral\n", failure=unread)
    assert broken.text == f"{begins}LinuxCNC reads nothing of this INI"


@pytest.mark.parametrize(
    "line", ["[G12] # ours", "  [HAL_2]", "[[odd]]", "# [G12", "A = [b", "B = c]"]
)
def test_lines_that_are_no_broken_headers(found, line):
    assert found(GOOD + f"[HAL]\n{line}\n") == []


def test_linuxcncs_own_word_only_where_nothing_else_explains_it(found):
    said = "toplevel here\n'x' is no function - 10:REMAP = M6\nBad character 'g' used\n"
    (failure,) = found(GOOD, failure=said)
    assert failure.kind == "does-not-load"
    assert "'x' is no function - 10:REMAP = M6" in failure.text
    assert kinds(found(GOOD.replace("= ngc\n", "= typo\n"), failure=said)) == ["no-sub"]


def test_python_errors_name_the_module_and_its_line():
    printed = (
        "initialize: module '/m/toplevel.py' init failed: \nTraceback (most recent call last):\n\n"
        '  File "/m/toplevel.py", line 4, in <module>\n    import remap\n\n'
        "ModuleNotFoundError: No module named 'remap'\n\n"
        "Python plugin configure() failed, status = -11\nPython plugin required for prolog=\n"
    )
    assert python_error(printed) == ("ModuleNotFoundError: No module named 'remap' (toplevel.py:4)")
    assert python_error("hello from toplevel\n") is None


def test_shortened_keywords_and_comments_in_remap_lines():
    remap = remap_from_value("g88.1 MODAL=1 Py=involute ngc=  # mine prolog=x")
    assert remap.code == "G88.1"
    assert remap.number == ("G", 881)
    assert remap.keywords == {"modalgroup": "1", "python": "involute", "ngc": ""}
    assert remap_from_value("").number == ("", 0)


def test_a_users_own_cycle_may_use_our_epilog():
    remap = remap_from_value("G88.1 modalgroup=1 ngc=mine epilog=cycle_done")
    assert features.model_of(remap) is None


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("nowhere.ini", "no such file"),
        ("mill.tbl", "no [RS274NGC]"),
        ("mill.ini.expanded", "name mill.ini"),
        ("odd.ini", "odd.ini:2: [RS274NGC: begins no section; write it as [RS274NGC]"),
    ],
)
def test_wrong_use_is_one_line_and_exit_code_2(tmp_path, capsys, name, says):
    write_config(tmp_path)
    (tmp_path / "mill.ini.expanded").write_text(MILL)
    (tmp_path / "odd.ini").write_text("[EMC]\n[RS274NGC\n")
    assert check.main([str(tmp_path / name)]) == 2
    error = capsys.readouterr().err
    assert error.startswith("g12 check: ")
    assert says in error
    assert error.count("\n") == 1


def test_only_a_problem_is_a_reason_to_fail_and_every_finding_shows_its_name(
    tmp_path, capsys, monkeypatch
):
    ini = write_config(tmp_path, GOOD)
    said = {}
    for level, code in ((NOTE, 0), (WARNING, 0), (PROBLEM, 1)):
        finding = ConfigFinding(level, "some-name", "something", "a cure")
        monkeypatch.setattr(check, "check_config", lambda text, f=finding: (config_of(ini), [f]))
        assert check.main([str(ini)]) == code
        said[level] = capsys.readouterr().out
    assert all(f"{level} [some-name]: something\n" in text for level, text in said.items())


def test_the_report_for_programs_says_what_the_one_for_people_says(tmp_path):
    text = with_lines(GOOD, "RS274NGC", "REMAP = M400 modalgroup=10 ngc=m400\n")
    config = config_of(write_config(tmp_path, text + "[G12]\nCLEARING = spiral\n"))
    said = check_report(config, findings_of(config))
    assert json.loads(json.dumps(said)) == said
    assert said["codes"][0] == {"code": "G12", "feature": "haas", "line": "mill.ini:7"}
    assert said["other_remaps"] == {"M400": "M400 modalgroup=10 ngc=m400"}
    assert said["settings"] == {"CLEARING": "spiral"}
    lines = "\n".join(lines_of_check(said))
    assert said["findings"]
    assert all(
        finding["text"] in lines and finding["cure"] in lines for finding in said["findings"]
    )
