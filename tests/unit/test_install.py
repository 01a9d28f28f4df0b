# SPDX-License-Identifier: GPL-2.0-or-later
"""What `install` writes and `uninstall` takes out; without LinuxCNC."""

import re
import shutil
import stat
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

from g12.tools import progress
from g12.tools.commands import install, uninstall
from g12.tools.errors import UsageError
from g12.tools.install import installation, package_copy, placing, trial
from g12.tools.install.config import features
from g12.tools.install.config.ini_edit import BEGIN_MARK, END_MARK, IniError, IniText
from g12.tools.install.plan import Refused
from g12.tools.machine import files
from g12.tools.machine.ini import read_ini
from g12.tools.preview.loading import UNREAD
from g12.tools.system import COMMAND
from support.small_configs import (
    MILL,
    config_of,
    content_of,
    files_of_package,
    package_of,
    put_in,
    restored,
    take_out,
    with_lines,
    write_config,
)

PACKAGE = {
    "ngc/g12_haas.ngc": b"(one)\n",
    "python/g12/__init__.py": b"",
    **files_of_package("python/toplevel.py", "python/remap.py"),
}
ABORT = "ON_ABORT_COMMAND = O <g12_on_abort> call\n"
OWN_PYTHON = "[PYTHON]\nPATH_PREPEND = python\nTOPLEVEL = python/toplevel.py\n"
small_package = package_of(PACKAGE)


@pytest.fixture
def ini(tmp_path):
    """Return the INI of a mill with haas installed."""
    path = write_config(tmp_path)
    put_in(path, "haas")
    return path


def own_python(folder):
    return {"remap": {"mine": "remap"}, "remap_file": str(folder / "python" / "remap.py")}


# INI files.


def test_the_lines_stand_at_the_end_of_their_section(ini):
    text = ini.read_text()
    section = text[text.index("[RS274NGC]") : text.index("[TRAJ]")]
    assert section == (
        "[RS274NGC]\nPARAMETER_FILE = mill.var\n"
        f"{BEGIN_MARK} (g12 uninstall takes these lines out again)\n"
        "SUBROUTINE_PATH = g12/ngc\n"
        "REMAP = G12 modalgroup=1 prolog=g12_haas ngc=g12_haas epilog=cycle_done\n"
        "REMAP = G13 modalgroup=1 prolog=g13_haas ngc=g12_haas epilog=cycle_done\n"
        f"{ABORT}"
        f"{END_MARK}\n\n"
    )
    assert text.endswith(
        f"[PYTHON]\nTOPLEVEL = g12/python/toplevel.py\nPATH_PREPEND = g12/python\n{END_MARK}\n"
    )


PATH = "SUBROUTINE_PATH = "
OWN_ABORT = "ON_ABORT_COMMAND = O <on_abort> call [7]\n"


@pytest.mark.parametrize("end", ["", "[G12]\nPOLAR_Z = allow\n"])
def test_a_users_own_command_after_an_abort_is_kept_and_called(tmp_path, end):
    ini = write_config(tmp_path, with_lines(MILL, "RS274NGC", OWN_ABORT) + end)
    with restored(ini):
        put_in(ini, "haas")
        put_in(ini, "circle-mill", package=tmp_path / "g12" / "python" / "g12")
        text = ini.read_text()
        assert f"# was: {OWN_ABORT}# now: {ABORT}{ABORT}{END_MARK}\n" in text
        assert f"# now: {OWN_ABORT}{OWN_ABORT}{END_MARK}\n" in text
        found = IniText(ini).ini()
        assert found.get("G12", "ON_ABORT_COMMAND") == "O <on_abort> call [7]"
        assert found.get("RS274NGC", "ON_ABORT_COMMAND") == "O <g12_on_abort> call"


def test_a_users_own_command_in_two_lines_is_refused(tmp_path):
    ini = write_config(
        tmp_path, with_lines(MILL, "RS274NGC", OWN_ABORT.replace(" call", " \\\n call"))
    )
    before = content_of(tmp_path)
    with pytest.raises(IniError, match=r"mill\.ini:5: goes on in the next line; write it in one"):
        put_in(ini, "haas")
    assert content_of(tmp_path) == before


