# SPDX-License-Identifier: GPL-2.0-or-later
"""What a cycle, a section, a shape or holes change in interpreter and machine, and its return.

Each of them takes one value, `Saved`, before its first change (`begin`) and restores it whole
(`give_back`). If that end never comes, the abort handler restores it (`after_abort`), which
LinuxCNC calls by [RS274NGC] ON_ABORT_COMMAND. Without one, the next code of the package restores
what no operator sees and no code commands (`settle_interrupted`). All else stays: a program or an
operator may have commanded it anew since, and with the same values.

The values are a stack: a shape's section begins and ends inside the shape.
"""

from __future__ import annotations

from math import isclose
from typing import NamedTuple

from g12.host import kinematics_switch
from g12.host.interp import (
    G7,
    PER_MINUTE,
    PER_REVOLUTION,
    PLANE_CODES,
    Interp,
    diameter_active,
    kept,
    millimetres_per_unit,
    set_wrapped,
    wrapped_axes,
)
from g12.section.block_rules import NO_CODE, GGroup
from g12.section.effects import SectionModes, decimal

PATH_ACTIVE = 11  # index into active_g_codes
G64 = 640
TOLERANCE, MERGING = 3, 4  # indices into active_settings: P and Q of G64
ADAPTIVE_ACTIVE, ADAPTIVE_FEED = 7, 52  # index into active_m_codes, and M52 there
# Seconds: where the machine is off, by an emergency stop, a limit switch or a command, LinuxCNC
# aborts once more, in one of the next cycles, and drops what the first abort has queued.
ABORTED_AGAIN = 0.5


class Saved(NamedTuple):
    """The modes before the change; lengths in the program unit of then, ``unit`` mm."""

    motion: int  # the code that bare words repeat
    distance: int  # of G90 or G91
    centres: int  # of G90.1 or G91.1
    diameter: bool  # G7
    plane: str
    feed_mode: int
    feed: float
    path: str  # G61, G61.1 or G64
    blending: tuple[float, float]  # P and Q of the last G64
    adaptive: bool  # M52
    spindle: int  # in use, which $ names
    wrapped: tuple[bool, ...]  # WRAPPED_ROTARY of A, B and C
    accelerations: tuple[float, ...]  # of X and Y by HAL pins, on a machine with the face
    unit: float

    @property
    def path_block(self) -> str:
        """The block that commands the path control."""
        return _blending_block(self) if self.path == "G64" else self.path

    def commanding(self, section: SectionModes) -> Saved:
        """Return the value with the modes that the lines of a section have commanded."""
        return self._replace(
            motion=section.motion,
            distance=int(section.incremental),
            feed_mode=PER_REVOLUTION if section.per_revolution else PER_MINUTE,
            feed=section.feed,
        )

    def on_the_face_of(self, other: Saved) -> Saved:
        """Return the value with those of another one that the switch to the face changes."""
        return self._replace(
            plane=other.plane,
            centres=other.centres,
            adaptive=other.adaptive,
            accelerations=other.accelerations,
        )


def modes_in_force(interp: Interp) -> Saved:
    """Return the modes in force."""
    active, settings = interp.active_g_codes, interp.active_settings
    return Saved(
        motion=interp.motion_mode,
        distance=interp.distance_mode,
        centres=interp.ijk_distance_mode,
        diameter=diameter_active(interp),
        plane=PLANE_CODES.get(interp.plane, ""),
        feed_mode=interp.feed_mode,
        feed=interp.feed_rate,
        path=f"G{active[PATH_ACTIVE] / 10:g}",
        blending=(settings[TOLERANCE], settings[MERGING]),
        adaptive=interp.active_m_codes[ADAPTIVE_ACTIVE] == ADAPTIVE_FEED,
        spindle=interp.active_spindle,
        wrapped=wrapped_axes(interp),
        accelerations=kinematics_switch.accelerations(interp),
        unit=millimetres_per_unit(interp),
    )


def restore(interp: Interp, saved: Saved, *, feed_set: bool = True) -> None:
    """Bring all modes back; the last block makes LinuxCNC show those that were only set.

    ``feed_set``: canonical calls may have set the feed, which the interpreter does not know.
    """
    set_wrapped(interp, saved.wrapped)
    interp.active_spindle, interp.motion_mode = saved.spindle, saved.motion
    _command(interp, saved)
    kinematics_switch.set_accelerations(saved.accelerations)
    feed = saved.feed * _scale(interp, saved)
    if feed_set or not isclose(feed, interp.feed_rate):  # a user may have remapped F
        interp.execute(f"F{decimal(feed)}")
    else:
        interp.execute(f"G{90 + saved.distance}")


def command_adaptive(interp: Interp, saved: Saved) -> None:
    """Command adaptive feed even if the interpreter has it: the planner may not."""
    interp.execute(f"M52P{saved.adaptive:d}")


def restore_before_face(interp: Interp, saved: Saved) -> None:
    """Bring back the modes that the face needs otherwise, at its end."""
    _command(interp, modes_in_force(interp).on_the_face_of(saved))


def _command(interp: Interp, saved: Saved) -> None:
    for block in missing_modes(interp, saved):
        interp.execute(block)


