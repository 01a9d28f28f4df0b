# SPDX-License-Identifier: GPL-2.0-or-later
"""The lines of a screen: forms, Cycles page, face; what `check` says of them, taking them out."""

import pytest

from g12.tools.install.checking import check_report, lines_of_check
from g12.tools.install.plan import Refused, make_plan
from g12.tools.install.rules import findings_of
from support.small_configs import (
    FILES_OF_PAGES,
    HAAS,
    LATHE,
    MILL,
    config_of,
    files_of_package,
    package_of,
    put_in,
    restored,
    with_lines,
    write_config,
)

AXIS = f"[DISPLAY]\nDISPLAY = axis\nCYCLE_TIME = 0.1\n\n{MILL}"
GMOCCAPY = AXIS.replace("axis", "gmoccapy")
TOUCHY, TK = AXIS.replace("axis", "touchy"), AXIS.replace("axis", "tklinuxcnc")
QTAXIS = AXIS.replace("axis", "qtvcp -d qtaxis")
QTVCP = AXIS.replace("axis", "qtvcp qtdragon")
OWN_PATH, CWD = "NGCGUI_SUBFILE_PATH = ../nc_files\n", "/proc/self/cwd/g12/ngc/"
WINDOW = "HALCMD = loadusr gladevcp -c forms g12/configs/include/forms.ui\n"
PAGES = "NGCGUI_SUBFILE = form_haas_mm.ngc\nNGCGUI_SUBFILE = form_circle_mill_mm.ngc\n"
SUBS = {
    f"g12/ngc/{name}.ngc": b"(a sub)\n"
    for name in ("form_start", "form_end", "form_haas_mm", "form_haas_inch", "form_circle_mill_mm")
}


small_package = package_of(
    {"python/g12/__init__.py": b"", **files_of_package(*FILES_OF_PAGES)}
    | {name.removeprefix("g12/"): content for name, content in SUBS.items()}
)


def reported(ini):
    """Return what `check` finds about forms."""
    return texts_of("form", ini)


def texts_of(kind, ini):
    return [finding.text for finding in findings_of(config_of(ini)) if finding.kind == kind]


PROBE_BASIC = AXIS.replace("axis", "probe_basic")
QTDRAGON_TAB = "EMBED_TAB_NAME = Cycles\nEMBED_TAB_LOCATION = tabWidget_utilities\n"
CYCLES = "-u g12/python/g12/tools/cycles_page/gtk_view.py g12/configs/include/cycles.ui\n"
CYCLES_WINDOW = f"HALCMD = loadusr gladevcp -c cycles {CYCLES}"
GLADE = "EMBED_TAB_COMMAND = gladevcp -x {XID} "
TAB = f"{GLADE}g12/configs/include/forms.ui\n{PAGES}"
OWN_TAB = with_lines(GMOCCAPY, "DISPLAY", "EMBED_TAB_NAME = Mine\nEMBED_TAB_COMMAND = mine\n")


@pytest.mark.parametrize(
    ("screen", "lines"),
    [
        (AXIS, f"TKPKG = Ngcgui 1.0\n{PAGES}"),
        (QTVCP, f"NGCGUI_SUBFILE_PATH = g12/ngc\n{PAGES}"),
        (GMOCCAPY, f"EMBED_TAB_NAME = Forms\nEMBED_TAB_LOCATION = ntb_user_tabs\n{TAB}"),
        (OWN_TAB, f"EMBED_TAB_NAME = Forms\n{TAB}"),
        (QTAXIS, PAGES),
        (with_lines(QTVCP, "DISPLAY", OWN_PATH), PAGES.replace("form_", f"{CWD}form_")),
    ],
)
def test_each_screen_gets_its_lines_and_loses_them_again(tmp_path, screen, lines):
    ini = write_config(tmp_path, screen)
    with restored(ini):
        put_in(ini, "haas", "circle-mill", "forms")
        display = ini.read_text().partition("[RS274NGC]")[0]
        assert lines in display
        assert display.count("[DISPLAY]") == 1
        assert (WINDOW in ini.read_text()) == (screen in (TK, QTAXIS))
        assert reported(ini) == []
        put_in(ini, "forms")
        assert ini.read_text().count("NGCGUI_SUBFILE =") == 2


def test_forms_of_codes_that_are_there_and_in_the_machines_unit(tmp_path):
    ini = write_config(tmp_path, AXIS.replace("= mm", "= inch"))
    put_in(ini, "haas")
    put_in(ini, "forms")
    assert "NGCGUI_SUBFILE = form_haas_inch.ngc" in ini.read_text()
    assert "circle_mill" not in ini.read_text()


