# SPDX-License-Identifier: GPL-2.0-or-later
"""``install --with programs-…``: the [FILTER] lines, what `check` says of them, taking them out."""

import pytest

from g12.tools.install.plan import Refused, make_plan
from g12.tools.install.rules import installed_programs, wrong_filters
from support.small_configs import LATHE, config_of, package_of, put_in, restored, write_config

FILTER = """\
PROGRAM_EXTENSION = .nc Programs of haas-mill
nc = python3 g12/python/g12 translate --control haas-mill
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


def test_a_filter_of_the_users_own_for_the_suffix_is_refused(tmp_path):
    ini = write_config(tmp_path)
    ini.write_text(f"{ini.read_text()}\n[FILTER]\nnc = mine\n")
    with pytest.raises(Refused) as refused:
        make_plan(config_of(ini), ["programs-haas-mill"])
    assert refused.value.args[0].text == "[FILTER] nc = mine is there already"


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
    (finding,) = wrong_filters(config_of(ini))
    assert text in finding.text


@pytest.mark.parametrize(
    ("spindles", "control", "settings"),
    [
        (2, "doosan-lathe", "POLAR_Z = allow\nLIVE_SPINDLE = 1\n"),
        (1, "mill-round-part", "[G12]\nCYLINDER_X = allow\nLIVE_SPINDLE = 0\n"),
    ],
)
def test_programs_on_a_lathe_need_settings(tmp_path, spindles, control, settings):
    ini = write_config(tmp_path, LATHE.replace("[TRAJ]\n", f"[TRAJ]\nSPINDLES = {spindles}\n"))
    with restored(ini):
        for _ in range(2):
            put_in(ini, f"programs-{control}")
            assert settings in ini.read_text()
            assert ini.read_text().count("LIVE_SPINDLE") == 1
