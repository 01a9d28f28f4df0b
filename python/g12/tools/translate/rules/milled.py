# SPDX-License-Identifier: GPL-2.0-or-later
"""A mill's program on a face or round a part: every cut lies in a section, each hole in none.

Where it goes is a surface, with its words, sections and holes. Points are in the mill's own axes.

1. Rapids in X and Y outside a section wait: the machine goes there when something is cut.
2. The first block at a feed begins the section: the axes go to its start at the safe height, then
   the section's code.
3. A call and a loop begin one before them, or what they cut would lie in one only sometimes.
4. A tool, an offset, G28, a drilling cycle, the end, a return: the section ends before it.
5. A drilling cycle is a call of the lathe's holes, each a hole, or a cycle of the mill's for each.
   The tool goes back to where it stood before each, as after G98: G99 costs a little time.

On the face of a bar X and Y become those of G12.1, and Z is along the spindle. Round a part one
axis is a length along it, the other one an angle in G07.1, and Z is the height above the axis: the
program's Z0 is the surface. Seen from the tool the drawing keeps its hands.

| machine | along the part | round it | out of it |
|---|---|---|---|
| lathe with C | X is Z | Y is C, the other way round | Z is X, a diameter |
| mill with A | X | Y is A, the other way round | Z |
| mill with B | Y | X is B | Z |
"""

import re
from collections.abc import Mapping
from math import degrees, fmod
from typing import NamedTuple

from g12.lengths import DEGREES_PER_TURN
from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.blocks.modal import MOVES, REFERENCES, UNKNOWN, UNSURE, ModalState
from g12.tools.translate.blocks.positions import SHIFTING, known_position, value_text
from g12.tools.translate.rules.codes import MACHINES_OWN
from g12.tools.translate.rules.decimals import UNIT
from g12.tools.translate.rules.polar import feed_of_rapids

OTHER_PLANES = frozenset(("G18", "G19"))
NEEDLESS = frozenset(("G17", "G98", "G99"))  # in a section G98 and G99 are feed modes
OTHER_FEEDS = {"G93": "inverse time", "G95": "a feed per revolution"}
ENDING = MACHINES_OWN | SHIFTING
ARC = frozenset("IJR")
DRILLED = frozenset(("G73", "G81", "G82", "G83"))


# ---------------------------------------------------------------- surfaces

SIGNED_NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)")
LEAST_RADIUS = {"G20": 0.2, "G21": 5.0}  # a section begins off the spindle's axis


class DrilledHole(NamedTuple):
    """A hole: where it is in the mill's X and Y, and the entries of its call, all as text."""

    x: str
    y: str
    depth: str
    retract: str
    feed: str
    peck: str
    dwell: str


class Winding(NamedTuple):
    """The machine's axes that run a flat program round a part."""

    wound: str  # the mill's axis that becomes an angle
    sense: float  # of that angle
    slides: Mapping[str, str]  # the machine's for X and Y, where there is one
    out: str  # the axis away from the part
    scale: int  # of its words: 2 for diameters
    arms: Mapping[str, tuple[str, float, float]] = {}  # of arcs, as `RoundPart.change` takes them


WINDINGS = {  # by the rotary axis
    "A": Winding("Y", -1.0, {"X": "X", "Y": "Y"}, "Z", 1),
    "B": Winding("X", 1.0, {"X": "X", "Y": "Y"}, "Z", 1),
    "C": Winding("Y", -1.0, {"X": "Z"}, "X", 2, {"I": ("K", 1.0, 0.0), "J": ("J", -1.0, 0.0)}),
}


def is_plain_number(value: str) -> bool:
    return bool(SIGNED_NUMBER.fullmatch(value))


def times(value: str, factor: float, plus: float = 0.0) -> str:
    """Return a value multiplied, and something added, with six decimals or as an expression."""
    if is_plain_number(value):
        text = f"{float(value) * factor + plus:.6f}".rstrip("0")
        return "0." if text == "-0." else text
    added = f" + {plus:g}" if plus else ""
    return f"[{value}] * {factor:.10g}{added}"


def _word(letter: str, value: str) -> ForeignWord:
    if is_plain_number(value):
        return ForeignWord(letter, value)
    return ForeignWord(letter, f"[{value}]", "expression")