def missing_modes(interp: Interp, saved: Saved) -> list[str]:
    """Return the blocks that bring back the modes which are not as they were, F apart."""
    now = modes_in_force(interp)
    codes = [code for code, in_force in zip(_codes(saved), _codes(now)) if code != in_force]
    return _path_blocks(now, saved, _scale(interp, saved)) + codes


def _path_blocks(now: Saved, saved: Saved, scale: float) -> list[str]:
    """Return the blocks that bring back the path control, and P and Q of G64 under G61 too."""
    blending = _blending_block(saved, scale)
    blocks = [] if _blending_block(now) == blending else [blending]
    if saved.path != ("G64" if blocks else now.path):
        blocks.append(blending if saved.path == "G64" else saved.path)
    return blocks


def _codes(saved: Saved) -> tuple[str, ...]:
    return (
        saved.plane,
        f"M52P{saved.adaptive:d}",
        "G95" if saved.feed_mode == PER_REVOLUTION else "G94",
        f"G{90 + saved.distance}",
        f"G{90 + saved.centres}.1",
        f"G{7 if saved.diameter else 8}",
    )


def _blending_block(saved: Saved, scale: float = 1.0) -> str:
    p, q = (decimal(scale * value) for value in saved.blending)
    return f"G64P{p}Q{q}"


def _scale(interp: Interp, saved: Saved) -> float:
    """Return the factor from lengths of the value to lengths of the program now."""
    return saved.unit / millimetres_per_unit(interp)


# Begin and end.


class Borrowed:
    """The values to restore, and the one that an abort has restored, with its time in seconds."""

    def __init__(self) -> None:
        self.stack: list[Saved] = []
        self.aborted: tuple[float, Saved | None] = (0.0, None)


def _stack(interp: Interp) -> list[Saved]:
    return kept(interp, Borrowed).stack


def saved_modes(interp: Interp) -> Saved:
    """Return the value of the one that has begun last."""
    return _stack(interp)[-1]


def begin(interp: Interp) -> None:
    """Take the value before the first change."""
    saved = _with_block(interp, modes_in_force(interp))
    _stack(interp).append(saved)


def _with_block(interp: Interp, saved: Saved) -> Saved:
    """Return the value with those codes of the block being remapped that are not yet active."""
    codes = interp.blocks[interp.remap_level].g_modes
    if codes[GGroup.DIAMETER] != NO_CODE:
        saved = saved._replace(diameter=codes[GGroup.DIAMETER] == G7)
    path = codes[GGroup.PATH_CONTROL]
    if path == G64:  # without a tolerance, whose words would be the remapped code's
        saved = saved._replace(blending=(0.0, 0.0))
    return saved if path == NO_CODE else saved._replace(path=f"G{path / 10:g}")


def renew(interp: Interp, saved: Saved) -> Saved:
    """Replace the value: the program itself has commanded other modes since `begin`."""
    _stack(interp)[-1] = saved
    return saved


def give_back(interp: Interp) -> None:
    restore(interp, saved_modes(interp), feed_set=False)
    forget(interp)


def forget(interp: Interp) -> None:
    """Drop the value, whose modes are back."""
    _stack(interp).pop()


# Where the end never comes.


def settle_interrupted(interp: Interp) -> str:
    """Restore what an interrupted borrower left and no code commands; return the other modes.

    An operator or a program may have commanded those anew, with the same values.
    """
    stack = _stack(interp)
    if not stack:
        return ""
    left = stack[0]
    stack.clear()
    set_wrapped(interp, left.wrapped)
    kinematics_switch.set_accelerations(left.accelerations)
    return " ".join(missing_modes(interp, left))


def restore_left(interp: Interp) -> None:
    """Restore all that an interrupted borrower left, in the planner too."""
    stack = _stack(interp)
    if stack:
        _restore_interrupted(interp, stack[0])
        stack.clear()
    _command_dropped(interp)


def _restore_interrupted(interp: Interp, saved: Saved) -> None:
    restore(interp, saved)
    if saved.accelerations:  # the face has M52 on
        command_adaptive(interp, saved)


def after_abort(interp: Interp, now: float) -> None:
    """Restore all that the aborted borrower changed, in the planner too; ``now`` in seconds."""
    borrowed = kept(interp, Borrowed)
    if borrowed.stack:
        borrowed.aborted = now, borrowed.stack[0]
        borrowed.stack.clear()
    at, saved = borrowed.aborted
    if saved and now - at < ABORTED_AGAIN:
        _restore_interrupted(interp, saved)
    _command_dropped(interp)


def _command_dropped(interp: Interp) -> None:
    """Command path control and F in force, even if the interpreter has them.

    It may have been ahead of the abort, past the end of a section, with nothing left to restore.
    But LinuxCNC has dropped the blocks that it had queued: the planner may never have had them.
    """
    if not interp.cutter_comp_side:  # under compensation LinuxCNC refuses it, and no code borrows
        interp.execute(modes_in_force(interp).path_block)
    if interp.feed_rate:
        interp.execute(f"F{decimal(interp.feed_rate)}")
