# SPDX-License-Identifier: GPL-2.0-or-later
"""The table of forms: what an operator fills in for each cycle, shape and kind of holes.

ngcgui's files (`ngcgui`, one for each unit) and the Cycles page (`tools/cycles_page`) are made from
it. A form is a sub whose parameters are the entries in their order; its body is NGC text. The
defaults suit a cutter of 6 mm or 1/4 inch.
"""

from itertools import combinations
from typing import NamedTuple

LENGTH, FEED, ANGLE, COUNT, RATIO, CHOICE, TOOL, SPEED, SECONDS = (
    *("length", "feed", "angle", "count", "ratio", "choice", "tool", "speed", "seconds"),
)
MILL, FACE, ROUND = "from above", "on the face", "on the unrolled surface"  # how a form is seen
HANDLERS = {  # of each feature with forms: one that the REMAP lines of a machine with it name
    "haas": "g12_haas",
    "yasnac": "g12_yasnac",
    "mitsubishi": "g12_mitsubishi",
    "circle-mill": "circle_mill_pocket",
    "bore": "g12_bore",
    "thread": "g12_thread",
    "frame": "g12_frame",
    "polar-shapes": "polar_shape",
}
UNITS = {  # of an entry's kind, by a form's unit
    "mm": {LENGTH: "mm", FEED: "mm/min", ANGLE: "°", SPEED: "1/min", SECONDS: "s"},
    "inch": {LENGTH: "in", FEED: "in/min", ANGLE: "°", SPEED: "1/min", SECONDS: "s"},
}


class Entry(NamedTuple):
    """One entry of a form."""

    name: str  # of the sub's local
    words: str  # beside the entry in ngcgui, at most 18 letters
    label: str  # beside the entry on the page
    kind: str  # LENGTH to SECONDS
    mm: float  # the default, lengths in mm
    inch: float | None = None  # the default of an inch form, where it is another
    choices: tuple[tuple[float, str], ...] = ()  # of CHOICE: value and words
    zero: str = ""  # what 0 leaves out; empty where 0 is a value like another
    omitted: bool = False  # 0 becomes -9999 in the call
    of_tool: float = 0.0  # the page proposes this share of the tool's diameter
    needs: str = ""  # an entry that must not be 0 for this one to matter

    def caption(self, unit: str) -> str:
        """Return what stands beside the entry on the page: label and unit."""
        return ", ".join(filter(None, (self.label, UNITS[unit].get(self.kind))))

    def default(self, unit: str) -> float:
        """Return the default of a form of ``unit``, mm or inch."""
        return self.mm if unit == "mm" or self.inch is None else self.inch


class Form(NamedTuple):
    """One form."""

    name: str  # of its files: form_NAME_mm.ngc
    feature: str  # of `install`, which has its codes
    title: str  # on the page
    info: str  # above ngcgui's entries; {lengths} is the unit
    page: str  # which says what its entries mean
    place: str  # MILL, FACE or ROUND: decides its start, its end, its machine and its view
    entries: tuple[Entry, ...]
    body: str = ""  # of a mill's form: from the start's call to the end's
    sub: str = ""  # which is called with the entries
    heights: tuple[str, str] = ("retract", "top")  # of a mill's form: where it ends, begins to cut


# ---------------------------------------------------------------- entries


def length(name: str, words: str, mm: float, inch: float, label: str = "",
           zero: str = "") -> Entry:  # fmt: skip
    return Entry(name, words, label or words, LENGTH, mm, inch, zero=zero)


def feed(mm: float, inch: float, name: str = "feed", words: str = "F feed, {feed}",
         label: str = "feed") -> Entry:  # fmt: skip
    return Entry(name, words, label, FEED, mm, inch)


def count(name: str, words: str, value: float, label: str = "") -> Entry:
    return Entry(name, words, label or words, COUNT, value)


def angle(words: str, name: str = "angle") -> Entry:
    return Entry(name, words, words, ANGLE, 0)


