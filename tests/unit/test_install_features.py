# SPDX-License-Identifier: GPL-2.0-or-later
"""The lines that `install` writes for screens, programs, kinematics and a spindle as C.

Each goes in, is found in order by `check`, and comes out again; without LinuxCNC.
"""

import re

import pytest

from g12.tools.errors import UsageError
from g12.tools.install.config import features
from g12.tools.install.config.loaded import filters_of
from g12.tools.install.lathe.hal import pins_taken
from g12.tools.install.lathe.kinematics import kinematics_findings
from g12.tools.install.lathe.spindle_c import read_pins, spindle_c_findings
from g12.tools.install.rules import filter_findings
from support.small_configs import (
    LATHE,
    MILL,
    TURNING,
    TURNING_HAL,
    config_of,
    files_of_package,
    module_of_kinematics,
    package_of,
    put_in,
    refused,
    restored,
    with_lines,
    write_config,
)

FORMS = ("form_haas_mm", "form_haas_inch", "form_circle_mill_mm")
INCLUDES = [f"configs/include/spindle_c{end}" for end in (".hal", "_limits.sh", ".inc")]
GUARDS = [f"configs/kinematics/polar_{name}.hal" for name in ("kinematics", "tool_offset")]
module = module_of_kinematics(autouse=True)
small_package = package_of(
    {"python/g12/__init__.py": b"", "python/g12/__main__.py": b""}
    | {f"ngc/{name}.ngc": b"(a sub)\n" for name in FORMS}
    | files_of_package(*INCLUDES, *GUARDS, "python/toplevel.py")
)


# Screens.

AXIS = f"[DISPLAY]\nDISPLAY = axis\nCYCLE_TIME = 0.1\n\n{MILL}"
GMOCCAPY, TOUCHY, TK, PROBE_BASIC, QTVCP, QTAXIS, QTLATHE = (
    AXIS.replace("axis", name)
    for name in ("gmoccapy", "touchy", "tklinuxcnc", "probe_basic", "qtvcp qtdragon",
                 "qtvcp -d qtaxis", "qtvcp qtlathe")
)  # fmt: skip
OWN_TAB = with_lines(GMOCCAPY, "DISPLAY", "EMBED_TAB_NAME = Mine\nEMBED_TAB_COMMAND = mine\n")
OWN_PATH, CWD = "NGCGUI_SUBFILE_PATH = ../nc_files\n", "/proc/self/cwd/g12/ngc/"
PAGES = "NGCGUI_SUBFILE = form_haas_mm.ngc\nNGCGUI_SUBFILE = form_circle_mill_mm.ngc\n"
GLADE = "EMBED_TAB_COMMAND = gladevcp -x {XID} "
WINDOW = "HALCMD = loadusr gladevcp -c "
FORMS_UI = "g12/configs/include/forms.ui\n"
CYCLES_UI = "-u g12/python/g12/tools/cycles_page/gtk_view.py g12/configs/include/cycles.ui\n"
QTDRAGON_TAB = "EMBED_TAB_LOCATION = tabWidget_utilities\n"
ON_LATHE = f"[DISPLAY]\nDISPLAY = axis\nLATHE = 1\n\n{LATHE}"
MILL_CODES = ("haas", "circle-mill")


def with_axes(text, axes):
    """Return a config with other axes."""
    return re.sub("COORDINATES = .*", f"COORDINATES = {' '.join(axes)}", text)