def test_the_command_of_an_older_package_is_brought_up_to_date(tmp_path, ini):
    ini.write_text(ini.read_text().replace(ABORT, "ON_ABORT_COMMAND = G13.1 P\n"))
    put_in(ini, "circle-mill", package=tmp_path / "g12" / "python" / "g12")
    assert "G13.1" not in ini.read_text() and ABORT in ini.read_text()
    take_out(ini)
    assert ini.read_text() == MILL


def test_an_existing_path_gets_longer(tmp_path):
    ini = write_config(tmp_path, with_lines(MILL, "RS274NGC", f"{PATH}a:\\\nb\nX = 1\n"))
    with restored(ini):
        put_in(ini, "haas")
        assert f"{PATH}a:\\\nb:g12/ngc\nX = 1\n" in ini.read_text()


def test_what_the_user_changed_since_survives_uninstall(tmp_path):
    own = "REMAP = M400 modalgroup=10 ngc=m400\n"
    ini = write_config(tmp_path, with_lines(MILL, "RS274NGC", f"{PATH}a\n"))
    put_in(ini, "haas")
    changed = ini.read_text()
    edits = (
        ("mill.var", "other.var"),
        ("a:g12/ngc", "a:g12/ngc:b"),
        (END_MARK, f"{own}{END_MARK}"),
    )
    for old, new in edits:
        assert old in changed
        changed = changed.replace(old, new, 1)
    ini.write_text(changed)
    reported = take_out(ini)
    text = MILL.replace("mill.var\n", f"other.var\n{own}")
    assert ini.read_text() == with_lines(text, "RS274NGC", f"{PATH}a:b\n")
    assert any(own.strip() in line and "stays" in line for line in reported)
    assert not (tmp_path / "g12").exists()


def test_a_path_that_the_user_added_to_ours_survives_uninstall(ini):
    ini.write_text(ini.read_text().replace("g12/ngc\n", "g12/ngc:mine\n"))
    take_out(ini)
    assert ini.read_text() == MILL.replace("mill.var\n", f"mill.var\n{PATH}mine\n")


def test_a_second_feature_joins_the_first(tmp_path):
    ini = write_config(tmp_path)
    with restored(ini):
        put_in(ini, "haas")
        put_in(ini, "circle-mill", package=tmp_path / "g12" / "python" / "g12")
        codes = re.findall("^REMAP = (G.*?) ", ini.read_text(), re.MULTILINE)
        assert codes == ["G12", "G13", "G12.2", "G13.2"]
        assert len(IniText(ini).blocks()) == 3


def test_python_without_a_toplevel_keeps_its_path_and_ours_comes_first(tmp_path):
    ini = write_config(tmp_path, MILL + "[PYTHON]\nPATH_PREPEND = mine\n\n; end\n")
    put_in(ini, "haas")
    found = IniText(ini).ini()
    assert found.all("PYTHON", "PATH_PREPEND") == ["mine", "g12/python"]
    assert found.get("PYTHON", "TOPLEVEL") == "g12/python/toplevel.py"


VALUES = st.sampled_from(["", " ", "a", "a:b", "a = b", "\xe9", "\udce9", "x \\\n y", "[y]"])
LINES = st.one_of(
    st.sampled_from(["", " ", "\t", "# note", "; note", "#REMAP = G12", "#INCLUDE more.inc"]),
    st.builds("{} = {}".format, st.sampled_from(["A", "  B", "DEBUG"]), VALUES),
    st.builds("SUBROUTINE_PATH = {}".format, st.sampled_from(["a", "a:b", "../x:~/y "])),
    st.sampled_from(["[RS274NGC]", "[PYTHON]", "[TRAJ]", " [EMC]", "[RS274NGC] "]),
)


@given(
    st.lists(LINES, max_size=12),
    st.lists(LINES, max_size=8),
    st.lists(LINES, max_size=6),
    st.sampled_from(["\n", "\r\n"]),
    st.booleans(),
)
@hypothesis_settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_whatever_the_ini_uninstall_is_the_reverse_of_install(
    tmp_path_factory, first, last, included, end, ended
):
    folder = tmp_path_factory.mktemp("config")
    more = end.join(included)
    text = end.join([*first, "[RS274NGC]", *last]) + (end if ended else "")
    ini = write_config(folder, text, more_inc=more.encode("utf-8", "surrogateescape").decode(
        "utf-8", "replace"))  # fmt: skip
    with restored(ini):
        put_in(ini, "haas")
        if "\r\n" in text and "\n" not in text.replace("\r\n", ""):
            assert b"\n" not in ini.read_bytes().replace(b"\r\n", b"")
        assert ini.read_bytes().endswith(b"\n") == text.endswith("\n")
        found = IniText(ini).ini()
        assert "g12/ngc" in found.get("RS274NGC", "SUBROUTINE_PATH")
        assert len([line for line in found.all("RS274NGC", "REMAP") if "g12_haas" in line]) == 2
        assert found.get("PYTHON", "TOPLEVEL") == "g12/python/toplevel.py"
        assert put_in(ini, "haas", package=folder / "g12" / "python" / "g12") == []


