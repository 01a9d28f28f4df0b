# SPDX-License-Identifier: GPL-2.0-or-later
"""A lathe whose C has a clamp: M10 closes it, M12 half, M11 opens it."""

from g12.tools.machine.ini import read_ini
from support.sim_machines import SIM

BLOCKS = {"m10": "M64 P0", "m11": "M65 P0\nM65 P1", "m12": "M64 P1"}  # its outputs


def with_clamp(name, folder, **settings):
    """Return the overrides for a machine; each sub shows a message of its name."""
    for code, block in BLOCKS.items():
        text = f"o<{code}> sub\n(MSG,{code})\n{block}\no<{code}> endsub\n"
        (folder / f"{code}.ngc").write_text(text)
    ini = read_ini(SIM / f"{name}.ini")
    own = [f"{code.upper()} modalgroup=10 ngc={code}" for code in BLOCKS]
    return {
        "G12": {"C_CLAMP": "M10 m11", **settings},
        "RS274NGC": {
            "REMAP": [*ini.all("RS274NGC", "REMAP"), *own],
            "SUBROUTINE_PATH": f"{ini.get('RS274NGC', 'SUBROUTINE_PATH')}:{folder}",
        },
    }
