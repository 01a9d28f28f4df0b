# SPDX-License-Identifier: GPL-2.0-or-later
"""The sample configs that LinuxCNC ships, as a user has them: copied, with their NGC files."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from g12.tools.install.config.findings import PROBLEM, ConfigFinding
from g12.tools.install.config.ini_edit import IniText
from g12.tools.install.config.loaded import load_config
from g12.tools.install.rules import findings_of

IN_PLACE = os.environ.get("EMC2_HOME")  # the folder of a LinuxCNC that runs in place
if IN_PLACE:
    SAMPLES, NC_FILES = Path(IN_PLACE, "configs"), Path(IN_PLACE, "nc_files")
else:
    SAMPLES = Path("/usr/share/doc/linuxcnc/examples/sample-configs")
    NC_FILES = Path("/usr/share/linuxcnc/ncfiles")


def copy_samples(base: Path, part: str = ".") -> Path:
    """Copy the samples, or a part of them, into a folder; return where they are there."""
    samples = base / "sample-configs"
    shutil.copytree(SAMPLES / part, samples / part, symlinks=True)
    for folder in (base, samples):
        if not (folder / "nc_files").exists():
            (folder / "nc_files").unlink(missing_ok=True)
            (folder / "nc_files").symlink_to(NC_FILES)
    return samples / part


def problems_of(ini: Path) -> list[ConfigFinding]:
    """Return the problems of a config as `check` finds them."""
    found = findings_of(load_config(IniText(ini)))
    return [finding for finding in found if finding.level == PROBLEM]


def tree(folder: Path) -> dict[Path, tuple[str | bytes, int]]:
    """Return every file and link below a folder, with content or target, and mode."""
    paths = [path for path in sorted(folder.rglob("*")) if path.is_symlink() or path.is_file()]
    return {
        path: (os.readlink(path) if path.is_symlink() else path.read_bytes(), path.lstat().st_mode)
        for path in paths
    }