@pytest.mark.parametrize(
    ("marker", "count", "missed"),
    [
        (END_MARK, 2, f'mill.ini:6: the line "{END_MARK}"'),
        (BEGIN_MARK, 2, f'the line "{BEGIN_MARK}"'),
    ],
)
def test_a_marker_without_its_other_one_is_refused(tmp_path, ini, capsys, marker, count, missed):
    ini.write_text(ini.read_text().replace(marker, "# gone", count))
    before = content_of(tmp_path)
    with pytest.raises(IniError, match=missed):
        take_out(ini)
    assert uninstall.main([str(ini)]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert content_of(tmp_path) == before


# Included files.


def test_lines_go_into_the_include_if_its_section_ends_there(tmp_path):
    base = (
        "[EMC]\n#INCLUDE deeper.inc\nVERSION = 1.1\n[RS274NGC]\nPARAMETER_FILE = mill.var\n[TRAJ]\n"
    )
    ini = write_config(tmp_path, "#INCLUDE base.inc\nCOORDINATES = X Y Z\n", base_inc=base)
    before = ini.read_bytes()
    with restored(ini):
        put_in(ini, "haas")
        assert ini.read_bytes() == before
        found = IniText(ini).ini()
        assert found.lines == read_ini(ini).lines
        assert found.get("PYTHON", "TOPLEVEL") == "g12/python/toplevel.py"
        assert found.get("TRAJ", "COORDINATES") == "X Y Z"
        assert found.get("EMC", "VERSION") == "1.1"


# The user's own modules.


def own_config(folder, toplevel="import remap\n", remap="def mine(self): pass\n", **python):
    ini = write_config(
        folder, MILL + OWN_PYTHON, python__toplevel_py=toplevel, python__remap_py=remap
    )
    return ini, {**own_python(folder), **python}


def test_a_users_remap_gets_one_line_and_loses_it_again(tmp_path):
    ini, python = own_config(tmp_path, remap="# \xe9\r\nx = 1")
    before, module = content_of(tmp_path), tmp_path / "python" / "remap.py"
    line = 'import sys; sys.path.append("g12/python"); from g12.remap import *  # by g12 install'
    with restored(ini):
        said = put_in(ini, "haas", **python)
        assert any("remap.py.before-g12" in line for line in said)
        put_in(ini, "circle-mill", **python)  # once is enough
        assert module.read_bytes() == before["python/remap.py"] + f"\r\n{line}".encode()
        assert (tmp_path / "python" / "toplevel.py").read_text() == "import remap\n"
        assert IniText(ini).ini().all("PYTHON", "PATH_PREPEND") == ["python"]
        assert ini.read_text().count("python/remap.py\n") == 1


def test_a_hand_made_import_is_enough(tmp_path):
    ini, python = own_config(tmp_path)
    ours = dict.fromkeys(features.functions_of("haas"), "g12.remap")
    package = tmp_path / "tools" / "python" / "g12"
    put_in(ini, "haas", **{**python, "remap": ours, "package": package})
    assert "by g12 install" not in (tmp_path / "python" / "remap.py").read_text()
    assert "SUBROUTINE_PATH = tools/ngc" in ini.read_text()
    assert not (tmp_path / "g12").exists()


def refused_kind(ini, *names, **python):
    """Return the kind of the refusal of an installation, which writes nothing."""
    before = content_of(ini.parent)
    with pytest.raises(Refused) as refused:
        put_in(ini, *names, **python)
    assert content_of(ini.parent) == before
    return refused.value.args[0].kind


def test_where_nothing_may_be_written_nothing_is(tmp_path):
    own, blank, outside = (tmp_path / name for name in ("own", "my mill", "inside"))
    for folder in (own, blank, outside):
        folder.mkdir()
    assert refused_kind(write_config(own, g12__notes_txt="mine\n"), "haas") == "folder"
    for feature in ("haas", "polar"):  # LinuxCNC reads no sub from such a folder
        assert refused_kind(write_config(blank), feature) == "blank-in-path"
    (tmp_path / "base.inc").write_text("[RS274NGC]\nPARAMETER_FILE = x\n[TRAJ]\n")
    (outside / "base.inc").symlink_to(tmp_path / "base.inc")
    for name in ("../base.inc", "base.inc"):
        ini = write_config(outside, f"#INCLUDE {name}\nCOORDINATES = X Y Z\n")
        assert refused_kind(ini, "haas") == "outside"
    (tmp_path / "remap.py").write_text("def mine(self): pass\n")
    ini, own = own_config(outside)
    assert refused_kind(ini, "haas", **{**own, "remap_file": "../remap.py"}) == "outside"
    (outside / "python" / "toplevel.py").unlink()
    assert refused_kind(ini, "haas", **own) == "no-toplevel"


def test_two_machines_share_the_copy_and_the_import(tmp_path):
    ini, python = own_config(tmp_path)
    other = write_config(tmp_path, MILL + OWN_PYTHON, "other.ini")
    with restored(other):
        put_in(ini, "haas", **python)
        put_in(other, "haas", **{**python, "remap": dict.fromkeys(python["remap"], "g12.remap")})
        said = take_out(ini)
        assert any("another INI of this folder uses it" in line for line in said)
        assert "by g12 install" in (tmp_path / "python" / "remap.py").read_text()
        assert (tmp_path / "g12" / package_copy.MANIFEST).exists()


def test_two_machines_share_an_included_path(tmp_path):
    text = MILL.replace("[RS274NGC]\n", "#INCLUDE rs.inc\n")
    ini = write_config(tmp_path, text, rs_inc="[RS274NGC]\nSUBROUTINE_PATH = a\n")
    other = write_config(tmp_path, text, "other.ini")
    with restored(other):
        put_in(ini, "haas")
        put_in(other, "haas")
        take_out(ini)
        assert IniText(other).ini().get("RS274NGC", "SUBROUTINE_PATH") == "a:g12/ngc"


def test_the_lines_of_an_older_package_are_brought_up_to_date(tmp_path):
    ini = write_config(tmp_path, MILL.replace("\n", "\r\n"))
    before = content_of(tmp_path)
    put_in(ini, "mitsubishi")
    up_to_date = ini.read_bytes()
    ini.write_bytes(up_to_date.replace(b"ngc=g12_mitsubishi", b"ngc=g12_circle"))
    put_in(ini, "circle-mill")
    assert b"g12_circle " not in ini.read_bytes()
    take_out(ini)
    assert content_of(tmp_path) == before


def test_a_line_of_the_users_own_is_not_brought_up_to_date(tmp_path):
    line = "REMAP = G12 modalgroup=1 prolog=g12_mitsubishi ngc=mine epilog=cycle_done\n"
    ini = write_config(tmp_path, with_lines(MILL, "RS274NGC", line))
    put_in(ini, "mitsubishi")
    assert line in ini.read_text()


# The copy of the package.


def test_the_copy_is_checked_by_sha256sum(tmp_path, ini):
    copy = tmp_path / "g12"
    subprocess.run(["sha256sum", "--check", "--strict", "MANIFEST"], cwd=copy, check=True)
    assert content_of(copy).keys() == {*PACKAGE, "MANIFEST"}


def test_edited_files_of_the_copy_survive_uninstall_and_are_reported(tmp_path, ini):
    (tmp_path / "g12" / "ngc" / "g12_haas.ngc").write_text("(mine)\n")
    (tmp_path / "g12" / "ngc" / "shelf").symlink_to(tmp_path)
    (tmp_path / "g12" / "python" / "__pycache__").mkdir()
    kept = "but for what you changed: ngc/shelf, ngc/g12_haas.ngc.edited"
    assert any(kept in line for line in take_out(ini))
    assert content_of(tmp_path / "g12") == {"ngc/g12_haas.ngc.edited": b"(mine)\n"}
    assert (tmp_path / "g12" / "ngc" / "shelf").readlink() == tmp_path
    with pytest.raises(Refused, match="g12 is there already, and is not this package"):
        put_in(ini, "haas")


def test_a_copy_whose_list_is_missing_stays_and_one_behind_a_link_is_not_the_configs(tmp_path, ini):
    shutil.move(tmp_path / "g12" / "ngc", tmp_path / "elsewhere")
    (tmp_path / "g12" / "ngc").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(UsageError):
        package_copy.listed(tmp_path / "g12")
    (tmp_path / "g12" / package_copy.MANIFEST).unlink()
    assert any("g12: stays, it has no list" in line for line in take_out(ini))


def test_a_package_put_there_by_hand_is_used_and_stays(tmp_path):
    ini = write_config(tmp_path)
    package_copy.write_files(tmp_path / "g12", PACKAGE)
    with restored(ini):
        put_in(ini, "haas")
        assert "TOPLEVEL = g12/python/toplevel.py" in ini.read_text()
        assert not (tmp_path / "g12" / package_copy.MANIFEST).exists()


def test_the_real_package_has_what_a_machine_needs(monkeypatch):
    monkeypatch.undo()
    names = package_copy.package_files()
    assert {"python/toplevel.py", "python/remap.py", "python/g12/__main__.py"} <= names.keys()
    assert {f"configs/include/{name}" for name in features.REMAP_FILES.values()} <= names.keys()
    subs = {f"ngc/{sub}.ngc" for f in features.REMAP_FILES for sub in features.names_of(f)}
    assert subs <= names.keys()
    assert not any("__pycache__" in name or name.startswith("tests") for name in names)


# Installations that were interrupted, damaged or edited.


def newer(monkeypatch, files):
    monkeypatch.setattr(package_copy, "package_files", lambda: dict(files))


def renew(ini):
    """Update the copy; return the lines to show."""
    return installation.write_changes({}, ini.parent, installation.out_of_date(ini.parent / "g12"))


def test_an_update_takes_no_new_file_for_an_edited_one(tmp_path, ini, monkeypatch):
    newer(monkeypatch, {**PACKAGE, "ngc/g12_haas.ngc": b"(two)\n"})
    (tmp_path / "g12" / "ngc" / "g12_haas.ngc").write_bytes(b"(two)\n")
    renew(ini)
    assert not list((tmp_path / "g12").rglob("*.edited*"))
    assert package_copy.edited(tmp_path / "g12") == []


def test_no_edit_is_ever_lost(tmp_path, ini, monkeypatch):
    copy = tmp_path / "g12"
    haas = copy / "ngc" / "g12_haas.ngc"
    for version in ("two", "three"):
        haas.write_text(f"(mine before {version})\n")
        assert not installation.out_of_date(copy)
        newer(monkeypatch, {**PACKAGE, "ngc/g12_haas.ngc": f"({version})\n".encode()})
        renew(ini)
    haas.write_text("(mine at last)\n")
    (copy / "ngc" / "new.ngc").write_text("(my own)\n")
    rest = {name: content for name, content in PACKAGE.items() if not name.startswith("ngc/")}
    newer(monkeypatch, {**rest, "ngc/new.ngc": b"(theirs)\n"})
    said = renew(ini)
    assert content_of(copy / "ngc") == {
        "g12_haas.ngc.edited": b"(mine before two)\n",
        "g12_haas.ngc.edited.2": b"(mine before three)\n",
        "g12_haas.ngc.edited.3": b"(mine at last)\n",
        "new.ngc": b"(theirs)\n",
        "new.ngc.edited": b"(my own)\n",
    }
    assert sum("your version" in line for line in said) == 2


def test_a_damaged_copy_is_mended(tmp_path, ini):
    whole = content_of(tmp_path)
    (tmp_path / "g12" / "ngc" / "g12_haas.ngc").unlink()
    (tmp_path / "g12" / "python" / "remap.py").write_bytes(b"")
    assert installation.missing_files(IniText(ini))
    renew(ini)
    assert content_of(tmp_path) == whole
    assert installation.missing_files(IniText(ini)) == []


def test_the_copy_that_only_a_users_module_names_is_missed_too(tmp_path):
    ini, python = own_config(tmp_path)
    assert installation.missing_files(IniText(ini)) == []
    put_in(ini, "polar", **python)
    shutil.rmtree(tmp_path / "g12")
    assert installation.missing_files(IniText(ini))


def test_a_copy_does_not_mend_itself(tmp_path, ini, monkeypatch):
    copy = tmp_path / "g12"
    monkeypatch.setattr(features, "ROOT", copy)
    (copy / "ngc" / "g12_haas.ngc").write_text("(mine)\n")
    newer(monkeypatch, {**PACKAGE, "ngc/g12_haas.ngc": b"(mine)\n"})
    assert not installation.out_of_date(copy)
    assert package_copy.edited(copy) == ["ngc/g12_haas.ngc"]
    (copy / "ngc" / "g12_haas.ngc").unlink()
    with pytest.raises(UsageError, match="from the package itself"):
        installation.out_of_date(copy)


@pytest.mark.parametrize(
    "line",
    [f"{'0' * 64}  ../precious.ngc", f"{'0' * 64}  /tmp/precious.ngc", "\xff"],
)
def test_a_list_with_anything_else_in_it_is_refused_first(tmp_path, line, capsys):
    ini = write_config(tmp_path, precious_ngc="(mine)\n")
    put_in(ini, "haas")
    manifest = tmp_path / "g12" / package_copy.MANIFEST
    manifest.write_bytes(manifest.read_bytes() + line.encode("latin-1") + b"\n")
    before = content_of(tmp_path)
    assert uninstall.main([str(ini)]) == 2
    error = capsys.readouterr().err
    assert "MANIFEST:5: not a line that install wrote" in error
    assert error.count("\n") == 1
    assert content_of(tmp_path) == before


def test_the_copy_stays_while_the_users_lines_need_it(tmp_path, ini):
    text = ini.read_text()
    remap = next(line for line in text.splitlines() if line.startswith("REMAP"))
    moved = text.replace(f"{remap}\n", "").replace("[RS274NGC]\n", f"[RS274NGC]\n{remap}\n")
    ini.write_text(moved)
    said = take_out(ini)
    assert f"mill.ini:5: still needs the package: {remap}" in said
    assert any("run uninstall again" in line for line in said)
    assert (tmp_path / "g12" / "ngc" / "g12_haas.ngc").exists()
    ini.write_text(ini.read_text().replace(f"{remap}\n", ""))
    assert any(line.endswith("g12: taken away") for line in take_out(ini))
    assert ini.read_text() == MILL
    assert not (tmp_path / "g12").exists()


def test_a_link_to_the_ini_is_no_other_machine(tmp_path):
    ini = write_config(tmp_path)
    (tmp_path / "link.ini").symlink_to(ini)
    put_in(ini, "haas")
    text = IniText(tmp_path / "link.ini")
    assert list(trial.others_including(text, [ini.absolute()])) == []
    take_out(tmp_path / "link.ini")
    assert ini.read_text() == MILL
    assert not (tmp_path / "g12").exists()


# Writing.


def test_writing_keeps_mode_and_links(tmp_path):
    target, link = tmp_path / "real.ini", tmp_path / "link.ini"
    target.write_text("old\n")
    target.chmod(0o640)
    link.symlink_to(target)
    files.write(link, b"new\n")
    assert link.is_symlink()
    assert target.read_text() == "new\n"
    assert stat.S_IMODE(target.stat().st_mode) == 0o640
    assert len(list(tmp_path.iterdir())) == 2


def test_a_write_that_fails_leaves_every_file_as_it_was(tmp_path, monkeypatch):
    ini, python = own_config(tmp_path)
    before, real = content_of(tmp_path), placing.take_after

    def fails_on_the_ini(new, model):
        real(new, model)
        if model.suffix == ".ini":
            raise OSError("disk full")

    monkeypatch.setattr(placing, "take_after", fails_on_the_ini)
    with pytest.raises(OSError, match="disk full"):
        put_in(ini, "haas", **python)
    assert content_of(tmp_path) == before
    assert not (tmp_path / placing.BESIDE).exists()


def test_two_commands_at_once_are_one_too_many(tmp_path, ini):
    with placing.folder_beside(tmp_path), pytest.raises(UsageError, match="another install"):
        take_out(ini)
    assert take_out(ini)


def test_a_file_that_could_not_be_replaced_whole_is_refused(tmp_path, ini):
    (tmp_path / "common").mkdir()
    shared = tmp_path / "common" / "remap.py"
    shared.write_text("x = 1  # by g12 install\n")
    (tmp_path / "mill").mkdir()
    with placing.folder_beside(tmp_path / "mill") as place, pytest.raises(UsageError) as refused:
        placing.stage(place, shared, b"", shared)
    assert "copy it into" in str(refused.value)


def test_old_versions_are_never_overwritten(tmp_path):
    path, first = tmp_path / "mill.ini", tmp_path / "mill.ini.before-g12"
    path.write_text("one\n")
    assert files.backup_of(path) == first
    first.write_text("one\n")
    assert files.backup_of(path) == first
    path.write_text("two\n")
    assert files.backup_of(path) == tmp_path / "mill.ini.before-g12.2"
    files.drop_backups(path, b"two\n")
    assert files.backups_of(path) == [first]


# The command line.


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ([], "the INI is missing, --with is missing"),
        (["mill.ini", "--with"], "expected at least one argument"),
        (["mill.ini", "--with", "heidenhain"], "no feature 'heidenhain' (usage: "),
    ],
)
def test_wrong_use_of_install(arguments, says, capsys):
    with pytest.raises(SystemExit) as stopped:
        install.main(arguments)
    assert stopped.value.code == 2
    said = capsys.readouterr().err
    assert said.startswith("g12 install: ")
    assert says in said
    assert said.count("\n") == 1


