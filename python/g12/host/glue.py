# SPDX-License-Identifier: GPL-2.0-or-later
"""The interpreter, touched here: snapshot, hand-over to NGC, refusals.

(Cycles go through it alone. `section` and its neighbours read on for polar interpolation.)
Facts about the interpreter that the code relies on stand beside the line that does.
"""

from __future__ import annotations

import functools
import itertools
import sys
from pathlib import Path

import emccanon
from interpreter import INTERP_ERROR

from g12.cycles.context import XY, XZ, YZ, Context, Tool
from g12.cycles.words import Words
from g12.errors import LONGEST_MESSAGE, Refusal
from g12.lengths import MM_PER_INCH
from g12.settings import Settings, settings_from_environment


def settings_at_start() -> tuple[Settings, Refusal | None]:
    """Return section [G12], and the start-up error if it cannot be used.

    The operator sees the error when LinuxCNC comes up, and every code of the package refuses
    with it. (An exception here would stop LinuxCNC with an empty message on the screen.)
    """
    try:
        return settings_from_environment(), None
    except Refusal as refusal:
        say_at_start(refusal)
        return Settings(), refusal


def say_at_start(refusal: Refusal) -> None:
    """Tell the operator, when LinuxCNC comes up, what cannot work."""
    print(f"g12: {refusal}", file=sys.stderr)
    emccanon.CANON_ERROR(f"g12: {refusal}")


SETTINGS, START_ERROR = settings_at_start()


def refuse_start_error() -> None:
    """Refuse every code after a start-up error, with its message."""
    if START_ERROR:
        raise Refusal(START_ERROR.message)


# indices into a block's g_modes
MODAL_0, TOOL_LENGTH, PATH_CONTROL, SPINDLE, DIAMETER = 0, 8, 13, 14, 15
NO_CODE = -1
READING_WORDS = (
    (TOOL_LENGTH, 430, "H"),
    (TOOL_LENGTH, 431, "XYZABCUVW"),
    (TOOL_LENGTH, 432, "HXYZABCUVW"),
    (PATH_CONTROL, 640, "PQ"),
    (SPINDLE, 960, "D"),
)
M_GROUPS = 11
HARMLESS_M = (NO_CODE, 0, 1, 2, 3, 4, 5, 7, 8, 9, 30, 48, 49, 60)
DIAMETER_ACTIVE = 15  # index into active_g_codes
G7 = 70
INCREMENTAL = 1  # distance_mode and ijk_distance_mode: 0 absolute, 1 incremental
INVERSE_TIME, PER_REVOLUTION = 1, 2  # feed_mode
INCH = 1  # length_units
PLANES = {1: XY, 2: YZ, 3: XZ}

# every word a block can carry besides F, S, T, N, M and O, which the interpreter deals with
LETTERS = "ABCDEHIJKPQRUVWXYZ"
WORD_FIELDS = [
    (
        letter,
        f"{letter.lower()}_flag",
        "d_number_float" if letter == "D" else f"{letter.lower()}_number",
    )
    for letter in LETTERS
]
NO_L = -1  # a block's l_number without an L word


class CycleState:
    """What the package remembers of one interpreter; it lives on the interpreter object.

    ``modes`` are those a cycle found and has to put back; ``radius_commanded`` tells a D of
    radius 0 from no D at all, which the interpreter's own last compensation radius cannot.
    ``first_plane`` is the circle mill's modal reference plane in mm and the program that
    commanded it, as it was then.
    """

    def __init__(self) -> None:
        self.modes: tuple[int, int, int, bool] = (0, 0, 0, False)
        self.radius_commanded = False
        self.first_plane: tuple[float, tuple[str, int] | None] | None = None


def state_of(interp: object) -> CycleState:
    """Return the package's state of this interpreter."""
    try:
        return interp.g12_state
    except AttributeError:
        interp.g12_state = CycleState()
        return interp.g12_state


