# SPDX-License-Identifier: GPL-2.0-or-later
"""The process of ``trace.Tracer``: LinuxCNC's preview interpreter on a socket.

It imports nothing of the package, because the machine's INI decides which copy of ``g12`` the
interpreter imports. A request is a line of JSON with ``program``, ``setup`` and ``parameter_file``,
the answer lines of moves and one of the rest of a Trace.  Every program gets a new interpreter
object, as in a GUI that opens a program again.
"""

import bisect
import ctypes
import json
import math
import os
import re
import select
import shutil
import signal
import socket
import traceback
from collections.abc import Sequence
from typing import IO

INCH = 25.4  # mm; the preview reports inches
FRESH, START = "G12 TRACE SET-UP", "G12 TRACE STARTS HERE"
NO_TOOL = (-1, *[0.0] * 12, 0)  # no tool yet
UNLOADED = (0, *[0.0] * 12, 0)  # after T0 M6
Position = tuple[float, float, float, float, float, float, float, float, float]  # XYZABCUVW
NO_OFFSET = (0.0,) * 9
LINEAR_AXES = (0, 1, 2, 6, 7, 8)
CURRENT = (
    "current_x", "current_y", "current_z", "AA_current", "BB_current", "CC_current",
    "u_current", "v_current", "w_current",
)  # fmt: skip
MOVES_OF_LINE = 1000
CART_FUZZ = 1e-8  # mm, of the same name in LinuxCNC, which ignores shorter moves
INCHES, METRIC = 1, 2
ASKED, CUT, MORE, END = "g12_reports", "g12 cut ", "g12 more ", "g12 end"  # `g12.cut_report`
PACKAGE, CLAMP_COMMENT = "g12 ", "g12 clamp "  # of `tracer`
MEANINGS_CHANGED = "g12: the axes mean something else now, acceleration "  # `g12.host`, a share
PLANE_NUMBERS = {1: 17, 2: 19, 3: 18}
UVW_PLANES = {4: "G17.1", 5: "G19.1", 6: "G18.1"}
ARC_AXES = {17: (0, 1, 2), 18: (2, 0, 1), 19: (1, 2, 0)}  # first, second, third axis
PR_SET_PDEATHSIG = 1  # of Linux: the signal a process gets when its parent dies
CALL_BY_M98, CALL_OF_REMAP = 2, 4  # call_type of a frame
M98 = re.compile(rb"M98(?!\d)")
COMMENT_OR_BLANK = re.compile(rb"\(.*?\)|;.*|\s")
STATE_VARIABLES = (
    "motion_mode", "plane", "length_units", "distance_mode", "ijk_distance_mode", "feed_mode",
    "feed_rate", "retract_mode", "cutter_comp_side", "cutter_comp_radius", "origin_index",
    "rotation_xy", "current_x", "current_y", "current_z", "AA_current", "BB_current",
    "CC_current", "current_tool", "call_level", "remap_level",
    "axis_offset_x", "axis_offset_y", "axis_offset_z", "CC_axis_offset",
)  # fmt: skip
LENGTH_GROUP = 8  # index of G43, G43.1, G43.2 and G49 in a block's G codes
LENGTH_CODE, SPINDLE_MODE = 9, 13  # indices of G43, G49 and of G96, G97 in the active G codes
PITCH_WORD = {330: "k_number", 331: "k_number", 760: "p_number"}  # of G33, G33.1, G76
BY_MACHINE = (280, 300, 530)
FEED_DECIMALS = 12
G91_ACTIVE = 1  # distance_mode
INVERSE_TIME = 1  # index in FEED_MODES: each block has an F of its own
FEED_MODE_CODES = ("G94", "G93", "G95")
CONTINUOUS = 3  # CANON_CONTINUOUS: G64
TOOL_FUNCTIONS = {  # with their types as C++ names them
    "tooldata_init": "b",
    "tool_mmap_creator": "PK13EMC_TOOL_STATi",
    "tooldata_reset": "v",
    "tooldata_load": "PKcPPc",
    "tooldata_last_index_get": "v",
    "tooldata_get": "P16CANON_TOOL_TABLEi",
}