SCREENS = [  # a config, features, lines that it gets
    (AXIS, (*MILL_CODES, "forms"), f"TKPKG = Ngcgui 1.0\n{PAGES}"),
    (QTVCP, (*MILL_CODES, "forms"), f"NGCGUI_SUBFILE_PATH = g12/ngc\n{PAGES}"),
    (with_lines(QTVCP, "DISPLAY", OWN_PATH), (*MILL_CODES, "forms"),
     PAGES.replace("form_", f"{CWD}form_")),
    (GMOCCAPY, (*MILL_CODES, "forms"), "EMBED_TAB_NAME = Forms\n"
     f"EMBED_TAB_LOCATION = ntb_user_tabs\n{GLADE}{FORMS_UI}{PAGES}"),
    (OWN_TAB, (*MILL_CODES, "forms"), f"EMBED_TAB_NAME = Forms\n{GLADE}{FORMS_UI}{PAGES}"),
    (QTAXIS, (*MILL_CODES, "forms"), f"{WINDOW}forms {FORMS_UI}"),
    (TK, (*MILL_CODES, "forms"), f"{WINDOW}forms {FORMS_UI}"),
    (AXIS.replace("= mm", "= inch"), ("haas", "forms"), "NGCGUI_SUBFILE = form_haas_inch.ngc\n"),
    (TOUCHY, ("haas", "cycles-page"), f"EMBED_TAB_NAME = Cycles\n{GLADE}{CYCLES_UI}"),
    (QTVCP, ("haas", "cycles-page"), f"EMBED_TAB_NAME = Cycles\n{QTDRAGON_TAB}{GLADE}{CYCLES_UI}"),
    (QTAXIS, ("haas", "cycles-page"), f"EMBED_TAB_LOCATION = rightTab\n{GLADE}{CYCLES_UI}"),
    (OWN_TAB.replace("gmoccapy", "qtvcp qtdragon"), ("haas", "cycles-page"),
     f"{WINDOW}cycles {CYCLES_UI}"),
    (QTLATHE, ("haas", "cycles-page"), f"{WINDOW}cycles {CYCLES_UI}"),
    (PROBE_BASIC, ("haas", "cycles-page"), "USER_TABS_PATH = g12/configs/include/probe_basic/\n"),
    (ON_LATHE, ("polar",), "USER_COMMAND_FILE = g12/configs/include/axis_face.py\n"
     "GEOMETRY = CXZ!\n"),
    (with_axes(AXIS, "XYZA"), ("cylinder",), "GEOMETRY = AXYZ!\n"),
    (with_axes(AXIS, "XYZB"), ("cylinder",), "GEOMETRY = -BXYZ!\n"),
    (with_axes(AXIS, "XYZA") + "[G12]\nROTARY_SENSE = reversed\n", ("cylinder",),
     "GEOMETRY = -AXYZ!\n"),
    (ON_LATHE.replace("axis", "gmoccapy"), ("cylinder",), "EMBED_TAB_NAME = Face\n"
     f"EMBED_TAB_LOCATION = ntb_user_tabs\n{GLADE}g12/configs/include/face_view.ui\n"),
]  # fmt: skip


@pytest.mark.parametrize(("screen", "names", "lines"), SCREENS)
def test_each_screen_gets_its_lines_and_loses_them_again(tmp_path, screen, names, lines):
    ini = write_config(tmp_path, screen)
    with restored(ini):
        put_in(ini, *names)
        text = ini.read_text()
        assert text.count(lines) == 1 and text.count("[DISPLAY]") == 1
        assert put_in(ini, names[-1]) == []


def test_lines_of_the_users_own_stay_and_are_not_doubled(tmp_path):
    own = "USER_COMMAND_FILE = own.py\nGEOMETRY = XZ\n"
    lathe = write_config(tmp_path, with_lines(ON_LATHE, "DISPLAY", own), "lathe.ini")
    put_in(lathe, "polar")
    assert lathe.read_text().count("USER_COMMAND") == lathe.read_text().count("GEOMETRY") == 1
    own = "TKPKG = Ngcgui 1.0\nNGCGUI_SUBFILE = simp.ngc\nNGCGUI_SUBFILE = form_haas_mm.ngc\n"
    ini = write_config(tmp_path, with_lines(AXIS, "DISPLAY", own))
    put_in(ini, "haas", "forms")
    text = ini.read_text()
    assert text.count("TKPKG") == text.count("form_haas_mm") == 1


