# SPDX-License-Identifier: GPL-2.0-or-later
"""The table of forms: what an operator fills in for each cycle, shape and kind of holes.

ngcgui's files (`ngcgui`, one for each unit) and the Cycles page (`tools/cycles_page`) are made from
it. A form is a sub whose parameters are the entries in their order; its body is NGC text.
"""

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
    source: str  # of the entries' meaning, a page or a sub
    place: str  # MILL, FACE or ROUND: decides its start, its end, its machine and its view
    entries: tuple[Entry, ...]
    start: str  # arguments of the start after its common ones, names of entries
    body: str  # from the start's call to the end's
    end: str  # the height that a mill's form ends at
    call: str = ""  # the entries of the body's call, ENTRIES

    @property
    def omitted(self) -> tuple[str, ...]:
        return tuple(entry.name for entry in self.entries if entry.omitted)


COOLANT = Entry(
    "coolant", "M 7, 8 on, 9 off", "coolant", CHOICE, 9,
    choices=((9, "off"), (7, "mist, M7"), (8, "flood, M8")),
)  # fmt: skip
CODE = Entry(
    "code", "G 12 or 13", "direction", CHOICE, 13,
    choices=((13, "G13, counterclockwise"), (12, "G12, clockwise")),
)  # fmt: skip


def tool(number: float, inch: float | None = None, words: str = "T tool") -> Entry:
    return Entry("tool", words, "tool", TOOL, number, inch)


def length(name: str, words: str, label: str, mm: float, inch: float, zero: str = "") -> Entry:
    return Entry(name, words, label, LENGTH, mm, inch, zero=zero)


def left_out(name: str, words: str, label: str, kind: str, zero: str, mm: float = 0,
             inch: float | None = None) -> Entry:  # fmt: skip
    """Return an entry whose 0 leaves it out of the call."""
    return Entry(name, words, label, kind, mm, inch, zero=zero, omitted=True)


def speed(words: str, label: str, value: float) -> Entry:
    return Entry("speed", words, label, SPEED, value)


def feed(mm: float, inch: float, name: str = "feed", words: str = "F feed, {unit}/min",
         label: str = "feed") -> Entry:  # fmt: skip
    return Entry(name, words, label, FEED, mm, inch)


CENTRE = (
    length("x", "X centre", "centre X", 0, 0),
    length("y", "Y centre", "centre Y", 0, 0),
)
SPINDLE = speed("S spindle, 1/min", "spindle speed", 3000)


def mill(number: float, inch: float, turns: float = 3000) -> tuple[Entry, ...]:
    """Return the entries that a mill's cycle begins with."""
    return (
        tool(number, inch, "T, D tool"),
        speed(SPINDLE.words, SPINDLE.label, turns),
        COOLANT,
        feed(400, 20),
        *CENTRE,
        length("retract", "Z retract height", "retract height", 10, 0.5),
    )


def levels(name: str, words: str, label: str, value: float) -> Entry:
    return Entry(name, words, label, COUNT, value)


NO_CODE = """\
o<no_code> if [#<code> NE 12 AND #<code> NE 13]
  (ABORT,form: G must be 12 or 13, not #<code>)
o<no_code> endif
"""


def whole(name: str, letter: str) -> str:
    """Return the check of a whole number from 1."""
    return f"""\
o<no_{name}> if [#<{name}> LT 1 OR #<{name}> NE FIX[#<{name}>]]
  (ABORT,form: {letter} must be a whole number from 1, not #<{name}>)
o<no_{name}> endif
"""


