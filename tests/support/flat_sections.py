# SPDX-License-Identifier: GPL-2.0-or-later
"""Sections of a lathe's program as plain moves of a mill in X and Y, and whether both cut the same.

On the mill LinuxCNC itself makes the toolpath of the same words: lines, arcs, levels, feeds and
cutter compensation. Where compensation begins LinuxCNC goes to the side of that line, a section to
the side of the element after it: the mill begins on that element, far before the part.
"""

import cmath
import math
import re
from itertools import groupby, islice

import numpy as np
import pytest

from g12.machine_ini import face_of
from g12.tools.path.part import ROLES, Part, Surface
from g12.tools.path.track import feed_length, rate
from g12.tools.preview.tracer import Tracer
from support.contour_geometry import apart, distances
from support.sim_machines import SIM
from support.valid_programs import AXIAL, CUTTERS, INCH, SPEED

NEAR = 1e-4  # mm: no motion
ROUNDED = 5e-4  # mm: arcs whose words are rounded do not close any better
FEED = 0.003  # relative: the same, beside C in degrees
SLOWEST = 0.05  # of the feed, on the face: what C cannot follow is slower
FAR = 99  # mm or inches
WORD = re.compile(r"([A-Z])(-?[\d.]+)")
BEGIN = re.compile(r"G12\.1|G7\.1 (?P<turn>[ABC])(?P<size>(?!0$)[\d.]+)")
END = re.compile(r"G13\.1|G7\.1 [ABC]0")
ON = re.compile("G4[12]")
PATHS = ("G61", "G64")  # which LinuxCNC takes without compensation alone
ANGLE = re.compile(r" [ABC]\S+$")  # a word outside of sections


def sections_of(text, ini):
    """Yield the lines of a program with their numbers, those of sections for a mill.

    On a face C becomes Y, round a part an angle becomes a length of X or Y, and on a lathe the
    place along Z becomes Y. Lines without a number are inside no section.
    """
    modes = "G18 G7" if "\nG7 " in text else "G18 G8" if "\nG8 " in text else "G17"
    flat, stands = None, ""
    for number, line in enumerate(text.splitlines(), 1):
        begin = BEGIN.fullmatch(line)
        if END.fullmatch(line):
            yield 0, modes
            flat = None
        elif begin and begin["turn"]:
            radius = float(begin["size"]) * (0.5 if ini.settings.cylinder_word != "radius" else 1.0)
            flat = unrolled(begin["turn"], math.radians(radius), ini, 0.5 if "G7" in modes else 1)
            yield 0, f"G17 G8 {flat(stands)}"
        elif begin:
            yield 0, f"G17 G0 Y{ini.tool_beside}"
            flat = on_face
        elif flat:
            yield number, "" if line in PATHS else flat(line)
        else:
            stands = line if ANGLE.search(line) else stands
            yield 0, ANGLE.sub("", line)


def on_face(line):
    return line.replace("C", "Y")


def unrolled(turn, degree, ini, half):
    """Return what writes a line of a section round a part; ``degree`` is the length of one."""
    sense = -1 if ini.settings.rotary_sense == "reversed" else 1
    scales = {
        "A": {"A": ("Y", -degree * sense)},
        "B": {"B": ("X", degree * sense)},
        "C": {"X": ("Z", half), "Z": ("Y", 1), "C": ("X", degree), "J": ("I", 1), "K": ("J", 1)},
    }[turn]
    here = {"H": ("X", "#5420", degree), "W": ("Y", "#5421", 1)}

    def word(found):
        letter, value = found[1], float(found[2])
        if letter in here:
            axis, at, scale = here[letter]
            return f"{axis}[{at} + {value * scale:.9f}]"
        axis, scale = scales.get(letter, (letter, 0))
        return f"{axis}{value * scale:.9f}" if scale else found[0]

    return lambda line: line if line.startswith("(") else WORD.sub(word, line)


def from_afar(lines):
    """Yield lines with compensation begun far before the element that it is for."""
    for at, (number, line) in enumerate(lines):
        if ON.search(line):
            here, there = islice(filter(None, (place_in(each) for _, each in lines[at:])), 2)
            step = FAR * (there - here) / abs(there - here)
            yield 0, block("G1", here - 2 * step)
            yield number, block(f"{ON.search(line)[0]} G1", here - step)
        else:
            yield number, line


