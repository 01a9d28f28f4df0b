# SPDX-License-Identifier: GPL-2.0-or-later
"""A proof for programs to read: lengths in mm, areas in mm², feeds in mm/min."""

from __future__ import annotations

import json

from g12.tools.path.slowest import Pace
from g12.tools.units import MM
from g12.tools.verify.compare.drilled import HolesFacts
from g12.tools.verify.paragraphs import AXES, pocket_slowest_line
from g12.tools.verify.pocket import PocketFacts
from g12.tools.verify.proof import Proof
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.sections.section import SectionFacts
from g12.tools.verify.shape import ShapeFacts
from g12.tools.verify.workpiece import Workpiece


def as_json(proof: Proof) -> str:
    """Return the proof for a program to read: lengths in mm, areas in mm², feeds in mm/min."""
    return json.dumps(
        {
            "program": str(proof.opened.source if proof.opened else proof.subject.program),
            "ini": str(proof.subject.ini.path),
            "real": proof.subject.real is not None,
            "pockets": [pocket_json(facts, proof) for facts in proof.pockets],
            "sections": [section_json(facts, proof) for facts in proof.sections],
            "holes": [holes_json(facts) for facts in proof.holes],
            "shapes": [shape_json(facts) for facts in proof.shapes],
            "rapids": [judged_json(each, proof) for each in proof.material.rapids],
            "stock": proof.material.given and stock_json(proof.material.given),
            "unseen": [
                {"line": proof.user_line(line), "code": code} for line, code in proof.unseen
            ],
            "messages": [
                {"line": proof.user_line(message.line), "text": message.text}
                for message in proof.subject.trace.messages
            ],
            "still": [{"line": proof.user_line(line), "code": code} for line, code in proof.still],
            "findings": [judged_json(each, proof) for each in proof.judged if each.is_finding],
            "notes": [judged_json(each, proof) for each in proof.judged if each.is_note],
            "not_judged": [
                judged_json(each, proof)
                for each in proof.judged
                if not (each.is_finding or each.is_note)
            ],
            "good": not proof.findings,
        },
        indent=2,
    )


def judged_json(found: Finding, proof: Proof) -> dict:
    """Return a finding or a note as plain values, its sentence in mm."""
    return {
        "code": found.code,
        "line": proof.user_line(found.line, found.file),
        "file": found.file or None,
        "text": proof.text(found, MM),
        "place": None if found.place is None else [float(value) for value in found.place],
    }


def pocket_json(facts: PocketFacts, proof: Proof) -> dict:
    """Return one pocket as plain values."""
    source, wall = facts.target.source, facts.target.wall
    return {
        "line": proof.user_line(source.line, source.file),
        "file": source.file or None,
        "code": source.code,
        "dialect": source.dialect,
        "centre": [float(value) for value in wall.origin[:2]],
        "cutter": 2 * facts.target.cutter.radius,
        "radius": wall.radius,
        "reached": facts.reached,
        "deviation": finite(facts.deviation),
        "left": facts.left,
        "core": facts.target.wall.core,
        "rings": list(facts.rings),
        "square_to": AXES[wall.plane],
        "depths": [wall.height(depth) for depth in facts.target.depths],
        "entry": {"way": "helix", **facts.helix._asdict()} if facts.helix else {"way": "straight"},
        "stepover": facts.target.asked.stepover,
        "shortest": facts.lengths[0],
        "longest": facts.lengths[1],
        "off_circles": facts.off_rings,
        "off_path": facts.off_path,
        **pace_json(facts.pace, pocket_slowest_line(facts.pace, proof)),
    }


def section_json(facts: SectionFacts, proof: Proof) -> dict:
    """Return one section as plain values."""
    return {
        "lines": [facts.section.line, facts.section.last],
        "file": facts.section.file or None,
        "code": facts.section.code,
        "cutter": 2 * facts.tool,
        "surface": facts.section.surface or None,
        "zero_line": None if facts.section.surface else facts.zero,
        "x_words": "diameters" if facts.section.diameters else "radii",
        "lowest": facts.lowest,
        "along_z" if facts.section.surface else "radii": list(facts.size.wanted),
        "reached": list(facts.size.reached),
        "across_flats": [list(flat) for flat in facts.size.flats],
        "deviation": finite(facts.deviation),
        "direction_jump": facts.jump,
        "pieces": facts.pieces,
        "shortest": facts.shortest,
        "longest": facts.longest,
        "c_speed": facts.turns.speed,
        "c_limit": finite(facts.c_limit),
        "turned_in_place": facts.in_place._asdict(),
        **pace_json(facts.pace, facts.slowest_line),
    }


def shape_json(facts: ShapeFacts) -> dict:
    """Return one shape as plain values; its entries are in program units."""
    return {
        "line": facts.call.line,
        "file": facts.call.file or None,
        "code": facts.call.name,
        "cutter": 2 * facts.call.cutter,
        "entries": facts.call.given,
        "lowest": facts.lowest,
        "deviation": finite(facts.deviation),
    }


def holes_json(facts: HolesFacts) -> dict:
    """Return a call of holes as plain values."""
    holes, call = facts.holes, facts.holes.call
    return {
        "line": call.line,
        "file": call.file or None,
        "code": call.name,
        "circle": 2 * holes.circle,
        "angles": holes.angles,
        "along_z": holes.z if holes.side else None,
        "depth": holes.depth,
        "deviation": finite(facts.deviation),
    }


def stock_json(piece: Workpiece) -> dict:
    """Return the stock as plain values."""
    return {"text": piece.stock.text, "bounds": list(piece.shape.bounds), "top": piece.top}


def pace_json(pace: Pace, line: int) -> dict:
    """Return feed and time as plain values."""
    return {
        "lowest_feed": pace.lowest,
        "lowest_feed_at": [float(value) for value in pace.point],
        "lowest_feed_line": line,
        "seconds": pace.seconds,
        "seconds_programmed": pace.expected,
    }


def finite(value: float) -> float | None:
    """Return a number that JSON has."""
    return value if abs(value) < float("inf") else None
