# SPDX-License-Identifier: GPL-2.0-or-later
"""install --with polar-kinematics: what it writes, restores and refuses; without LinuxCNC."""

import pytest

from g12.tools.install import trial
from g12.tools.install.config import features
from g12.tools.install.lathe.kinematics_rules import kinematics_findings
from g12.tools.install.plan import Refused, make_plan
from support.small_configs import TURNING as LATHE
from support.small_configs import TURNING_HAL as HAL
from support.small_configs import (
    config_of,
    content_of,
    files_of_package,
    package_of,
    put_in,
    restored,
    take_out,
    write_config,
)

REFUSED = [  # what is changed of the INI, and what is said
    ("trivkins coordinates=xzc kinstype=B", "trivkins", "is not trivkins coordinates=…"),
    ("coordinates=xzc", "coordinates=xyzc", "without Y"),
    ("COORDINATES =   X Z C", "COORDINATES = X Y Z C", "COORDINATES = X Y Z C is not"),
    ("JOINTS = 3", "JOINTS = 4", "JOINTS is not 3"),
    ("MAX_VELOCITY = 360\n", "", "[AXIS_C] has no MAX_VELOCITY"),
    ("MAX_LIMIT = 200.0", "MAX_LIMIT = 150", "MAX_LIMIT 150 and 200"),
    ("[AXIS_C]", "[AXIS_Y]\nMAX_LIMIT = 1\n[AXIS_C]", "there is an [AXIS_Y]"),
    ("HALFILE = motion.hal", "HALFILE = motion.tcl", "HALFILE = motion.tcl is no HAL file"),
    ("[HAL]", "[HAL]\nTWOPASS = on", "TWOPASS"),
    ("[KINS]KINEMATICS", "trivkins coordinates=XZC", "no HAL file has loadrt [KINS]KINEMATICS"),
    ("motion-controller servo-thread", "motion-controller fast", "addf motion-controller servo"),
    ("net x", "source more.hal\nnet x", "a source line"),
]


small_package = package_of(
    files_of_package(
        "configs/kinematics/polar_kinematics.hal", "configs/kinematics/polar_tool_offset.hal"
    )
)


def config_in(folder, text=LATHE, hal=HAL):
    return write_config(folder, text, "lathe.ini", motion_hal=hal, later_hal="# nothing\n")


@pytest.mark.parametrize(
    ("text", "polar"),
    [
        (LATHE.replace("\n", "\r\n"), "polar-g12.3"),
        (LATHE.rstrip() + "\n[G12]\nPOLAR_KINEMATICS = 0 \nPOLAR_TOOL_OFFSET = 2", "polar"),
    ],
)
def test_check_finds_nothing_and_uninstall_gives_every_byte_back(
    tmp_path, monkeypatch, text, polar
):
    monkeypatch.setattr("g12.tools.install.lathe.kinematics_rules.module_file", lambda: tmp_path)
    monkeypatch.setattr("g12.tools.install.lathe.kinematics_rules.is_outdated", lambda _: False)
    ini = config_in(tmp_path, text)
    with restored(ini):
        put_in(ini, polar, features.KINEMATICS)
        assert list(kinematics_findings(config_of(ini))) == []
        assert config_of(ini).ini.axes == "XYZC"
        put_in(ini, features.KINEMATICS)  # again: nothing


def test_the_picture_on_the_screen_gets_the_faces_axes_and_every_byte_comes_back(tmp_path):
    ini = config_in(tmp_path, f"[DISPLAY]\nDISPLAY = axis\n\n{LATHE}")
    with restored(ini):
        put_in(ini, "polar")
        assert config_of(ini).ini.get("DISPLAY", "GEOMETRY") == "CXZ!"
        own = {"package": tmp_path / "g12" / "python" / "g12", "remap_file": "remap.py"}
        put_in(ini, features.KINEMATICS, remap={"polar_on": "g12.host"}, **own)
        assert config_of(ini).ini.get("DISPLAY", "GEOMETRY") == "CXYZ!"