def test_the_command_shows_what_it_writes_and_what_to_do_next(tmp_path, monkeypatch, capsys):
    ini, python = write_config(tmp_path), {}
    before = content_of(tmp_path)
    monkeypatch.setattr(installation, "load_config", lambda text: config_of(text.path, **python))
    monkeypatch.setattr(installation, "try_out", lambda _: [])
    words = [str(ini), "--with", "haas"]
    assert install.main([*words, "--dry-run"]) == 0
    shown = capsys.readouterr().out
    assert "+SUBROUTINE_PATH = g12/ngc\n" in shown
    assert shown.endswith("dry run: nothing was written\n") and "would get the package" in shown
    assert content_of(tmp_path) == before
    assert install.main(words) == 0
    said = capsys.readouterr().out.splitlines()
    assert said[-2:] == ["  G12    is refused, a word is missing: it works",
                         f"to take it out again: {COMMAND} uninstall {ini}"]  # fmt: skip
    python["package"] = tmp_path / "g12" / "python" / "g12"
    assert install.main(words) == 0
    assert capsys.readouterr().out == f"{ini}: haas: installed already, nothing to do\n"
    assert install.main([str(ini), "--with", "yasnac"]) == 1
    assert "haas and yasnac exclude each other" in capsys.readouterr().err
    assert install.main([*words, "yasnac"]) == 2
    assert "haas and yasnac exclude each other: choose one" in capsys.readouterr().err