def refuse_block(interp: object, error: Exception) -> int:
    """Tell the operator why the block being remapped is not executed; return the error status.

    Raising or returning a string would not do: LinuxCNC shows "pycall(...) failed" instead. It
    hands a failed execute over as a SystemError, whose own text stands already.
    """
    if isinstance(error, Refusal):
        interp.set_errormsg(error.message)
    elif not isinstance(error, SystemError):
        sys.excepthook(type(error), error, error.__traceback__)
        text = f"g12: a fault of the package, please report it: {type(error).__name__}: {error}"
        interp.set_errormsg(text[:LONGEST_MESSAGE])
    return INTERP_ERROR


def handler(function):
    """Turn an exception of a remap handler into the operator's message."""

    @functools.wraps(function)
    def guarded(self, **words):
        try:
            refuse_start_error()
            return function(self, **words)
        except Exception as error:
            return refuse_block(self, error)

    return guarded


def code_of_block(interp: object) -> str:
    """Return the remapped code as the operator wrote it: ``G12``, ``G12.2``."""
    return interp.blocks[interp.remap_level].executing_remap.name.upper()


def words_of_block(interp: object) -> Words:
    """Return the words of the block being remapped; refuse a second code that reads them."""
    block = interp.blocks[interp.remap_level]
    values = {
        letter: getattr(block, field) for letter, flag, field in WORD_FIELDS if getattr(block, flag)
    }
    if block.l_number != NO_L:
        values["L"] = block.l_number
    if block.radius_flag:
        values["@"] = block.radius
    if block.theta_flag:
        values["^"] = block.theta
    words = Words(code_of_block(interp), values)
    other = code_reading_words(block, words)
    if other:
        raise words.refuse(f"{other} cannot stand in the same block")
    return words


def code_reading_words(block: object, words: Words) -> str | None:
    """Return a code of the block that would read a word of the cycle too, or change its tool.

    (The interpreter knows the tool that M6 brings only behind the block.)
    """
    g_modes = block.g_modes
    if g_modes[MODAL_0] != NO_CODE:
        return f"G{g_modes[MODAL_0] / 10:g}"
    for group, code, letters in READING_WORDS:
        if g_modes[group] == code and any(letter in words for letter in letters):
            return f"G{code / 10:g}"
    if block.m_count:
        for group in range(M_GROUPS):
            if block.m_modes[group] not in HARMLESS_M:
                return f"M{block.m_modes[group]}"
    return None


def entries_of_call(interp: object, sub: str, count: int) -> list[float] | None:
    """Return the entries of ``o<sub> call`` if the code stands alone in that sub, else None.

    The frame of the remap is on top of the sub's; #1 to #30 are still the sub's in a prolog.
    """
    if interp.sub_context[interp.call_level - 1].subname != sub:
        return None
    return [interp.params[index] for index in range(1, count + 1)]


def program_units_per_machine_unit(interp: object) -> float:
    """Return the factor from INI file and tool table lengths to the program's."""
    return millimetres_per_machine_unit() / millimetres_per_unit(interp)


def millimetres_per_machine_unit() -> float:
    """Return the machine's unit in mm."""
    return 1 / emccanon.GET_EXTERNAL_LENGTH_UNITS()


def tool_from_entry(interp: object, entry: object) -> Tool:
    """Return a tool table entry's number and radius in program units."""
    return Tool(entry.toolno, entry.diameter / 2 * program_units_per_machine_unit(interp))


def tool_in_spindle(interp: object) -> Tool | None:
    """Return the loaded tool, None if there is none."""
    entry = interp.tool_table[0]
    return tool_from_entry(interp, entry) if entry.toolno > 0 else None


def tool_in_table(interp: object, tool_number: int) -> Tool | None:
    """Return the tool of that number from the tool table, None if it is not there.

    The table is in the order of the tool file; `find_tool_pocket` would give the pocket, which
    is another number. Place 0 is the spindle, with a random tool changer the tool's only place.
    """
    table = interp.tool_table
    for place in itertools.chain(range(1, len(table)), (0,)):
        entry = table[place]
        if entry.toolno == tool_number:
            return tool_from_entry(interp, entry)
    return None


def last_radius(interp: object) -> float | None:
    """Return the cutter radius of the last D commanded, by a cycle or by G41/G42.

    The interpreter keeps its compensation radius after G40 and converts it with G20/G21, and
    the cycles store their D there too: one register, as on the control.
    """
    state, radius = state_of(interp), interp.cutter_comp_radius
    state.radius_commanded = state.radius_commanded or radius > 0
    return radius if state.radius_commanded else None