class FaceOfBar:
    """The face of a bar: in a section Y is C, so that its words stay."""

    section = "on"  # the state's name for a section
    y_in = "C"  # the axis whose position is followed for Y in it
    away = "Z"  # the axis along which the tool leaves the part of a lathe, "" on a mill

    def __init__(self, draft: Draft) -> None:
        self.draft, self.control = draft, draft.control

    def words(self) -> None:
        """Rewrite the words of a block."""

    def home(self) -> None:
        """Rewrite the words of a block that goes to a machine position."""
        self.draft.comment_out("Y", ": no Y here")

    def begin(self, x: str, y: str, feed: float) -> list[str]:
        """Return the lines that begin a section at a point."""
        least = LEAST_RADIUS[self.draft.state.units]
        start = f"[2 * SQRT[[{x}] ** 2 + [{y}] ** 2 + {least:g} ** 2]]"
        if is_plain_number(x) and is_plain_number(y):
            start = f"{2 * max(abs(complex(float(x), float(y))), least):.4f}"
        on = self.control.polar_codes[0]
        return [f"G0 X{start} C0", "G8", on, f"G1 X{x} C{y} G94 F{feed:g}"]

    def end(self) -> list[str]:
        return [self.control.polar_codes[1], "G7"]

    def hole(self, cycle: str, hole: DrilledHole) -> list[str]:
        entries = (times(hole.x, 2), *hole[1:])
        return [f"o<face_hole_at> call {' '.join(f'[{entry}]' for entry in entries)} [0]"]


class RoundPart(FaceOfBar):
    """A part that turns: in a lathe about C, on a mill about A or B."""

    section = "cylinder"
    y_in = "Y"

    def __init__(self, draft: Draft) -> None:
        super().__init__(draft)
        turn = self.control.value("mill", "turn", "")
        self.turn, self.winding = turn or "C", WINDINGS[turn or "C"]
        self.away = "" if turn else self.winding.out

    @property
    def diameter(self) -> float:
        value = self.control.value("mill", "diameter", 0.0)
        if not value:
            raise NotTranslated(
                "the diameter of the part is not known: say --diameter, or diameter = … under "
                "[mill]"
            )
        return value

    @property
    def degrees_per_length(self) -> float:
        sense = self.winding.sense * self.control.value("mill", "sense", 1.0)
        return sense * degrees(2 / self.diameter)

    def height(self) -> tuple[str, float, float]:
        """Return what becomes of Z; where it is no increment, the part's radius is added."""
        added = self.diameter / 2 if self.draft.state.distance == "G90" else 0.0
        return self.winding.out, self.winding.scale, self.winding.scale * added

    def change(self, changes: Mapping[str, tuple[str, float, float]]) -> None:
        """Rewrite words: for each letter the new one, a factor, something to add."""
        for at, word in enumerate(self.draft.words):
            if word.letter in changes:
                letter, factor, added = changes[word.letter]
                self.draft.words[at] = _word(letter, times(word.value, factor, added))

    def words(self) -> None:
        wound, slides = self.winding.wound, self.winding.slides
        changes = {a: (slide, 1.0, 0.0) for a, slide in slides.items() if a != slide}
        changes[wound] = (self.turn, self.degrees_per_length, 0.0)
        self.change({**changes, "Z": self.height(), **self.winding.arms})

    def home(self) -> None:
        """Leave G53 of a mill alone: its words are the machine's own."""
        if not self.away:
            self.change({} if "G53" in self.draft.codes() else {"Z": self.height()})
            return
        self.words()
        if self.draft.take(self.turn):
            self.draft.comments.append("Y: no such slide here")

    def _angle(self, x: str, y: str) -> str:
        return times(x if self.winding.wound == "X" else y, self.degrees_per_length)

    def _slides(self, x: str, y: str) -> str:
        """Return the words that lead the slides above a point: one that is wound goes to 0."""
        values = {"X": x, "Y": y, self.winding.wound: "0"}
        return " ".join(f"{slide}{values[axis]}" for axis, slide in self.winding.slides.items())

    def begin(self, x: str, y: str, feed: float) -> list[str]:
        code, word = self.control.cylinder_code
        size = self.diameter if word == "diameter" else self.diameter / 2
        angle = _word(self.turn, self._angle(x, y)).text
        return [f"G0 {self._slides(x, y)} {angle}", f"{code} {self.turn}{size:g}"]

    def end(self) -> list[str]:
        return [f"{self.control.cylinder_code[0]} {self.turn}0"]

    def hole(self, cycle: str, hole: DrilledHole) -> list[str]:
        angle = self._angle(hole.x, hole.y)
        return self._side_hole(hole, angle) if self.away else self._cycle(cycle, hole, angle)

    def _side_hole(self, hole: DrilledHole, angle: str) -> list[str]:
        if is_plain_number(angle):
            angle = times(str(fmod(float(angle), DEGREES_PER_TURN)), 1.0)
        entries = ("1", hole.x, angle, "-9999", f"{self.diameter:g}", *hole[2:], "0")
        return [f"o<side_holes> call {' '.join(f'[{entry}]' for entry in entries)}"]

    def _cycle(self, cycle: str, hole: DrilledHole, angle: str) -> list[str]:
        there, radius = self._slides(hole.x, hole.y), self.diameter / 2
        bottom, retract = times(hole.depth, -1, radius), times(hole.retract, 1, radius)
        peck = times(hole.peck, -1 if cycle == "G73" else 1)  # below 0 for chips alone
        more = {"G82": f" P{hole.dwell}", "G73": f" Q{peck}", "G83": f" Q{peck}"}.get(cycle, "")
        heights = f"{_word('Z', bottom).text} {_word('R', retract).text}"
        return [
            f"G0 {there} {_word(self.turn, angle).text}",
            f"G98 {cycle} {there} {heights}{more} F{hole.feed}",
            "G80",
        ]