def tool_library() -> dict:
    """Return LinuxCNC's functions for tool tables by their names in C, which 2.9 lacks.

    Of several libraries on a computer it is the one that the interpreter has loaded.
    """
    import gcode  # noqa: F401

    library = ctypes.CDLL("libtooldata.so.0")
    return {
        name: getattr(library, name if hasattr(library, name) else f"_Z{len(name)}{name}{types}")
        for name, types in TOOL_FUNCTIONS.items()
    }


class ToolEntry(ctypes.Structure):
    """LinuxCNC's record of one tool, with room for fields of later versions."""

    _fields_ = (
        ("number", ctypes.c_int),
        ("pocket", ctypes.c_int),
        ("offset", ctypes.c_double * 9),
        ("diameter", ctypes.c_double),
        ("angles", ctypes.c_double * 2),
        ("orientation", ctypes.c_int),
        ("reserve", ctypes.c_char * 512),
    )


def load_tools(table: str, random: bool) -> list[tuple]:
    """Load a tool table in LinuxCNC's shared form, which the interpreter looks tools up in.

    Return its records in the preview's form.
    """
    library = tool_library()
    library["tooldata_init"](ctypes.c_bool(random))
    library["tool_mmap_creator"](None, int(random))
    library["tooldata_reset"]()
    if library["tooldata_load"](table.encode(), None):
        raise ValueError(f"{table}: LinuxCNC cannot read this tool table")
    entries = [ToolEntry() for _ in range(library["tooldata_last_index_get"]() + 1)]
    for index, entry in enumerate(entries):
        library["tooldata_get"](ctypes.byref(entry), index)
    return [(e.number, *e.offset, e.diameter, *e.angles, e.orientation) for e in entries]


class Lines:
    """Finds the line of the program itself that is being executed, at any call level."""

    def __init__(self, program: str) -> None:
        self._program = program
        with open(program, "rb") as file:
            text = file.read()
        self._ends = [match.start() for match in re.finditer(b"\n", text)]
        self._lines = text.split(b"\n")

    def now(self, line: int = 0) -> int:
        """Return the program's line during execution; ``line`` is that of a move, in its own file.

        The interpreter has none for the remainder of a block, after its remapped M code. Under
        compensation it emits a move while it executes the next block.
        """
        this = interpreter_object()
        if not this.call_level:
            return self._of_remap(this) if this.remap_level else line or this.sequence_number
        if this.sub_context[1].call_type == CALL_OF_REMAP:
            own = this.filename == self._program and this.sequence_number  # a remap may set it
            return own or self._of_remap(this)
        return self._of_call(this)

    def of_error(self) -> int:
        """Return the program's line after an error, when the interpreter has unwound all calls.

        A remap in progress is still marked in block 1. The interpreter loses the line of a remap,
        but not its offset in the file.
        """
        this = interpreter_object()
        in_remap = this.blocks[1].executing_remap is not None
        if in_remap and this.sub_context[1].call_type == CALL_OF_REMAP:
            return self._of_remap(this)
        return this.sequence_number

    def remap(self) -> str:
        """Return the remapped code that makes the present motion, in upper case, "" without one.

        It has a call; the remainder of a block, after its remapped M code, has none.
        """
        this = interpreter_object()
        calls = (this.sub_context[level].call_type for level in range(1, this.call_level + 1))
        level = sum(call == CALL_OF_REMAP for call in calls)
        return this.blocks[level].executing_remap.name.upper() if level else ""

    def _of_remap(self, this) -> int:
        return bisect.bisect_left(self._ends, this.blocks[1].offset) + 1

    def _of_call(self, this) -> int:
        """Return the line of a call: LinuxCNC counts one less while M98 L is to be repeated."""
        line, sub = this.sub_context[0].sequence_number, this.sub_context[1]
        if sub.call_type != CALL_BY_M98 or self._calls(line, sub.subname):
            return line
        return line + 1

    def _calls(self, line: int, sub: str) -> bool:
        """Return whether a line calls a numbered sub by M98, or may, with an expression."""
        text = COMMENT_OR_BLANK.sub(b"", b"".join(self._lines[line - 1 : line])).upper()
        number = re.search(rb"P(\d+)", text)
        return bool(M98.search(text)) and (not number or int(number[1]) == int(sub))


