# SPDX-License-Identifier: GPL-2.0-or-later
"""The moves and actions of a planned section, handed to the machine in order.

While pieces go out the interpreter is in G90 G94 with C unwrapped, and in G64 with the tolerance that is
left for blending; `Emission.release` puts everything back to what the program commanded.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from interpreter import MODE_ABSOLUTE

from .polar import Run
from .polar.block import G1, Modes, Place, decimal

PER_REVOLUTION = 2  # feed_mode
PATH_ACTIVE = 11  # index into active_g_codes
G64 = 640
TOLERANCE, MERGING = 3, 4  # indices into active_settings: P and Q of G64
EXACT_PATHS = EXACT_PATH, EXACT_STOP = "G61", "G61.1"

PIECE = {
    "XC": "X{0:.9f}C{1:.9f}F{3:.9f}",
    "XCZ": "X{0:.9f}C{1:.9f}Z{2:.9f}F{3:.9f}",
    "Z": "Z{2:.9f}F{3:.9f}",
}


class Action(NamedTuple):
    """A block that is no motion, in its place between the moves.

    ``modes`` are those in force when the tool gets there, None for a comment, which needs none.
    ``level`` is the call level whose saved state an M70 to M72 means, None for other blocks.
    """

    line: int
    text: str
    modes: Modes | None
    level: int | None = None


def path_of(interp: object) -> str:
    """Return the path control in force as a block: G61, G61.1, or G64 with its tolerances."""
    code = interp.active_g_codes[PATH_ACTIVE]
    if code != G64:
        return f"G{code / 10:g}"
    settings = interp.active_settings
    if settings[TOLERANCE] == settings[MERGING] == 0:
        return "G64"
    return f"G64P{decimal(settings[TOLERANCE])}Q{decimal(settings[MERGING])}"


class Emission:
    """Hands steps to the interpreter.

    ``x_factor`` turns a radius value into an X word (2 under G7); ``blending`` is in program units.
    """

    def __init__(self, interp: object, code: str, x_factor: float, blending: float) -> None:
        self.interp, self.code = interp, code
        self.x_factor = x_factor
        self.smooth = f"G64P{decimal(blending)}Q0"
        self.exact_lines: set[int] = set()
        self.path = self._in_force = path_of(interp)
        self._wrapped = interp.c_axis_wrapped
        self._per_revolution = interp.feed_mode == PER_REVOLUTION

    def run(self, steps: Sequence[Run | Action], modes: Modes) -> Iterator[int]:
        """Hand over all steps; yield the status of a block that makes the machine wait."""
        self._take_over()
        for step, following in zip(steps, [*steps[1:], None]):
            if isinstance(step, Run):
                self._moves(step, following)
            else:
                yield from self._act(step)
        self.release(modes)

    def release(self, modes: Modes) -> None:
        """Put the interpreter into the modes that the program commanded."""
        interp = self.interp
        interp.c_axis_wrapped = self._wrapped
        self._set_path(self.path)
        self._per_revolution = modes.per_revolution
        interp.execute("G95" * modes.per_revolution + f"F{decimal(modes.feed)}")
        interp.execute("G91" if modes.incremental else "G90")
        interp.motion_mode = modes.motion

    def _take_over(self) -> None:
        interp = self.interp
        interp.c_axis_wrapped = False
        interp.distance_mode = MODE_ABSOLUTE
        if self._per_revolution:
            interp.execute("G94")
        interp.motion_mode = G1

    def _moves(self, run: Run, following: Run | Action | None) -> None:
        interp, factor = self.interp, self.x_factor
        execute, piece = interp.execute, PIECE[run.axes].format
        interp.sequence_number = run.line
        self._set_path(self._path_within())
        *pieces, (last_x, last_c, last_z, last_feed) = run.pieces
        for x, c, z, feed in pieces:
            execute(piece(x * factor, c, z, feed))
        self._set_path(self._path_at_end(run, following))
        execute(piece(last_x * factor, last_c, last_z, last_feed))

    def _path_within(self) -> str:
        """The path control between the pieces of one block: they are one curve."""
        return self.path if self.path.startswith("G64P") else self.smooth

    def _path_at_end(self, run: Run, following: Run | Action | None) -> str:
        """The path control of a run's last piece: what was programmed for the end of its block."""
        block_goes_on = isinstance(following, Run) and following.line == run.line
        if not block_goes_on and run.line in self.exact_lines:
            return EXACT_STOP
        if not block_goes_on and self.path in EXACT_PATHS:
            return self.path
        return EXACT_PATH if run.stop else self._path_within()

    def _set_path(self, path: str) -> None:
        if path != self._in_force:
            self.interp.execute(path)
            self._in_force = path

    def _act(self, action: Action) -> Iterator[int]:
        """Execute a block in its place."""
        self.interp.sequence_number = action.line
        if action.modes is None:
            self._execute(action)
            return
        self.release(action.modes)
        status = self._execute(action)
        if status:
            yield status
        self.path = self._in_force = path_of(self.interp)
        self._take_over()

    def _execute(self, action: Action) -> int:
        """Execute the block as one of the program, which a remapped code must be."""
        interp, place = self.interp, Place(self.code, str(action.line))
        level = interp.call_level
        interp.call_level = level if action.level is None else action.level
        try:
            interp.read(action.text)
            status = interp.execute(None)
        except SystemError:
            raise place.refuse(interp.get_errormsg()) from None
        if action.level is None and interp.call_level != level:
            raise place.refuse(f"{action.text} waits for the machine in its handler")
        interp.call_level = level
        return status
