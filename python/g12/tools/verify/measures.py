# SPDX-License-Identifier: GPL-2.0-or-later
"""Every measure of a proof as plain values: lengths in mm, areas in mm², feeds in mm/min.

``--json`` prints them, ``--full`` puts them into the rows of ``report``; None is not known.
"""

from __future__ import annotations

import json
from dataclasses import asdict

from g12.tools.path.slowest import Pace
from g12.tools.units import MM, plain
from g12.tools.verify.compare.drilled import HolesFacts
from g12.tools.verify.pocket import PocketFacts
from g12.tools.verify.proof import Proof
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.sections.section import SectionFacts
from g12.tools.verify.sections.section_gain import times_of_section
from g12.tools.verify.shape import ShapeFacts
from g12.tools.verify.workpiece import Workpiece

AXES = "XYZ"
TURNS = {-1: "clockwise", 1: "counterclockwise"}
SIDES = {1: "left of the contour (G41)", -1: "right of the contour (G42)", 0: "on the contour"}


def as_json(proof: Proof) -> str:
    """Return the proof for a program to read."""
    kinds = {"findings": "is_finding", "notes": "is_note", "not_judged": "is_not_judged"}
    judged = {
        name: [judged_values(each, proof) for each in proof.judged if getattr(each, kind)]
        for name, kind in kinds.items()
    }
    values = {
        "program": str(proof.opened.source if proof.opened else proof.subject.program),
        "ini": str(proof.subject.ini.path),
        "real": proof.subject.real is not None,
        "pockets": [pocket_values(facts, proof) for facts in proof.pockets],
        "sections": [section_values(facts, proof) for facts in proof.sections],
        "holes": [holes_values(facts, proof) for facts in proof.holes],
        "shapes": [shape_values(facts, proof) for facts in proof.shapes],
        "rapids": [judged_values(each, proof) for each in proof.judged if "path" in each.values],
        "stock": proof.given and stock_values(proof.given),
        "unseen": [{"line": proof.user_line(line), "code": code} for line, code in proof.unseen],
        "messages": [
            {"line": proof.user_line(message.line), "text": message.text}
            for message in proof.subject.trace.messages
        ],
        "still": [{"line": proof.user_line(line), "code": code} for line, code in proof.still],
        **judged,
        "good": not judged["findings"],
    }
    return json.dumps(values, indent=2)


def judged_values(found: Finding, proof: Proof) -> dict:
    """Return a finding or a note as plain values, its sentence in mm."""
    return {
        "code": found.code,
        "line": proof.user_line(found.line, found.file),
        "file": found.file or None,
        "text": proof.text(found, MM),
        "place": None if found.place is None else [float(value) for value in found.place],
    }


def pocket_values(facts: PocketFacts, proof: Proof) -> dict:
    """Return the measures of one pocket."""
    target, wall, cutter = facts.target, facts.target.wall, facts.target.cutter
    reach, in_plane = max(facts.rings, default=0.0), wall.plane == AXES.index("Z")
    helix = facts.helix
    return {
        "line": proof.user_line(target.source.line, target.source.file),
        "file": target.source.file or None,
        "code": target.source.code,
        "dialect": target.source.dialect,
        "centre": [float(value) for value in wall.origin[:2]],
        "cutter": 2 * cutter.radius,
        "circle": {"word": cutter.word, "radius": cutter.circle} if cutter.word else None,
        "radius": wall.radius,
        "reached": facts.reached,
        "deviation": finite(facts.deviation),
        "left": facts.left,
        "core": wall.core or None,
        "rings": list(facts.rings),
        "turns": " and ".join(TURNS[turn] for turn in facts.turns),
        "square_to": AXES[wall.plane],
        "depths": [wall.height(depth) for depth in target.depths],
        "z": None if in_plane else [float(wall.origin[2]) + side for side in (-reach, reach)],
        "entry": {"way": "helix", **asdict(helix)} if helix else {"way": "straight"},
        "stepover": target.asked.stepover,
        "shortest": facts.lengths[0],
        "longest": facts.lengths[1],
        "off_circles": facts.off_rings,
        "off_path": facts.off_path,
        **pace_values(facts.pace),
        "lowest_feed_line": proof.user_line(proof.subject.trace.moves[facts.pace.move].block),
    }


