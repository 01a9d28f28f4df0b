# SPDX-License-Identifier: GPL-2.0-or-later
"""Random valid programs, many pockets or sections in each.

``chance`` is a `random.Random`. A program's modes are drawn once more for each pocket; pockets
stand apart, and the tool goes from one to the next above all of them.
"""

import cmath
import itertools
import math

from g12.tools.machine.ini import read_ini
from support.sim_machines import SIM

INCH = 25.4
CUTTERS = {"mm": {3: 6.0, 4: 10.0, 5: 12.0, 10: 20.0}, "inch": {1: 6.35, 2: 12.7, 4: 9.525}}  # mm
PITCH = 60.0  # mm from pocket to pocket
ROWS = 6
OUT = -9999
SPEED = 4000  # of a driven tool, a minute


class Text:
    """A program in the making; lengths are given in mm and written in its units."""

    def __init__(self, chance, unit, *, polar=False):
        self.chance, self.scale = chance, 1.0 if unit == "mm" else INCH
        self.code = {"mm": "G21", "inch": "G20"}[unit]
        modes, self.polar = "G18" if polar else "G17", polar
        self.shifts = ["G10 L2 P1"] if polar else ["G10 L2 P1", "G10 L2 P1", "G52"]
        self.plane = self.between(1, 3)  # of events, above the part
        self.lines = [f"{self.code} {modes} G40 G49 G54 G80 G90 G94 G91.1 G64 P{self.n(0.01)}"]

    def n(self, mm):
        """Return a length as it is written."""
        return f"{mm / self.scale:.5f}".rstrip("0").rstrip(".")

    def add(self, *words):
        """Add a block."""
        self.lines.append(" ".join(filter(None, words)))

    def one_of(self, *values):
        return self.chance.choice(values)

    def between(self, least, most):
        """Return a length that the program's decimals can write."""
        return round(self.chance.uniform(least, most) / self.scale, 3) * self.scale

    def shuffled(self, code, *words):
        """Return a block with its words in any order."""
        words = [word for word in words if word]
        self.chance.shuffle(words)
        return " ".join([code, *words])

    def shift(self, *words):
        """Move the program's zero: by G10, or by G52 on top of it, which a section's does not."""
        at = " ".join(f"{letter}{self.n(self.between(*ends))}" for letter, *ends in words)
        self.add(self.one_of(*self.shifts), at)

    def height(self, k):
        """Return a shift of Z before the first cut; later the part would stand higher or lower."""
        return [("Z", -3, 3)] * (k == 0)

    def wrapped(self, first, name):
        """Put the lines from ``first`` on into a sub, a condition or a loop, as often as not."""
        body, kind = self.lines[first:], self.one_of("sub", "if", "repeat", "", "", "")
        if not kind:
            return
        condition = {"sub": "", "if": " [#<_x> LT 9999]", "repeat": " [2]"}[kind]
        self.lines[first:] = [f"o{name} {kind}{condition}", *body, f"o{name} end{kind}"]
        if kind == "sub":
            self.lines += [f"o{name} call"] * self.one_of(1, 2)

    def end(self, height=20):
        self.add("G90", f"G0 Z{self.n(height)}")
        self.add("M2")
        return "\n".join([*self.lines, ""])