@pytest.mark.parametrize("screen", [ON_LATHE.replace("LATHE = 1\n", ""), QTVCP + LATHE])
def test_other_screens_show_the_face_already(tmp_path, screen):
    ini = write_config(tmp_path, screen)
    put_in(ini, "polar")
    assert "face" not in ini.read_text()


@pytest.mark.parametrize(
    ("text", "names", "why"),
    [
        (MILL, ["haas", "forms"], "[DISPLAY] DISPLAY is missing"),
        (AXIS, ["cycles-page"], "no code here has a form"),
        (TURNING, ["polar-kinematics"], "there is no G12.1 here"),
        (TURNING, ["spindle-c"], "install cannot know the inputs of your spindle's drive"),
        (with_lines(PROBE_BASIC, "DISPLAY", "USER_TABS_PATH = own/\n"), ["haas", "cycles-page"],
         "USER_TABS_PATH = own/ is yours"),
        (with_axes(AXIS, "XYZAB"), ["cylinder"], "[DISPLAY] GEOMETRY = AXYZ! or -BXYZ! first"),
        (f"{MILL}\n[FILTER]\nTAP = mine\n", ["programs-fanuc-mill"],
         "[FILTER] TAP = mine is there already"),
    ],
)  # fmt: skip
def test_refused_for_what_is_missing(tmp_path, text, names, why):
    finding = refused(write_config(tmp_path, text), *names)[0]
    assert why in f"{finding.text}\n{finding.cure}"


# Programs of other controls.

COMMAND = "python3 g12/python/g12 translate --control"


@pytest.mark.parametrize(
    ("control", "suffixes", "options"),
    [
        ("haas-mill", "nc NC", " --decimals least --units inch"),
        ("fanuc-mill", "nc NC tap TAP", ""),
        ("okuma-lathe", "min MIN nc NC", ""),
        ("mazak-integrex", "eia EIA nc NC", ""),
    ],
)
def test_each_usual_extension_is_opened_in_both_cases(tmp_path, control, suffixes, options):
    ini = write_config(tmp_path)
    with restored(ini):
        put_in(ini, f"programs-{control}", options=options)
        put_in(ini, "circle-mill", options=options)
        filters = ini.read_text().partition("[FILTER]\n")[2].partition("# <<<")[0]
        shown = ",".join(f".{suffix}" for suffix in suffixes.split())
        assert filters.splitlines() == [
            f"PROGRAM_EXTENSION = {shown} Programs of {control}",
            *(f"{suffix} = {COMMAND} {control}{options}" for suffix in suffixes.split()),
        ]
        assert {call["control"] for *_, call in filters_of(config_of(ini))} == {control}
        assert list(filter_findings(config_of(ini))) == []


@pytest.mark.parametrize(
    ("spindles", "control", "settings"),
    [
        (2, "doosan-lathe", "POLAR_Z = allow\nLIVE_SPINDLE = 1\n"),
        (1, "mill-round-part", "[G12]\nCYLINDER_X = allow\nLIVE_SPINDLE = 0\n"),
        (1, "mill-on-face", "[G12]\nPOLAR_Z = allow\nLIVE_SPINDLE = 0\n"),
    ],
)
def test_programs_on_a_lathe_need_settings(tmp_path, spindles, control, settings):
    ini = write_config(tmp_path, LATHE.replace("[TRAJ]\n", f"[TRAJ]\nSPINDLES = {spindles}\n"))
    with restored(ini):
        put_in(ini, f"programs-{control}")
        assert settings in ini.read_text()
        assert put_in(ini, f"programs-{control}") == []


# The kinematics of the face, and a spindle that becomes C.

PINS = """\
velocity = "drive.velocity"
velocity_scale = 60
position = "drive.position"
holds = "drive.mode"
brake = "drive.brake"
"""
TURNS_ONLY = TURNING_HAL.replace("net c joint.2.motor-pos-cmd => joint.2.motor-pos-fb\n", "")


