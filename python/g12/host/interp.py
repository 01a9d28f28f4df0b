# SPDX-License-Identifier: GPL-2.0-or-later
"""The interpreter: names for its types and values, which its modules lack."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, TypeAlias, TypeVar

from g12.lengths import MM_PER_INCH
from g12.state import XY, XZ, YZ

Interp: TypeAlias = Any  # interpreter.Interp, with the package's state on it
ParsedBlock: TypeAlias = Any  # interpreter.block, as it was parsed
CanonModule: TypeAlias = Any  # the module emccanon, or a test's substitute
ToolTableEntry: TypeAlias = Any  # of the tool table
Kept = TypeVar("Kept")

G7 = 70
DIAMETER_ACTIVE = 15  # index of G7 and G8 in active_g_codes
INCH_UNITS = 1  # length_units
PER_MINUTE, INVERSE_TIME, PER_REVOLUTION = 0, 1, 2  # feed_mode
PLANE_CODES = {1: XY, 2: YZ, 3: XZ}  # plane
MOVE_WORDS = "ABCDHIJKRUVWXYZ"
WORD_FIELDS = {  # of a block: flag and value
    letter: (f"{letter.lower()}_flag", f"{letter.lower()}_number")
    for letter in "ABCDEFHIJKLPQRSTUVWXYZ"
} | {
    "D": ("d_flag", "d_number_float"),
    "@": ("radius_flag", "radius"),
    "^": ("theta_flag", "theta"),
}


def words_in(block: ParsedBlock, letters: Iterable[str]) -> dict[str, float]:
    """Return those of the words that a block has."""
    fields = ((letter, *WORD_FIELDS[letter]) for letter in letters)
    return {letter: getattr(block, value) for letter, flag, value in fields if getattr(block, flag)}


POSITION_FIELDS = {  # of the interpreter: the program's position
    "X": "current_x",
    "Y": "current_y",
    "Z": "current_z",
    "A": "AA_current",
    "B": "BB_current",
    "C": "CC_current",
    "U": "u_current",
    "V": "v_current",
    "W": "w_current",
}


def position_of(interp: Interp, letters: Iterable[str]) -> dict[str, float]:
    """Return the program's position by letter, X as a radius."""
    return {letter: getattr(interp, POSITION_FIELDS[letter]) for letter in letters}


def set_position(interp: Interp, letters: Iterable[str], values: Iterable[float]) -> None:
    for letter, value in zip(letters, values):
        setattr(interp, POSITION_FIELDS[letter], value)


WRAPPED = ("a_axis_wrapped", "b_axis_wrapped", "c_axis_wrapped")  # by WRAPPED_ROTARY in the INI


def wrapped_axes(interp: Interp) -> tuple[bool, ...]:
    """Return whether A, B and C are wrapped."""
    return tuple(bool(getattr(interp, name)) for name in WRAPPED)


def set_wrapped(interp: Interp, wrapped: Iterable[bool]) -> None:
    for name, value in zip(WRAPPED, wrapped):
        setattr(interp, name, value)


def diameter_active(interp: Interp) -> bool:
    """Return whether G7 is active: before the block, as all active codes."""
    return bool(interp.active_g_codes[DIAMETER_ACTIVE] == G7)


def millimetres_per_unit(interp: Interp) -> float:
    """Return the length of the program's unit."""
    return MM_PER_INCH if interp.length_units == INCH_UNITS else 1.0


def kept(interp: Interp, kind: type[Kept]) -> Kept:
    """Return the one value of its kind that lasts as long as the interpreter."""
    name = f"g12_{kind.__name__}"
    value = getattr(interp, name, None)
    if value is None:
        value = kind()
        setattr(interp, name, value)
    return value