def remember_radius(interp: object, radius: float) -> None:
    """Store the cutter radius of a D word as the last commanded."""
    interp.cutter_comp_radius = radius
    state_of(interp).radius_commanded = True


def main_program(interp: object) -> tuple[str, int] | None:
    """Return the file at the bottom of the call stack and when it was last written.

    In MDI it is the one that is open, if any.
    """
    name = interp.filename if interp.call_level < 2 else interp.sub_context[0].filename
    try:
        return name, Path(name).stat().st_mtime_ns
    except (OSError, TypeError):
        return None


def millimetres_per_unit(interp: object) -> float:
    """Return the program's unit in mm."""
    return MM_PER_INCH if interp.length_units == INCH else 1.0


def first_plane(interp: object) -> float | None:
    """Return the circle mill's first reference plane as last commanded by this program.

    Another program's, or that of a text since edited, would send the tool to a height that this
    one never mentions.
    """
    plane = state_of(interp).first_plane
    if plane is None or plane[1] != main_program(interp):
        return None
    return plane[0] / millimetres_per_unit(interp)


def remember_first_plane(interp: object, height: float) -> None:
    """Store the first reference plane as the last commanded."""
    plane = height * millimetres_per_unit(interp), main_program(interp)
    state_of(interp).first_plane = plane


def snapshot(interp: object) -> Context:
    """Return what the block finds: modes, units, position, tools."""
    return Context(
        inch=interp.length_units == INCH,
        x=interp.current_x,
        y=interp.current_y,
        z=interp.current_z,
        incremental=interp.distance_mode == INCREMENTAL,
        plane=PLANES.get(interp.plane, "G17.1, G18.1 or G19.1"),
        inverse_time=interp.feed_mode == INVERSE_TIME,
        per_revolution=per_revolution(interp),
        speed=spindle_speed(interp),
        feed=interp.feed_rate,
        compensated=interp.cutter_comp_side != 0,
        offset_pending=bool(interp.arc_not_allowed),
        spindle_tool=tool_in_spindle(interp),
        last_radius=last_radius(interp),
        tool_in_table=functools.partial(tool_in_table, interp),
    )


def spindle_speed(interp: object) -> float:
    """Return the commanded speed of the spindle in use."""
    return interp.speed[feed_spindle(interp)]


def feed_spindle(interp: object) -> int:
    """Return the number of the spindle in use, to which feeds per revolution refer.

    LinuxCNC leaves it unset until a block names one with $.
    """
    spindle = interp.active_spindle
    return spindle if 0 <= spindle < interp.num_spindles else 0


def per_revolution(interp: object) -> bool:
    """Tell whether feeds are per revolution (G95)."""
    return interp.feed_mode == PER_REVOLUTION


def traverse_feed(interp: object) -> float:
    """Return the feed per minute of Yasnac's fast moves in program units, 0 for rapids."""
    return SETTINGS.yasnac_traverse * program_units_per_machine_unit(interp)


def diameter_mode(interp: object) -> bool:
    """Tell whether G7 is active (the active codes are those before this block)."""
    commanded = interp.blocks[interp.remap_level].g_modes[DIAMETER]
    return (interp.active_g_codes[DIAMETER_ACTIVE] if commanded == -1 else commanded) == G7


def hand_over(interp: object, **locals_: float) -> None:
    """Set the named locals of the NGC sub that is about to run, and note the modes it finds."""
    params = interp.params
    for name, value in locals_.items():
        params[name] = value
    state_of(interp).modes = (
        interp.motion_mode,
        interp.distance_mode,
        interp.ijk_distance_mode,
        diameter_mode(interp),
    )


def restore_modes(interp: object) -> None:
    """Put back the modes the block found: motion, G90/G91, G90.1/G91.1, G7/G8."""
    motion, distance, centre, diameter = state_of(interp).modes
    interp.motion_mode = motion
    # a block after the assignment, or the active codes shown would still be the cycle's
    interp.execute(f"G{90 + distance} G{90 + centre}.1 G{7 if diameter else 8}")


def message(text: str) -> None:
    """Show the operator a message that is no error."""
    emccanon.MESSAGE(text)