CIRCLE_FORMS = (
    Form(
        "haas", "haas", "Circular pocket, Haas",
        "Circular pocket, G12/G13 as on Haas. Lengths are {lengths}, radii are those of the pocket",
        "one pocket; the words of ngc/haas.md", MILL,
        (
            *mill(5, 2),
            length("top", "Z top", "top of the part", 0, 0),
            length("z", "Z depth", "depth, Z", -4, -0.25),
            levels("levels", "L levels", "levels", 2),
            CODE,
            length("i", "I first radius", "first radius I", 10, 0.4)._replace(of_tool=0.8),
            length("k", "K radius, 0: none", "finished radius K", 30, 1.2, "one circle"),
            length("q", "Q ring to ring", "stepover Q", 8, 0.35)._replace(of_tool=0.7, needs="k"),
        ),
        "x y retract top z",
        NO_CODE + whole("levels", "L") + """\
START
G1 Z#<top> F#<feed>
o<clearing> if [#<k>]
  G91 G#<code> I#<i> K#<k> Q#<q> Z[[#<z> - #<top>] / #<levels>] L#<levels> D#<tool>
o<clearing> else
  G91 G#<code> I#<i> Z[[#<z> - #<top>] / #<levels>] L#<levels> D#<tool>
o<clearing> endif
""", "retract",
    ),
    Form(
        "yasnac", "yasnac", "Circle, Yasnac",
        "Circle cutting, G12/G13 as on Yasnac. Lengths are {lengths}, radii are those of the"
        " circle",
        "one circle; the words of ngc/yasnac.md", MILL,
        (
            *mill(10, 5, 2000),
            length("top", "Z rapid to", "rapid down to", 2, 0.1),
            length("z", "Z depth", "depth, Z", -10, -0.4),
            CODE,
            length("i", "I radius, signed", "radius I, its sign the side", 50, 2),
            length("r", "R rapid, 0: none", "bored radius R", 0, 0, "no rapid: into the full"),
            length("k", "K first, 0: none", "first radius K", 12, 0.6, "no spiral"),
            length("q", "Q growth per turn", "growth a turn Q", 8, 0.4)._replace(needs="k"),
            levels("circles", "L circles", "finished circles", 1),
        ),
        "x y retract top z",
        NO_CODE + whole("circles", "L") + """\
START
G0 Z#<top>
G1 Z#<z> F#<feed>
o<words> if [#<r> AND #<k>]
  G#<code> I#<i> R#<r> K#<k> Q#<q> L#<circles> D#<tool>
o<words> elseif [#<k>]
  G#<code> I#<i> K#<k> Q#<q> L#<circles> D#<tool>
o<words> elseif [#<r>]
  G#<code> I#<i> R#<r> L#<circles> D#<tool>
o<words> else
  G#<code> I#<i> L#<circles> D#<tool>
o<words> endif
""", "retract",
    ),
    Form(
        "mitsubishi", "mitsubishi", "Circle, Mitsubishi",
        "Circular cutting, G12/G13 as on Mitsubishi. Lengths are {lengths}, the radius is that of"
        " the circle",
        "one circle; the words of ngc/mitsubishi.md", MILL,
        (
            *mill(6, 3, 2000),
            length("top", "Z rapid to", "rapid down to", 2, 0.1),
            length("z", "Z depth", "depth, Z", -5, -0.2),
            CODE,
            length("i", "I radius", "radius I", 50, 2),
        ),
        "x y retract top z",
        NO_CODE + """\
START
G0 Z#<top>
G1 Z#<z> F#<feed>
G#<code> I#<i> D#<tool>
""", "retract",
    ),
    Form(
        "circle_mill", "circle-mill", "Circle mill event",
        "Circle mill event, pocket or perimeter. Lengths are {lengths}, 0 leaves an entry in [ ]"
        " out",
        "one event; its entries as in ngc/circle_mill.ngc", MILL,
        (
            tool(5, 2), SPINDLE, COOLANT,
            Entry("event", "G 7 pocket, 0 wall", "cut", CHOICE, 7,
                  choices=((7, "pocket"), (0, "along the circle"))),
            *CENTRE,
            length("z", "Z depth", "depth, Z", -6, -0.25),
            length("w", "W start height", "start height W", 2, 0.1),
            length("o", "O retract height", "retract height O", 10, 0.5),
            length("r", "R radius", "radius R", 40, 1.5),
            Entry("d", "D sense, 0 to 3", "direction, rough / finish", CHOICE, 0,
                  choices=((0, "CW / CW"), (1, "CCW / CCW"), (2, "CW / CCW"), (3, "CCW / CW"))),
            Entry("c", "C side, 0 to 2", "tool", CHOICE, 2,
                  choices=((2, "right of it"), (1, "left of it"), (0, "on the circle"))),
            left_out("k", "[K] plunge depth", "depth per plunge K", LENGTH, "at once", 3, 0.12),
            left_out("j", "[J] pass width", "roughing width J", LENGTH, "the tool less 0.25 mm"),
            left_out("l", "[L] finish", "finish L", LENGTH, "no finish", 0.3, 0.01),
            left_out("p", "[P] plunge feed", "plunge feed P", FEED, "the feed", 150, 6),
            feed(600, 25, "f", "F rough feed"),
            left_out("v", "[V] finish feed", "finish feed V", FEED, "the feed"),
        ),
        "x y o w z",
        """\
o<no_event> if [#<event> NE 0 AND #<event> NE 7]
  (ABORT,form: G must be 0 or 7, not #<event>)
o<no_event> endif
START
OMITTED
o<circle_mill> call ENTRIES
""", "o",
        "event x y z w o r d c k j l p f v",
    ),
)  # fmt: skip


