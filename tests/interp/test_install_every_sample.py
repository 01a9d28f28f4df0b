# SPDX-License-Identifier: GPL-2.0-or-later
"""Every sample config of LinuxCNC's screens: each name of ``--with`` in, checked, and out again.

The stock interpreter is asked once for each kind of screen and machine; the others are installed
with the answer that it gives a config whose modules all load.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

from g12.machine_ini import remap_from_value
from g12.tools.install import checking, installation, package_copy, removal
from g12.tools.install.checking import check_config
from g12.tools.install.config import features, forms
from g12.tools.install.config.findings import PROBLEM
from g12.tools.install.config.ini_edit import IniText
from g12.tools.install.config.loaded import Config, Python, codes_of, load_config, remaps_in
from g12.tools.install.plan import Refused, make_plan, refuse_problems
from g12.tools.install.rules import findings_of, installed_programs
from g12.tools.machine.ini import read_ini
from support.sample_configs import SAMPLES, copy_samples, tree
from support.small_configs import FILES_OF_PAGES, files_of_package

SCREENS = ("axis", "gmoccapy", "qtvcp", "touchy", "tklinuxcnc")
MILL = ["haas", "circle-mill"]
LATHE = ["polar", "polar-shapes", "cylinder"]
HANDLERS = {name: "g12.remap" for feature in features.REMAP_FILES
            for name in features.functions_of(feature)} | {"g12_on_abort": "g12.remap"}  # fmt: skip
MODULES = [f"python/{name}.py" for name in ("toplevel", "remap", "g12/__init__")]
PACKAGE = {
    **files_of_package(*MODULES, *FILES_OF_PAGES),
    **{f"ngc/{file.name}": b"" for file in features.ROOT.glob("ngc/*.ngc")},
    "python/g12/__main__.py": b"",
}
PAGES = (features.FORMS, features.CYCLES_PAGE)  # they need a code with forms
# of samples that are no machines by themselves
NO_MACHINE = {"interpreter", "does-not-load", "no-sub", "python-fails"}


def screen_of(path):
    words = (read_ini(path).get("DISPLAY", "DISPLAY") or "").split()
    return Path(words[0]).name if words else ""


INIS = sorted(path.relative_to(SAMPLES) for path in SAMPLES.rglob("*.ini")
              if screen_of(path) in SCREENS)  # fmt: skip
pytestmark = pytest.mark.skipif(not INIS, reason="no sample configs here")


@pytest.fixture(scope="module")
def samples(tmp_path_factory):
    return copy_samples(tmp_path_factory.mktemp("samples"))


@pytest.fixture(scope="module")
def content():
    """Return a function: what stood in a folder at first, read once."""
    return cache(tree)


def full_set(ini):
    """Return the features of a machine that go together."""
    lathe = "Y" not in ini.axes
    control = "programs-fanuc-lathe" if lathe else "programs-haas-mill"
    codes = [name for name in (LATHE if lathe else MILL) if not why_not(ini, name)]
    names = [*codes, *PAGES] if any(name in forms.FORMS_OF for name in codes) else codes
    return names if ini.get("FILTER", "nc") else [*names, control]


def is_outside(ini):
    """Tell whether a machine's Python, which codes have to be added to, is not in its folder."""
    toplevel = ini.file("PYTHON", "TOPLEVEL")
    return bool(toplevel) and not toplevel.resolve().is_relative_to(ini.directory.resolve())


def why_not(ini, name):
    """Return the kind of finding by which a machine must refuse a single feature, None if none."""
    if name in features.REMAP_FILES and is_outside(ini):
        return "outside"
    if name == features.SPINDLE_AS_C:
        return "pins"
    own = {remap_from_value(value).number for value in ini.all("RS274NGC", "REMAP")}
    if name in features.REMAP_FILES and own & {remap.number for remap in features.remaps_of(name)}:
        return "taken"
    if name in features.REMAP_FILES and not set(features.AXES_NEEDED.get(name, "XYZ")) <= set(
        ini.axes
    ):
        return "no-axis"
    if name in features.CONTROLS and ini.get("FILTER", "nc"):
        return "filter"
    if name in PAGES:
        return name
    return {"polar-shapes": "no-polar", features.KINEMATICS: "kinematics"}.get(name)


OWN_PROBLEMS = {  # samples with the pin names of an older LinuxCNC
    "rolfmill.ini": {"hal-pin"},
    "3-axis-servo.ini": {"hal-pin"},
    "3-axis-stepper.ini": {"hal-pin"},
}


def refusal(path, names, dry_run=False):
    """Install features; return the kinds of the findings they are refused for."""
    try:
        list(installation.install(IniText(path), names, dry_run))
    except Refused as refused:
        return {finding.kind for finding in refused.args}
    return set()