class Canon:
    """Records the interpreter's canonical calls, in mm and machine coordinates."""

    def __init__(self, machine: dict, tools: list[tuple], request: dict) -> None:
        self.machine, self.tools = machine, list(tools)
        self.parameter_file = request["parameter_file"]
        self.lines = Lines(request["program"])
        self.started = False
        self.refused: tuple[str, int] | None = None  # what cannot be traced, and the line
        self.moves: list[tuple] = []
        self.events: list[tuple] = []
        self.in_force: tuple = ()
        self.reports = machine.get("reports")
        self.cuts: list[list] = []  # first move, end, line, last line, C before, comments
        self.open_cuts = 0
        self.c_commanded = ""
        self.tables: list[tuple[int, list]] = []
        self.pitch = ""
        self.line = 0
        self.on_face = False  # on the face, where Y is the tool's
        self.share = 1.0  # of the INI's accelerations of X and Y there
        self.position: tuple[float, ...] = ()  # of the tip, in machine coordinates, from the start
        self.work = self.g92 = self.length = NO_OFFSET
        self.length_code = 490  # ten times the G code that set it
        self.rotation, self.cos, self.sin = 0.0, 1.0, 0.0
        self.plane = 17
        self.feed = self.program_feed = 0.0
        self.modal_feed, self.units = 0.0, INCHES  # F and its units
        self.index, self.spindle = 0, NO_TOOL

    # Queries by the interpreter.

    def get_external_angular_units(self) -> float:
        return 1.0

    def get_external_length_units(self) -> float:
        return self.machine["units"]

    def get_axis_mask(self) -> int:
        return self.machine["axis_mask"]

    def get_block_delete(self) -> bool:
        """Return True: blocks that begin with / are skipped, as a fresh LinuxCNC does."""
        return True

    def check_abort(self) -> bool:
        """Return False: no abort during interpretation."""
        return False

    def get_tool(self, index: int) -> tuple:
        """Return a record of the tool table; index 0 is the spindle.

        The interpreter reads all of them, that of the spindle first, when it starts, after M6, M61
        and G10 L0, each time right after its position.
        """
        if not index:
            if self.position:
                self._correct_position()
                self._load(interpreter_object().current_pocket)
            return self.spindle
        return self.tools[index] if index < len(self.tools) else NO_TOOL

    # State reported by the interpreter.

    def next_line(self, state) -> None:
        line = state.sequence_number
        self.line = line if line >= 0 else self.lines.now()  # -1 in G70 to G72
        self._convert_feed()
        if self.started:
            self._note_conditions(state)

    def comment(self, text: str) -> None:
        """Begin without a feed, and discard the set-up's records when the program itself starts."""
        this = interpreter_object()
        if text == FRESH:
            this.feed_rate = 0.0  # not by F0: a machine may have remapped F
            this.active_spindle = 0  # LinuxCNC leaves it unset, and reads it in G33 without $
            if self.reports:
                setattr(this, ASKED, {})
            self.modal_feed, self.units = 0.0, this.length_units
            self._read_position()
        self._convert_feed()
        prefix, changed, share = text.partition(MEANINGS_CHANGED)
        if changed and not prefix:
            self.on_face = not self.on_face
            self.share = float(share)
            self._read_position()
        if text == START:
            self.started = True
            for records in (self.moves, self.events, self.cuts):
                records.clear()
        if self.reports:
            self._note_report(text)

    def _note_report(self, text: str) -> None:
        """Note the outermost cuts: a shape may have a section in it."""
        this = interpreter_object()
        if text.startswith(CUT):
            self.open_cuts += 1
            if self.open_cuts == 1:
                self._note_tools()
                place = [len(self.moves), None, self.lines.now(), 0]
                self.cuts.append([*place, self.c_commanded, [text]])
        elif text.startswith(MORE) and self.open_cuts == 1:
            self.cuts[-1][-1].append(text)
        elif text.startswith(CLAMP_COMMENT):
            self._note(text.removeprefix(PACKAGE))
        elif text == END:
            self.open_cuts -= 1
            if not self.open_cuts:
                self.cuts[-1][1], self.cuts[-1][3] = len(self.moves), this.sequence_number
                self.c_commanded = ""

    def _note_c(self, start: float, end: float) -> None:
        """Note how a move outside of cuts commands C."""
        this = interpreter_object()
        has_word = this.blocks[this.remap_level].c_flag
        if has_word and this.distance_mode == G91_ACTIVE and not goes_by_machine():
            self.c_commanded = self.c_commanded or "increment"
        elif has_word or start != end:
            self.c_commanded = "angle"

    def message(self, text: str) -> None:
        self._note(f"message {text}")

    def set_g5x_offset(self, _index: int, *offset: float) -> None:
        self.work = in_mm(offset)

    def set_g92_offset(self, *offset: float) -> None:
        self.g92 = in_mm(offset)

    def tool_offset(self, *offset: float) -> None:
        """Note the tool length offset, inches, and the code; it moves the tip, not the axes."""
        this = interpreter_object()
        self.length_code = this.blocks[this.remap_level].g_modes[LENGTH_GROUP]
        before, self.length = self.length, in_mm(offset)
        self.position = tuple(a + b - c for a, b, c in zip(self.position, before, self.length))

    def set_xy_rotation(self, degrees: float) -> None:
        self.rotation = degrees
        self.cos, self.sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))

    def set_plane(self, plane: int) -> None:
        """Note the plane; that of U, V and W, which LinuxCNC accepts, is not traced."""
        if plane in UVW_PLANES:
            text = f"{UVW_PLANES[plane]}: LinuxCNC accepts it, but U, V and W arcs are not traced"
            self.refused = text, self.lines.now()
        self.plane = PLANE_NUMBERS[plane]

    def set_feed_rate(self, rate: float) -> None:
        """Note the feed, inches per minute or revolution if the program is metric."""
        this = interpreter_object()
        self.units = this.length_units
        self.feed = rate * INCH
        feed = rate * INCH if self.units == METRIC else rate
        self.program_feed = round(feed, FEED_DECIMALS)  # through inches F loses its last bit
        self.modal_feed = self.program_feed
        if self.program_feed:  # M2 reports 0, whatever F then is
            this.feed_rate = self.program_feed

    def change_tool(self, _which: int) -> None:
        """Load the selected tool: LinuxCNC 2.9 passes its index, 2.10 its number."""
        self._load(interpreter_object().selected_pocket, by_m6=True)

    def _load(self, index: int, by_m6=False) -> None:
        """Note the tool in the spindle, by M6 or M61, and the table with the values of G10 L1.

        LinuxCNC then reads the whole table, where they remain, as on a machine.
        """
        table = interpreter_object().tool_table
        self.tools[1:] = [for_canon(table[each]) for each in range(1, len(self.tools))]
        if by_m6 or index != self.index:
            self.index, self.spindle = index, self.tools[index] if index else UNLOADED
            self._note(f"tool {self.spindle[0]}")

    def dwell(self, seconds: float) -> None:
        """Note a pause; the move before it is not blended into the next."""
        self._note(f"dwell {seconds:.10g}")
        if self.moves:
            *move, _, by_machine, share = self.moves[-1]
            self.moves[-1] = (*move, True, by_machine, share)

    def user_defined_function(self, number: int, first: float, second: float) -> None:
        self._note(f"M{100 + number} P{first:.10g} Q{second:.10g}")

    def set_traverse_rate(self, _rate: float) -> None:
        """Rapids have no feed."""

    def _convert_feed(self) -> None:
        """Convert F where the units have changed, as a machine does: the preview sets it to 1."""
        this = interpreter_object()
        if this.length_units != self.units and this.feed_mode != INVERSE_TIME:
            self.units = this.length_units
            this.feed_rate = self.modal_feed * (INCH if self.units == METRIC else 1 / INCH)
        self.modal_feed = this.feed_rate

    def _note_pitch(self) -> None:
        """Note a new pitch of a thread, which is its feed in place of F."""
        this = interpreter_object()
        word = PITCH_WORD.get(this.motion_mode)
        if word:
            unit = 1.0 if this.length_units == METRIC else INCH
            pitch = f"pitch {getattr(this.blocks[this.remap_level], word) * unit:.10g} mm"
            known, self.pitch = self.pitch, pitch
            if pitch != known:
                self._note(pitch)

    def _note_tools(self) -> None:
        sizes = tool_sizes(len(self.tools))
        if not self.tables or sizes != self.tables[-1][1]:
            self.tables.append((len(self.moves), sizes))

    def _note(self, text: str) -> None:
        self.events.append((len(self.moves), self.lines.now(), text))

    def _note_conditions(self, state) -> None:
        length = length_code(self.length_code, self.length)
        known, self.in_force = self.in_force, conditions(state, length)
        for word in self.in_force:
            if word not in known:
                self._note(word)

    # Moves.

    def straight_traverse(self, *target: float) -> None:
        self._move("rapid", in_mm(target), 0.0)

    def straight_feed(self, *target: float) -> None:
        self._note_pitch()
        self._move("feed", in_mm(target), self._rate(target))

    def straight_probe(self, *target: float) -> None:
        self._move("probe", in_mm(target), self._rate(target))

    def rigid_tap(self, x: float, y: float, z: float) -> None:
        """Record both strokes and the pitch, the only event that distinguishes them from a cut."""
        self.pitch = ""
        self._note_pitch()
        back = self._tip()
        self._move("feed", (*in_mm((x, y, z))[:3], *back[3:]), self.feed)
        self._move("feed", back, self.feed)

    def arc_feed(self, first: float, second: float, first_centre: float, second_centre: float,
                 turns: int, third: float, *others: float) -> None:  # fmt: skip
        """Record an arc: end and centre on the plane's axes, then the others."""
        target, centre = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
        one, two, three = ARC_AXES[self.plane]
        target[one], target[two], target[three] = first, second, third
        centre[one], centre[two] = first_centre, second_centre
        centre[three] = self._tip()[three] / INCH
        resolved = self._resolved(in_mm((*centre, *NO_OFFSET[3:])))
        self._move("arc", in_mm((*target, *others)), self.feed, resolved[:3], turns)

    def _rate(self, target: tuple) -> float:
        """Feed of a straight move: degrees per minute if only rotary axes move."""
        lengths = tuple(map(float.__sub__, self.position, self._resolved(in_mm(target))))
        only_rotary = all(abs(lengths[axis]) < CART_FUZZ for axis in LINEAR_AXES)
        return self.program_feed if only_rotary else self.feed

    def _move(self, kind: str, tip: tuple, feed: float, centre=None, turns=0) -> None:
        before, self.position = self.position, self._resolved(tip)
        start = tuple(  # an axis that the move does not command starts exactly where it ends
            end if abs(at - end) < CART_FUZZ else at for at, end in zip(before, self.position)
        )
        mode = FEED_MODE_CODES[interpreter_object().feed_mode] if feed else ""
        state = (self.plane, self.spindle[0], self.length)
        path = (kind, self.line, self.lines.now(self.line), start, self.position)
        remap = self.lines.remap()
        how = (is_exact(), goes_by_machine(), self.share)
        if self.reports and not self.open_cuts:
            self._note_c(start[5], self.position[5])
        self.moves.append((*path, feed, mode, *state, centre, turns, self.rotation, remap, *how))

    def _read_position(self) -> None:
        """Copy the interpreter's position, which a switch of kinematics changes without a move."""
        this = interpreter_object()
        self.position = self._resolved(
            tuple(getattr(this, name) * unit for name, unit in program_units().items())
        )

    def _correct_position(self) -> None:
        """Set the interpreter's position to the machine's.

        The preview reports the end of the last straight move as commanded there, without regard
        to arcs, units and offsets since.
        """
        this = interpreter_object()
        for (name, unit), value in zip(program_units().items(), self._tip()):
            setattr(this, name, value / unit)

    def _tip(self) -> tuple:
        """Return the tip in program coordinates, mm: the inverse of `_resolved`."""
        x, y, *rest = map(float.__sub__, self.position, self.work)
        y -= self._beside_x()
        unrotated = (x * self.cos + y * self.sin, y * self.cos - x * self.sin, *rest)
        return tuple(map(float.__sub__, unrotated, self.g92))

    def _resolved(self, tip: tuple) -> tuple:
        """Machine coordinates of a point in program coordinates, both in mm."""
        x, y, *rest = map(float.__add__, tip, self.g92)
        rotated = (x * self.cos - y * self.sin, x * self.sin + y * self.cos, *rest)
        x, y, *rest = map(float.__add__, rotated, self.work)
        return (x, y + self._beside_x(), *rest)

    def _beside_x(self) -> float:
        """Return Y of the tool, mm, on a lathe whose tool is beside the X line."""
        return 0.0 if self.on_face else self.machine["beside"]


