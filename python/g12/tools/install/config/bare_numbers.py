# SPDX-License-Identifier: GPL-2.0-or-later
"""What a number without a decimal point is, asked with one of the user's own programs."""

import re
from collections.abc import Iterator
from pathlib import Path

from g12.tools.install.config.loaded import Config, folder_from_ini
from g12.tools.translate.blocks.control import Control
from g12.tools.translate.blocks.lexer import program_text, source_lines

REMARK = re.compile(r"\([^()]*\)|;.*")
BARE = re.compile(r"(?<![A-Z])([XYZUW])\s*(-?0*[1-9][0-9]*)(?![0-9.#\[])")
FILES_READ = 100  # of the folder are looked at
BYTES_READ = 1_000_000
SOME_NUMBER = ("X", "1500", "")


def question_of(control: Control, config: Config) -> Iterator[str]:
    """Yield the question by which `install` asks for ``--decimals``, if the control leaves it."""
    if control.decimals:
        return
    folder = config.ini.get("DISPLAY", "PROGRAM_PREFIX")
    found = _found(folder_from_ini(config.ini, folder), control) if folder else iter(())
    letter, digits, where = next(found, SOME_NUMBER)
    least = (float(control.value("increments", f"length_{unit}", 0.0)) for unit in ("mm", "inch"))
    number = int(digits)
    mm, inch = (number * increment for increment in least)
    yield (
        f"asked: {letter}{digits}{where} has no decimal point. With --decimals least it is "
        f"{mm:g} mm or {inch:g} in, with --decimals whole {number} mm or in. Install "
        f"programs-{control.name} with one of them: until then such programs are refused."
    )


def _found(folder: Path, control: Control) -> Iterator[tuple[str, str, str]]:
    """Yield numbers without a decimal point in a control's programs, with their places."""
    files = sorted(folder.iterdir())[:FILES_READ] if folder.is_dir() else []
    for file in (file for file in files if file.suffix[1:].lower() in control.extensions):
        if file.is_file() and file.stat().st_size < BYTES_READ:
            for line, row in enumerate(source_lines(program_text(file.read_bytes())), 1):
                if found := BARE.search(REMARK.sub("", row).upper()):
                    yield found[1], found[2], f" ({file.name}, line {line})"