def choice(name: str, words: str, label: str, *choices: tuple[float, str]) -> Entry:
    """Return a choice whose first is the default."""
    return Entry(name, words, label, CHOICE, choices[0][0], choices=choices)


def code(words: str, clockwise: float) -> Entry:
    """Return the choice of a cycle's direction: G12 or G13 and their like."""
    ways = (clockwise + 1, "counterclockwise"), (clockwise, "clockwise")
    return choice("code", words, "direction", *((at, f"G{at:g}, {way}") for at, way in ways))


def left_out(name: str, words: str, label: str, kind: str, zero: str, mm: float = 0,
             inch: float | None = None) -> Entry:  # fmt: skip
    """Return an entry whose 0 leaves it out of the call."""
    return Entry(name, words, label, kind, mm, inch, zero=zero, omitted=True)


def loaded(words: str) -> Entry:
    return Entry("tool", words, "tool", TOOL, 0, zero="the loaded tool")


def speed(words: str, label: str, value: float) -> Entry:
    return Entry("speed", words, label, SPEED, value)


COOLANT = choice(
    "coolant", "M 7, 8 on, 9 off", "coolant", (9, "off"), (7, "mist, M7"), (8, "flood, M8")
)
CENTRE = length("x", "X centre", 0, 0, "centre X"), length("y", "Y centre", 0, 0, "centre Y")


def mill(turns: float = 3000) -> tuple[Entry, ...]:
    """Return the entries that a mill's cycle begins with."""
    return (
        loaded("T, D, 0: loaded"),
        speed("S spindle, 1/min", "spindle speed", turns),
        COOLANT,
        feed(400, 20),
        *CENTRE,
        length("retract", "Z retract height", 10, 0.5, "retract height"),
    )


def depth(mm: float, inch: float) -> Entry:
    return length("z", "Z depth", mm, inch, "depth, Z")


# ---------------------------------------------------------------- cycles of a mill


def block(words: str, *optional: str) -> str:
    """Return a block with those of its optional words whose first one's entry is not 0."""
    lines: list[str] = []
    for number in range(len(optional), -1, -1):
        for chosen in combinations(optional, number):
            needed = " AND ".join(f"#<{word[0].lower()}>" for word in chosen)
            begin = f"{'elseif' if lines else 'if'} [{needed}]" if needed else "else"
            lines += [f"o<words> {begin}", " ".join([f"  {words}", *chosen])]
    return "\n".join([*lines, "o<words> endif", ""])