def surface_of(draft: Draft) -> FaceOfBar:
    return FaceOfBar(draft) if draft.control.onto == "face" else RoundPart(draft)


# ---------------------------------------------------------------- sections


def mill_block(draft: Draft) -> None:
    if not draft.control.onto:
        return
    draft.sure("polar", "a section has begun on one way to this block, and not on another")
    _refuse_foreign(draft)
    if "cancel cycle" in draft.meanings:
        draft.comments.append(draft.meanings.pop("cancel cycle").code)
        draft.change(cycle=UNKNOWN, cycle_words=())
    if draft.state.polar != "off" and _ends_here(draft):
        _end_section(draft)
    _go_home(draft)
    if _drills(draft):
        return
    has_words = bool(draft.letters() & {"X", "Y", "Z", *ARC})
    if has_words and not draft.call and MACHINES_OWN.isdisjoint(draft.codes()):
        _write_move(draft)
    elif draft.call:
        before_loop(draft)
    if draft.state.polar != "off":
        surface_of(draft).words()
    elif draft.state.compensation in ("G41", "G42"):
        code = draft.state.compensation
        raise NotTranslated(f"{code} before the first cut: write it with the contour's first G1")


def before_loop(draft: Draft) -> None:
    """Begin a section before a loop or a call, so that each round of it lies in one."""
    if draft.control.onto and draft.state.polar == "off" and draft.state.waiting:
        _begin_section(draft)


def _refuse_foreign(draft: Draft) -> None:
    """Refuse what a program of X, Y and Z in G17 does not have."""
    codes = set(draft.codes())
    for word in draft.words:
        if word.letter in "ABC" and not draft.call:
            raise NotTranslated(f"{word.text}: a program for {draft.control.name} has X, Y and Z")
    for code in sorted(codes & OTHER_PLANES):
        raise NotTranslated(f"{code}: arcs lie in X and Y here (G17): no vertical leads in CAM")
    for code in codes & OTHER_FEEDS.keys():
        raise NotTranslated(f"{code}, {OTHER_FEEDS[code]}: write G94 and F per minute")
    draft.comments += draft.take_codes(NEEDLESS)


def _drills(draft: Draft) -> bool:
    if "drilling cycle" in draft.meanings:
        return True
    moves = not (MOVES | REFERENCES).isdisjoint(draft.codes())
    return bool(draft.state.cycle) and not moves and bool(draft.letters() & set("XYZR"))