def lathe_in(folder, text=TURNING, hal=TURNING_HAL):
    return write_config(folder, text, "lathe.ini", motion_hal=hal, later_hal="# nothing\n")


def pins_of(folder, text=PINS):
    path = folder.parent / f"{folder.name}.toml"
    path.write_text(text)
    return read_pins(path)


def found(ini):
    config = config_of(ini)
    rules = (spindle_c_findings, kinematics_findings, pins_taken)
    return [finding for rule in rules for finding in rule(config)]


@pytest.mark.parametrize(
    "text",
    [
        f"[DISPLAY]\nDISPLAY = axis\n{TURNING}",
        TURNING.replace("\n", "\r\n"),
        TURNING.rstrip() + "\n[G12]\nPOLAR_KINEMATICS = 0 \nPOLAR_TOOL_OFFSET = 2",
    ],
)
@pytest.mark.parametrize(
    "steps",
    [
        [["polar", "polar-kinematics"]],
        [["polar", "spindle-c"], ["polar-kinematics"]],
        [["polar-g12.3", "polar-kinematics"], ["spindle-c"]],
    ],
)
def test_kinematics_and_spindle_go_in_in_each_order_and_out(tmp_path, text, steps):
    ini = lathe_in(tmp_path, text)
    with restored(ini):
        for names in steps:
            put_in(ini, *names, pins=pins_of(tmp_path) if "spindle-c" in names else None)
        assert found(ini) == []
        ini_now = config_of(ini).ini
        assert ini_now.axes == "XYZC"
        assert ini_now.get("SPINDLE_C", "ENABLED") in (None, "polar-enabled")
        assert ini_now.get("DISPLAY", "GEOMETRY") in (None, "CXYZ!")


def test_what_a_spindle_that_becomes_c_gets(tmp_path):
    ini = lathe_in(tmp_path)
    put_in(ini, "spindle-c", pins=pins_of(tmp_path))
    text = ini.read_text()
    for lines in (
        "HALFILE = g12/configs/include/spindle_c.hal\n"
        "HALCMD = unlinkp drive.velocity\nHALCMD = net spindle-c-velocity => drive.velocity\n",
        "RPS = rps\nINDEX = index\nREACHED = spindle-c-always\nENABLED = sc-enabled\n",
        "VELOCITY_SCALE = 60\nPOSITION_SCALE = 1\n",
    ):
        assert lines in text
    ini.write_text(text.replace("TOLERANCE = 0.02", "TOLERANCE = 0.2"))
    put_in(ini, "polar")  # without the file of pins; the owner's value stays
    assert config_of(ini).ini.all("SPINDLE_C", "TOLERANCE") == ["0.2"]
    assert "VELOCITY_SCALE = 60\n" in ini.read_text() and found(ini) == []


KINS, SPINDLE = ("polar", "polar-kinematics"), ("spindle-c",)
UNUSUAL = [  # what is changed of a lathe, in its INI and its HAL file; features; what is said
    ("trivkins coordinates=xzc kinstype=B", "trivkins", KINS, "is not trivkins coordinates=…"),
    ("coordinates=xzc", "coordinates=xyzc", KINS, "without Y"),
    ("COORDINATES =   X Z C", "COORDINATES = X Y Z C", KINS, "COORDINATES = X Y Z C is not"),
    ("MAX_VELOCITY = 360\n", "", KINS, "[AXIS_C] has no MAX_VELOCITY"),
    ("MAX_LIMIT = 200.0", "MAX_LIMIT = 150", KINS, "MAX_LIMIT 150 and 200"),
    ("[AXIS_C]", "[AXIS_Y]\nMAX_LIMIT = 1\n[AXIS_C]", KINS, "there is an [AXIS_Y]"),
    ("HALFILE = motion.hal", "HALFILE = motion.tcl", KINS, "motion.tcl is no HAL file"),
    ("trivkins coordinates=xzc", "trivkins coordinates=xza", SPINDLE, "no joint is C alone"),
    ("encoder.position => spindle.0.revs", "a => b", SPINDLE,
     "no HAL file connects spindle.0.revs"),
    ("HALFILE = motion.hal", "HALFILE = LIB:basic_sim.tcl", SPINDLE,
     "no HAL file connects spindle.0.index-enable (LIB:basic_sim.tcl is Tcl"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "names", "said"), UNUSUAL)