def test_each_feature_has_a_first_step():
    assert all(map(features.first_step, features.FEATURE_NAMES))


def test_an_ini_that_linuxcnc_does_not_read_is_refused_with_its_problem(
    tmp_path, monkeypatch, capsys
):
    """LinuxCNC 2.10 reads nothing of an INI with a broken header; its Python is unknown."""
    ini = write_config(tmp_path, MILL + "[G12\n")
    config = replace(config_of(ini, failure=f"{UNREAD}: line 13"), python=None)
    monkeypatch.setattr(installation, "load_config", lambda _: config)
    assert install.main([str(ini), "--with", "haas"]) == 1
    (said,) = capsys.readouterr().err.splitlines()
    assert said.startswith("g12 install: [header] mill.ini:13: [G12: begins no section")


@pytest.mark.parametrize(
    "words",
    [
        ["mill.ini", "--with", "haas", "circle-mill"],
        ["--with", "haas", "circle-mill", "mill.ini"],
        ["--with", "Haas,circle-mill", "mill.ini"],
        ["mill.ini", "--with", "haas", "CIRCLE-MILL,haas"],
    ],
)
def test_the_ways_to_name_features(words):
    options = install.command_parser().parse_args(words)
    found = install.ini_and_features(options.ini, options.features)
    assert found == (Path("mill.ini"), ["haas", "circle-mill"])


def test_what_nobody_reads_is_done_to_its_end(tmp_path, monkeypatch):
    ini = write_config(tmp_path)
    before = content_of(tmp_path)
    put_in(ini, "haas")

    def broken(*_arguments, **_options):
        raise BrokenPipeError

    monkeypatch.setattr(progress, "print", broken, raising=False)
    with pytest.raises(BrokenPipeError):
        uninstall.main([str(ini)])
    assert content_of(tmp_path) == before


def test_a_dry_run_of_uninstall_shows_and_writes_nothing(tmp_path, ini, capsys):
    before = content_of(tmp_path)
    assert uninstall.main([str(ini), "--dry-run"]) == 0
    assert "-REMAP = G12 " in capsys.readouterr().out
    assert content_of(tmp_path) == before
