# SPDX-License-Identifier: GPL-2.0-or-later
"""Place the package and the simulated machines: place.py PACKAGE SAMPLES.

LinuxCNC's configuration selector copies the folder of the machine that is picked.  So the samples'
folder is whole: it has its own copy of the package, which stays when the Debian package goes.
"""

import re
import shutil
import sys
from pathlib import Path

from g12.tools.install.package_copy import package_files

SIM = Path("configs/sim")
UNPICKED = re.compile(r"_headless|_kinematics")  # without a screen; with something to compile
MOVED = (
    ("../../tests/programs", "samples"),
    ("../../", "g12/"),
    ("../include", "g12/configs/include"),
)


def place(folder: Path) -> None:
    """Copy the package's files, of which `install` makes its own copies."""
    for name, content in package_files().items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content)
    (folder / "LICENSE").unlink()
    (folder / "LICENSE").symlink_to("/usr/share/common-licenses/GPL-2")


def place_samples(folder: Path) -> None:
    """Copy the simulated machines, with the package in their folder."""
    place(folder / "g12")
    for path in sorted(SIM.rglob("*")):
        name = path.relative_to(SIM)
        if path.is_dir() or UNPICKED.search(str(name)):
            continue
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        text = path.read_text(encoding="utf-8")
        if path.suffix == ".ini":
            for old, new in MOVED:
                text = text.replace(old, new)
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "README").write_text(readme(sorted(folder.glob("*.ini"))), encoding="utf-8")


def readme(machines: list[Path]) -> str:
    """Return what the configuration selector shows beside a machine: what each one is."""
    texts = []
    for ini in machines:
        first = ini.read_text(encoding="utf-8").splitlines()[0]
        texts.append(f"{ini.stem}\n  {first.removeprefix('# ')}\n")
    return "Circular pockets and polar interpolation, simulated.\n\n" + "\n".join(texts)


if __name__ == "__main__":
    package, samples = map(Path, sys.argv[1:])
    place(package)
    shutil.copy("README.md", package / "README.md")
    unread = shutil.ignore_patterns("foreign", "regress")  # the demo reads the others
    shutil.copytree("tests/programs", package / "tests" / "programs", ignore=unread)
    shutil.copytree(SIM, package / SIM)
    place_samples(samples)
