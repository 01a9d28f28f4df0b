# SPDX-License-Identifier: GPL-2.0-or-later
"""Write ngcgui's file of every form, in mm and inch: python3 .ci/forms.py."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))

from g12.tools.forms.ngcgui import CODES, file_name, form_text  # noqa: E402
from g12.tools.forms.table import FORMS  # noqa: E402


def files() -> dict[str, str]:
    """Return the text of every file, by its name."""
    return {file_name(form, unit): form_text(form, unit) for form in FORMS for unit in CODES}


if __name__ == "__main__":
    for name, text in files().items():
        (ROOT / "ngc" / name).write_text(text)
