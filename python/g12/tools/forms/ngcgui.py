# SPDX-License-Identifier: GPL-2.0-or-later
"""The files of ngcgui and the calls of the forms, from the table."""

from g12.tools.forms.table import MILL, Form

LICENCE = "(SPDX-License-Identifier: GPL-2.0-or-later)\n"
LENGTHS = {"mm": "mm", "inch": "inches"}
FEEDS = {"mm": "mm", "inch": "in"}
CODES = {"mm": 21, "inch": 20}
DIAMETERS = "  #<diameters> = #<_lathe_diameter_mode>\n"


def file_name(form: Form, unit: str) -> str:
    return f"form_{form.name}_{unit}.ngc"


def shown(value: float) -> str:
    """Return a default as the file has it."""
    return f"{value:g}"


def form_text(form: Form, unit: str) -> str:
    """Return the file of a form of ``unit``, mm or inch."""
    name = file_name(form, unit).removesuffix(".ngc")
    on_mill = form.place == MILL
    restored = f"G{CODES[unit]} and restores the units" if on_mill else ""
    restored = restored or f"G{CODES[unit]} G7 and restores the modes"
    entries = "".join(
        f"  #<{entry.name}> = #{number} (={shown(entry.default(unit))}"
        f" {entry.words.format(unit=FEEDS[unit])})\n"
        for number, entry in enumerate(form.entries, 1)
    )
    return (
        f"{LICENCE}(info: {form.info.format(lengths=LENGTHS[unit])})\n"
        f"(Form of {form.source}. Sets {restored}.)\n"
        f"o<{name}> sub\n{entries}  #<imperial> = #<_imperial>\n"
        f"{'' if on_mill else DIAMETERS}{_indented(_body(form, unit))}o<{name}> endsub\n"
    )


def _body(form: Form, unit: str) -> str:
    """Return the lines after the entries."""
    omitted = "".join(
        f"#<{name}> = [#<{name}> - 9999 * [#<{name}> EQ 0]]\n" for name in form.omitted
    )
    if form.place == MILL:
        start = f"tool speed coolant {form.start}"
        begin, end = "form_start", f"o<form_end> call [#<{form.end}>] [#<imperial>]\n"
    else:
        start = "tool speed on coolant retract spindle"
        begin = "form_face_start"
        end = "o<form_face_end> call [#<off>] [#<imperial>] [#<diameters>] [#<spindle>]\n"
    text = form.body.replace("START\n", f"o<{begin}> call [{CODES[unit]}] {_arguments(start)}\n")
    text = text.replace("OMITTED\n", omitted)
    return text.replace("ENTRIES", _arguments(form.call)) + end


def _arguments(names: str) -> str:
    return " ".join(f"[#<{name}>]" for name in names.split())


def _indented(text: str) -> str:
    return "".join(f"  {line}\n" for line in text.splitlines())