def program_units() -> dict[str, float]:
    """Return one program unit of each of the interpreter's coordinates in mm or degrees."""
    length = 1.0 if interpreter_object().length_units == METRIC else INCH
    return {name: length if axis in LINEAR_AXES else 1.0 for axis, name in enumerate(CURRENT)}


def conditions(state, length: int) -> tuple:
    """Return the conditions besides the path, as words; ``state`` is the modal state of a line.

    LinuxCNC brings that state up to date at the end of a block.
    """
    this = interpreter_object()
    blending = this.active_settings
    path = f"G{state.path_mode / 10:g}"
    return (
        f"G{state.origin / 10:g}",
        f"G{length / 10:g}",
        f"{path} P{blending[3]:.10g} Q{blending[4]:.10g}" if path == "G64" else path,
        f"G{state.gcodes[SPINDLE_MODE] / 10:g}",
        f"M{state.spindle}",
        f"S{state.speed:.10g}",
        "M7 on" if this.mist else "M7 off",
        "M8 on" if this.flood else "M8 off",
        f"M{state.overrides}",
    )


def length_code(code: int, length: tuple) -> int:
    """Return ten times the G code of the tool length: a length of zero is G49, also on 2.10."""
    return code if any(length) else 490


def goes_by_machine() -> bool:
    this = interpreter_object()
    return this.blocks[this.remap_level].g_modes[0] in BY_MACHINE