def _ends_here(draft: Draft) -> bool:
    returns = draft.returns and draft.state.section == draft.program[0][0]  # its first block
    changes = (
        "T" in draft.letters()
        or "M6" in draft.m_codes()
        or not ENDING.isdisjoint(draft.codes())
        or draft.start.units != draft.state.units
    )
    return changes or draft.ends or returns or _drills(draft)


def _write_move(draft: Draft) -> None:
    across = bool(draft.letters() & {"X", "Y"})
    if not _moves_by_rapid(draft):
        if draft.state.polar == "off":
            _begin_section(draft)
    elif draft.state.polar != "off":
        _check_rapid(draft, across)
    else:
        _rapid_outside(draft, across)


def _rapid_outside(draft: Draft, across: bool) -> None:
    """Store X and Y of a rapid for the next cut, write Z."""
    if draft.word("Z") or _start_height(draft) is not None:
        _check_rapid(draft, across and _start_height(draft) is not None)
    if across and draft.state.distance != "G90":
        raise NotTranslated("a rapid in X or Y under G91 before the first cut: write it under G90")
    waiting = _waiting_point(draft) | {w.letter: w.value for w in draft.words if w.letter in "XY"}
    for letter in "XY":
        draft.comment_out(letter, " with the next cut")
    draft.change(waiting=tuple(sorted(waiting.items())))
    if draft.control.onto != "face":
        surface_of(draft).words()


def _begin_section(draft: Draft) -> None:
    if _ends_here(draft):
        raise NotTranslated(
            "a cut begins here beside a tool, an offset or units: write them in a block before it"
        )
    height, safe = _start_height(draft), _safe_height(draft)
    if height is None or height < safe:
        where = "not known" if height is None else f"{height:g}"
        raise NotTranslated(
            f"a cut begins here with the tool at Z {where}: G0 Z at or above {safe:g} before it, "
            "with X and Y"
        )
    why = "a cut begins here, and the position of {} is not known: G0 X Y before it"
    x, y = (_point_value(draft, axis, draft.start, why.format(axis)) for axis in "XY")
    first, *lines = surface_of(draft).begin(x, y, feed_of_rapids(draft))
    absolute = draft.start.distance == "G90"
    draft.before += [first, *lines] if absolute else [f"G90 {first}", *lines, "G91"]
    draft.change(
        polar=surface_of(draft).section,
        section=draft.program[0][0],
        waiting=(),
        own_motion="G1",
        own_feed="other",
        at_c=known_position(draft.state, "Y"),
    )


def _end_section(draft: Draft) -> None:
    if draft.start.compensation != "G40" or draft.state.delayed:
        raise NotTranslated("G41 or G42 is on where the section ends: G40 with a move before it")
    draft.before += surface_of(draft).end()
    own = _drills(draft) and "Y" in draft.letters()  # of the hole, which no section is for
    y = known_position(draft.state, "Y" if own else surface_of(draft).y_in)
    draft.change(polar="off", section=UNKNOWN, own_motion=UNSURE, at_y=y, at_c=None)


def _go_home(draft: Draft) -> None:
    """Write G28, G30 and G53 in a lathe's axes: the mill's machine zero has no meaning there."""
    codes, surface = MACHINES_OWN.intersection(draft.codes()), surface_of(draft)
    if not codes:
        return
    if codes == {"G53"} and surface.away:
        _machine_zero(draft, surface.away)
    else:
        surface.home()
        if surface.away and not draft.axis_words():
            draft.comments += draft.take_codes(codes)  # without an axis G28 moves each of them
    draft.change(waiting=())


def _machine_zero(draft: Draft, away: str) -> None:
    """Write G53 as G28 away from the part if it has Z, as a comment if not."""
    motions = draft.take_codes({"G0", "G1"})
    goes_home = "Z" in draft.letters()
    draft.comments += draft.take_codes({"G53"})
    for word in [word for word in draft.words if word.letter in "XYZ"]:
        draft.comment_out(word.letter)
    if goes_home:
        absolute = [] if draft.state.distance == "G91" else ["G90"]
        draft.after += [f"G91 G28 {away}0", *absolute]
    if motions:
        draft.change(motion=motions[0], own_motion=UNSURE)


# ---------------------------------------------------------------- heights and points


