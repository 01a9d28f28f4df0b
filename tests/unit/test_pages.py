# SPDX-License-Identifier: GPL-2.0-or-later
"""The pages: every link leads somewhere, what they name is there, `install` copies them whole."""

import re
from pathlib import Path

import pytest

from g12.tools.commands import main as command_line
from g12.tools.install import package_copy
from support.sim_machines import ROOT

FOLDERS = ("ngc", "configs", "python", "tests")
PAGES = [ROOT / "README.md", *(page for name in FOLDERS for page in (ROOT / name).rglob("*.md"))]
FENCED = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
INDENTED = re.compile(r"(?:^ {4,}\S.*\n|^\n(?= {4,}\S))+", re.MULTILINE)
LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+ (.*)$", re.MULTILINE)
COMMAND = re.compile(r"python/g12 ((?:regress )?[a-z]+)\b(.*)")
NEEDED = re.compile(r"(?<=\s)(-[a-z-]+) [A-Z]")  # in a usage: what stands in no brackets
MAKE = re.compile(r"(?:^ {4}|`)make ([a-z-]+)\b", re.MULTILINE)
QUOTED = re.compile(r"`([^`\n]+)`")
IN_REPOSITORY = re.compile(rf"(?:{'|'.join(FOLDERS)})/[\w./-]+")


def name_of(page):
    return page.relative_to(ROOT).as_posix()


def prose(page):
    """Return a page's text without its code blocks."""
    return INDENTED.sub("", FENCED.sub("", page.read_text(encoding="utf-8")))


def anchors(page):
    """Return the anchors of a page's headings, as GitHub and other viewers name them."""
    titles = HEADING.findall(FENCED.sub("", page.read_text(encoding="utf-8")))
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


def links(page):
    """Return where the links of a page lead: file and anchor."""
    places = [place for place in LINK.findall(prose(page)) if "://" not in place]
    split = (place.partition("#") for place in places)
    return [((page.parent / file).resolve() if file else page, anchor) for file, _, anchor in split]


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_link_leads_somewhere(page):
    for file, anchor in links(page):
        assert file.is_file(), file
        assert not anchor or anchor in anchors(file), f"{file}#{anchor}"


def test_every_page_can_be_reached_from_the_first():
    reached, ahead = set(), [ROOT / "README.md"]
    while ahead:
        page = ahead.pop()
        reached.add(page)
        ahead += [file for file, _ in links(page) if file.suffix == ".md" and file not in reached]
    assert reached == set(PAGES)


def test_what_install_copies_needs_nothing_else_to_be_read():
    copied = set(package_copy.package_files())
    pages = [page for page in PAGES if name_of(page) in copied]
    assert {"ngc/haas.md", "ngc/polar.md", "configs/README.md"} <= {name_of(page) for page in pages}
    needed = {name_of(file) for page in pages for file, _ in links(page)}
    assert needed <= copied


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_page_with_a_command_says_how_it_is_called_where_it_is_installed(page):
    text = " ".join(page.read_text(encoding="utf-8").split())
    if "python3 python/g12" in text and page.parent != ROOT / "tests":
        assert re.search(r"Debian package.*`g12`", text)


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_command_that_a_page_shows_has_its_options_and_what_it_needs(page, capsys):
    text = page.read_text(encoding="utf-8")
    to_copy = COMMAND.findall("".join(INDENTED.findall(text)))
    for command, rest in dict.fromkeys(COMMAND.findall(text)):
        with pytest.raises(SystemExit) as ended:
            command_line.main([*command.split(), "--help"])
        assert ended.value.code == 0, command
        known = capsys.readouterr().out
        for option in re.findall(r"(?<!\S)--?[a-z][a-z-]*", rest.partition("#")[0]):
            assert option in known, f"{command} {option}"
        for option in NEEDED.findall(known.partition("\n\n")[0]):
            assert (command, rest) not in to_copy or f" {option} " in rest, f"{command} {option}"


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_file_and_make_target_that_a_page_names_exists(page):
    text = page.read_text(encoding="utf-8")
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for target in MAKE.findall(text):
        assert re.search(rf"^{target}:", makefile, re.MULTILINE), target
    for file in filter(IN_REPOSITORY.fullmatch, QUOTED.findall(prose(page))):
        assert "NAME" in file or (ROOT / file).exists(), file


def test_every_kind_of_finding_stands_on_the_page_about_what_is_wrong():
    rules = (ROOT / "python/g12/tools/install/rules.py").read_text(encoding="utf-8")
    kinds = set(re.findall(r'(?:problem|warning|note)\(\s*"([a-z-]+)"', rules))
    named = set(QUOTED.findall((ROOT / "configs" / "README.md").read_text(encoding="utf-8")))
    assert "no-sub" in kinds and kinds <= named


# The page of the developers.

INSIDE = ROOT / "python" / "g12" / "README.md"
DOTTED = re.compile(r"([a-z]\w*)\.([A-Za-z_]\w*)")


def test_every_function_that_the_page_names_exists():
    named = filter(None, map(DOTTED.fullmatch, QUOTED.findall(prose(INSIDE))))
    for file, name in (match.groups() for match in named):
        texts = [path.read_text(encoding="utf-8") for path in INSIDE.parent.rglob(f"{file}.py")]
        if texts and name != "py":
            there = re.compile(rf"^ *(?:def|class) {name}\b|^{name}\b.* = ", re.MULTILINE)
            assert any(map(there.search, texts)), f"{file}.{name}"


def test_the_rooms_page_names_what_is_there():
    page = INSIDE.read_text(encoding="utf-8")
    within = ("", "python/g12", "python/g12/host", "python/g12/tools", "python/g12/tools/verify")
    roots = [ROOT / folder for folder in within]
    named = re.findall(r"`((?:[a-z_]+/)+[a-z_0-9]*)(?:\.(\w+))?`", page)
    for path, name in named:
        if "NAME" in f"{path}{name}":
            continue
        places = [root / path for root in roots]
        files = [place.with_suffix(".py") for place in places if place.with_suffix(".py").is_file()]
        if files:
            assert name in ("", "py") or re.search(rf"\b{name}\b", files[0].read_text()), (
                path,
                name,
            )
        else:
            end = f".{name}" if name else ""
            assert any(Path(f"{place}{end}").exists() for place in places), (path, name)