def is_exact() -> bool:
    import emccanon

    return emccanon.GET_EXTERNAL_MOTION_CONTROL_MODE() != CONTINUOUS


def in_mm(position: Sequence[float]) -> Position:
    """Return the preview's X Y Z U V W, inches, in mm; degrees stay."""
    x, y, z, a, b, c, u, v, w = (*position, *NO_OFFSET[len(position) :])
    return (x * INCH, y * INCH, z * INCH, a, b, c, u * INCH, v * INCH, w * INCH)


def for_canon(entry) -> tuple:
    """Return a record of the interpreter's tool table in the preview's form."""
    tip, offset = entry.offset.tran, entry.offset
    axes = (tip.x, tip.y, tip.z, *(getattr(offset, letter) for letter in "abcuvw"))
    angles = (entry.frontangle, entry.backangle, entry.orientation)
    return (entry.toolno, *axes, entry.diameter, *angles)


def tool_sizes(count: int) -> list[tuple[int, float, float, float]]:
    """Return number, diameter and offsets in Z and X, machine units, of the tools in the table.

    It has ``count`` entries, and the values of G10. The last entry of a tool counts.
    """
    table = interpreter_object().tool_table
    entries = [table[index] for index in reversed(range(count))]
    return [
        (e.toolno, e.diameter, e.offset.tran.z, e.offset.tran.x) for e in entries if e.toolno > 0
    ]


