# SPDX-License-Identifier: GPL-2.0-or-later
"""What `check` says of a lathe with C: its screen, its turns, G28; and what `install` sets."""

import pytest

from g12.tools.install.config import features
from g12.tools.install.config.findings import NOTE, WARNING
from g12.tools.install.lathe.rules import lathe_findings
from g12.tools.install.plan import make_plan
from support.small_configs import (
    LATHE,
    config_of,
    files_of_package,
    package_of,
    put_in,
    take_out,
    with_lines,
    write_config,
)

SCREEN = f"[DISPLAY]\nDISPLAY = axis\n\n{LATHE}"


small_package = package_of(
    {"python/g12/__init__.py": b"", "ngc/g12_skipped_over.ngc": b"(a sub)\n"}
    | files_of_package("python/toplevel.py", "python/remap.py")
)


def found(folder, text, names=("polar",), var="5161 50.0\n"):
    """Return kind and level of what `check` finds on a lathe."""
    text = with_codes(text, names)
    config = config_of(write_config(folder, text, **({"mill_var": var} if var else {})))
    return {finding.kind: finding.level for finding in lathe_findings(config)}


def with_codes(text, names):
    """Return an INI with the REMAP lines of features."""
    remaps = (remap.text for name in names for remap in features.remaps_of(name))
    return with_lines(text, "RS274NGC", "".join(f"REMAP = {remap}\n" for remap in remaps))


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        ("GEOMETRY = XZC\n", {"geometry": WARNING}),  # moved first, then turned
        ("GEOMETRY = CZ\n", {"geometry": WARNING}),  # never moved along X
        ("GEOMETRY = CXZ!\n", {}),
        ("GEOMETRY = -CXZ\n", {}),
    ],
)
def test_a_screen_that_does_not_turn_the_part(tmp_path, lines, expected):
    assert found(tmp_path, with_lines(SCREEN, "DISPLAY", lines)) == expected


def test_c_that_unwinds(tmp_path):
    text = LATHE.replace("WRAPPED_ROTARY = 1", "MIN_LIMIT = -9999\nMAX_LIMIT = 9999")
    assert found(tmp_path, text) == {"unwinding": NOTE}
    assert found(tmp_path, text.replace("9999", "180")) == {}


@pytest.mark.parametrize(
    ("var", "never_set"),
    [("", True), ("5163\t-12.5\n", False)],
)
def test_a_g28_that_was_never_set(tmp_path, var, never_set):
    assert found(tmp_path, LATHE, var=var) == ({"g28": NOTE} if never_set else {})


def test_install_leaves_the_geometry_and_uninstall_takes_the_lines_out(tmp_path):
    """A geometry without C stays; check reports it."""
    ini = write_config(tmp_path, with_lines(SCREEN, "DISPLAY", "GEOMETRY = XZ\n"))
    before = ini.read_bytes()
    put_in(ini, "polar")
    added = set(ini.read_text().splitlines()) - set(before.decode().splitlines())
    assert not any("GEOMETRY" in line for line in added)
    own = {"remap": {"polar_on": "g12.host"}, "remap_file": "g12/python/remap.py"}
    assert make_plan(config_of(ini, **own), ["polar"]).changes() == {}
    take_out(ini)
    assert ini.read_bytes() == before
