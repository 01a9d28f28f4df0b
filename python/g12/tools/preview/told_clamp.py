# SPDX-License-Identifier: GPL-2.0-or-later
"""An INI whose preview shows the codes of C's clamp, which make no canonical call.

The REMAP of such a code calls a sub of this module: a comment, then the machine's own sub.
"""

import re
from pathlib import Path

from g12.machine_ini import Remap, remap_lines
from g12.tools.machine.ini import Ini

CLAMP_COMMENT = "g12 clamp "  # for the worker
NGC = re.compile(r"\bngc=(\S+)")


def with_told_clamp(ini: Ini, folder: Path) -> Ini:
    """Return the INI; its further subs are in ``folder``."""
    settings, remaps = ini.settings, remap_lines(ini.all)
    codes = {f"M{code}" for code in (*settings.c_clamp, *settings.c_clamp_shapes)}
    if not any(remap.code in codes and "ngc" in remap.keywords for remap in remaps):
        return ini
    lines = [_told(each, folder) if each.code in codes else each.text for each in remaps]
    path = ":".join(filter(None, (str(folder), ini.get("RS274NGC", "SUBROUTINE_PATH"))))
    return ini.replaced({"RS274NGC": {"REMAP": lines, "SUBROUTINE_PATH": path}})


def _told(remap: Remap, folder: Path) -> str:
    own, name = remap.keywords.get("ngc"), f"g12_told_{remap.code.lower()}"
    if not own:
        return remap.text
    text = f"o<{name}> sub\n({CLAMP_COMMENT}{remap.code})\no<{own}> call\no<{name}> endsub\n"
    (folder / f"{name}.ngc").write_text(text, encoding="utf-8")
    return NGC.sub(f"ngc={name}", remap.text)
