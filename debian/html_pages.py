# SPDX-License-Identifier: GPL-2.0-or-later
"""Write the pages as HTML, to be read in a browser without a network: html_pages.py FOLDER.

A link to another page leads to its HTML, any other to the file that the package installs.
"""

import re
import shutil
import sys
from pathlib import Path

import markdown

INSTALLED = "/usr/share/linuxcnc-g12"
UNREAD = ("build", "debian")
EXTENSIONS = ["tables", "fenced_code", "toc", "sane_lists"]
LINK = re.compile(r'(href|src)="(?!https?:|#|mailto:)([^"#]+)(#[^"]*)?"')
PAGE = """\
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>{title}</title>
<style>
body {{ max-width: 52em; margin: 2em auto; padding: 0 1em; font: 16px/1.5 sans-serif; }}
pre {{ background: #f4f4f2; padding: 0.7em; overflow-x: auto; }}
code {{ font-family: monospace; }}
table {{ border-collapse: collapse; margin: 1em 0; }}
td, th {{ border: 1px solid #bbb; padding: 0.25em 0.6em; text-align: left; vertical-align: top; }}
img {{ max-width: 100%; }}
</style>
</head>
<body>
<p><a href="{home}">{home_name}</a></p>
{body}
</body>
</html>
"""


def slug(heading: str, _separator: str) -> str:
    """Return the anchor of a heading, as the pages' links name it."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def pages(root: Path) -> list[Path]:
    found = (path.relative_to(root) for path in root.rglob("*.md"))
    return sorted(path for path in found if path.parts[0] not in UNREAD)


def html_of(root: Path, page: Path) -> str:
    text = (root / page).read_text(encoding="utf-8")
    settings = {"toc": {"slugify": slug}}
    body = markdown.markdown(text, extensions=EXTENSIONS, extension_configs=settings)
    folder = (root / page).parent
    body = LINK.sub(lambda link: in_html(root, folder, link), body)
    title = text.splitlines()[0].lstrip("# ")
    home = "../" * (len(page.parts) - 1) + "README.html"
    return PAGE.format(title=title, home=home, home_name="g12", body=body)


def in_html(root: Path, folder: Path, link: re.Match[str]) -> str:
    attribute, target, anchor = link.groups()
    file = (folder / target).resolve()
    name = file.relative_to(root.resolve())
    if file.suffix == ".md" and name.parts[0] not in UNREAD:
        target = target.removesuffix(".md") + ".html"
    elif attribute == "href":
        target = f"{INSTALLED}/{name}"
    return f'{attribute}="{target}{anchor or ""}"'


def write(root: Path, folder: Path) -> None:
    for page in pages(root):
        target = folder / page.with_suffix(".html")
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(html_of(root, page), encoding="utf-8")
    shutil.copytree(root / "ngc" / "pictures", folder / "ngc" / "pictures")


if __name__ == "__main__":
    write(Path(), Path(sys.argv[1]))