def in_and_out(path, names):
    """Install features in a config that takes them, check, uninstall; all is as it was."""
    assert refusal(path, names) == set()
    config, found = check_config(IniText(path))
    problems = [finding.kind for finding in found if finding.level == PROBLEM]
    assert {*problems} <= OWN_PROBLEMS.get(path.name, set())
    there = {*config.features} | {f"programs-{control}" for control in installed_programs(config)}
    assert there == {*names} - {*PAGES}
    of_codes = forms.files_of(config, names) if "forms" in names else []
    assert {f"{form}.ngc" for form in forms.shown(config)} == set(of_codes)
    list(removal.uninstall(IniText(path), dry_run=False))


@pytest.fixture
def no_interpreter(monkeypatch):
    """Install a small package, and take the modules of each config for loaded."""
    monkeypatch.setattr(package_copy, "package_files", lambda: PACKAGE)
    known = {}

    def own_python(text):
        """Return what the stock interpreter says of a config with Python of its own, asked once."""
        if not text.ini().get("PYTHON", "TOPLEVEL"):
            return Python(), None
        if text.path not in known:
            config = load_config(text)
            known[text.path] = config.python or Python(), config.failure
        return known[text.path]

    def loaded(text, ini=None):
        remaps = remaps_in(text)
        installed = bool(codes_of(remaps))
        unasked = installed and text.path not in known
        python, failure = (Python(), None) if unasked else own_python(text)
        if installed:
            python = replace(python, remap={**python.remap, **HANDLERS})
        return Config(
            text, ini or text.ini(), remaps, "2.9.0", python, frozenset(), failure, {1: 6.0}
        )

    monkeypatch.setattr(checking, "load_config", loaded)
    monkeypatch.setattr(installation, "load_config", loaded)


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    """Return a small copy of the package, as `install` makes it."""
    folder = tmp_path_factory.mktemp("package") / "g12"
    package_copy.build(folder, folder.with_name("none"), PACKAGE)
    return folder


def in_and_out_in_memory(path, name):
    """Put one feature into a config, check it and take it out again, without writing anything."""
    plan = make_plan(checking.load_config(IniText(path)), [name])
    assert plan.changes()
    own = OWN_PROBLEMS.get(path.name, set())
    found = findings_of(checking.load_config(plan.text))
    refuse_problems(finding for finding in found if finding.kind not in own)
    blocks = plan.text.blocks()
    removal.remove_blocks(plan.text, blocks)
    removal.remove_noted(plan.text, removal.notes_in(blocks), False)
    assert plan.text.files == IniText(path).files


def refusal_in_memory(path, name):
    """Put one feature in and take it out; return the kinds of findings it is refused for."""
    try:
        in_and_out_in_memory(path, name)
    except Refused as refused:
        return {finding.kind for finding in refused.args}
    return set()


def tried_on(name):
    """Return the features to try on a sample: of the controls, which differ in one word, one."""
    controls = list(features.CONTROLS)
    others = [feature for feature in features.FEATURE_NAMES if feature not in controls]
    return [*others, controls[INIS.index(name) % len(controls)]]


def on_a_core(name):
    """Return a sample as a parameter: those below one folder go to one core."""
    group = pytest.mark.xdist_group("/".join(name.parts[:2]))
    return pytest.param(name, marks=group, id=str(name))


@pytest.mark.usefixtures("no_interpreter")
@pytest.mark.parametrize("name", map(on_a_core, INIS))
def test_every_feature_goes_in_and_out(samples, content, package, name):
    path = samples / name
    ini, before = read_ini(path), content(path.parent)
    unfit = refusal(path, ["circle-mill" if "Y" in ini.axes else "polar"], True) & NO_MACHINE
    names = full_set(ini)
    if names and not unfit:
        in_and_out(path, names)
    (path.parent / "g12").symlink_to(package)
    try:
        for feature in tried_on(name):
            kinds, why = refusal_in_memory(path, feature), why_not(ini, feature)
            assert kinds if unfit else kinds >= ({why} - {None}) and bool(kinds) == bool(why)
    finally:
        (path.parent / "g12").unlink()
    assert tree(path.parent) == before


# One of each: screen, kind of machine, pages of its own; tests/sim has others, and runs them.
KINDS = [
    "sim/axis/axis_mm.ini",
    "sim/axis/db_demo/db_ran.ini",
    "sim/axis/ngcgui/ngcgui.ini",
    "sim/gmoccapy/gmoccapy.ini",
    "sim/tklinuxcnc/tklinuxcnc.ini",
    "sim/touchy/touchy.ini",
]


@pytest.mark.parametrize(
    "name", [*KINDS, *(name for name in map(str, INIS) if "qtaxis.ini" in name)]
)
def test_the_full_set_loads_in_the_stock_interpreter(samples, name, capsys):
    path = samples / name
    before = tree(path.parent)
    in_and_out(path, full_set(read_ini(path)))
    assert tree(path.parent) == before
