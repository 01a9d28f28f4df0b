# SPDX-License-Identifier: GPL-2.0-or-later
"""What a slide and a C axis have to do along a path, measured by small steps: no formula of it.

A path is a function from lengths to complex places; the tool stands ``beside`` the slide's line.
"""

import numpy as np

from g12.geometry.curve import Line

NEAR = 3e-4  # of where the slide stands: steps in which a rate is measured


def along(shape):
    """Return a shape, line or arc, as a path that goes on beyond its ends."""
    if isinstance(shape, Line):
        unit = (shape.end - shape.start) / shape.length
        return lambda at: shape.start + unit * np.asarray(at)
    arm, turn = shape.start - shape.centre, np.sign(shape.sweep) / shape.radius
    return lambda at: shape.centre + arm * np.exp(1j * turn * np.asarray(at))


def axes_of(places, beside=0.0):
    """Return where slide and C, in radians without a jump, have to be for places of the tool."""
    slide = np.sqrt(abs(places) ** 2 - beside**2)
    return slide, np.unwrap(np.angle(places) - np.arctan2(beside, slide))


def places_of(slide, angle, beside=0.0):
    """Return the places of the tool for where slide and C are, radians."""
    return (slide + 1j * beside) * np.exp(1j * angle)


def rates(path, at, beside=0.0):
    """Return the slide's place, and how it and C (radians) change per unit of the path."""
    slide, step, sides = _about(path, at, beside)
    there, angle = axes_of(path(sides), beside)
    return slide, np.diff(there)[..., 0] / (2 * step), np.diff(angle)[..., 0] / (2 * step)


def bend(path, at, beside=0.0):
    """Return by how much a straight move of slide and C curves more to the left than the path."""
    _, step, sides = _about(path, at, beside)
    there, angle = axes_of(path(sides), beside)
    heading = np.diff(path(sides))[..., 0]
    off = places_of(there.mean(axis=-1), angle.mean(axis=-1), beside) - path(at)
    return -2.0 * (off * np.conj(heading)).imag / abs(heading) / step**2


def _about(path, at, beside):
    """Return where the slide stands, a small step, and the lengths beside."""
    slide, _ = axes_of(path(np.asarray(at)[..., None]), beside)
    step = NEAR * slide[..., 0]
    return slide[..., 0], step, np.stack((at - step, at + step), axis=-1)