def _safe_height(draft: Draft) -> float:
    """Return the Z from which on a rapid is clear of the part, in the program's units."""
    safe = draft.control.value("mill", "safe", None)
    if safe is not None:
        return safe
    units = draft.sure("units", "how high a rapid must be depends on the units")
    if units not in UNIT:
        raise NotTranslated(
            "how high a rapid must be depends on the units: say G20 or G21 (--units)"
        )
    return draft.control.value("mill", f"safe_{UNIT[units]}")


def _waiting_point(draft: Draft) -> dict[str, str]:
    """Return the values of X and Y to which rapids lead that are not written yet."""
    return dict(draft.sure("waiting", "where X and Y go depends on the way to this block"))


def _point_value(draft: Draft, axis: str, state: ModalState, why: str) -> str:
    waiting = _waiting_point(draft).get(axis)
    position = known_position(state, axis)
    if waiting is None and position is None:
        raise NotTranslated(why)
    return waiting or value_text(position)


def _start_height(draft: Draft) -> float | None:
    return known_position(draft.start, "Z")


def _moves_by_rapid(draft: Draft) -> bool:
    codes = MOVES.intersection(draft.codes())
    motion = min(codes) if codes else draft.sure("motion", "X, Y or Z without G0 or G1")
    if motion == UNKNOWN:
        raise NotTranslated("X, Y or Z without G0 or G1, and none before them")
    return motion == "G0"


def _check_rapid(draft: Draft, across: bool) -> None:
    """Refuse a rapid below the safe height; ``across``: it moves in X or Y. Up is allowed."""
    safe, start = _safe_height(draft), _start_height(draft)
    end = known_position(draft.state, "Z") if draft.word("Z") else start
    if end is None or (across and start is None):
        raise NotTranslated(
            "G0, and the position of Z is not known here: write Z as a number first"
        )
    lowest = end if start is None or not across else min(start, end)
    if lowest < safe and (across or start is None or end < start):
        raise NotTranslated(
            f"G0 at Z{lowest:g}, below {safe:g} where rapids are clear of the part: write G1 "
            "and F, or say --safe"
        )


# ---------------------------------------------------------------- holes


def whole_cycle(draft: Draft) -> None:
    """Have the cycle written with all of its words in each block."""
    if draft.control.onto and ("drilling cycle" in draft.meanings or draft.state.cycle):
        if draft.state.distance != "G90":
            raise NotTranslated("a drilling cycle under G91: write its holes under G90")
        draft.change(own_motion=UNSURE)


def hole_call(draft: Draft) -> None:
    cycle = draft.state.cycle
    if not draft.control.onto or cycle not in draft.codes():
        return
    if cycle not in DRILLED:
        raise NotTranslated(f"{cycle}: G73 and G81 to G83 are translated here")
    words = {letter: draft.take(letter) for letter in "XYZRQPF"}
    given = {letter: word.value for letter, word in words.items() if word}
    if "L" in draft.letters():
        raise NotTranslated(f"{cycle} with L: write each hole with its X and Y")
    draft.take_codes({cycle, "G90", "G94"})
    hole = _hole_of_cycle(draft, cycle, given)
    after, draft.after = draft.after, []
    draft.write([*surface_of(draft).hole(cycle, hole), *after])
    draft.change(waiting=(), own_motion=UNSURE, own_feed="other", at_z=_start_height(draft))


def _hole_of_cycle(draft: Draft, cycle: str, given: dict[str, str]) -> DrilledHole:
    feed = draft.sure("feed", f"{cycle} needs F")
    retract, depth = given["R"], given["Z"]
    if not feed:
        raise NotTranslated(f"{cycle} needs F")
    if is_plain_number(depth) and float(depth) >= 0:
        raise NotTranslated(f"{cycle} Z{depth}: the hole must end below Z0, the part's surface")
    if is_plain_number(retract) and float(retract) <= 0:
        retract = f"{_safe_height(draft):g}"
    peck = {"G83": given.get("Q", "0"), "G73": times(given.get("Q", "0"), -1)}.get(cycle, "0")
    dwell = given.get("P", "0") if cycle == "G82" else "0"
    why = "where the hole is along {} is not known: write X and Y"
    x, y = (
        given.get(axis) or _point_value(draft, axis, draft.state, why.format(axis)) for axis in "XY"
    )
    return DrilledHole(x, y, times(depth, -1), retract, feed, peck, dwell)
