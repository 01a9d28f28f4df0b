# SPDX-License-Identifier: GPL-2.0-or-later
"""Polar and cylindrical interpolation: G112, G137 as G12.1 and G13.1, G107, G132 as G7.1.

X in polar mode is a diameter on most controls and a radius on some: where it is not as outside, G7
or G8 is written before the section, and the other after it. Y is C and V is H. The control's file
defines a rapid in polar mode.

A cylinder's code has its radius as C or H.
"""

from g12.tools.translate.blocks.draft import Draft, word_of
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ALL_PLANES, ForeignWord
from g12.tools.translate.blocks.modal import (
    AS_PROGRAMMED,
    CONSUMERS,
    MOTIONS,
    MOVES,
    REFERENCES,
    UNKNOWN,
    UNSURE,
)
from g12.tools.translate.blocks.positions import (
    IN_POLAR,
    STAYING,
    axis_of,
    is_unmoved,
    known_position,
)
from g12.tools.translate.rules.decimals import UNIT

IN_PLANE = frozenset("XCUH")
SECTION_NAMES = {
    "on": "in polar mode",
    "cylinder": "on a cylinder",
    "off": "to where a section begins",
    UNSURE: "in polar mode",
}
MODES_OF_X = {"diameter": "G7", "radius": "G8"}
X_OF = {"G7": 2.0, "G8": 1.0}  # the word of a point whose radius is 1


def plane_letters(draft: Draft) -> None:
    """Drop what a plane code has beside it to name its axes: ``G17 XC``, ``G17 U0 H0``."""
    if not ALL_PLANES.intersection(draft.codes()):
        return
    named = [word for word in draft.words if word.kind == "bare"]
    if not named and not draft.letters() - set("NGUVWH"):
        named = [w for w in draft.words if w.letter in "UVWH" and w.is_zero]
    draft.drop(named)
    draft.comments += [" ".join(word.text for word in named)] if named else []


def turn_on(draft: Draft, code: ForeignWord) -> None:
    """Write G12.1; X a radius if it is one on the control."""
    x = draft.control.value("polar", "x", "")
    if x in ("", "say"):
        raise NotTranslated(
            f'{code.code}: is X a diameter or a radius in it? say x = "diameter" or "radius" under '
            "[polar] of your control (--polar-x)"
        )
    if draft.control.is_lathe and "C" in draft.letters() and draft.words[-1].is_zero:
        draft.take("C")
    outside, inside = _x_modes(draft)
    lines = [*own_feed_ended(draft), *([inside] if inside != outside else [])]
    own_block(draft, code.code, [*lines, draft.control.polar_codes[0]])
    draft.change(polar="on", own_motion=UNSURE, at_c=0.0)
    _keep_slides(draft, X_OF[inside] / X_OF[outside])


def _x_modes(draft: Draft) -> tuple[str, str]:
    outside = draft.sure("x_words", "polar mode") or "G8"
    return outside, MODES_OF_X.get(draft.control.value("polar", "x"), outside)


def turn_off(draft: Draft, code: ForeignWord) -> None:
    """Write G13.1, which means nothing outside of polar mode."""
    outside, inside = _x_modes(draft)
    is_on = draft.state.polar != "off"
    back = [outside] if is_on and outside != inside else []
    own_block(draft, code.code, [draft.control.polar_codes[1], *back])
    if is_on and draft.state.delayed:
        raise NotTranslated(
            f"G40 is after the last move of the section: write a move in X or C with it "
            f"before {code.code}"
        )
    if is_on:
        draft.change(polar="off", own_motion=UNSURE)
        _keep_slides(draft, X_OF[outside] / X_OF[inside])


def _keep_slides(draft: Draft, scale: float) -> None:
    """Keep the positions of X and Z over the switch; ``scale`` multiplies X."""
    x, z = known_position(draft.start, "X"), known_position(draft.start, "Z")
    draft.change(at_x=None if x is None else x * scale, at_z=z)


def own_block(draft: Draft, code: str, lines: list[str]) -> None:
    """Write lines after the block's other words, which must move nothing."""
    if draft.axis_words() or draft.letters() & set("UVWHIJKR"):
        raise NotTranslated(f"{code} moves nothing: its block has {draft.words[-1].text}")
    draft.write(lines)


def inside_polar(draft: Draft) -> None:
    if draft.letters() & set("XYCUVH"):
        draft.sure("polar", "polar mode or a cylinder is on")
    if draft.state.polar == "off":
        return
    is_polar = draft.state.polar == "on"
    if is_polar:
        draft.words = [w._replace(letter=IN_POLAR.get(w.letter, w.letter)) for w in draft.words]
    for letter in "CH":
        if sum(word.letter == letter for word in draft.words) > 1:
            raise NotTranslated(f"{letter} and its other name in one block")
    _offset_number(draft)
    if is_polar:
        if draft.letters() & IN_PLANE and is_unmoved(draft, "Z"):
            draft.comment_out("Z")
        _delay_compensation(draft)
    rapid(draft)