def hole_code(number: int) -> Entry:
    """Return the choice of direction of G12.5 to G13.7."""
    ways = [(13 + number / 10, "counterclockwise"), (12 + number / 10, "clockwise")]
    return Entry(
        "code", f"G 12.{number} or 13.{number}", "direction", CHOICE, ways[0][0],
        choices=tuple((code, f"G{code:g}, {way}") for code, way in ways),
    )  # fmt: skip


def no_hole_code(number: int) -> str:
    return f"""\
o<no_code> if [#<code> NE 12.{number} AND #<code> NE 13.{number}]
  (ABORT,form: G must be 12.{number} or 13.{number}, not #<code>)
o<no_code> endif
"""


def with_or_without(letter: str, block: str) -> str:
    """Return a block with a word, or without it where its entry is 0."""
    name = letter.lower()
    return f"""\
o<with_{name}> if [#<{name}>]
  {block} {letter}#<{name}>
o<with_{name}> else
  {block}
o<with_{name}> endif
"""


THREAD_BLOCK = "G#<code> Z#<z> R#<top> I#<i> K#<k> P#<pitch> H#<side> J#<teeth> E#<taper> D#<tool>"
HOLE_FORMS = (
    Form(
        "bore", "bore", "Bore along a helix",
        "Bore along a helix, G12.5/G13.5. Lengths are {lengths}, radii are those of the hole",
        "one bore; the words of ngc/bore.md", MILL,
        (
            *mill(3, 1),
            length("top", "Z top, R", "top of the hole R", 0, 0),
            length("z", "Z depth", "depth, Z", -8, -0.3),
            hole_code(5),
            length("i", "I radius", "radius I", 5, 0.2)._replace(of_tool=0.8),
            length("p", "P down per turn", "descent a turn P", 0.3, 0.01)._replace(of_tool=0.03),
            length("k", "K open, 0: none", "open radius K", 0, 0, "cut into the full"),
            length("q", "Q step, 0: one", "stepover Q", 0, 0, "one helix"),
            Entry("circles", "L spring circles", "spring circles L", COUNT, 0),
        ),
        "x y retract top z",
        no_hole_code(5) + """\
START
F#<feed>
""" + with_or_without("Q", "G#<code> Z#<z> R#<top> I#<i> P#<p> K#<k> L#<circles> D#<tool>"),
        "retract",
    ),
    Form(
        "thread", "thread", "Thread milling",
        "Thread milling, G12.6/G13.6. Lengths are {lengths}, radii are those of the thread",
        "one thread; the words of ngc/thread.md", MILL,
        (
            *mill(3, 1),
            length("top", "Z top, R", "top of the thread R", 0, 0),
            length("z", "Z end", "end of the thread Z", -10, -0.4),
            hole_code(6),
            Entry("side", "H 0 in, 1 outside", "side", CHOICE, 0,
                  choices=((0, "inside"), (1, "outside"))),
            length("i", "I larger radius", "larger radius I", 5, 0.1875),
            length("k", "K smaller radius", "smaller radius K", 4.188, 0.153),
            Entry("pitch", "P pitch, < 0 left", "pitch P, below 0 left-hand", LENGTH, 1.5, 0.0625),
            length("q", "Q infeed, 0: one", "infeed a pass Q", 0, 0, "one pass"),
            levels("teeth", "J teeth", "teeth of the cutter J", 1),
            Entry("taper", "E taper", "taper E", RATIO, 0),
        ),
        "x y retract top z",
        no_hole_code(6) + """\
START
F#<feed>
""" + with_or_without("Q", THREAD_BLOCK),
        "retract",
    ),
    Form(
        "frame", "frame", "Frame, pocket or wall",
        "Frame, G12.7/G13.7. Lengths are {lengths}, those of the finished rectangle",
        "one frame; the words of ngc/frame.md", MILL,
        (
            *mill(3, 1),
            length("top", "Z top", "top of the part", 0, 0),
            length("z", "Z depth", "depth, Z", -4, -0.2),
            hole_code(7),
            Entry("side", "H 0 to 2", "cut", CHOICE, 0,
                  choices=((0, "pocket"), (1, "along its inside"), (2, "along its outside"))),
            length("i", "I along X", "length along X, I", 40, 1.5),
            length("j", "J along Y", "length along Y, J", 30, 1),
            length("r", "R corner radius", "corner radius R", 5, 0.2)._replace(of_tool=0.8),
            length("k", "K level, 0: one", "depth per level K", 2, 0.1, "at once"),
            length("q", "Q stepover", "stepover Q", 2, 0.1)._replace(of_tool=0.4),
            length("e", "E finish", "finish allowance E", 0.2, 0.01, "none"),
            feed(150, 6, "p", "P plunge feed", "plunge feed P"),
        ),
        "x y retract top z",
        no_hole_code(7) + """\
START
G1 Z#<top> F#<feed>
#<k> = [#<k> + [#<k> EQ 0] * [#<top> - #<z>]]
o<pocket> if [#<side> EQ 0]
  G#<code> Z#<z> I#<i> J#<j> R#<r> K#<k> Q#<q> E#<e> P#<p> H#<side> D#<tool>
o<pocket> else
  G#<code> Z#<z> I#<i> J#<j> R#<r> K#<k> E#<e> P#<p> H#<side> D#<tool>
o<pocket> endif
""", "retract",
    ),
)  # fmt: skip

