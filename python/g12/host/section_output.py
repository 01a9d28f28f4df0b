# SPDX-License-Identifier: GPL-2.0-or-later
"""Execution of a planned section: its moves and actions, in order.

The interpreter executes segments in G90 G94 with rotary axes unwrapped, blended in G64.
`SectionOutput.release` restores the modes that the program commanded (`g12.host.borrowed`),
wherever the program can read them, or the machine waits. The move before the section would be
blended into its first segment: a G4 P0 stops it. (Also under G61: a move ends by the path control
in force at that move.)

A G4 P0 also stops a segment that another one is blended into. While two segments that turn C are
blended, LinuxCNC (2.9.0~pre1, 2.9.4, 2.10) brakes the first with half of the acceleration and
starts the second with half of it, but with all of it if that ends in G61. Together they would reach
1.5 times the feed and the acceleration.

On the face (`configs/kinematics`) lines and arcs are executed as they are, in X and Y. For the
switch there and back the machine has to stop, and the interpreter to wait for it.
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence

from g12.compensation.contour import PlaneMove
from g12.geometry.curve import Arc
from g12.host import borrowed, kinematics_switch
from g12.host.borrowed import Saved
from g12.host.interp import (
    PER_MINUTE,
    PER_REVOLUTION,
    CanonModule,
    Interp,
    position_of,
    set_position,
    set_wrapped,
)
from g12.host.program_lines import error_text
from g12.moves.setup import SectionKind
from g12.moves.steps import FaceMove, FaceSwitch, MachinePosition, Segment, Segments, Step
from g12.polar.face import blending_halves
from g12.section.block_rules import G1
from g12.section.effects import Action, SectionModes, decimal
from g12.section.line import BlockLocation

EXACT_PATHS = EXACT_PATH, EXACT_STOP = "G61", "G61.1"
STOP_HERE = "G4P0"
NOT_WRAPPED = (False, False, False)
INITIAL_TOLERANCE = 0.0254  # mm, of the G64 that LinuxCNC starts with; its Q is 0
SWITCH_MM, SWITCH_DEGREES = 1e-3, 1e-3  # how far the tool may be from where a section begins
SAME_TOLERANCE = 1e-9  # program units
ELSEWHERE = (
    "the tool is not where the section begins: "
    "with kinematics, Run from line cannot pass over a section"
)
MEANINGS_CHANGED = "g12: the axes mean something else now, acceleration "  # for preview/worker
CANON_AXES = "XYZABCUVW"  # in the order of canonical calls


class PathControl:
    """Path control: G61, G61.1 or G64 as commanded by the program, and as a section needs it.

    The segments of one block are blended, with ``smooth`` if the program gave no tolerance. The
    path control at the end of a block is the commanded one. In blocks without C, LinuxCNC rounds a
    corner of X and Z by all of P at any speed, and merges lines by all of Q (measured: 0.100 mm
    under P0.1 at F60, 0.082 mm under Q0.1). There both are at most ``blending``. ``initial`` is the
    tolerance that LinuxCNC starts with, which does not count as commanded on the face. Both are in
    program units.
    """

    def __init__(self, interp: Interp, saved: Saved, blending: float, initial: float) -> None:
        self.interp, self.smooth, self._initial = interp, f"G64P{decimal(blending)}Q0", initial
        self._blending_of_section = blending
        self.find(saved)

    def find(self, saved: Saved) -> None:
        """Take the path control in force as the commanded one."""
        (tolerance, merging), self._commanded = saved.blending, saved.path_block
        own_tolerance = self._commanded not in EXACT_PATHS and tolerance > 0
        self._within = self._commanded if own_tolerance else self.smooth
        is_coarse = max(tolerance, merging) > self._blending_of_section
        self._without_c = self.smooth if is_coarse else self._within
        is_initial = abs(tolerance - self._initial) < SAME_TOLERANCE and not merging
        self._on_face = self.smooth if is_initial else self._within
        self._in_force = self._commanded

    def renew(self) -> None:
        """Set the next one even if it is unchanged: Run from line skips the block that set it."""
        self._in_force = ""

    def inside(self, turning: bool) -> None:
        """Set the path control within one block, for segments with or without a turn of C."""
        self.set(self._within if turning else self._without_c)

    def on_face(self) -> None:
        """Set the path control for blocks on the face, which also applies at their corners."""
        self.set(self._on_face)

    def ending(self, stop: bool, exact_stop: bool, block_ends: bool) -> str:
        """Return the path control that a run has to end in, "" where it is blended.

        The planner sets ``stop``, a G9 ``exact_stop``.
        """
        if block_ends and exact_stop:
            return EXACT_STOP
        if block_ends and self._commanded in EXACT_PATHS:
            return self._commanded
        return EXACT_PATH if stop else ""

    def set(self, path: str) -> None:
        if path != self._in_force:
            self.interp.execute(path)
            self._in_force = path


class SectionOutput:
    """Hands steps to the interpreter; ``canon`` are its canonical functions."""

    def __init__(
        self,
        interp: Interp,
        kind: SectionKind,
        *,
        canon: CanonModule,
    ) -> None:
        state = kind.state
        self.interp, self.code, self.canon = interp, kind.start.location.code, canon
        self.axes = kind.words.axes
        self.factors = {"X": 1.0 + state.diameter}  # of words
        self.machine_unit, self.beside = state.machine_unit, kind.rules.beside
        self.millimetre = state.millimetre
        initial = state.length(INITIAL_TOLERANCE)
        saved = borrowed.saved_modes(interp)
        self.path = PathControl(interp, saved, kind.tolerance / 2, initial)
        self._begun = self.on_face = False
        self._flows = False  # the last segment is blended into the next

    def run(
        self, steps: Sequence[Step], modes: SectionModes, exact_lines: Container[int]
    ) -> Iterator[str]:
        """Execute all steps, and release the interpreter in ``modes``.

        ``exact_lines`` are those of blocks with G9. Yields blocks to execute and to wait for.
        """
        self._stop_before_section(steps)
        self._set_own_modes()
        for step, following in zip(steps, [*steps[1:], None]):
            if isinstance(step, Action):
                self._act(step)
            elif isinstance(step, FaceSwitch):
                yield from self._switch(step)
            elif isinstance(step, FaceMove):
                self._move_on_face(step, following, step.line in exact_lines)
            elif isinstance(step, Segments):
                self._segments(step, following, step.line in exact_lines)
        self.release(modes)

    def release(self, modes: SectionModes) -> None:
        """Restore the modes that the program commanded; on the face, what the face needs stays."""
        interp = self.interp
        saved = borrowed.renew(interp, borrowed.saved_modes(interp).commanding(modes))
        here = saved.on_the_face_of(borrowed.modes_in_force(interp)) if self.on_face else saved
        borrowed.restore(interp, here)
        self.path.find(saved)

    def _go_on(self) -> None:
        """Take the modes that an action has left as the commanded ones."""
        interp = self.interp
        now = borrowed.modes_in_force(interp)
        saved = now.on_the_face_of(borrowed.saved_modes(interp)) if self.on_face else now
        self.path.find(borrowed.renew(interp, saved))
        self._set_own_modes()

    def _stop_before_section(self, steps: Sequence[Step]) -> None:
        if steps and not self._begun:
            self.interp.sequence_number = steps[0].line
            self.interp.execute(STOP_HERE)
        self._begun = True

    def _set_own_modes(self) -> None:
        interp = self.interp
        set_wrapped(interp, NOT_WRAPPED)
        if interp.distance_mode:
            interp.execute("G90")
        if borrowed.saved_modes(interp).feed_mode == PER_REVOLUTION:
            interp.execute("G94")
        interp.feed_mode = PER_MINUTE  # reading ahead may have set the modes of the section's end
        interp.motion_mode = G1

    def _segments(self, run: Segments, following: Step | None, exact_stop: bool) -> None:
        """Execute the moves of a block, and the stop at their end."""
        block_ends = not isinstance(following, Segments) or following.line != run.line
        ending = self.path.ending(run.stop, exact_stop, block_ends)
        blended = self._flows or len(run.segments) > 1
        self._flows = not ending
        if ending and not blended:
            self.path.set(ending)
            self.interp.sequence_number = run.line
            self._block(run.axes, *run.segments[0])
            return
        self._moves(run.line, run.axes, run.segments)
        if ending:
            self.interp.execute(STOP_HERE)

    def _moves(self, line: int, axes: str, segments: Sequence[Segment]) -> None:
        """Execute the moves of one block.

        The first goes through the interpreter, which sets the line and the modes. The others are
        canonical calls, the same as for blocks, in a third of the time.
        """
        interp, axis = self.interp, self.axes
        interp.sequence_number = line
        turn = position_of(interp, axis.turn)[axis.turn]
        self.path.inside(any(segment[1] != turn for segment in segments))
        self._block(axes, *segments[0])
        there = [*position_of(interp, CANON_AXES).values()]
        slide, turn, height = map(CANON_AXES.index, axis)
        set_feed, move = self.canon.SET_FEED_RATE, self.canon.STRAIGHT_FEED
        for there[slide], there[turn], there[height], feed in segments[1:]:
            set_feed(feed)
            move(line, *there)
        set_position(interp, axis, segments[-1])

    def _block(self, axes: str, *segment: float) -> None:
        # every digit: X must parse to exactly the number in the following moves
        values = dict(zip((*self.axes, "F"), segment))
        self.interp.execute(
            "".join(
                f"{word}{values[word] * self.factors.get(word, 1.0):.17f}" for word in (*axes, "F")
            )
        )

    def _switch(self, step: FaceSwitch) -> Iterator[str]:
        """Switch to the face or back; the result of the program's last M66 is restored."""
        interp, refuse = self.interp, BlockLocation(self.code, step.line).refuse
        interp.sequence_number = step.line
        found = interp.params[kinematics_switch.INPUT_RESULT]
        of_ini = borrowed.saved_modes(interp).accelerations
        self.on_face = True
        if step.on:
            unit = self.machine_unit
            yield from kinematics_switch.to_face(interp, unit, step, refuse, of_ini)
            interp.execute(kinematics_switch.ON_THE_FACE)
            self.path.renew()
        else:
            borrowed.restore_before_face(interp, borrowed.saved_modes(interp))
            yield from kinematics_switch.to_axes(interp, of_ini)
        if not kinematics_switch.has_switched(interp):
            raise refuse(kinematics_switch.not_switched())
        wrong = self._wrong_position(step.position) if step.on and interp.task else ""
        if wrong:
            yield from kinematics_switch.to_axes(interp, of_ini)
            raise refuse(wrong)
        self.on_face = step.on
        interp.params[kinematics_switch.INPUT_RESULT] = found
        set_position(interp, self.axes, step.position)
        interp.current_y = step.on * self.beside - kinematics_switch.y_offset(interp)
        if not interp.task:
            self.canon.COMMENT(f"{MEANINGS_CHANGED}{step.share}")

    def _wrong_position(self, position: MachinePosition) -> str:
        """Return why the machine's actual position is not the planned one, "" if it is."""
        length = SWITCH_MM * self.millimetre
        compared = zip(self._machine_position(), position, (length, SWITCH_DEGREES, length))
        if any(abs(there - planned) > most for there, planned, most in compared):
            return ELSEWHERE
        return kinematics_switch.other_offset(self.interp, self.beside, self.millimetre)

    def _move_on_face(self, step: FaceMove, following: Step | None, exact_stop: bool) -> None:
        """Execute a line, an arc or a move of Z on the face."""
        interp, move = self.interp, step.move
        block_ends = not isinstance(following, FaceMove) or following.line != step.line
        interp.sequence_number = step.line
        self.path.on_face()
        ends = isinstance(following, FaceSwitch)
        if ends or (isinstance(following, FaceMove) and blending_halves(move, following.move)):
            self.path.set(EXACT_PATH)
        ending = self.path.ending(False, exact_stop, block_ends)
        if ending:
            self.path.set(ending)
        curve = move.curve if isinstance(move, PlaneMove) else None
        words = "G1" if not isinstance(curve, Arc) else "G3" if curve.sweep > 0.0 else "G2"
        values = {"F": move.feed}
        if curve:
            values["X"] = curve.end.real * self.factors["X"]
            values["Y"] = curve.end.imag - kinematics_switch.y_offset(interp)
        if isinstance(curve, Arc):
            values["I"] = curve.centre.real - interp.current_x
            values["J"] = curve.centre.imag - kinematics_switch.y_offset(interp) - interp.current_y
        if move.h0 != move.h1:
            values["Z"] = move.h1
        interp.execute(words + "".join(f"{word}{value:.17f}" for word, value in values.items()))
        interp.motion_mode = G1

    def _act(self, action: Action) -> None:
        self.interp.sequence_number = action.line
        if action.modes is None:
            self._execute(action)
            return
        self.release(action.modes)
        self._execute(action)
        self._go_on()

    def _execute(self, action: Action) -> None:
        """Execute the action's block as one of the program, which a remapped code requires."""
        interp, location = self.interp, BlockLocation(self.code, action.line)
        level, position = interp.call_level, self._machine_position()
        interp.call_level = level if action.level is None else action.level
        try:
            interp.read(action.text)
            status = interp.execute(None)
        except SystemError:  # a failed read or execute of LinuxCNC's
            raise location.refuse(error_text(interp)) from None
        finally:
            interp.call_level = level
        if status:
            raise location.refuse(f"{action.text} waits for the machine: not inside a section")
        if self._machine_position() != position:
            raise location.refuse(f"{action.text} moves the machine: not inside a section")

    def _machine_position(self) -> list[float]:
        return [*position_of(self.interp, self.axes).values()]
