# SPDX-License-Identifier: GPL-2.0-or-later
"""Which codes begin and end a section: the user's choice."""

from g12.machine_ini import remap_from_value
from g12.section.effects import codes_of_section

PAIR = ("G12.1 modalgroup=1 python=polar_on", "G13.1 modalgroup=1 python=polar_off")
OTHER = ("G12.3 modalgroup=1 py=polar_on", "G13.3 modalgroup=1 py=polar_off")


def codes(code, *lines):
    return codes_of_section(
        code, [remap_from_value(line) for line in lines], "polar_on", "polar_off"
    )


def test_every_code_of_the_handler_ends_a_section_and_the_partner_is_named():
    found = codes("G12.3", *PAIR, *OTHER)
    assert (found.on, found.off, found.off_code) == ({121, 123}, {131, 133}, "G13.3")


def test_without_any_off_code_it_is_one_more():
    found = codes("G12.1", PAIR[0])
    assert (found.off, found.off_code) == ({131}, "G13.1")


def test_m_codes_to_subs_and_to_python():
    found = codes("G12.1", *PAIR, "M33 modalgroup=10 n=m33", "M400 modalgroup=10 python=mine")
    assert found.remapped == {33: True, 400: False}