def test_what_is_written(tmp_path):
    ini = config_in(tmp_path)
    put_in(ini, "polar", features.KINEMATICS)
    text = ini.read_text()
    for lines in (
        "# was: KINEMATICS = trivkins coordinates=xzc kinstype=B\n"
        "# now: KINEMATICS = polar_xzc coordinates=XZC\n"
        "KINEMATICS = polar_xzc coordinates=XZC\n# <<<",
        "# was: COORDINATES =   X Z C\n# now: COORDINATES = X Y Z C\nCOORDINATES = X Y Z C\n# <<<",
        "# was: MIN_LIMIT = -5.0\n# now: MIN_LIMIT = -200\nMIN_LIMIT = -200\n# <<<",
        "# was: MAX_ACCELERATION = 1000\n# now: MAX_ACCELERATION = 700\nMAX_ACCELERATION = 700\n#",
        "[AXIS_Y]\n# now: MIN_LIMIT = -200; MAX_LIMIT = 200; MAX_VELOCITY = 100; "
        "MAX_ACCELERATION = 700\n"
        "MIN_LIMIT = -200\nMAX_LIMIT = 200\nMAX_VELOCITY = 100\nMAX_ACCELERATION = 700\n",
        "HALFILE = g12/configs/kinematics/polar_kinematics.hal\n# <<<",
        "ON_ABORT_COMMAND = O <g12_on_abort> call\n# <<<",
        "[G12]\nPOLAR_KINEMATICS = 1\n",
    ):
        assert lines in text
    assert "[JOINT_0]\nMIN_LIMIT = -5\nMAX_LIMIT = 200\nMAX_VELOCITY = 100\nMAX_ACC" in text


def test_what_the_user_changed_since_stays_as_a_comment_and_is_reported(tmp_path):
    ini = config_in(tmp_path)
    put_in(ini, "polar", features.KINEMATICS)
    ours, theirs = "COORDINATES = X Y Z C\n# <<<", "COORDINATES = X Y Z C A\n# <<<"
    assert ini.read_text().count(ours) == 1
    ini.write_text(ini.read_text().replace(ours, theirs))
    said = take_out(ini)
    (reported,) = [line for line in said if "you changed it, it stays as a comment: " in line]
    lines = ini.read_text().splitlines(True)
    (comment,) = [line for line in lines if line.startswith("# before unin")]
    assert reported.endswith("COORDINATES = X Y Z C A") and comment.endswith(
        reported.split(": ")[-1] + "\n"
    )
    assert "".join(line for line in lines if line != comment) == LATHE
    assert take_out(ini) == [f"{ini}: nothing that install put in"]


def test_an_ini_of_an_older_install_is_given_back(tmp_path):
    ini = config_in(tmp_path)
    put_in(ini, "polar", features.KINEMATICS)
    lines = ini.read_text().splitlines(keepends=True)
    ini.write_text("".join(line for line in lines if not line.startswith("# now: ")))
    take_out(ini)
    assert ini.read_text() == LATHE


@pytest.mark.parametrize(("usual", "unusual", "says"), REFUSED)
def test_an_unusual_ini_or_hal_file_is_refused_with_a_way_to_the_steps(
    tmp_path, usual, unusual, says
):
    text, hal = (each.replace(usual, unusual, 1) for each in (LATHE, HAL))
    assert (text, hal) != (LATHE, HAL)
    refused_in(tmp_path, text, hal, says)


def refused_in(folder, text, hal, says):
    ini = config_in(folder, text, hal)
    before = content_of(folder)
    with pytest.raises(Refused) as refused:
        put_in(ini, "polar", features.KINEMATICS)
    found = refused.value.args
    assert any(says in finding.text for finding in found), found
    assert {finding.kind for finding in found} == {"kinematics"}
    assert content_of(folder) == before


def test_an_included_file_is_left_alone(tmp_path):
    (tmp_path / "kins.inc").write_text(
        "[KINS]\nKINEMATICS = trivkins coordinates=XZC\nJOINTS = 3\n"
    )
    begin, end = LATHE.index("[KINS]"), LATHE.index("[HAL]")
    text = f"{LATHE[:begin]}#INCLUDE kins.inc\n{LATHE[end:]}"
    refused_in(tmp_path, text, HAL, "kins.inc:2: KINEMATICS is in an included file")


def test_without_g12_1_it_says_how(tmp_path):
    ini = config_in(tmp_path)
    with pytest.raises(Refused) as refused:
        put_in(ini, features.KINEMATICS)
    assert "--with polar polar-kinematics" in refused.value.args[0].cure


def test_the_trial_reads_the_hal_file_of_the_package(tmp_path):
    config = config_of(config_in(tmp_path))
    plan = make_plan(config, ["polar", features.KINEMATICS])
    ini = trial.trial_ini(plan, plan.text.ini(), tmp_path / "scratch")
    assert ini.all("HAL", "HALFILE") == [
        "motion.hal",
        str(tmp_path / "scratch/configs/kinematics/polar_kinematics.hal"),
    ]