def test_an_unusual_lathe_is_left_alone_and_named(tmp_path, old, new, names, said):
    assert old in TURNING + TURNING_HAL
    ini = lathe_in(tmp_path, TURNING.replace(old, new, 1), TURNING_HAL.replace(old, new))
    findings = refused(ini, *names, pins=pins_of(tmp_path))
    assert said in "".join(finding.text for finding in findings)


def without_c():
    """Return a lathe's INI without C."""
    text = TURNING
    for old, new in (("xzc", "xz"), ("X Z C", "X Z"), ("JOINTS = 3", "JOINTS = 2")):
        text = text.replace(old, new)
    return text[: text.index("[AXIS_C]")]


def said_to(folder, text):
    """Return what install tells the owner of a lathe without C to write."""
    (finding,) = refused(lathe_in(folder, text, TURNS_ONLY), "spindle-c", pins=pins_of(folder))
    return finding.cure


def test_a_lathe_without_c_is_told_its_lines_and_with_them_it_is_installed(tmp_path):
    text = without_c()
    first, *lines = said_to(tmp_path, text).splitlines()
    assert "configs/spindle_c.md" in first
    blank = lines.index("")
    for line in lines[:blank]:
        section, key, value = re.fullmatch(r"(\[\w+\]) (\w+) = (.*)", line).groups()
        head, tail = text.split(section, 1)
        text = head + section + re.sub(rf"(?m)^{key} = .*", f"{key} = {value}", tail, count=1)
    assert "KINEMATICS = trivkins coordinates=XZC kinstype=B\nJOINTS = 3\n" in text
    assert "COORDINATES = X Z C\n" in text
    ini = lathe_in(tmp_path, "\n".join((text, *lines[blank:], "")), TURNS_ONLY)
    put_in(ini, "spindle-c", pins=pins_of(tmp_path))
    assert found(ini) == []
    simulated = (features.ROOT / "configs" / "sim" / "lathe_spindle_c_mm.ini").read_text()
    assert "\n".join(lines[blank:]) in simulated  # that machine runs with these sections


def test_only_what_is_missing_is_told(tmp_path):
    cure = said_to(tmp_path, f"{without_c()}\n[JOINT_2]\nTYPE = ANGULAR\n")
    assert "[AXIS_C]" in cure and "[JOINT_2]" not in cure
    text = TURNING.replace("trivkins coordinates=xzc kinstype=B", "mykins")
    assert said_to(tmp_path, text) == (
        "make C a joint of its own, as the steps in configs/spindle_c.md say"
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("velocity = 'a'", "position: missing; holds: missing"),
        (f"{PINS}\nspeed = 'a'", "speed is none of velocity, position"),
        (PINS.replace("60", "'fast'"), "velocity_scale = 'fast': must be a number"),
        (PINS.replace("60", "9" * 400), "velocity_scale = 9999"),
        (f"{PINS}\ntimeout = -5", "timeout = -5: must be above 0"),
        (f"{PINS}\nindex_speed = 0", "index_speed = 0: must not be 0"),
        (f"{PINS}\ntolerance = nan", "tolerance = nan: must be 1e.09 at most"),
        (PINS.replace('"drive.mode"', "3"), "holds is the name of a pin, not 3"),
        ("velocity", "Expected .=. after a key"),
    ],
)
def test_a_file_of_pins_that_says_something_else(tmp_path, text, said):
    with pytest.raises(UsageError, match=said):
        pins_of(tmp_path, text)
