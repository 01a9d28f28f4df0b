# SPDX-License-Identifier: GPL-2.0-or-later
"""Every sample config of LinuxCNC's screens: each name of ``--with`` in, and out byte for byte.

One of each screen and kind of machine is installed, checked and uninstalled with the stock
interpreter; `sim/test_install_samples.py` runs others.
"""

import pytest

from g12.machine_ini import remap_from_value
from g12.tools.commands.main import main
from g12.tools.forms.table import HANDLERS
from g12.tools.install.config import features
from g12.tools.install.config.findings import Refused
from g12.tools.install.config.ini_edit import IniText
from g12.tools.install.config.loaded import filters_of, load_config
from g12.tools.machine.ini import read_ini
from support.sample_configs import SAMPLES, copy_samples, problems_of, tree
from support.small_configs import planned

SCREENS = ("axis", "gmoccapy", "qtvcp", "touchy", "tklinuxcnc")
MILL = ["haas", "circle-mill", "bore"]
LATHE = ["polar", "polar-shapes", "cylinder"]


def screen_of(path):
    words = (read_ini(path).get("DISPLAY", "DISPLAY") or "").split()
    return words[0].rpartition("/")[2] if words else ""


INIS = sorted(path.relative_to(SAMPLES) for path in SAMPLES.rglob("*.ini")
              if screen_of(path) in SCREENS)  # fmt: skip
pytestmark = pytest.mark.skipif(not INIS, reason="no sample configs here")


@pytest.fixture(scope="module")
def samples(tmp_path_factory):
    return copy_samples(tmp_path_factory.mktemp("samples"))


def full_set(ini):
    """Return the features of a machine that go together."""
    lathe = "Y" not in ini.axes
    control = "programs-fanuc-lathe" if lathe else "programs-haas-mill"
    own = {remap_from_value(value).number for value in ini.all("RS274NGC", "REMAP")}
    codes = [name for name in (LATHE if lathe else MILL)
             if own.isdisjoint(remap.number for remap in features.remaps_of(name))]  # fmt: skip
    with_forms = not HANDLERS.keys().isdisjoint(codes)
    names = [*codes, *(["forms", "cycles-page"] if with_forms else [])]
    return names if ini.get("FILTER", "nc") else [*names, control]


def in_and_out(path, names):
    """Plan an installation, and take it out again in memory; return the refused kinds."""
    try:
        text = planned(path, *names)
    except Refused as refused:
        return {finding.kind for finding in refused.args}
    assert text.changes()
    assert text.words() == [name for name in features.FEATURE_NAMES if name in names]
    text.take_out()
    assert text.files == IniText(path).files
    return set()


REFUSED = {  # a single feature that a machine may not take: the kinds of findings
    "spindle-c": {"pins", "spindle-c"},
    "polar-kinematics": {"kinematics"},
    "cylinder": {"cylinder"},  # A and B: which of them turns the part is asked
    "forms": {"forms"},
    "cycles-page": {"cycles-page"},
}


def on_a_core(name):
    """Return a sample as a parameter: those below one folder go to one core."""
    group = pytest.mark.xdist_group("/".join(name.parts[:2]))
    return pytest.param(name, marks=group, id=str(name))


@pytest.mark.parametrize("name", map(on_a_core, INIS))
def test_every_feature_goes_in_and_out(samples, name):
    path = samples / name
    if not IniText(path).section("RS274NGC"):
        pytest.skip("no machine")
    controls = list(features.CONTROLS)  # which differ in one word: one of them
    for feature in (*features.FEATURES, controls[INIS.index(name) % len(controls)]):
        kinds = in_and_out(path, [feature])
        allowed = REFUSED.get(feature, {"filter"} if feature in features.CONTROLS else set())
        assert kinds <= allowed | {"outside"}, feature
    assert in_and_out(path, full_set(read_ini(path))) <= {"outside"}


# One of each: screen, kind of machine, pages and Python of its own.
KINDS = [
    "sim/axis/axis_mm.ini",
    "sim/axis/db_demo/db_ran.ini",
    "sim/axis/ngcgui/ngcgui.ini",
    "sim/axis/remap/extend-builtins/extend-builtins.ini",
    "sim/gmoccapy/gmoccapy.ini",
    "sim/gmoccapy/lathe_configs/lathe_C.ini",
    "sim/tklinuxcnc/tklinuxcnc.ini",
    "sim/touchy/touchy.ini",
]


@pytest.mark.parametrize(
    "name", [*KINDS, *(name for name in map(str, INIS) if "qtaxis.ini" in name)]
)
def test_the_full_set_loads_in_the_stock_interpreter(samples, name):
    path = samples / name
    before, names = tree(path.parent), full_set(read_ini(path))
    assert main(["install", str(path), "--with", *names]) == 0
    assert problems_of(path) == []
    config = load_config(IniText(path))
    there = {*config.features} | {f"programs-{call['control']}" for *_, call in filters_of(config)}
    assert there == {*names} - {"forms", "cycles-page"}
    assert bool(config.ini.all("DISPLAY", "NGCGUI_SUBFILE")) == ("forms" in names)
    installed = tree(path.parent)
    assert main(["install", str(path), "--with", names[0]]) == 0  # again: nothing
    assert tree(path.parent) == installed
    assert main(["uninstall", str(path)]) == 0
    assert tree(path.parent) == before
