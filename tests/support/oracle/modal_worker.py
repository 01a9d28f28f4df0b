# SPDX-License-Identifier: GPL-2.0-or-later
"""The modal state around each reported cut, as events: ``found {json}``, then ``left {json}``.

Runs in the process of the preview. LinuxCNC's state is that of the end of the block before, so
``left`` comes with the first line after a cut.
"""

import json

NOT_MODAL = "02"  # the line's number, and G10 and the like


def put_in(worker):
    """Let the preview note these events."""

    class ModalCanon(worker.Canon):  # type: ignore[name-defined]
        def __init__(self, *arguments):
            super().__init__(*arguments)
            self.state, self.ended = {}, None

        def next_line(self, state):
            super().next_line(state)
            if self.started:
                self.state = state_of(worker, state, self)
            if self.ended and self.ended != level_and_line(worker):
                self._note(f"left {json.dumps(self.state)}")
                self.ended = None

        def comment(self, text):
            super().comment(text)
            if text.startswith(worker.CUT) and self.open_cuts == 1:
                self._note(f"found {json.dumps(self.state)}")
            elif text == worker.END and not self.open_cuts:
                forget_line(worker)
                self.ended = level_and_line(worker)

    worker.Canon = ModalCanon


def level_and_line(worker):
    this = worker.interpreter_object()
    return this.call_level, this.sequence_number


def forget_line(worker):
    """Let LinuxCNC report the next line, even if its number is the last one of a cycle's sub."""
    import emccanon

    this = worker.interpreter_object()
    number, this.sequence_number = this.sequence_number, -1
    emccanon.COMMENT("g12 oracle")
    this.sequence_number = number


def state_of(worker, state, canon):
    """Return modes by the number of their group, and what else lasts."""
    this = worker.interpreter_object()
    codes = {str(group): f"G{code / 10:g}" for group, code in enumerate(state.gcodes)}
    codes = {group: code for group, code in codes.items() if group not in NOT_MODAL}
    return {
        "codes": codes,
        "F": this.active_settings[1],
        "T": this.selected_tool,
        "S": this.active_settings[2],
        "tip": canon._tip(),
        "zero": [canon.work, canon.g92, canon.length, canon.rotation],
        "offsets": worker.work_offsets(),
    }