def _delay_compensation(draft: Draft) -> None:
    """Write G40, G41 and G42 with a move in the plane: their own or the next one."""
    own = [code for code in draft.codes() if code in ("G40", "G41", "G42")]
    code = own[0] if own else draft.state.delayed
    if not code:
        return
    if code == UNSURE:
        draft.sure("delayed", "G40 or G41 is before it")
    axes = {axis_of(word.letter) for word in draft.words if word.letter in IN_PLANE}
    is_arc = bool(draft.letters() & set("IJKR"))
    if axes and (is_arc or not all(is_unmoved(draft, axis) for axis in axes)):
        if code not in own:
            draft.put_first(code)
        draft.change(delayed=UNKNOWN)
        return
    needless = code == "G40" == draft.start.compensation and not draft.state.delayed
    draft.take_codes({code})
    draft.words = [word for word in draft.words if word.letter not in IN_PLANE]
    draft.comments += [f"{code}{'' if needless else ' with the next move'}"] if own else []
    draft.change(delayed=UNKNOWN if needless else code)


def _offset_number(draft: Draft) -> None:
    """Drop a D that names the loaded tool: G41 and G42 take its radius."""
    word = draft.take("D")
    if word and word.value.lstrip("0") not in (draft.state.length, draft.state.tool):
        raise NotTranslated(
            f"{word.text} {SECTION_NAMES[draft.state.polar]}: G41 and G42 take the loaded tool's "
            "radius"
        )


def rapid(draft: Draft) -> None:
    rule = draft.control.value("polar", "rapid", "refuse")
    if rule == "keep" or not _is_rapid(draft):
        return
    if rule == "refuse":
        sentence = f"G0 {SECTION_NAMES[draft.state.polar]}: write G1 with a high feed"
        if "G0" not in draft.codes():
            raise NotTranslated(f"{sentence}, or G1 if this is a cut: no G1 is before it")
        raise NotTranslated(f'{sentence}, or say rapid = "feed" in [polar]')
    feed = feed_of_rapids(draft)
    draft.take_codes({"G0"})
    draft.take("F")  # of later blocks
    draft.words += map(word_of, ("G1", "G94", f"F{feed:g}"))
    draft.change(motion="G0", own_motion="G1", own_feed="other")
    draft.has_motion = draft.has_feed = True


def _is_rapid(draft: Draft) -> bool:
    codes = MOVES.intersection(draft.codes())
    moves = draft.letters() & set("XYZCUWH")
    return "G0" in codes or (bool(moves) and not codes and draft.state.motion == "G0")


def feed_of_rapids(draft: Draft) -> float:
    where = SECTION_NAMES[draft.state.polar]
    unit = UNIT.get(draft.state.units)
    if not unit:
        raise NotTranslated(f"G0 {where}: its speed needs the units: say G20 or G21 (--units)")
    key = f"rapid_feed_{unit}"
    feed = draft.control.value("polar", key, 0)
    if not feed:
        raise NotTranslated(f"G0 {where} needs its speed: say {key} under [polar]")
    return feed


def feed_again(draft: Draft) -> None:
    """Write the feed that holds on the control where LinuxCNC has a polar rapid's."""
    needless = draft.has_feed or draft.state.own_feed == AS_PROGRAMMED
    moves = draft.axis_words() or draft.increments() or draft.word("F")
    if needless or not moves or _goes_by_rapid(draft):
        return
    own = {*draft.codes(), *(word.text for word in draft.words if word.letter == "F")}
    draft.words += [word_of(text) for text in _programs_feed(draft) if text not in own]
    draft.change(own_feed=AS_PROGRAMMED)


def _goes_by_rapid(draft: Draft) -> bool:
    """Whether a block needs no feed: that of the next cut may not be the same on every way.

    A drilling cycle cuts, and a block that repeats one, also where G0 is the mode.
    """
    if "F" in draft.letters():
        return False
    codes = set(draft.codes())
    if set(draft.meanings) - STAYING:
        return False
    if draft.state.cycle or codes & (MOTIONS | CONSUMERS):
        return not codes.isdisjoint(REFERENCES | {"G0"})
    return _is_rapid(draft)


def own_feed_ended(draft: Draft) -> list[str]:
    """Return the line that gives LinuxCNC the control's feed, if it has another."""
    if draft.state.own_feed == AS_PROGRAMMED:
        return []
    draft.change(own_feed=AS_PROGRAMMED)
    return [" ".join(_programs_feed(draft))]


def _programs_feed(draft: Draft) -> list[str]:
    why = "LinuxCNC has another feed before this block"
    feed, mode = draft.sure("feed", why), draft.sure("feed_mode", why)
    if feed == UNKNOWN:
        raise NotTranslated(f"{why}: write F")
    return [f"F{feed}", *([mode] if mode else [])]


def switch_cylinder(draft: Draft, code: ForeignWord) -> None:
    size = draft.take("C") or draft.take("H")
    if not size:
        raise NotTranslated(f"{code.code} needs C, the radius of the cylinder, or C0")
    radius = "" if size.is_zero else size.value
    name, word = draft.control.cylinder_code
    value = f"[2 * {radius}]" if radius and word == "diameter" else radius or "0"
    feed = own_feed_ended(draft) if radius else []
    own_block(draft, code.code, [*feed, f"{name} C{value}"])
    draft.change(polar="cylinder" if radius else "off", own_motion=UNSURE)
