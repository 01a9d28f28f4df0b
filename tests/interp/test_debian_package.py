# SPDX-License-Identifier: GPL-2.0-or-later
"""What `make deb` places: the demo's programs and machines are among it, and load."""

import argparse
import importlib
import os
import re
import subprocess
import sys

import pytest

from g12.tools.commands.main import COMMANDS
from g12.tools.demo import SAMPLES
from support.sim_machines import ROOT


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    """Place the folder that becomes /usr/share/linuxcnc-g12."""
    folder = tmp_path_factory.mktemp("placed")
    places = [str(folder / "package"), str(folder / "samples")]
    paths = f"python:debian:{os.environ.get('PYTHONPATH', '')}"
    place = [sys.executable, "debian/place.py", *places]
    subprocess.run(place, cwd=ROOT, env={**os.environ, "PYTHONPATH": paths}, check=True)
    return folder / "package"


def placed(package, sample):
    """Return the program and the machine of a sample in the package."""
    return [package / path.relative_to(ROOT) for path in (sample.path, sample.ini)]


def test_every_program_of_the_demo_and_its_machine_is_there(package):
    files = [file for sample in SAMPLES for file in placed(package, sample)]
    assert len(files) > 20
    assert [file for file in files if not file.is_file()] == []


@pytest.mark.parametrize("name", ["circle_mill/sample.ngc", "polar/hexagon.ngc"])
def test_a_machine_of_the_demo_loads_from_there(package, name):
    sample = next(sample for sample in SAMPLES if sample.program == name)
    program, ini = placed(package, sample)
    command = [sys.executable, package / "python" / "g12", "trace", program, "--ini", ini]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.count("\n") > 20


LINK = re.compile(r'(?:href|src)="(?!https?:)([^"#]*)(?:#([^"]*))?"')


def targets_of(page, package):
    """Yield each link of a page as it is written, its file and its anchor."""
    for target, anchor in LINK.findall(page.read_text(encoding="utf-8")):
        installed = target.removeprefix("/usr/share/linuxcnc-g12/")
        file = page if not target else (page.parent / target).resolve()
        yield target, file if installed == target else package / installed, anchor


def test_every_link_of_the_pages_in_html_leads_somewhere(package, monkeypatch, tmp_path):
    monkeypatch.syspath_prepend(str(ROOT / "debian"))
    importlib.import_module("html_pages").write(ROOT, tmp_path)
    links = [
        (page.name, target, file, anchor)
        for page in tmp_path.rglob("*.html")
        for target, file, anchor in targets_of(page, package)
    ]
    assert len(links) > 100
    assert [link for link in links if not link[2].exists()] == []
    assert [
        link for link in links if link[3] and f'id="{link[3]}"' not in link[2].read_text()
    ] == []


def texts_of(parser):
    """Yield the help of a parser and of all below it."""
    yield parser.format_help()
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for below in action.choices.values():
                yield from texts_of(below)


def test_the_manual_page_names_the_command_as_it_is_typed_there(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "debian"))
    texts = list(texts_of(importlib.import_module("command_line").parser()))
    assert len(texts) > len(COMMANDS)
    assert [text for text in texts if "python3 python/g12" in text] == []
    assert "g12 regress check [-h]" in " ".join(texts)