def interpreter_object():
    import interpreter

    return interpreter.this


def record_errors_of_handlers() -> None:
    """Report CANON_ERROR of Python handlers as a message, which the preview drops."""
    import emccanon

    emccanon.CANON_ERROR = lambda text, *_args: emccanon.MESSAGE(text)


def interpret(machine: dict, tools: list[tuple], request: dict) -> dict:
    canon = Canon(machine, tools, request)
    setup = [f"({FRESH})", "G49", *machine["setup"], *request["setup"], f"({START})"]
    error = interpreted(canon, request["program"], setup)
    return {
        "moves": canon.moves,
        "events": canon.events,
        "error": error,
        "cuts": canon.cuts,
        "tool_sizes": tool_sizes(len(tools)),
        "tables": canon.tables,
        "position": canon.position,
        **state_after(request, canon.length),
    }


def interpreted(canon: Canon, program: str, setup: list[str]) -> tuple[str, int] | None:
    """Let LinuxCNC interpret a program; return the text and the line of an error.

    What ``canon`` refuses is a RuntimeError of LinuxCNC's that does not say why; so is a comment
    that is no UTF-8, which LinuxCNC itself runs.
    """
    import gcode

    try:
        result, _ = gcode.parse(program, canon, setup)
    except RuntimeError:
        refused = canon.refused or no_utf8(program)
        if refused:
            return refused
        raise
    if result <= gcode.MIN_ERROR:
        return None
    return gcode.strerror(result), canon.lines.of_error() if canon.started else 0