def section_values(facts: SectionFacts, proof: Proof) -> dict:
    """Return the measures of one section; on a cylinder its sizes are along Z."""
    section, on_cylinder = facts.section, facts.section.surface > 0.0
    reading, modal = proof.subject.ini.settings.polar_x, "G7" if section.diameters else "G8"
    is_modal = on_cylinder or reading == "inherit"
    depth = section.surface - (facts.lowest - facts.start_height + section.height)
    x, c, z = facts.slowest_at
    times = times_of_section(facts.section, facts.path.expected, proof.subject.ini)
    return {
        "lines": [section.line, section.last],
        "file": section.file or None,
        "code": section.code,
        "cutter": 2 * facts.tool,
        "sides": " and ".join(SIDES[side] for side in facts.sides if side) or SIDES[0],
        "surface": section.surface or None,
        "starts_at": section.c if on_cylinder else None,
        "zero_line": None if on_cylinder else facts.zero,
        "x_words": "diameters" if section.diameters else "radii",
        "x_words_by": modal if is_modal else f"POLAR_X = {reading}",
        "lowest": facts.lowest,
        "below_surface": depth if on_cylinder else None,
        "along_z" if on_cylinder else "radii": list(facts.size.wanted),
        "reached": list(facts.size.reached),
        "across_flats": [list(flat) for flat in facts.size.flats],
        "deviation": finite(facts.deviation),
        "direction_jump": facts.jump,
        "segments": facts.segments,
        "shortest": facts.shortest,
        "longest": facts.longest,
        "c_speed": facts.turns.speed,
        "c_limit": finite(facts.c_limit),
        "turned_in_place": facts.turns.in_place._asdict(),
        **pace_values(facts.pace),
        "seconds_planned": times and times._asdict(),
        "lowest_feed_words": [
            ["X", 2 * x if section.diameters else x],
            ["C", plain(c, 3) if on_cylinder else c],
            ["Z", z],
        ],
        "lowest_feed_line": proof.user_line(facts.slowest_line, section.file),
    }


def shape_values(facts: ShapeFacts, proof: Proof) -> dict:
    """Return the measures of one shape; its entries are in program units."""
    call = facts.call
    return {
        "line": proof.user_line(call.line, call.file),
        "file": call.file or None,
        "code": call.name,
        "cutter": 2 * call.cutter,
        "entries": call.given,
        "lowest": facts.lowest,
        "deviation": finite(facts.deviation),
    }


def holes_values(facts: HolesFacts, proof: Proof) -> dict:
    """Return the measures of a call of holes."""
    holes, call = facts.holes, facts.holes.call
    return {
        "line": proof.user_line(call.line, call.file),
        "file": call.file or None,
        "code": call.name,
        "circle": 2 * holes.circle,
        "angles": holes.angles,
        "along_z": holes.z if holes.side else None,
        "depth": holes.depth,
        "deviation": finite(facts.deviation),
    }


def stock_values(workpiece: Workpiece) -> dict:
    """Return the stock as plain values."""
    return {
        "text": workpiece.stock.text,
        "bounds": list(workpiece.shape.bounds),
        "top": workpiece.top,
    }


def pace_values(pace: Pace) -> dict:
    """Return feed and time as plain values."""
    return {
        "lowest_feed": pace.lowest,
        "lowest_feed_at": [float(value) for value in pace.point],
        "seconds": pace.seconds,
        "seconds_programmed": pace.expected,
    }


def finite(value: float) -> float | None:
    """Return a number that JSON has."""
    return value if abs(value) < float("inf") else None
