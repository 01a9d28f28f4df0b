# SPDX-License-Identifier: GPL-2.0-or-later
"""What `install` writes and `uninstall` takes out; without LinuxCNC."""

import os
import re
import shutil
import subprocess
from types import SimpleNamespace

import pytest
from hypothesis import HealthCheck, given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

from g12.tools import progress
from g12.tools.commands import uninstall
from g12.tools.commands.main import main
from g12.tools.install import package_copy
from g12.tools.install.config.ini_edit import BEGIN_MARK, END_MARK, IniText
from g12.tools.machine import files
from g12.tools.machine.ini import IniError
from support.small_configs import (
    MILL,
    content_of,
    files_of_package,
    package_of,
    planned,
    put_in,
    refused,
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
PATH = "SUBROUTINE_PATH = "
small_package = package_of(PACKAGE)


@pytest.fixture
def ini(tmp_path):
    """Return the INI of a mill with haas installed."""
    path = write_config(tmp_path)
    put_in(path, "haas")
    return path


def without_marks(text):
    return "".join(line for line in text.splitlines(True) if not re.match("# (>>>|<<<)", line))


# INI files.


def test_the_lines_stand_at_the_end_of_their_section(ini):
    text = ini.read_text()
    assert text.count(f"{BEGIN_MARK} haas\n") == text.count(END_MARK) == 2
    section = without_marks(text[text.index("[RS274NGC]") : text.index("[TRAJ]")])
    assert section == (
        "[RS274NGC]\nPARAMETER_FILE = mill.var\nSUBROUTINE_PATH = g12/ngc\n"
        "REMAP = G12 modalgroup=1 prolog=g12_haas ngc=g12_haas epilog=cycle_done\n"
        "REMAP = G13 modalgroup=1 prolog=g13_haas ngc=g12_haas epilog=cycle_done\n"
        f"{ABORT}\n"
    )
    python = "[PYTHON]\nTOPLEVEL = g12/python/toplevel.py\nPATH_PREPEND = g12/python\n"
    assert without_marks(text).endswith(python)


@pytest.mark.parametrize("folders", ["a:\\\nb", "a/" * 114])  # the second gets too long
def test_the_users_own_lines_are_replaced_and_led_to(tmp_path, folders):
    own = f"{PATH}{folders}\nON_ABORT_COMMAND = O <on_abort> call [7]\n"
    text = with_lines(MILL, "RS274NGC", own) + OWN_PYTHON + "[G12]\nPOLAR_Z = allow"
    ini = write_config(tmp_path, text)
    with restored(ini):
        put_in(ini, "haas")
        put_in(ini, "circle-mill")
        found = IniText(ini).ini()
        users = "".join(f"# was: {line}\n" for line in f"{PATH}{folders}".split("\n"))
        assert users in ini.read_text()
        assert max(map(len, ini.read_text().splitlines())) <= 255
        joined = folders.replace("\\\n", "")
        assert found.get("RS274NGC", "SUBROUTINE_PATH") == f"{joined}:g12/ngc"
        assert found.get("RS274NGC", "ON_ABORT_COMMAND") == "O <g12_on_abort> call"
        assert found.get("G12", "ON_ABORT_COMMAND") == "O <on_abort> call [7]"
        assert found.get("PYTHON", "TOPLEVEL") == "g12/python/toplevel.py"
        assert found.get("G12", "TOPLEVEL") == "python/toplevel.py"
        assert found.all("PYTHON", "PATH_APPEND") == ["g12/python"]


def test_what_the_user_changed_since_survives_uninstall_and_is_named(tmp_path, ini):
    text, own = ini.read_text(), "REMAP = M400 modalgroup=10 ngc=m400\n"
    first_end = text.index(END_MARK)
    text = f"{text[:first_end]}{own}{text[first_end:]}".replace("mill.var", "other.var")
    text = f"{text}PATH_APPEND = mine\n"  # below a header of ours, which stays with it
    ini.write_text(text.replace(f"{PATH}g12/ngc", f"{PATH}mine"))
    said = take_out(ini)
    kept = f"other.var\n{PATH}mine\n{own}"
    users = f"{MILL}[PYTHON]\nPATH_APPEND = mine\n"
    assert ini.read_text() == users.replace("mill.var\n", kept)
    assert sum("stays, it is not by install, or you changed it" in line for line in said) == 2
    assert not (tmp_path / "g12").exists()


def test_a_second_feature_joins_the_first_and_again_is_nothing_new(tmp_path):
    own = "REMAP = G12 modalgroup=1 prolog=g12_mitsubishi ngc=mine epilog=cycle_done\n"
    ini = write_config(tmp_path, with_lines(MILL, "RS274NGC", own))
    put_in(ini, "mitsubishi")
    put_in(ini, "circle-mill")
    codes = re.findall("^REMAP = (G.*?) ", ini.read_text(), re.MULTILINE)
    assert codes == ["G12", "G13", "G12.2", "G13.2"]  # the first is the user's own
    assert IniText(ini).words() == ["mitsubishi", "circle-mill"]
    assert put_in(ini, "mitsubishi") == []


KEYS = ("A", "B", "DEBUG")
VALUES = st.sampled_from(["", " ", "a", "a:b", "a = b", "\xe9", "\udce9", "x \\\n y", "[y]"])
LINES = st.one_of(
    st.sampled_from(["", " ", "\t", "# note", "; note", "#REMAP = G12", "#INCLUDE more.inc"]),
    st.builds("{}{} = {}".format, st.sampled_from(["", "  "]), st.sampled_from(KEYS), VALUES),
    st.builds("SUBROUTINE_PATH = {}".format, st.sampled_from(["a", "a:b", "../x:~/y ", "a:\\\nb"])),
    st.sampled_from(["[RS274NGC]", "[PYTHON]", "[TRAJ]", " [EMC]", "[RS274NGC] ", "TOPLEVEL = x"]),
)


def values_of(ini):
    """Return the user's own values, by section and key."""
    found, sections = IniText(ini).ini(), ("EMC", "PYTHON", "RS274NGC", "TRAJ")
    return {(section, key): found.all(section, key) for section in sections for key in KEYS}


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
    before = values_of(ini)
    with restored(ini):
        try:
            put_in(ini, "haas")
        except IniError:
            assert text.count("#INCLUDE") > 1
            return
        assert values_of(ini) == before
        if "\r\n" in text and "\n" not in text.replace("\r\n", ""):
            assert b"\n" not in ini.read_bytes().replace(b"\r\n", b"")
        assert ini.read_bytes().endswith(b"\n") == text.endswith("\n")
        found = IniText(ini).ini()
        assert "g12/ngc" in found.get("RS274NGC", "SUBROUTINE_PATH")
        assert len([line for line in found.all("RS274NGC", "REMAP") if "g12_haas" in line]) == 2
        assert found.get("PYTHON", "TOPLEVEL") == "g12/python/toplevel.py"
        assert put_in(ini, "haas") == []


@pytest.mark.parametrize("marker", [END_MARK, BEGIN_MARK])
def test_markers_that_are_not_both_there_are_refused(tmp_path, ini, capsys, marker):
    ini.write_text(ini.read_text().replace(marker, "# gone", 1))
    before, says = content_of(tmp_path), r"mill\.ini:\d+: a marker of install without its other one"
    assert main(["uninstall", str(ini)]) == 2
    (said,) = capsys.readouterr().err.splitlines()
    assert re.search(says, said)
    with pytest.raises(IniError, match=says):
        put_in(ini, "haas")
    assert content_of(tmp_path) == before


# Included files, and several machines in a folder.


def test_a_file_that_is_included_twice_is_never_changed_and_taken_out_once(tmp_path):
    include = "#INCLUDE rs.inc\n"
    text, own = with_lines(MILL, "RS274NGC", include), f"{PATH}a\n"
    ini = write_config(tmp_path, with_lines(text, "EMC", include), rs_inc=own)
    before = content_of(tmp_path)
    with pytest.raises(IniError, match=r"rs\.inc: would have to change, and is included twice: "):
        put_in(ini, "haas")
    assert content_of(tmp_path) == before
    ini.write_text(text)
    put_in(ini, "haas")
    assert "# was: " in (tmp_path / "rs.inc").read_text()
    ini.write_text(with_lines(ini.read_text(), "EMC", include))  # by the user, since then
    take_out(ini)
    assert {**before, "mill.ini.before-g12": text.encode()} == content_of(tmp_path)


def test_machines_share_the_copy_and_an_included_path_until_the_last_goes(tmp_path):
    text = MILL.replace("[RS274NGC]\n", "#INCLUDE rs.inc\n")
    ini = write_config(tmp_path, text, rs_inc="[RS274NGC]\nSUBROUTINE_PATH = a\n")
    other = write_config(tmp_path, text, "other.ini")
    (tmp_path / "link.ini").symlink_to(ini)  # is no other machine
    with restored(other):
        put_in(ini, "haas")
        put_in(other, "haas")
        assert sorted(tmp_path.glob("other.ini.*")) == [tmp_path / "other.ini.before-g12"]
        said = take_out(ini)
        assert any("another INI of this folder uses it" in line for line in said)
        assert IniText(other).ini().get("RS274NGC", "SUBROUTINE_PATH") == "a:g12/ngc"
        assert (tmp_path / "g12" / package_copy.MANIFEST).exists()


def test_where_nothing_may_be_written_nothing_is(tmp_path):
    own, blank, outside = (tmp_path / name for name in ("own", "my mill", "inside"))
    for folder in (own, blank, outside):
        folder.mkdir()
    assert refused(write_config(own, g12__notes_txt="mine\n"), "haas")[0].kind == "folder"
    assert refused(write_config(blank), "polar")[0].kind == "blank-in-path"
    (tmp_path / "base.inc").write_text("[RS274NGC]\nPARAMETER_FILE = x\n[TRAJ]\n")
    (outside / "base.inc").symlink_to(tmp_path / "base.inc")
    for name in ("../base.inc", "base.inc"):
        ini = write_config(outside, f"#INCLUDE {name}\nCOORDINATES = X Y Z\n")
        assert refused(ini, "haas")[0].kind == "outside"


# The package.


def test_edited_files_of_the_copy_survive_uninstall_and_are_named(tmp_path, ini):
    (tmp_path / "g12" / "ngc" / "g12_haas.ngc").write_text("(mine)\n")
    (tmp_path / "g12" / "ngc" / "shelf").symlink_to(tmp_path)
    (tmp_path / "g12" / "python" / "__pycache__").mkdir()
    kept = "but for what you changed: ngc/g12_haas.ngc.edited, ngc/shelf"
    assert any(kept in line for line in take_out(ini))
    assert content_of(tmp_path / "g12") == {"ngc/g12_haas.ngc.edited": b"(mine)\n"}
    assert (tmp_path / "g12" / "ngc" / "shelf").readlink() == tmp_path
    assert refused(ini, "haas")[0].kind == "folder"


def test_no_edit_is_lost_by_an_update_and_no_new_file_is_taken_for_one(tmp_path, ini, monkeypatch):
    copy = tmp_path / "g12"
    haas, own = copy / "ngc" / "g12_haas.ngc", copy / "ngc" / "new.ngc"
    haas.write_text("(mine before two)\n")
    assert package_copy.is_current(copy)
    newer = {**PACKAGE, "ngc/g12_haas.ngc": b"(two)\n"}
    monkeypatch.setattr(package_copy, "package_files", lambda: newer)
    put_in(ini, "haas")
    haas.write_text("(mine before three)\n")
    newer = {name: content for name, content in PACKAGE.items() if name != "ngc/g12_haas.ngc"}
    own.write_text("(my own)\n")
    newer["ngc/new.ngc"] = b"(theirs)\n"
    monkeypatch.setattr(package_copy, "package_files", lambda: newer)
    (copy / "python" / "toplevel.py").write_bytes(b"")
    (tmp_path / "mine").mkdir()
    shutil.rmtree(copy / "python" / "g12")
    (copy / "python" / "g12").symlink_to(tmp_path / "mine")  # in place of a folder
    said = put_in(ini, "haas")
    assert (copy / "python" / "g12.edited").is_symlink()
    assert content_of(copy / "ngc") == {
        "g12_haas.ngc.edited": b"(mine before two)\n",
        "g12_haas.ngc.edited.2": b"(mine before three)\n",
        "new.ngc": b"(theirs)\n",
        "new.ngc.edited": b"(my own)\n",
    }
    assert (copy / "python" / "toplevel.py").read_bytes() == b""  # edited, of the same version
    assert sum("your version" in line for line in said) == 3


def test_a_damaged_copy_is_mended_but_not_by_itself(tmp_path, ini, monkeypatch):
    check = ["sha256sum", "--check", "--strict", "MANIFEST"]
    subprocess.run(check, cwd=tmp_path / "g12", check=True, stdout=subprocess.DEVNULL)
    whole, lost = content_of(tmp_path), tmp_path / "g12" / "ngc" / "g12_haas.ngc"
    lost.unlink()
    monkeypatch.setattr(package_copy, "ROOT", tmp_path / "g12")
    put_in(ini, "haas")
    assert not lost.exists()
    monkeypatch.undo()
    monkeypatch.setattr(package_copy, "package_files", lambda: PACKAGE)
    put_in(ini, "haas")
    assert content_of(tmp_path) == whole


def test_the_copy_stays_while_the_users_lines_need_it(tmp_path, ini):
    text = ini.read_text()
    remap = next(line for line in text.splitlines() if line.startswith("REMAP"))
    moved = text.replace(f"{remap}\n", "").replace("[RS274NGC]\n", f"[RS274NGC]\n{remap}\n")
    ini.write_text(moved)
    said = take_out(ini)
    assert f"mill.ini:5: still needs the package: {remap}" in said
    assert any(line.endswith("g12: stays, lines need it") for line in said)
    ini.write_text(ini.read_text().replace(f"{remap}\n", ""))
    assert any(line.endswith("g12: taken away") for line in take_out(ini))
    assert ini.read_text() == MILL
    assert not (tmp_path / "g12").exists()


# Writing.


def test_modes_links_and_old_versions_are_kept(tmp_path, monkeypatch):
    target, link = tmp_path / "real.ini", tmp_path / "mill.ini"
    target.write_text(MILL)
    target.chmod(0o600)
    link.symlink_to("real.ini")
    (tmp_path / "mill.ini.before-g12").write_text("an older one\n")
    seen, put = set(), os.replace

    def watched(new, path):
        put(new, path)
        seen.add((os.path.basename(path), os.stat(path).st_mode))

    monkeypatch.setattr(os, "replace", watched)
    with restored(link):
        said = put_in(link, "haas")
        assert any(line.endswith("as it was: mill.ini.before-g12.2") for line in said)
        assert seen == {(name, 0o100600) for name in ("real.ini", "mill.ini.before-g12.2")}
        assert link.is_symlink()
    target.write_text("two\n")
    assert files.backup_of(target) == tmp_path / "real.ini.before-g12"


def test_what_a_killed_write_left_goes_with_the_next_one(tmp_path):
    for name in (".axis.ini.g12-a_b1c2d3", ".axis.ini.original", ".other.ini.g12-a_b1c2d3"):
        (tmp_path / name).touch()
    files.write(tmp_path / "axis.ini", b"new")
    kept = {".axis.ini.original", ".other.ini.g12-a_b1c2d3", "axis.ini"}
    assert {path.name for path in tmp_path.iterdir()} == kept


# The command line.


def test_uninstall_shows_first_and_is_done_to_its_end_though_nobody_reads(
    tmp_path, ini, capsys, monkeypatch
):
    before = content_of(tmp_path)
    assert main(["uninstall", str(ini), "--dry-run"]) == 0
    assert "-REMAP = G12 " in capsys.readouterr().out
    assert content_of(tmp_path) == before

    def broken(*_arguments, **_options):
        raise BrokenPipeError

    monkeypatch.setattr(progress, "print", broken, raising=False)
    with pytest.raises(BrokenPipeError):
        uninstall.main(SimpleNamespace(ini=ini, dry_run=False))
    assert content_of(tmp_path).keys() == {"mill.ini", "mill.tbl"}
    assert list(map(str, planned(ini, "haas").changes())) == [str(ini)]