def test_lines_of_the_users_own_stay_and_are_not_doubled(tmp_path):
    own = "TKPKG = Ngcgui 1.0\nNGCGUI_SUBFILE = simp.ngc\nNGCGUI_SUBFILE = form_haas_mm.ngc\n"
    ini = write_config(tmp_path, with_lines(AXIS, "DISPLAY", own))
    put_in(ini, "haas", "forms")
    text = ini.read_text()
    assert text.count("TKPKG") == text.count("form_haas_mm") == 1
    assert reported(ini) == []


@pytest.mark.parametrize("pages", ["forms", "cycles-page"])
@pytest.mark.parametrize(
    ("text", "names", "why"),
    [
        (MILL, ["haas"], "[DISPLAY] DISPLAY is missing"),
        (AXIS, [], "no code here has a form"),
    ],
)
def test_refused_where_nothing_would_be_shown(tmp_path, text, names, why, pages):
    with pytest.raises(Refused) as refused:
        make_plan(config_of(write_config(tmp_path, text)), [*names, pages])
    assert why in refused.value.args[0].text
    assert refused.value.args[0].kind == pages


def shown_in(tmp_path, screen, lines, remaps=HAAS):
    """Return what `check` finds about forms in a config set up by hand."""
    text = with_lines(with_lines(screen, "DISPLAY", lines), "RS274NGC", remaps)
    files = {
        name.replace("/", "__").replace(".", "_"): text.decode() for name, text in SUBS.items()
    }
    text = with_lines(text, "RS274NGC", "SUBROUTINE_PATH = g12/ngc\n")
    return reported(write_config(tmp_path, text, **files))


HAAS_PAGE = "NGCGUI_SUBFILE = form_haas_mm.ngc\n"
TKPKG = "TKPKG = Ngcgui 1.0\n"


@pytest.mark.parametrize(
    ("screen", "lines", "remaps", "finding"),
    [
        (AXIS, "", HAAS, "TKPKG = nothing: AXIS shows no forms"),
        (AXIS, "TKPKG = ngcgui 1.0\n", HAAS, "TKPKG = ngcgui: AXIS shows no"),
        (AXIS, TKPKG, "", "form_haas_mm.ngc: the codes of haas are not set up"),
        (GMOCCAPY, "", HAAS, "gmoccapy shows no forms"),
        (QTVCP, "", HAAS, "NGCGUI_SUBFILE_PATH = nothing, NGCGUI_SUBFILE = form_haas_mm.ngc"),
        (TK, "PROGRAM_PREFIX = nowhere\n", HAAS, "PROGRAM_PREFIX = nowhere: there is no"),
    ],
)
def test_what_keeps_forms_from_being_shown_is_found(tmp_path, screen, lines, remaps, finding):
    if "PROGRAM_PREFIX" in lines:
        window = "HALCMD = loadusr gladevcp -c forms forms.ui\n"
        screen = with_lines(f"[HAL]\n\n{screen}", "HAL", window)
        (tmp_path / "forms.ui").write_text("PyNgcGui")
    (found,) = shown_in(tmp_path, screen, lines + HAAS_PAGE, remaps)
    assert finding in found


def test_a_form_that_is_nowhere_is_found(tmp_path):
    (found,) = shown_in(tmp_path, AXIS, f"{TKPKG}NGCGUI_SUBFILE = form_hass_mm.ngc\n")
    assert "form_hass_mm.ngc is in none of" in found


def test_a_form_in_order_is_reported_and_no_finding(tmp_path):
    assert shown_in(tmp_path, AXIS, f"{TKPKG}{HAAS_PAGE}NGCGUI_SUBFILE = simp.ngc\n") == []
    config = config_of(tmp_path / "mill.ini")
    assert "         form         form_haas_mm" in lines_of_check(check_report(config, []))


CYCLES_TAB = f"{GLADE}{CYCLES}"


