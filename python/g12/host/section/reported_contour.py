# SPDX-License-Identifier: GPL-2.0-or-later
"""The report of a section: its contour as the elements of `g12.cut_report`."""

from __future__ import annotations

import os

import emccanon

from g12.compensation.contour import Contour, PlaneMove, Plunge
from g12.cut_report import CutElement, SectionCut, more_text, report_text
from g12.geometry.curve import Arc
from g12.host.interp import Interp
from g12.host.program_lines import running_file
from g12.host.reported import SECTION_BEGAN, asked, report_of
from g12.section.start import SectionStart


def begin_section(
    interp: Interp, start: SectionStart, contour: Contour, surface: float, diameters: bool
) -> None:
    """Report a section, or the part of it that follows M66; ``surface`` is 0 on the face."""
    memory = asked(interp)
    if memory is None:
        return
    elements = tuple(element for each in contour.elements if (element := _element(each)))
    if memory.get(SECTION_BEGAN):
        emccanon.COMMENT(more_text(elements))
        return
    memory[SECTION_BEGAN] = True
    cut = SectionCut(surface, diameters, elements)
    report = report_of(interp, start.location.code, start.location.line, start.words, cut)
    home = interp.filename
    report = report._replace(  # since the lines of the section were read other modes are in force
        file="" if home == running_file(interp) else os.path.basename(home),
        at=(start.x, interp.current_y, start.z, start.c),
        feed=start.modes.feed,
        per_revolution=start.modes.per_revolution,
        incremental=start.modes.incremental,
    )
    emccanon.COMMENT(report_text(report))


def _element(element: object) -> CutElement | None:
    if isinstance(element, PlaneMove):
        line, feed, offset, curve, z0, z1, side = element
        more = (curve.centre, curve.sweep) if isinstance(curve, Arc) else (None, 0.0)
        return CutElement(line, side, abs(offset), feed, z0, z1, curve.start, curve.end, *more)
    if isinstance(element, Plunge):
        return CutElement(element.line, 0, 0.0, element.feed, element.z0, element.z1)
    return None
