# SPDX-License-Identifier: GPL-2.0-or-later
"""A proof of a filtered program with the lines of the file that the user wrote."""

from __future__ import annotations

from dataclasses import replace

from g12.tools.machine.filter import OpenedProgram
from g12.tools.preview.source_lines import trace_in_source
from g12.tools.verify.pocket import PocketFacts
from g12.tools.verify.proof import Proof
from g12.tools.verify.section import SectionFacts


def proof_in_source(proof: Proof, opened: OpenedProgram) -> Proof:
    """Return a proof that names the user's file and its lines."""
    if not opened.lines:
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
        unseen=[(opened.source_line(line), code) for line, code in proof.unseen],
    )


def _pocket(facts: PocketFacts, opened: OpenedProgram) -> PocketFacts:
    source = facts.target.source
    if source.file:
        return facts
    source = replace(source, line=opened.source_line(source.line))
    return replace(facts, target=replace(facts.target, source=source))


def _section(facts: SectionFacts, opened: OpenedProgram) -> SectionFacts:
    section = facts.section
    first, last = opened.source_line(section.line), opened.source_line(section.last)
    return replace(facts, section=replace(section, line=first, last=last))