CIRCLE_FORMS = (
    Form(
        "haas", "haas", "Circular pocket, Haas",
        "Circular pocket, G12/G13 as on Haas. Lengths are {lengths}, radii are those of the pocket",
        "haas", MILL,
        (
            *mill(),
            length("top", "Z top", 0, 0, "top of the part"),
            depth(-4, -0.25),
            count("levels", "L levels", 2, "levels"),
            code("G 12 or 13", 12),
            length("i", "I first radius", 8, 0.3, "first radius I")._replace(of_tool=0.8),
            length("k", "K radius, 0: none", 30, 1.2, "finished radius K", "one circle"),
            length("q", "Q ring to ring", 4, 0.15, "stepover Q")._replace(of_tool=0.7, needs="k"),
        ),
        """\
o<no_levels> if [#<levels> LT 1 OR #<levels> NE FIX[#<levels>]]
  (ABORT,form: L must be a whole number from 1, not #<levels>)
o<no_levels> endif
START
G1 Z#<top> F#<feed>
#<level> = [[#<z> - #<top>] / #<levels>]
""" + block("G91 G#<code> I#<i> Z#<level> L#<levels> D#<tool>", "K#<k> Q#<q>"),
    ),
    Form(
        "yasnac", "yasnac", "Circle, Yasnac",
        "Circle cutting, G12/G13 as on Yasnac. Lengths are {lengths}, radii are those of the"
        " circle",
        "yasnac", MILL,
        (
            *mill(2000),
            length("top", "Z rapid to", 2, 0.1, "rapid down to"),
            depth(-10, -0.4),
            code("G 12 or 13", 12),
            length("i", "I radius, signed", 50, 2, "radius I, its sign the side"),
            length("r", "R rapid, 0: none", 0, 0, "bored radius R", "no rapid: into the full"),
            length("k", "K first, 0: none", 12, 0.6, "first radius K", "no spiral"),
            length("q", "Q growth per turn", 4, 0.15, "growth a turn Q")._replace(needs="k"),
            count("circles", "L circles", 1, "finished circles"),
        ),
        """\
START
G0 Z#<top>
G1 Z#<z> F#<feed>
""" + block("G#<code> I#<i> L#<circles> D#<tool>", "R#<r>", "K#<k> Q#<q>"),
    ),
    Form(
        "mitsubishi", "mitsubishi", "Circle, Mitsubishi",
        "Circular cutting, G12/G13 as on Mitsubishi. Lengths are {lengths}, the radius is that of"
        " the circle",
        "mitsubishi", MILL,
        (
            *mill(2000),
            length("top", "Z rapid to", 2, 0.1, "rapid down to"),
            depth(-5, -0.2),
            code("G 12 or 13", 12),
            length("i", "I radius", 50, 2, "radius I"),
        ),
        """\
START
G0 Z#<top>
G1 Z#<z> F#<feed>
G#<code> I#<i> D#<tool>
""",
    ),
    Form(
        "circle_mill", "circle-mill", "Circle mill event",
        "Circle mill event, pocket or perimeter. Lengths are {lengths}, 0 leaves an entry in [ ]"
        " out",
        "circle_mill", MILL,
        (
            loaded("T tool, 0: loaded"), *mill()[1:3],
            choice("event", "G 7 pocket, 0 wall", "cut", (7, "pocket"), (0, "along the circle")),
            *CENTRE,
            depth(-6, -0.25),
            length("w", "W start height", 2, 0.1, "start height W"),
            length("o", "O retract height", 10, 0.5, "retract height O"),
            length("r", "R radius", 40, 1.5, "radius R"),
            choice("d", "D sense, 0 to 3", "direction, rough / finish", (0, "CW / CW"),
                   (1, "CCW / CCW"), (2, "CW / CCW"), (3, "CCW / CW")),
            choice("c", "C side, 0 to 2", "tool", (2, "right of it"), (1, "left of it"),
                   (0, "on the circle")),
            left_out("k", "[K] plunge depth", "depth per plunge K", LENGTH, "at once", 3, 0.12),
            left_out("j", "[J] pass width", "roughing width J", LENGTH, "the tool less 0.25 mm"),
            left_out("l", "[L] finish", "finish L", LENGTH, "no finish", 0.3, 0.01),
            left_out("p", "[P] plunge feed", "plunge feed P", FEED, "the feed", 150, 6),
            feed(600, 25, "f", "F rough feed"),
            left_out("v", "[V] finish feed", "finish feed V", FEED, "the feed"),
        ),
        sub="circle_mill", heights=("o", "w"),
    ),
)  # fmt: skip