def pocket_program(chance, unit, count, add_pocket):
    """Return a program of ``count`` pockets that ``add_pocket(text, tool, cutter, x, y)`` adds."""
    text, loaded = Text(chance, unit), None
    for k in range(count):
        if loaded is None or chance.random() < 0.1:
            loaded = chance.choice(list(CUTTERS[unit]))
            text.add("G90 G0", f"Z{text.n(20)}")  # a larger tool would not come out of the pocket
            text.add(f"T{loaded} M6 G43")
            text.add("S2000 M3")
            text.add("F" + text.n(text.between(100, 900)))
        x, y = (PITCH * (place - (ROWS - 1) / 2) for place in (k % ROWS, k // ROWS))
        if chance.random() < 0.15:
            text.add("G90 G0", f"Z{text.n(20)}")
            text.shift(("X", -20, 20), ("Y", -20, 20), *text.height(k))
        first = len(text.lines)
        text.add("G90 G0", f"Z{text.n(20)}")
        add_pocket(text, loaded, CUTTERS[unit][loaded] / 2, x, y)
        text.wrapped(first, 100 + k)
    return text.end()


def feed_mode(text):
    """Draw a feed per minute, or per revolution, or none, which goes on as before."""
    text.add(text.one_of("", f"F{text.n(text.between(100, 900))}"))
    if text.chance.random() < 0.15:
        text.add(f"G95 F{text.n(0.2)}")
        return f"G94 F{text.n(500)}"
    return ""


def haas(text, tool, radius, x, y):
    """Add a pocket in rings or in a spiral, a spring pass, one circle in a bored hole."""
    first = radius + text.between(0.1, 1.8 * radius)
    outward, levels = text.chance.random() < 0.8, text.one_of(1, 1, 2, 3)
    incremental, centred = text.chance.random() < 0.4, text.chance.random() < 0.5
    text.add("G0", f"X{text.n(0 if centred else x)} Y{text.n(0 if centred else y)}")
    text.add(f"Z{text.n(1)}")
    back = feed_mode(text)
    words = [f"I{text.n(first)}", f"Z{text.n(-text.between(1.5, 4))}"]
    if outward:
        words.append(f"K{text.n(first + text.between(0.1, 28 - first))}")
        words.append(f"Q{text.n(text.between(0.2, 1.9) * radius)}")
    words.append(f"L{levels}" if levels > 1 else "")
    words.append(f"D{tool}")
    words.append(text.one_of("", f"F{text.n(text.between(100, 900))}") if not back else "")
    if centred:  # the tool stands at X0 Y0
        words += [f"X{text.n(x)}", f"Y{text.n(y)}"]
    text.add(text.one_of("", "G61", f"G64 P{text.n(0.005)}"))
    text.add("G91" if incremental else "")
    text.add(text.shuffled(text.one_of("G12", "G13"), *words))
    text.add("G90", back)


def yasnac(text, tool, radius, x, y):
    """Add a circle with or without a fast approach, in one turn or in a spiral."""
    text.add("G0", f"X{text.n(x)} Y{text.n(y)}")
    text.add(f"Z{text.n(1)}")
    back = feed_mode(text)
    text.add("G1", f"Z{text.n(-text.between(1, 4))}")
    with_d = text.chance.random() < 0.8
    offset, side = radius if with_d else 0.0, text.one_of(1, -1)
    first, last = sorted(text.between(0.1, 25.0) for _ in range(2))
    last = max(last, first + 0.1)
    words = [f"I{text.n(side * (last + offset))}"]
    spiral = text.chance.random() < 0.5
    if with_d and text.chance.random() < 0.5:  # a bored hole, which the first circle reaches
        widest = (first if spiral else last) - 0.05
        least = widest - (0.05 if spiral else 0.9) * radius
        near = text.between(max(0.01, least), widest)
        text.add(
            f"G13 I{text.n(near + offset)} K{text.n(min(near, radius) / 2 + offset)}",
            f"Q{text.n(radius)} D{tool}",
        )  # it is bored so far before
        words.append(f"{text.one_of('R', 'J')}{text.n(side * (near + offset))}")
    if spiral:
        words.append(f"K{text.n(side * (first + offset))}")
        words.append(f"Q{text.n(text.between(0.2, 1.9) * radius)}")
    words.append(f"D{tool}" if with_d else "")
    words.append(text.one_of("", "L1", "L2", "L3"))
    text.add(text.shuffled(text.one_of("G12", "G13"), *words))
    text.add(back)


def mitsubishi(text, tool, radius, x, y):
    """Add a full circle in any plane."""
    text.add("G0", f"X{text.n(x)} Y{text.n(y)}")
    text.add(f"Z{text.n(1)}")
    back = feed_mode(text)
    text.add("G1", f"Z{text.n(-text.between(1, 4))}")
    plane, with_d = text.one_of("G17", "G17", "G18", "G19"), text.chance.random() < 0.8
    circle = text.between(0.1, 20.0) + (radius if with_d else 0.0)
    text.add(plane)
    words = [f"I{text.n(text.one_of(1, -1) * circle)}", f"D{tool if with_d else 0}"]
    text.add(text.shuffled(text.one_of("G12", "G13"), *words))
    text.add("G17", back)


def circle_mill(text, tool, radius, x, y):
    """Add an event as a code or as a call, pocket or perimeter, with finishes and pecks."""
    event = _event(text, radius, x, y)
    text.add("G0", f"X{text.n(x + text.between(-9, 9))} Y{text.n(y + text.between(-9, 9))}")
    call = text.chance.random() < 0.5
    (_add_call if call else _add_code)(text, event)


def _event(text, radius, x, y):
    """Return the entries of an event by the letters of the control, in mm."""
    pocket = text.chance.random() < 0.5
    direction = text.chance.randrange(4)
    left_is_inside = direction in (1, 3)
    side = text.one_of("in", "out", "on") if not pocket else "in"
    finish = text.between(0.1, 0.8) if side != "on" and text.chance.random() < 0.5 else None
    deep = text.between(1, 7)
    return {
        "G": 7 if pocket else 0,
        "X": x,
        "Y": y,
        "Z": -deep,
        "W": text.plane,
        "O": text.one_of(None, text.plane + text.between(0, 6)),
        "R": radius + text.between(1, 18 - radius) if side == "in" else text.between(2, 18),
        "D": direction,
        "C": {"on": 0, "in": 1 if left_is_inside else 2, "out": 2 if left_is_inside else 1}[side],
        "K": text.one_of(None, text.between(0.7, 4)),
        "J": text.between(0.2 * radius, 1.8 * radius) if pocket and text.one_of(0, 1) else None,
        "L": finish and text.one_of(1, -1) * finish,
        "P": text.one_of(None, text.between(50, 300)),
        "F": text.between(100, 900),
        "V": text.one_of(None, text.between(100, 900)),
    }


def _add_call(text, event):
    whole = "GDC"
    values = (
        OUT if value is None else value if letter in whole else text.n(value)
        for letter, value in event.items()
    )
    text.add("o<circle_mill> call", *(f"[{value}]" for value in values))


def _add_code(text, event):
    names = {"W": "I", "O": "E", "C": "H"}
    words = [
        f"{names.get(letter, letter)}{value if letter in 'DC' else text.n(value)}"
        for letter, value in event.items()
        if value is not None and letter not in "GLV"
    ]
    if event["L"]:
        words.append(f"Q{text.n(abs(event['L']))}")
        words.append("" if event["L"] > 0 else "L0")
    text.add(text.shuffled("G13.2" if event["G"] else "G12.2", *words))


# ---------------------------------------------------------------- polar sections

AXIAL = {"mm": {1: 12.0, 2: 10.0, 3: 6.0}, "inch": {1: 12.7, 2: 9.525, 3: 6.35}}


def polar_program(chance, unit, count, kind=""):
    """Return a program of sections: contours with compensation and without, some in subs.

    ``kind`` sloping: Z may change along lines, and G0 is a feed; beside: the centre is left out.
    """
    text = Text(chance, unit, polar=True)
    text.sloping, text.beside = kind == "sloping", kind == "beside"
    text.diameter = chance.random() < 0.5
    text.add("G7" if text.diameter else "G8", f"G97 S{SPEED}")
    loaded = None
    for k in range(count):
        if loaded is None or chance.random() < 0.2:
            loaded = chance.choice(list(AXIAL[unit]))
            text.add(f"T{loaded} M6 G43")
            text.add(f"S{SPEED} M3")
        in_sub, times = chance.random() < 0.3, chance.choice([1, 1, 2, 3])
        if chance.random() < 0.15:
            text.shift(("X", 0, 8), *text.height(k))
        if in_sub:
            text.add(f"o{100 + k} sub")
            text.add(f"G0 Z{text.n(5)}")  # zero may have been moved up to the tool
            text.add(f"G0 X{_x(text, 60)} C#1")
            _section(text, AXIAL[unit][loaded] / 2)
            text.add(f"G0 Z{text.n(5)}")
            text.add(f"o{100 + k} endsub")
            for turn in range(times):
                text.add(f"o{100 + k} call [{turn * 360 / times:g}]")
        else:
            text.add(f"G0 X{_x(text, 60)} Z{text.n(5)}", f"C{chance.choice([0, 0, 90, -45, 400])}")
            _section(text, AXIAL[unit][loaded] / 2)
            text.add(f"G0 Z{text.n(5)}")
    return text.end()


def _x(text, radius):
    return text.n(radius * (2 if text.diameter else 1))


def _section(text, cutter):
    text.rev = text.chance.random() < 0.15
    text.add(text.one_of("", "G61", f"G64 P{text.n(0.01)}"))
    text.add("G12.1")
    text.add("G95" if text.rev else "", _feed(text))
    kind = text.one_of("polygon", "polygon", "rounded", "rounded" if text.beside else "free")
    (_free if kind == "free" else _compensated)(text, cutter, kind == "rounded")
    text.add("G94" if text.rev else "")
    text.add("G13.1")


def _feed(text):
    """Return an F word along the part, per minute or per revolution at SPEED."""
    feed = text.between(100, 1500)
    return f"F{feed / text.scale / SPEED:.7f}" if text.rev else f"F{text.n(feed)}"


def _act(text):
    """Add something that is no motion, or nothing."""
    text.add(text.one_of("", "", "M8", "M9", "G4 P.2", "(MSG, on it)", "M7", "G61", "G64"))


def _to(text, point, words="G1", more=""):
    text.add(words, f"X{_x(text, point.real)}", f"C{text.n(point.imag)}", more)


def _polygon(text):
    """Return the corners of a convex polygon about the spindle or beside it, counterclockwise."""
    chance = text.chance
    count, radius = chance.randint(6 if text.beside else 3, 8), chance.uniform(8, 25)
    centre = complex(chance.uniform(-3, 3), chance.uniform(-3, 3)) * (not text.beside)
    gaps = [chance.uniform(0.6, 1.0) for _ in range(count)]
    turned, angles = chance.uniform(0, 6), list(itertools.accumulate(gaps))
    if text.beside:  # the tool comes from X60 and stays on that side
        turned = turned / 6 - 0.5 - gaps[0] / angles[-1] * math.pi
    return [
        centre + cmath.rect(radius, turned + angle / angles[-1] * 2 * math.pi) for angle in angles
    ]


def _compensated(text, cutter, rounded):
    """Add a convex polygon, cut from the middle of a side round; corners sharp or round."""
    corners = _polygon(text)
    clockwise = text.chance.random() < 0.5
    if clockwise:
        corners.reverse()
    start = (corners[-1] + corners[0]) / 2
    along = (corners[0] - corners[-1]) / abs(corners[0] - corners[-1])
    out = along * (1j if clockwise else -1j)
    reach = cutter + text.chance.uniform(1, 8)
    _to(text, start + out * reach)
    _to(text, start, "G41 G1" if clockwise else "G42 G1")
    depths = sorted(text.between(0.5, 5) for _ in range(text.one_of(1, 1, 2)))
    depths += depths[-1:] * text.one_of(0, 0, 1)  # a spring pass
    for depth in depths:
        text.add(f"G1 Z{text.n(-depth)}", text.one_of("", _feed(text)))
        _act(text)
        for corner, following in zip(corners, [*corners[1:], corners[0]]):
            _corner(text, corner, following, rounded, clockwise, corners)
        _to(text, start)
    _to(text, start + out * reach, "G40 G1")


def _corner(text, corner, following, rounded, clockwise, corners):
    if not rounded:
        return _to(text, corner)
    before = corners[corners.index(corner) - 1]
    a, b = (before - corner, following - corner)
    a, b = a / abs(a), b / abs(b)
    half = abs(cmath.phase(b / a)) / 2
    leg = 1.5
    radius = leg * math.tan(half)
    _to(text, corner + leg * a)
    end = corner + leg * b
    code = "G2" if clockwise else "G3"
    text.add(code, f"X{_x(text, end.real)} C{text.n(end.imag)} R{text.n(radius)}")
    return None


def _free(text, *_):
    """Add lines, arcs and circles without compensation, anywhere on the face; Z in blocks alone."""
    at = complex(60, 0)
    text.add(f"G1 Z{text.n(-text.between(0.5, 5))}")
    for _ in range(text.chance.randint(1, 8)):
        kind = text.one_of("line", "line", "arc", "circle", "z", "bare")
        slope = f"Z{text.n(-text.between(0, 5))}" if text.sloping and text.one_of(0, 1) else ""
        _act(text)
        to = complex(text.between(-30, 30), text.between(-30, 30))
        if kind == "z":
            text.add(f"G1 Z{text.n(-text.between(0, 5))}")
        elif kind == "circle":
            arm = complex(text.between(-12, 12), text.between(1, 12))
            text.add(text.one_of("G2", "G3"), f"I{text.n(arm.real)} J{text.n(arm.imag)}", slope)
        elif abs(to - at) > 1.0:
            if kind == "arc":
                radius = abs(to - at) * text.chance.uniform(0.55, 0.9) * text.one_of(1, -1)
                words = f"X{_x(text, to.real)} C{text.n(to.imag)} R{text.n(radius)}"
                text.add(text.one_of("G2", "G3"), words, slope)
            else:
                _to(text, to, "G0" if text.sloping and text.one_of(0, 0, 1) else "G1", slope)
            at = to


# ---------------------------------------------------------------- sections on a cylinder


# The letters of the angle, along its axis, and of the height.
ON_MILL = {"a": ("A", "X", "Z"), "reversed": ("A", "X", "Z"), "b": ("B", "Y", "Z")}


def cylinder_program(chance, unit, count, kind=""):
    """Return a program of sections round a part: grooves, arcs, turns, walls with compensation.

    ``kind`` sloping: the height may change along lines, and G7.1 has diameters; a, b: on a mill.
    """
    text = Text(chance, unit, polar=kind not in ON_MILL)
    text.turn, text.along, text.height = ON_MILL.get(kind, ("C", "Z", "X"))
    text.sloping, text.reversed = kind == "sloping", kind == "reversed"
    text.diameter, text.shifts = text.polar and chance.random() < 0.5, text.shifts[:1]
    tools = (AXIAL if text.polar else CUTTERS)[unit]
    text.add(("G7" if text.diameter else "G8") if text.polar else "", f"G97 S{SPEED}")
    for _ in range(count):
        loaded = chance.choice(list(tools))
        radius = text.between(15, 60)
        z, c = -text.between(20, 80), chance.choice([0, 90, -45, 400])
        if chance.random() < 0.15:
            text.shift((text.height, -3, 3), (text.along, -9, 9))
        text.add(f"T{loaded} M6 G43")
        text.add(f"S{SPEED} M3")
        text.add("G0", _height(text, 90), "" if text.polar else {"A": "Y0", "B": "X0"}[text.turn])
        text.add("G0", _height(text, radius + 5), f"{text.along}{text.n(z)} {text.turn}{c}")
        text.add(text.one_of("", "G61", f"G64 P{text.n(0.01)}"))
        text.add(f"G7.1 {text.turn}{text.n(radius * (2 if text.sloping else 1))}")
        deep, feed = radius - text.between(0.5, 4), text.between(50, 300)
        text.add("G1", _height(text, deep), f"F{text.n(feed)}")
        text.add(f"F{text.n(text.between(100, 1500))}")
        if chance.random() < 0.5:
            _groove(text, radius, complex(radius * math.radians(c), z))
        else:
            _wall(text, radius, complex(radius * math.radians(c), z), tools[loaded] / 2)
        text.add("G1", _height(text, radius + 5))
        text.add(f"G7.1 {text.turn}0")
    return text.end(20 if text.polar else 90)


def _height(text, radius):
    return f"{text.height}{_x(text, radius)}"


def _around(text, radius, point, words="G1", more=""):
    """Add a block to a point of the unrolled surface, its first axis along the angle."""
    angle = f"{text.turn}{math.degrees(point.real / radius):.5f}"
    text.add(words, f"{text.along}{text.n(point.imag)} {angle}", more)


def _groove(text, radius, at):
    """Add lines and arcs through places anywhere, some of them turns away."""
    text.rev = False
    for _ in range(text.chance.randint(1, 6)):
        to = at + complex(text.between(-40, 40), text.between(-8, 8))
        kind = text.one_of("line", "arc", "turns", "circle")
        _act(text)
        slope = ""
        if text.sloping and text.one_of(0, 1):
            slope = _height(text, radius - text.between(0.5, 4))
        if kind == "arc" and abs(to - at) > 1.0:
            bow = abs(to - at) * text.chance.uniform(0.55, 0.9) * text.one_of(1, -1)
            _around(text, radius, to, text.one_of("G2", "G3"), f"R{text.n(bow)} {slope}")
        elif kind == "circle":
            centre = f"J{text.n(text.between(1, 9))} {'K' if text.polar else 'I'}{text.n(2)}"
            text.add(text.one_of("G2", "G3"), centre)
            to = at
        elif kind == "turns" and text.polar:
            text.add("G1", f"W{text.n(text.between(1, 9))} H{text.one_of(-720, 540, 360)}")
            return
        else:
            _around(text, radius, to, more=slope)
        at = to


def _wall(text, radius, start, cutter):
    """Add a wall of a line, an arc and a line, the tool on the side that it comes from."""
    heading, below = text.one_of(1, -1), text.one_of(True, False)
    out = (cutter + text.between(1, 8)) * (-1j if below else 1j) / heading  # seen along the wall
    at, bow = start - out * heading, 2.5 * cutter + text.between(1, 20)
    codes = {True: "G41 G1", False: "G42 G1"}
    _around(text, radius, at, codes[(below != (heading == 1)) != text.reversed])
    at += text.between(5, 30) * heading
    _around(text, radius, at)
    bend = text.one_of(1, -1) * 1j
    centre, sweep = at + bend * bow * heading, cmath.exp(bend * text.chance.uniform(0.2, 1))
    at, heading = centre + (at - centre) * sweep, heading * sweep
    _around(text, radius, at, "G3" if (bend.imag > 0) != text.reversed else "G2", f"R{text.n(bow)}")
    at += text.between(5, 30) * heading
    _around(text, radius, at)
    _around(text, radius, at + out * heading, "G40 G1")


# ---------------------------------------------------------------- shapes on the face


def shapes_program(chance, unit, count, _kind=""):
    """Return a program of polygons, slots and round pockets by their calls."""
    text = Text(chance, unit, polar=True)
    text.diameter = chance.random() < 0.5
    text.add("G7" if text.diameter else "G8", f"G97 S{SPEED}", f"F{text.n(400)}")
    for k in range(count):
        if not k or chance.random() < 0.2:
            loaded = chance.choice(list(AXIAL[unit]))
            text.add(f"G0 X{_x(text, 60)} Z{text.n(9)}")
            text.add(f"T{loaded} M6 G43")
            text.add(f"S{SPEED} M3")
        if chance.random() < 0.15:
            text.shift(("X", 0, 8), *text.height(k), ("C", 0, 1))
        text.add(f"G0 X{_x(text, 60)} Z{text.n(5)}")
        first = len(text.lines)
        name, entries = chance.choice([_polygon_call, _slot_call, _pocket_call])(
            text, AXIAL[unit][loaded] / 2
        )
        text.add(f"o<{name}> call", *(f"[{entry}]" for entry in entries))
        if chance.random() < 0.3:
            text.wrapped(first, 100 + k)
    return text.end()


def _passes(text, depth, allowance):
    """Return the entries from depth_per_pass on: pass, allowance, feed, plunge feed."""
    n = text.n
    feeds = (n(text.between(200, 900)), text.one_of(OUT, n(text.between(50, 200))))
    return (text.one_of(OUT, n(depth / text.one_of(1, 2, 2.5))), allowance, *feeds)


def _polygon_call(text, cutter):
    across, sides, depth = text.between(12, 30), text.chance.randint(2, 9), text.between(1, 5)
    stock, rounding = across + text.between(1, 12), text.one_of(0, text.between(0.5, 3))
    finish = text.one_of(OUT, text.n(0.3), text.n(0.012))
    entries = [sides, *map(text.n, (across, depth, stock, rounding * (sides > 2)))]
    angle = text.chance.choice([OUT, 0, 30, -77.5])
    return "polar_polygon", [*entries, *_passes(text, depth, finish), angle]


def _slot_call(text, cutter):
    width = 2 * cutter + text.one_of(0, text.between(0.5, 9))
    length, depth = width + text.between(2, 20), text.between(1, 5)
    finish = text.one_of(OUT, text.n(0.15), text.n(0.012)) if width > 2 * cutter + 0.4 else OUT
    entries = [text.n(value) for value in (width, length, depth)]
    return "polar_slot", [*entries, *_passes(text, depth, finish), text.one_of(OUT, 0, 45, -120)]


def _pocket_call(text, cutter):
    diameter, depth = 2 * cutter + text.between(1, 20), text.between(1, 5)
    x, c = text.one_of(0, text.between(-9, 9)), text.one_of(0, text.between(-9, 9))
    finish = text.one_of(OUT, text.n(0.15), text.n(0.012))
    entries = [_x(text, x), *map(text.n, (c, diameter, depth))]
    return "polar_pocket", [*entries, *_passes(text, depth, finish)]


# ---------------------------------------------------------------- each kind by its name

MACHINES = {  # a machine, and settings of [G12] in place of its own
    "haas": ("mill_mm", {}),
    "haas inch": ("mill_inch", {}),
    "haas spiral": ("mill_mm", {"CLEARING": "spiral", "PLUNGE_FEED": "40"}),
    "haas helix": ("mill_helix_mm", {}),
    "haas helix spiral": (
        "mill_inch", {"CLEARING": "spiral", "ENTRY": "helix", "ENTRY_ANGLE": "5"},
    ),
    "yasnac": ("mill_yasnac_mm", {}),
    "yasnac traverse": ("mill_yasnac_mm", {"YASNAC_TRAVERSE": "3000"}),
    "mitsubishi": ("mill_mitsubishi_mm", {}),
    "circle mill": ("mill_mm", {}),
    "polar": ("lathe_mm", {}),
    "polar inch": ("lathe_inch", {}),
    "polar kinematics": ("lathe_mm_kinematics", {}),
    "polar sloping": (
        "lathe_mm", {"POLAR_Z": "allow", "POLAR_G0": "feed", "POLAR_G0_FEED": "2500"},
    ),
    "polar beside": ("lathe_mm", {"POLAR_TOOL_OFFSET": "0.4"}),
    "polar beside kinematics": ("lathe_mm_kinematics", {"POLAR_TOOL_OFFSET": "-0.7"}),
    "shapes": ("lathe_mm", {}),
    "shapes inch": ("lathe_inch", {}),
    "shapes kinematics": ("lathe_mm_kinematics", {}),
    "cylinder": ("lathe_mm", {}),
    "cylinder inch": ("lathe_inch", {}),
    "cylinder sloping": ("lathe_mm", {"CYLINDER_X": "allow", "CYLINDER_WORD": "diameter"}),
    "cylinder a": ("mill_a_mm", {"CYLINDER_X": "refuse"}),
    "cylinder reversed": ("mill_a_mm", {"ROTARY_SENSE": "reversed"}),
    "cylinder b": ("mill_a_mm", {}),
}  # fmt: skip
WITH_B = {
    "TRAJ": {"COORDINATES": "X Y Z B"},
    "KINS": {"KINEMATICS": "trivkins coordinates=XYZB"},
    "AXIS_B": {"MIN_LIMIT": "-99999", "MAX_LIMIT": "99999", "MAX_VELOCITY": "360",
               "MAX_ACCELERATION": "3600"},
}  # fmt: skip
LATHE_PROGRAMS = {"polar": polar_program, "shapes": shapes_program, "cylinder": cylinder_program}
POCKETS = {"yasnac": yasnac, "mitsubishi": mitsubishi, "circle": circle_mill, "haas": haas}


def machine_of(kind):
    """Return the machine of a kind with its settings."""
    name, settings = MACHINES[kind]
    own = WITH_B if kind == "cylinder b" else {}
    return read_ini(SIM / f"{name}_headless.ini").replaced({"G12": settings, **own})


def valid_program(kind, chance, count):
    """Return a program of ``count`` pockets or sections of a kind of `MACHINES`."""
    what, *more = kind.split()
    unit = "inch" if MACHINES[kind][0].endswith("inch") else "mm"
    if what in LATHE_PROGRAMS:
        return LATHE_PROGRAMS[what](chance, unit, count, more[0] if more else "")
    return pocket_program(chance, unit, count, POCKETS[what])
