# SPDX-License-Identifier: GPL-2.0-or-later
"""The handlers that the REMAP lines of `configs/include/` name: one or two per code."""

from __future__ import annotations

from interpreter import INTERP_OK

from . import host
from .haas import plan_pocket


def prepare_haas(interp: object, counterclockwise: bool) -> int:
    """Check a Haas G12/G13 block and hand its pocket to `ngc/g12_haas.ngc`."""
    pocket = plan_pocket(host.words_of_block(interp), host.snapshot(interp), host.SETTINGS.clearing)
    host.hand_over(
        interp,
        x=pocket.x,
        y=pocket.y,
        move_to_centre=pocket.move_to_centre,
        z=pocket.z,
        z_step=pocket.z_step,
        levels=pocket.levels,
        first_radius=pocket.first_radius,
        links=pocket.links,
        growth=pocket.first_grow / pocket.first_radius,
        shrink=pocket.shrink,
        keep=0.0 if pocket.z_step else pocket.first_radius / pocket.last_radius,
        rings=not pocket.spiral,
        arc=3 if counterclockwise else 2,
        hand=1 if counterclockwise else -1,
    )
    host.remember_radius(interp, pocket.cutter_radius)
    if pocket.message:
        host.message(pocket.message)
    return INTERP_OK


@host.handler
def g12_haas(self, **words):
    """Prolog of G12, clockwise circular pocket."""
    return prepare_haas(self, counterclockwise=False)


@host.handler
def g13_haas(self, **words):
    """Prolog of G13, counterclockwise circular pocket."""
    return prepare_haas(self, counterclockwise=True)


@host.handler
def cycle_done(self, **words):
    """Epilog of every cycle: the modes are again what the block found."""
    host.restore_modes(self)
    return INTERP_OK