def no_utf8(program: str) -> tuple[str, int] | None:
    """Return the error of the file that was being executed if it is no UTF-8, with its call."""
    this = interpreter_object()
    with open(this.filename, "rb") as file:
        content = file.read()
    try:
        content.decode()
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        text = (
            f"{os.path.basename(this.filename)}:{line}: a byte that is no UTF-8: LinuxCNC runs it, "
            "its preview does not; convert the file, for example with iconv"
        )
        return text, line if this.filename == program else this.sub_context[0].sequence_number
    return None


def state_after(request: dict, length: tuple) -> dict:
    """Return the interpreter's state after the program, with a tool of a ``length``."""
    this = interpreter_object()
    codes = list(this.active_g_codes)
    codes[LENGTH_CODE] = length_code(codes[LENGTH_CODE], length)
    names = set(this.params.globals()) - set(request.get("known_globals", ()))
    return {
        "gcodes": codes[1:],
        "mcodes": list(this.active_m_codes)[1:],
        "settings": list(this.active_settings)[1:],
        "globals": {name: this.params[name] for name in sorted(names)},
        "state": {name: getattr(this, name) for name in STATE_VARIABLES},
    }


def printed(path: str) -> str:
    with open(path, "r+", encoding="utf-8", errors="replace") as file:
        text = file.read()
        file.truncate(0)
    return text


def blank(directory: str) -> dict:
    """Return a request for a program that does nothing and has no end."""
    files = {name: os.path.join(directory, name) for name in ("blank.ngc", "blank.var")}
    for name in files.values():
        with open(name, "w", encoding="ascii") as file:
            file.write("\n")
    return {
        "program": files["blank.ngc"],
        "parameter_file": files["blank.var"],
        "setup": [],
    }


def answered(machine: dict, tools: list[tuple], request: dict) -> dict:
    """Interpret one program; ``failure`` in the answer is a fault of this process."""
    try:
        return interpret(machine, tools, request)
    except Exception:
        traceback.print_exc()
        return {"failure": "a fault of the preview, please report it"}