@pytest.mark.parametrize(
    ("screen", "lines"),
    [
        (AXIS, f"EMBED_TAB_NAME = Cycles\n{CYCLES_TAB}"),
        (TOUCHY, f"EMBED_TAB_NAME = Cycles\n{CYCLES_TAB}"),
        (GMOCCAPY, f"EMBED_TAB_NAME = Cycles\nEMBED_TAB_LOCATION = ntb_user_tabs\n{CYCLES_TAB}"),
        (OWN_TAB, f"EMBED_TAB_NAME = Cycles\n{CYCLES_TAB}"),
        (QTVCP, f"{QTDRAGON_TAB}{CYCLES_TAB}"),
        (QTAXIS, f"EMBED_TAB_NAME = Cycles\nEMBED_TAB_LOCATION = rightTab\n{CYCLES_TAB}"),
        (OWN_TAB.replace("gmoccapy", "qtvcp qtdragon"), CYCLES_WINDOW),
        (QTAXIS.replace("qtaxis", "qtlathe"), CYCLES_WINDOW),
        (TK, CYCLES_WINDOW),
        (PROBE_BASIC, "USER_TABS_PATH = g12/configs/include/probe_basic/\n"),
    ],
)
def test_each_screen_gets_the_cycles_page(tmp_path, screen, lines):
    ini = write_config(tmp_path, screen)
    with restored(ini):
        put_in(ini, "haas", "cycles-page")
        assert lines in ini.read_text()
        assert "NGCGUI" not in ini.read_text()
        assert texts_of("screen", ini) == []
        installed = ini.read_text()
        put_in(ini, "cycles-page")
        assert ini.read_text() == installed


ON_LATHE = with_lines(f"[DISPLAY]\nDISPLAY = axis\n\n{LATHE}", "DISPLAY", "LATHE = 1\n")
GMOCCAPY_LATHE = ON_LATHE.replace("axis", "gmoccapy")
AXIS_FACE = "USER_COMMAND_FILE = g12/configs/include/axis_face.py\n"
FACE_TAB = f"{GLADE}g12/configs/include/face_view.ui\n"


@pytest.mark.parametrize(
    ("screen", "lines"),
    [
        (ON_LATHE, AXIS_FACE),
        (GMOCCAPY_LATHE, f"EMBED_TAB_NAME = Face\nEMBED_TAB_LOCATION = ntb_user_tabs\n{FACE_TAB}"),
        (ON_LATHE.replace("axis", "touchy"), f"EMBED_TAB_NAME = Face\n{FACE_TAB}"),
    ],
)
@pytest.mark.parametrize("names", [("polar",), ("cylinder",), ("polar", "polar-shapes")])
def test_a_lathes_screen_shows_the_face(tmp_path, screen, lines, names):
    ini = write_config(tmp_path, screen)
    with restored(ini):
        put_in(ini, *names)
        assert ini.read_text().count(lines) == 1
        assert texts_of("screen", ini) == []


@pytest.mark.parametrize("screen", [ON_LATHE.replace("LATHE = 1\n", ""), QTVCP + LATHE])
def test_other_screens_show_the_face_already(tmp_path, screen):
    ini = write_config(tmp_path, screen)
    put_in(ini, "polar")
    assert "face" not in ini.read_text()


def test_a_command_file_of_the_users_own_stays_and_is_named(tmp_path):
    line = "USER_COMMAND_FILE = own.py\n"
    ini = write_config(tmp_path, with_lines(ON_LATHE, "DISPLAY", line), own_py="print()\n")
    with restored(ini):
        put_in(ini, "polar")
        assert ini.read_text().count("USER_COMMAND_FILE") == 1
        (said,) = texts_of("screen", ini)
        assert line.strip() in said and "is yours and stays" in said
    (tmp_path / "own.py").write_text("# axis_face.py\n")
    put_in(ini, "polar")
    assert texts_of("screen", ini) == []


def test_a_folder_of_tabs_of_the_users_own_is_refused_until_it_has_the_page(tmp_path):
    text = with_lines(PROBE_BASIC, "DISPLAY", "USER_TABS_PATH = own/\n")
    ini = write_config(tmp_path, text)
    with pytest.raises(Refused, match="USER_TABS_PATH = own/ is yours and stays"):
        put_in(ini, "haas", "cycles-page")
    (tmp_path / "own" / "cycles").mkdir(parents=True)
    put_in(ini, "haas", "cycles-page")
    assert texts_of("screen", ini) == []
    assert "include/probe_basic" not in ini.read_text()


@pytest.mark.parametrize("screen", [AXIS, TK, PROBE_BASIC])
def test_a_page_that_is_not_there_is_found(tmp_path, screen):
    ini = write_config(tmp_path, screen)
    put_in(ini, "haas", "cycles-page")
    ini.write_text(ini.read_text().replace("configs/include/", "configs/included/include/"))
    missing = [text for text in texts_of("screen", ini) if "is not there" in text]
    assert len(missing) == 1
