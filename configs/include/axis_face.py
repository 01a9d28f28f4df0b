# SPDX-License-Identifier: GPL-2.0-or-later
# [DISPLAY] USER_COMMAND_FILE of AXIS on a lathe (LATHE = 1), which shows the XZ plane alone.
# The view along Z is the face of the part, as the tool sees it: its button is back, as is that of
# the view in perspective, and the key V changes between the three. ~/.axisrc, which AXIS reads only
# without a USER_COMMAND_FILE, is read here.
if lathe:
    plane = widgets.view_y2 if lathe_backtool else widgets.view_y
    for button in (widgets.view_p, widgets.view_z):
        button.pack(side="left", after=plane)
    FACE_VIEWS = [
        commands.set_view_y2 if lathe_backtool else commands.set_view_y,
        commands.set_view_z,
        commands.set_view_p,
    ]

    def next_face_view(event=None):
        FACE_VIEWS.append(FACE_VIEWS.pop(0))
        FACE_VIEWS[0]()

    root_window.bind("v", next_face_view)

_own = os.path.expanduser("~/.axisrc")
if os.path.exists(_own):
    exec(compile(open(_own, "rb").read(), _own, "exec"))
