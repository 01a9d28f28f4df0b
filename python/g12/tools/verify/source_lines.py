# SPDX-License-Identifier: GPL-2.0-or-later
"""A proof of a filtered program with the lines of the file that the user wrote."""

from __future__ import annotations

from dataclasses import replace

from g12.tools.machine.filter import OpenedProgram
from g12.tools.preview.source_lines import trace_in_source
from g12.tools.verify.in_stock import StockFacts
from g12.tools.verify.pocket import PocketFacts
from g12.tools.verify.proof import Proof
from g12.tools.verify.section import SectionFacts


def proof_in_source(proof: Proof, opened: OpenedProgram) -> Proof:
    """Return a proof that names the user's file and its lines."""
    if not opened.is_filtered:
        return proof
    subject = proof.subject
    return replace(
        proof,
        subject=replace(
            subject, program=opened.source, trace=trace_in_source(subject.trace, opened)
        ),
        pockets=[_pocket(facts, opened) for facts in proof.pockets],
        sections=[_section(facts, opened) for facts in proof.sections],
        collisions=[replace(h, line=opened.source_line(h.line)) for h in proof.collisions],
        stock=proof.stock and _stock(proof.stock, opened),
        unseen=[(opened.source_line(line), code) for line, code in proof.unseen],
        still=[(opened.source_line(line), code) for line, code in proof.still],
    )


def _pocket(facts: PocketFacts, opened: OpenedProgram) -> PocketFacts:
    source = facts.target.source
    if source.file:
        return facts
    source = replace(source, line=opened.source_line(source.line))
    return replace(facts, target=replace(facts.target, source=source))


def _stock(facts: StockFacts, opened: OpenedProgram) -> StockFacts:
    lists = {
        name: tuple(each._replace(line=opened.source_line(each.line)) for each in values)
        for name, values in (("plunges", facts.plunges), ("standing", facts.standing))
    }
    hits = tuple(replace(hit, line=opened.source_line(hit.line)) for hit in facts.rapids)
    return replace(facts, rapids=hits, **lists)


def _section(facts: SectionFacts, opened: OpenedProgram) -> SectionFacts:
    line, section = opened.source_line, facts.section
    if section.file:
        return facts
    return replace(
        facts,
        section=replace(section, line=line(section.line), last=line(section.last)),
        slowest_line=line(facts.slowest_line),
        depth_off=facts.depth_off and facts.depth_off._replace(line=line(facts.depth_off.line)),
        feed_off=facts.feed_off and facts.feed_off._replace(line=line(facts.feed_off.line)),
        order_off=facts.order_off and facts.order_off._replace(line=line(facts.order_off.line)),
        act_off=facts.act_off and facts.act_off._replace(line=line(facts.act_off.line)),
        motion_off=tuple(off._replace(line=line(off.line)) for off in facts.motion_off),
    )
