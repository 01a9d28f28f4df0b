# SPDX-License-Identifier: GPL-2.0-or-later
"""The toolpaths of G12, G13 and of circle mill events, by the page of each in ngc/.

Points are seen from the circle's centre along the plane's axes, radii are those of the tool's
centre, levels are measured from the tool before the block; mm.
"""

import math

from g12.request import LEFT_OUT
from support.oracle.toolpath import Writer

ROUNDING = 1e-6  # mm
TURNS = {"G12": -1, "G13": 1}
CLEARED = 0.9  # of the cutter's radius: the helix is not larger
LEAST_CORNER = math.radians(0.99)  # between two half turns of the helix
RETRACT = 2.54  # mm, of an event's pocket between its levels
NARROWER = 0.254  # mm: the roughing width without J is the cutter's diameter less this
CODE_ENTRIES = {"I": "W", "E": "O", "Q": "L", "H": "C", **{name: name for name in "XYZRKJPD"}}
ROUGH_FINISH = ((-1, -1), (1, 1), (-1, 1), (1, -1))  # turns by D


class BlockInMm:
    """The words of a reported block in mm; the tool's position before it; the cutter's radius."""

    def __init__(self, report, cutter, settings):
        self.report, self.cutter, self.settings = report, cutter, settings
        self.words, self.unit = report.words, report.frame.mm
        self.feed = report.feed * self.unit

    def length(self, letter, default=0.0):
        return self.words[letter] * self.unit if letter in self.words else default

    def centre(self):
        """Return the program's X, Y and Z of the circle's centre, in its unit."""
        x, y, z, _ = self.report.at
        words = (self.words.get(letter) for letter in "XY")
        steps = (
            0.0 if word is None else word if self.report.incremental else word - here
            for word, here in zip(words, (x, y))
        )
        return *map(sum, zip((x, y), steps)), z

    def writer(self, start=0j):
        return Writer(start, 0.0, self.report.line, self.report.per_revolution)

    def from_centre(self):
        """Return the tool's position before the block in the XY plane."""
        (x, y, _), (here_x, here_y, *_) = self.centre(), self.report.at
        return complex(here_x - x, here_y - y) * self.unit

    def depth(self, count):
        """Return how far the Z word, ``count`` times if incremental, leads from the tool."""
        if "Z" not in self.words:
            return 0.0
        here = 0.0 if self.report.incremental else self.report.at[2] * self.unit
        return self.length("Z") * (count if self.report.incremental else 1) - here


# ---------------------------------------------------------------- haas


def haas_path(block):
    turn, words, settings = TURNS[block.report.code], block.words, block.settings
    first = block.length("I") - block.cutter
    last, step = block.length("K", block.length("I")) - block.cutter, block.length("Q")
    helix = min(first, CLEARED * block.cutter) if block.cutter else first
    helix *= settings.entry == "helix"
    spiral = settings.clearing == "spiral" and step
    down, half = block.feed * settings.plunge_feed / 100, turn * math.pi
    writer = block.writer(block.from_centre())
    writer.straight("rapid to the centre", 0j, rapid=True)
    ahead, above = 1 + 0j, 0.0  # the direction of the lead-in
    for depth in (block.depth(count + 1) for count in range(round(words.get("L", 1)))):
        by_helix = helix > 0.0 and depth < above - ROUNDING
        ahead = ahead if by_helix or abs(depth - above) <= ROUNDING else 1 + 0j
        radius = helix if by_helix else first
        if not by_helix:
            writer.vertical("plunge", depth, down)
        writer.arc("lead-in", ahead * radius / 2, half, block.feed)
        if by_helix:
            for fall in falls_of(above - depth, helix, math.radians(settings.entry_angle)):
                writer.arc("helix", 0j, half, down, fall)
        writer.arc("ring", 0j, 2 * half, block.feed)
        if radius < first:
            writer.arc("stepover", ahead * (helix - first) / 2, half, block.feed)
            writer.arc("ring", 0j, 2 * half, block.feed)
            ahead = -ahead
        further = spiral_out if spiral else links_out
        if step:
            ahead = further(writer, ahead, (first, last, step), turn, block.feed)
        writer.arc("lead-out", writer.at / 2, half, block.feed)
        above = depth
    return writer.path


def links_out(writer, ahead, radii, turn, feed):
    """Write the further rings: straight on by the stepover, a quarter turn, the ring."""
    first, last, step = radii
    while first < last - ROUNDING:
        larger = last if first + step > last - ROUNDING else first + step
        onward = ahead * 1j * turn * (larger - first)
        writer.straight("stepover", writer.at + onward, feed)
        writer.arc("stepover", onward, turn * math.pi / 2, feed)
        writer.arc("ring", 0j, 2 * turn * math.pi, feed)
        ahead, first = ahead * 1j * turn, larger
    return ahead


def spiral_out(writer, ahead, radii, turn, feed):
    """Write half turns that grow by half the pitch, and the last ring."""
    first, last, pitch = radii
    while first < last - ROUNDING:
        larger = last if first + pitch / 2 > last - ROUNDING else first + pitch / 2
        writer.arc("spiral", ahead * (first - larger) / 2, turn * math.pi, feed)
        ahead, first = -ahead, larger
    writer.arc("ring", 0j, 2 * turn * math.pi, feed)
    return ahead


def falls_of(height, radius, angle):
    """Return by how much each half turn of a helix falls.

    As many as are needed and an even number; the last of them lose their slope in equal steps.
    """
    easing = math.ceil(angle / LEAST_CORNER)
    shares = [step / easing for step in range(easing - 1, 0, -1)]
    most = math.pi * radius * math.tan(angle)
    steep = max(1, math.ceil(height / most - sum(shares)))
    steep += (steep + len(shares)) % 2
    fall = height / (steep + sum(shares))
    return [fall] * steep + [fall * share for share in shares]