ON_AND_OFF = (
    Entry("on", "M tool on", "M code, tool on", COUNT, 3),
    Entry("off", "M tool off", "M code, tool off", COUNT, 5),
)
LIVE = Entry("spindle", "spindle $, 1 live", "spindle of the tool", COUNT, 0)
PER_PASS = left_out("per_pass", "[depth] per pass", "depth per pass", LENGTH, "at once")
ALLOWANCE = length("allowance", "finish allowance", "finish allowance", 0, 0, "no finish round")
PLUNGE = left_out("plunge_feed", "[plunge feed]", "plunge feed", FEED, "the feed")
SHAPE_INFO = "Lengths are {lengths}, 0 leaves an entry in [ ] out"


def on_a_face(number: float, turns: float = 3000, retract: str = "Z retract height",
              label: str = "retract height") -> tuple[Entry, ...]:  # fmt: skip
    """Return the entries that a form on a lathe begins with."""
    return (
        tool(number),
        speed("S tool, 1/min", "tool speed", turns),
        *ON_AND_OFF,
        COOLANT,
        length("retract", retract, label, 5, 0.2),
    )


def angle(words: str, label: str, name: str = "angle") -> Entry:
    return Entry(name, words, label, ANGLE, 0)


HOLE_ENTRIES = (
    length("depth", "depth", "depth", 8, 0.3),
    length("height", "retract height", "clear height", 2, 0.1),
    feed(120, 5, words="F, tap: the pitch", label="feed; tap: pitch"),
    length("peck", "peck, < 0: chips", "peck; below 0 breaks chips", 0, 0, "no peck"),
    Entry("dwell", "dwell, s", "dwell", SECONDS, 0),
    Entry("kind", "kind, 0 drills", "kind", CHOICE, 0,
          choices=((0, "drill"), (1, "tap, right"), (2, "tap, left"), (3, "bore"))),
    LIVE,
)  # fmt: skip
FIRST = angle("first angle", "first angle", "first_angle")
STEP = left_out("step", "[angle to next]", "angle to the next", ANGLE, "all round")