HOLE_FORMS = (
    Form(
        "bore", "bore", "Bore along a helix",
        "Bore along a helix, G12.5/G13.5. Lengths are {lengths}, radii are those of the hole",
        "bore", MILL,
        (
            *mill(),
            length("top", "Z top, R", 0, 0, "top of the hole R"),
            depth(-8, -0.3),
            code("G 12.5 or 13.5", 12.5),
            length("i", "I radius", 5, 0.2, "radius I")._replace(of_tool=0.8),
            length("p", "P down per turn", 0.3, 0.01, "descent a turn P")._replace(of_tool=0.03),
            length("k", "K open, 0: none", 0, 0, "open radius K", "cut into the full"),
            length("q", "Q step, 0: one", 0, 0, "stepover Q", "one helix"),
            count("circles", "L spring circles", 0, "spring circles L"),
        ),
        "START\nF#<feed>\n"
        + block("G#<code> Z#<z> R#<top> I#<i> P#<p> K#<k> L#<circles> D#<tool>", "Q#<q>"),
    ),
    Form(
        "thread", "thread", "Thread milling",
        "Thread milling, G12.6/G13.6. Lengths are {lengths}, radii are those of the thread",
        "thread", MILL,
        (
            *mill(),
            length("top", "Z top, R", 0, 0, "top of the thread R"),
            length("z", "Z end", -10, -0.4, "end of the thread Z"),
            code("G 12.6 or 13.6", 12.6),
            choice("side", "H 0 in, 1 outside", "side", (0, "inside"), (1, "outside")),
            length("i", "I larger radius", 5, 0.1875, "larger radius I"),
            length("k", "K small, 0: ISO", 0, 0, "smaller radius K", "that of ISO, 60°"),
            length("pitch", "P pitch, < 0 left", 1.5, 0.0625, "pitch P, below 0 left-hand"),
            length("q", "Q infeed, 0: one", 0, 0, "infeed a pass Q", "one pass"),
            count("teeth", "J teeth", 1, "teeth of the cutter J"),
            Entry("taper", "E taper", "taper E", RATIO, 0),
        ),
        "START\nF#<feed>\n"
        + block(
            "G#<code> Z#<z> R#<top> I#<i> P#<pitch> H#<side> J#<teeth> E#<taper> D#<tool>",
            "K#<k>", "Q#<q>",
        ),
    ),
    Form(
        "frame", "frame", "Frame, pocket or wall",
        "Frame, G12.7/G13.7. Lengths are {lengths}, those of the finished rectangle",
        "frame", MILL,
        (
            *mill(),
            length("top", "Z top", 0, 0, "top of the part"),
            depth(-4, -0.2),
            code("G 12.7 or 13.7", 12.7),
            choice("side", "H 0 to 2", "cut", (0, "pocket"), (1, "along its inside"),
                   (2, "along its outside")),
            length("i", "I along X", 40, 1.5, "length along X, I"),
            length("j", "J along Y", 30, 1, "length along Y, J"),
            length("r", "R corner radius", 5, 0.2, "corner radius R")._replace(of_tool=0.8),
            length("k", "K level, 0: one", 2, 0.1, "depth per level K", "at once"),
            length("q", "Q stepover", 2, 0.1, "stepover Q")._replace(of_tool=0.4),
            length("e", "E finish", 0.2, 0.01, "finish allowance E", "none"),
            feed(150, 6, "p", "P plunge feed", "plunge feed P"),
        ),
        """\
START
G1 Z#<top> F#<feed>
#<q> = [#<q> * [#<side> EQ 0]]
""" + block(
            "G#<code> Z#<z> I#<i> J#<j> R#<r> E#<e> P#<p> H#<side> D#<tool>", "K#<k>", "Q#<q>"
        ),
    ),
)  # fmt: skip

# ---------------------------------------------------------------- shapes and holes on a lathe

LIVE = count("spindle", "spindle $, 1 live", 0, "spindle of the tool")
PASSES = (
    left_out("per_pass", "[depth] per pass", "depth per pass", LENGTH, "at once"),
    length("allowance", "finish allowance", 0, 0, zero="no finish round"),
    feed(400, 15),
    left_out("plunge_feed", "[plunge feed]", "plunge feed", FEED, "the feed"),
)
SHAPE_INFO = "Lengths are {lengths}, 0 leaves an entry in [ ] out"


