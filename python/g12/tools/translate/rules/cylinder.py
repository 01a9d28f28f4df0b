# SPDX-License-Identifier: GPL-2.0-or-later
"""Cylindrical interpolation: G107 and G132 as G7.1.

Most controls give the cylinder's radius as C (or H) and angles as C. Haas maps an axis of lengths
onto the cylinder instead, ``G107 Y0 C0 R25.``: Y is then the length along its surface.
"""

from math import degrees

from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.blocks.modal import UNKNOWN, UNSURE
from g12.tools.translate.rules.polar import own_block, own_feed_ended

ANGLE_LETTERS = {"Y": "C", "V": "H"}


def switch_cylinder(draft: Draft, code: ForeignWord) -> None:
    if draft.control.value("cylinder", "word") == "mapped":
        radius = _mapped_radius(draft, code.code)
        draft.change(mapped=radius)
    else:
        radius = _named_radius(draft, code.code)
    name, word = draft.control.cylinder_code
    value = f"[2 * {radius}]" if radius and word == "diameter" else radius or "0"
    feed = own_feed_ended(draft) if radius else []
    own_block(draft, code.code, [*feed, f"{name} C{value}"])
    draft.change(polar="cylinder" if radius else "off", own_motion=UNSURE)


def _named_radius(draft: Draft, code: str) -> str:
    """Return the radius that C or H says, "" for the end of the cylinder."""
    word = draft.take("C") or draft.take("H")
    if not word:
        raise NotTranslated(f"{code} needs C, the radius of the cylinder, or C0")
    if word.is_zero:
        return ""
    return word.value


def _mapped_radius(draft: Draft, code: str) -> str:
    """Return the radius of a cylinder that Y is mapped onto, "" for its end, the code alone."""
    sizes, axes = draft.take_each("RQ"), draft.take_each("YC")
    if not sizes and not axes:
        return ""
    if len(sizes) != 1 or len(axes) != 2 or not all(word.is_zero for word in axes):
        raise NotTranslated(f"{code} needs Y0, C0 and R or Q, radius or diameter; alone it ends")
    (size,) = sizes
    return size.value if size.letter == "R" else f"[{size.value} / 2]"


def on_the_surface(draft: Draft) -> None:
    """Write lengths along the surface of a mapped cylinder as angles."""
    if draft.state.polar != "cylinder" or draft.state.mapped == UNKNOWN:
        return
    radius = draft.sure("mapped", "Y is mapped onto a cylinder")
    if draft.letters() & {"C", "H"}:
        raise NotTranslated("C while Y is mapped onto the cylinder: write the point as Y")
    for at, word in enumerate(draft.words):
        if word.letter in ANGLE_LETTERS:
            angle = f"[[{word.value}] * {degrees(1):.12f} / {radius}]"
            draft.words[at] = ForeignWord(ANGLE_LETTERS[word.letter], angle, "expression")