FACE_FORMS = (
    Form(
        "polygon", "polar-shapes", "Polygon on a bar's end",
        f"Polygon or two flats on a bar's end. {SHAPE_INFO}",
        "a polygon; its entries as in ngc/polar_shapes.md", FACE,
        (
            *on_a_face(1),
            levels("sides", "sides, 2: flats", "sides (2: flats)", 6),
            length("across_flats", "across flats", "across flats", 27, 1),
            length("depth", "depth", "depth", 5, 0.2),
            length("stock_diameter", "stock diameter", "stock diameter", 40, 1.5),
            length("corner_radius", "corner radius", "corner radius", 0, 0, "sharp"),
            PER_PASS, ALLOWANCE, feed(400, 15), PLUNGE,
            angle("angle of a flat", "angle of a flat"), LIVE,
        ),
        "",
        """\
START
OMITTED
o<polar_polygon> call ENTRIES
""", "",
        "sides across_flats depth stock_diameter corner_radius per_pass allowance feed "
        "plunge_feed angle",
    ),
    Form(
        "slot", "polar-shapes", "Slot on a bar's end",
        f"Slot about the centre of a bar's end. {SHAPE_INFO}",
        "a slot; its entries as in ngc/polar_shapes.md", FACE,
        (
            *on_a_face(3),
            length("width", "width", "width", 8, 0.3125)._replace(of_tool=1.3),
            length("length", "length over all", "length over all", 30, 1.2),
            length("depth", "depth", "depth", 4, 0.15),
            PER_PASS, ALLOWANCE, feed(400, 15), PLUNGE,
            angle("angle of the slot", "angle of the slot"), LIVE,
        ),
        "",
        """\
START
OMITTED
o<polar_slot> call ENTRIES
""", "",
        "width length depth per_pass allowance feed plunge_feed angle",
    ),
    Form(
        "face_pocket", "polar-shapes", "Round pocket on a bar's end",
        f"Round pocket on a bar's end. {SHAPE_INFO}",
        "a pocket; its entries as in ngc/polar_shapes.md", FACE,
        (
            *on_a_face(3),
            length("x", "X centre, diam.", "centre X, a diameter", 0, 0),
            length("c", "C centre, length", "centre C, a length", 0, 0),
            length("diameter", "pocket diameter", "diameter", 20, 0.75),
            length("depth", "depth", "depth", 4, 0.15),
            PER_PASS, ALLOWANCE, feed(400, 15), PLUNGE, LIVE,
        ),
        "",
        """\
START
OMITTED
o<polar_pocket> call ENTRIES
""", "",
        "x c diameter depth per_pass allowance feed plunge_feed",
    ),
    Form(
        "face_holes", "polar-shapes", "Holes on a bar's end",
        f"Holes on a circle on a bar's end. {SHAPE_INFO}",
        "holes; its entries as in ngc/holes.md", FACE,
        (
            *on_a_face(3, 2000),
            levels("count", "number of holes", "number of holes", 6),
            length("circle_diameter", "circle diameter", "circle diameter", 30, 1.2),
            FIRST, STEP, *HOLE_ENTRIES,
        ),
        "",
        """\
START
OMITTED
o<face_holes> call ENTRIES
""", "",
        "count circle_diameter first_angle step depth height feed peck dwell kind",
    ),
    Form(
        "side_holes", "polar-shapes", "Holes round a bar",
        f"Holes round a bar. {SHAPE_INFO}",
        "holes; its entries as in ngc/holes.md", ROUND,
        (
            *on_a_face(3, 2000, "Z in front of bar", "Z in front of the bar"),
            length("clear", "X clear, diameter", "X clear, a diameter", 60, 2.4),
            levels("count", "number of holes", "number of holes", 4),
            length("z", "Z of the holes", "Z of the holes", -10, -0.4),
            FIRST, STEP,
            length("surface_diameter", "surface diameter", "surface diameter", 40, 1.6),
            *HOLE_ENTRIES,
        ),
        "",
        """\
START
G0 X#<clear>
OMITTED
o<side_holes> call ENTRIES
""", "",
        "count z first_angle step surface_diameter depth height feed peck dwell kind",
    ),
)  # fmt: skip

FORMS = (*CIRCLE_FORMS, *HOLE_FORMS, *FACE_FORMS)