def on_a_face(turns: float = 3000, retract: str = "Z retract height",
              label: str = "retract height") -> tuple[Entry, ...]:  # fmt: skip
    """Return the entries that a form on a lathe begins with."""
    return (
        loaded("T tool, 0: loaded"),
        speed("S tool, 1/min", "tool speed", turns),
        count("on", "M tool on", 3, "M code, tool on"),
        count("off", "M tool off", 5, "M code, tool off"),
        COOLANT,
        length("retract", retract, 5, 0.2, label),
    )


ROUND_IT = (
    angle("first angle", "first_angle"),
    left_out("step", "[angle to next]", "angle to the next", ANGLE, "all round"),
)
DRILLING = (
    length("depth", "depth", 8, 0.3),
    length("height", "retract height", 2, 0.1, "clear height"),
    feed(120, 5, words="F, tap: the pitch", label="feed; tap: pitch"),
    length("peck", "peck, < 0: chips", 0, 0, "peck; below 0 breaks chips", "no peck"),
    Entry("dwell", "dwell, s", "dwell", SECONDS, 0),
    choice("kind", "kind, 0 drills", "kind", (0, "drill"), (1, "tap, right"), (2, "tap, left"),
           (3, "bore")),
    LIVE,
)  # fmt: skip
FACE_FORMS = (
    Form(
        "polygon", "polar-shapes", "Polygon on a bar's end",
        f"Polygon or two flats on a bar's end. {SHAPE_INFO}", "polar_shapes", FACE,
        (
            *on_a_face(),
            count("sides", "sides, 2: flats", 6, "sides (2: flats)"),
            length("across_flats", "across flats", 27, 1),
            length("depth", "depth", 5, 0.2),
            length("stock_diameter", "stock diameter", 40, 1.5),
            length("corner_radius", "corner radius", 0, 0, zero="sharp"),
            *PASSES, angle("angle of a flat"), LIVE,
        ),
        sub="polar_polygon",
    ),
    Form(
        "slot", "polar-shapes", "Slot on a bar's end",
        f"Slot about the centre of a bar's end. {SHAPE_INFO}", "polar_shapes", FACE,
        (
            *on_a_face(),
            length("width", "width", 8, 0.3125)._replace(of_tool=1.3),
            length("length", "length over all", 30, 1.2),
            length("depth", "depth", 4, 0.15),
            *PASSES, angle("angle of the slot"), LIVE,
        ),
        sub="polar_slot",
    ),
    Form(
        "face_pocket", "polar-shapes", "Round pocket on a bar's end",
        f"Round pocket on a bar's end. {SHAPE_INFO}", "polar_shapes", FACE,
        (
            *on_a_face(),
            length("x", "X centre, diam.", 0, 0, "centre X, a diameter"),
            length("c", "C centre, length", 0, 0, "centre C, a length"),
            length("diameter", "pocket diameter", 20, 0.75, "diameter"),
            length("depth", "depth", 4, 0.15),
            *PASSES, LIVE,
        ),
        sub="polar_pocket",
    ),
    Form(
        "face_holes", "polar-shapes", "Holes on a bar's end",
        f"Holes on a circle on a bar's end. {SHAPE_INFO}", "holes", FACE,
        (
            *on_a_face(2000),
            count("count", "number of holes", 6),
            length("circle_diameter", "circle diameter", 30, 1.2),
            *ROUND_IT, *DRILLING,
        ),
        sub="face_holes",
    ),
    Form(
        "side_holes", "polar-shapes", "Holes round a bar",
        f"Holes round a bar. {SHAPE_INFO}", "holes", ROUND,
        (
            *on_a_face(2000, "Z in front of bar", "Z in front of the bar"),
            length("clear", "X clear, diameter", 60, 2.4, "X clear, a diameter"),
            count("count", "number of holes", 4),
            length("z", "Z of the holes", -10, -0.4),
            *ROUND_IT,
            length("surface_diameter", "surface diameter", 40, 1.6),
            *DRILLING,
        ),
        sub="side_holes",
    ),
)  # fmt: skip

FORMS = (*CIRCLE_FORMS, *HOLE_FORMS, *FACE_FORMS)
