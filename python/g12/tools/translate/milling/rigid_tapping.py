# SPDX-License-Identifier: GPL-2.0-or-later
"""M29 and G84 or G74 after it: rigid tapping as G33.1, which follows the spindle.

LinuxCNC's own G84 is for a floating holder: it does not. For each hole:

1. rapid to X and Y, rapid to R
2. G33.1 to Z and back to R, K the pitch: F over S, or F itself per revolution
3. under G98 rapid to where Z stood when the cycle began
"""

from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.modal import MOVES, UNKNOWN, UNSURE
from g12.tools.translate.blocks.positions import value_text

SPINDLE_OF_TAP = {"G84": "M3", "G74": "M4"}


def rigid_tap(draft: Draft) -> None:
    code = draft.meanings.pop("rigid tapping", None)
    if code:
        speed = draft.word("S")
        if not speed:
            raise NotTranslated(f"{code.code} needs S, the speed of the tap")
        draft.comments.append(code.code)
        draft.change(tap_speed=speed.value)
    elif "cancel cycle" in draft.meanings or (draft.state.cycle and MOVES & set(draft.codes())):
        draft.change(tap_speed=UNKNOWN, tap_top=UNKNOWN)
    if draft.state.tap_speed:
        _tap(draft)


def _tap(draft: Draft) -> None:
    code = draft.meanings.get("drilling cycle")
    name = code.code if code else draft.state.cycle
    if name not in SPINDLE_OF_TAP:
        return
    speed = draft.sure("tap_speed", f"{name} may be rigid")
    if draft.state.distance != "G90" or draft.letters() & {"L", "K"}:
        raise NotTranslated(f"rigid tapping by {name} is translated under G90, hole by hole")
    values = {**dict(draft.state.cycle_words or ()), **{w.letter: w.value for w in draft.words}}
    if not {"Z", "R"} <= values.keys():
        raise NotTranslated(f"rigid tapping by {name} needs Z and R")
    if code:
        draft.meanings.pop("drilling cycle")
        draft.before.append(f"{SPINDLE_OF_TAP[name]} S{speed}")
        draft.change(tap_top=draft.start.at_z, cycle=name)
    if code or draft.letters() & set("XYZR"):
        _write_hole(draft, values, _pitch_by_speed(draft, speed))
    draft.change(cycle_words=(("R", values["R"]), ("Z", values["Z"])))


def _pitch_by_speed(draft: Draft, speed: str) -> str:
    feed = draft.sure("feed", "the pitch of a tap depends on F")
    if feed == UNKNOWN:
        raise NotTranslated("a tap needs F")
    return feed if draft.state.feed_mode == "G95" else f"[{feed} / {speed}]"


def _write_hole(draft: Draft, values: dict[str, str], pitch: str) -> None:
    position = [word.text for word in draft.words if word.letter in "XY"]
    draft.comment_out("P", ": no dwell in a rigid tap")
    draft.take_codes(MOVES)
    draft.words = [word for word in draft.words if word.letter not in "XYZR"]
    lines = [" ".join(["G0", *position])] if position else []
    lines += [f"G0 Z{values['R']}", f"G33.1 Z{values['Z']} K{pitch}"]
    if draft.state.retract != "G99":
        top = draft.state.tap_top
        if not isinstance(top, float):
            raise NotTranslated("a tap under G98 needs Z as a number before its cycle: G0 Z…")
        lines.append(f"G0 Z{value_text(top)}")
    draft.write(lines)
    draft.change(own_motion=UNSURE, at_z=None)