def place_in(line):
    words = dict(WORD.findall(line))
    return complex(float(words["X"]), float(words["Y"])) if words.keys() >= {"X", "Y"} else None


def block(code, place):
    return f"{code} X{place.real:.9f} Y{place.imag:.9f}"


class FlatSections:
    """The blocks of a program's sections as LinuxCNC makes them on a mill, one after the other."""

    def __init__(self, text, unit, ini):
        lines = [*from_afar([*sections_of(text, ini)])]
        scale = INCH if unit == "inch" else 1.0
        diameters = (AXIAL if "C" in ini.axes else CUTTERS)[unit]
        tools = {number: diameter / scale for number, diameter in diameters.items()}
        with Tracer(SIM / f"mill_{unit}.ini", tools=tools) as mill:
            trace = mill.trace_text([line for _, line in lines])
        assert trace.error is None, trace.error
        moves = (move._replace(line=lines[move.line - 1][0]) for move in trace.moves)
        self.blocks = blocks_of(move for move in moves if move.line)
        self.begins = {number for number, line in lines if number and ON.search(line)}
        self.ini, self.tolerance = ini, ini.settings.tolerance(ini.mm) * ini.mm + ROUNDED

    def check(self, cut, trace):
        """Compare the next section."""
        made, seen = blocks_of(trace.moves[cut.at : cut.end]), seen_as(cut, self.ini)
        flat, self.blocks = self.blocks[: len(made)], self.blocks[len(made) :]
        assert [line for line, _ in made] == [line for line, _ in flat], cut.line
        zero = np.array(cut.report.frame.zero[:3]) * cut.report.frame.mm
        is_beginning = False
        for (line, moves), (_, wanted) in zip(made, flat):
            points = np.concatenate([seen(move) for move in moves])
            path = np.concatenate([Part(False).polyline(move) for move in wanted]) - zero
            goes = np.ptp(points[:, :2], axis=0).max() > NEAR
            if line in self.begins:
                is_beginning = True
            elif is_beginning and goes:  # the mill comes from afar
                assert distances(points, path).max() < self.tolerance, line
                assert points[-1] == pytest.approx(path[-1], abs=self.tolerance), line
                is_beginning = False
            elif is_beginning:
                assert points[:, 2] == pytest.approx(path[:, 2]), line
            else:
                assert apart(points, path, step=1) < self.tolerance, line
                self.check_feed(moves, wanted, cut)

    def check_feed(self, moves, wanted, cut):
        """Compare a block's time with that on the mill; on the face C may make it slower."""
        given = [length_of(move) / rate(move, SPEED) for move in moves if rate(move, SPEED)]
        length = sum(move.length for move in wanted)
        feed = rate(wanted[0], SPEED) or (self.ini.settings.polar_g0_feed or 0.0) / 60.0
        if len(given) == len(moves) and feed:
            rounding = FEED + ROUNDED / length
            on_face = face_of(self.ini.get) and not cut.report.cut.surface
            share = length / feed / sum(given)
            assert (SLOWEST if on_face else 1 - rounding) < share < 1 + rounding, wanted[0].line


def blocks_of(moves):
    """Return line and moves of each block that goes anywhere."""
    going = (move for move in moves if length_of(move) > NEAR)
    return [(line, list(some)) for line, some in groupby(going, key=lambda move: move.line)]


def length_of(move):
    return move.length if move.kind == "arc" else feed_length(move)


def seen_as(cut, ini):
    """Return what draws a move of a section as points of the mill: two of its plane, and Z."""
    frame, planned = cut.report.frame, cut.report.cut
    zero, angle = np.array(frame.zero[:3]) * frame.mm, math.radians(frame.zero[3])
    if planned.surface:
        roles, radius = ROLES[planned.turn], planned.surface * frame.mm
        part = Surface(True, ini.tool_beside, 0.0, roles, radius, planned.sense)
        base = [angle * radius * planned.sense, zero[roles.along], zero[roles.height]]
        order = [1, 0, 2] if planned.turn == "A" else [0, 1, 2]
        return lambda move: (part.polyline(move) - base)[:, order]
    face = Part(True, ini.tool_beside, zero[0])
    axis = cmath.rect(1.0, angle + math.radians(cut.report.at[3]))

    def seen(move):
        points = face.polyline(move)
        flat = (points[:, 0] + 1j * points[:, 1]) / axis
        return np.column_stack([flat.real, flat.imag, points[:, 2] - zero[2]])

    return seen