def ini_refused(machine: dict) -> str | None:
    """Return why this LinuxCNC cannot read the INI; the interpreter would continue without it.

    2.9 reads any file, 2.10 none with a line that it does not understand. The INI is a copy, whose
    line numbers mean nothing to the user: the text names the line itself.
    """
    import linuxcnc

    try:
        linuxcnc.ini(machine["ini"])
    except linuxcnc.error:
        before, _, reason = printed(machine["output"]).rpartition(": error: ")
        place, _, number = before.rpartition(":")
        line = f"#INCLUDE {os.path.basename(before)}"  # the fault of a file as such
        if place:
            with open(machine["ini"], encoding="utf-8", errors="replace") as file:
                line = file.readlines()[int(number) - 1].strip()
        return f"LinuxCNC does not read it: {reason.strip()}: {line}"
    return None


def start(machine: dict, tools: list[tuple]) -> dict:
    """Load the machine's Python modules and return its answer to a blank program.

    ``no_end`` is this LinuxCNC's error for a program without an end.

    The interpreter's own modules exist after a first parse with an empty INI, and so can be
    adjusted before the machine's modules import them.
    """
    request = blank(os.path.dirname(machine["output"]))
    os.environ["INI_FILE_NAME"] = request["parameter_file"]
    no_end, _ = interpret({**machine, "setup": []}, tools, request)["error"]
    record_errors_of_handlers()
    refused = ini_refused(machine)
    if refused:
        return {"error": (refused, 0)}
    os.environ["INI_FILE_NAME"] = machine["ini"]
    answer = answered(machine, tools, request)
    if answer.get("error") and answer["error"][0] == no_end:
        answer["error"] = None
    return {**answer, "no_end": no_end}


def send(stream: IO[str], answer: dict | list) -> None:
    stream.write(json.dumps(answer) + "\n")
    stream.flush()


def reply(stream: IO[str], machine: dict, answer: dict) -> None:
    """Send an answer; its moves first, as lists, so that no line is long."""
    moves = answer.pop("moves", [])
    for at in range(0, len(moves), MOVES_OF_LINE):
        send(stream, moves[at : at + MOVES_OF_LINE])
    send(stream, {**answer, "printed": printed(machine["output"])})


def reply_alone(stream: IO[str], machine: dict, tools: list[tuple], request: dict) -> None:
    """Answer from a fork of this process, which discards the state of the machine's modules."""
    copy = os.fork()
    if copy:
        _, status = os.waitpid(copy, 0)
        if status:
            send(stream, {"failure": "the interpreter died"})
        return
    end_with_parent()
    reply(stream, machine, answered(machine, tools, request))
    os._exit(0)


def end_with_parent() -> None:
    """Let this process be killed when its parent ends."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def serve(descriptor: int) -> None:
    """Answer requests until the other end closes, in a fork, which may be busy then."""
    end = socket.socket(fileno=descriptor)
    stream = end.makefile("rw", encoding="ascii")
    machine = json.loads(stream.readline())
    copy = os.fork()
    if not copy:
        end_with_parent()
        answer_requests(stream, machine)
        return
    poll = select.poll()
    poll.register(end, 0)  # also notices the death of the other end
    with open(os.pidfd_open(copy), "rb") as ended:
        poll.register(ended, select.POLLIN)
        if descriptor in dict(poll.poll()):  # closed; the fork may be busy
            os.kill(copy, signal.SIGKILL)
            os.waitpid(copy, 0)
            shutil.rmtree(os.path.dirname(machine["output"]), ignore_errors=True)


def answer_requests(stream: IO[str], machine: dict) -> None:
    """Load the machine and answer requests until the other end closes."""
    tools = load_tools(machine["tool_table"], machine["random"])
    answer = start(machine, tools)
    known = tuple(answer.get("globals", ()))
    reply(stream, machine, answer)
    for line in stream:
        request = {**json.loads(line), "known_globals": known}
        if request["alone"]:
            reply_alone(stream, machine, tools, request)
        else:
            reply(stream, machine, answered(machine, tools, request))