# ---------------------------------------------------------------- yasnac, mitsubishi


def yasnac_path(block):
    """Return fast to the approach, onto the circle or the spiral, round, and back.

    Positions along X have the sign of I. The traverse is a rapid, or at a feed per minute.
    """
    words, half = block.words, TURNS[block.report.code] * math.pi
    inward = math.copysign(block.cutter, words["I"])
    bore, radius = block.length("R") or block.length("J"), block.length("I") - inward
    approach = bore - inward if bore else 0.0
    first = block.length("K") - inward if "K" in words else radius
    traverse = block.settings.yasnac_traverse * block.machine_mm
    fast = {"per_rev": False} if traverse else {"rapid": True}
    writer = block.writer()
    writer.straight("fast move", complex(approach), traverse or None, **fast)
    writer.arc("lead-in", complex(approach + first) / 2, half, block.feed)
    rest, pitch = abs(radius - first), block.length("Q")
    while rest > ROUNDING:
        growth = pitch if rest > pitch + ROUNDING else rest
        for _ in range(2):
            outward = math.copysign(growth / 2, writer.at.real)
            writer.arc("spiral", complex(-outward / 2), half, block.feed)
        rest -= growth
    for _ in range(round(words.get("L", 1))):
        writer.arc("circle", 0j, 2 * half, block.feed)
    writer.arc("lead-out", complex(approach + radius) / 2, half, block.feed)
    writer.straight("fast move", 0j, traverse or None, **fast)
    return writer.path


def mitsubishi_path(block):
    """Return half a circle out along the first axis, round, and back."""
    half, radius = TURNS[block.report.code] * math.pi, abs(block.length("I")) - block.cutter
    writer = block.writer()
    writer.arc("lead-in", complex(radius) / 2, half, block.feed)
    writer.arc("circle", 0j, 2 * half, block.feed)
    writer.arc("lead-out", complex(radius) / 2, half, block.feed)
    return writer.path


# ---------------------------------------------------------------- events


def event_entries(block):
    """Return the entries of an event by the control's letters, lengths in mm."""
    words, code = block.words, block.report.code
    if code == "circle_mill":
        given = {name: value for name, value in words.items() if value != LEFT_OUT}
    else:
        given = {CODE_ENTRIES[name]: words[name] for name in words if name in CODE_ENTRIES}
        given["G"] = 7.0 if code == "G13.2" else 0.0
        if words.get("L") == 0.0:
            given["L"] = -given["L"]
    return {name: value if name in "GDC" else value * block.unit for name, value in given.items()}


def event_path(block, planes):
    """Return the moves of an event: to the plunge point, the levels, the finish, and back.

    ``planes`` are W and O of the events before, mm; None where no event has one.
    """
    entries, here = event_entries(block), block.report.at[2] * block.unit
    top, modal = entries.get("W", planes[0]), planes[1]
    base = top if block.report.incremental else 0.0
    second = entries.get("O", top if modal is None else modal) - here
    bottom = entries["Z"] + base - here
    pocket, finish = entries.get("G") == 7.0, entries.get("L", 0.0)
    turn, finish_turn = ROUGH_FINISH[round(entries.get("D", 0.0))]
    side = {0: 0, 1: -turn, 2: turn}[round(entries["C"])]  # clockwise: left is outside
    final = entries["R"] + side * block.cutter
    rough = final + side * abs(finish)
    widest = entries.get("J", 2 * block.cutter - NARROWER) if pocket else rough
    count = max(1, math.ceil((rough - ROUNDING) / widest))
    rings = [rough * (ring + 1) / count for ring in range(count)]
    top -= here
    feed = entries.get("F", block.feed)
    down = entries.get("P", feed)
    start = block.from_centre()
    writer = block.writer(start)
    writer.vertical("rapid up", max(0.0, top), rapid=True)
    place = 0j if pocket else complex(0.0, -rough)
    writer.straight("rapid to the plunge point", place, rapid=True)
    writer.vertical("rapid to the first reference plane", top, rapid=True)
    for index, level in enumerate(event_levels(top, bottom, finish, entries.get("K"))):
        if index and pocket:
            writer.vertical("retract", min(writer.level + RETRACT, top), rapid=True)
            writer.straight("rapid back to the centre", 0j, rapid=True)
        writer.vertical("plunge", level, down)
        for radius in rings:
            writer.straight("stepover", complex(0.0, -radius), feed)
            writer.arc("circle", 0j, 2 * math.pi * turn, feed)
    if finish:
        middle, entry = complex(0.0, -(rough + final) / 2), math.pi * finish_turn * -side
        last_feed = entries.get("V", feed)
        writer.arc("lead-in of the finish", middle, entry, last_feed)
        writer.arc("finish circle", 0j, 2 * math.pi * finish_turn, last_feed)
        writer.arc("lead-out of the finish", middle, entry, last_feed)
    writer.vertical("rapid to the second reference plane", second, rapid=True)
    writer.straight("rapid back to the start", start, rapid=True)
    return writer.path


def event_levels(top, bottom, finish, peck):
    """Return the levels of the passes, downward; a finish above 0 is for the bottom, too."""
    rough = bottom + max(0.0, finish)
    peck = peck or top - rough
    levels = [top - peck]
    while levels[-1] > rough + ROUNDING:
        levels.append(levels[-1] - peck)
    levels[-1] = rough
    return levels + [bottom] * (rough > bottom)
