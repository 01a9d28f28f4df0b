# SPDX-License-Identifier: GPL-2.0-or-later
"""The choice of the picture for a machine and its program."""

from matplotlib.figure import Figure

from g12.tools.plot.face import draw_face
from g12.tools.plot.mill import draw_mill, draw_turn
from g12.tools.plot.scene import Scene
from g12.tools.plot.unrolled import draw_unrolled


def picture_of(scene: Scene) -> Figure:
    if scene.marks.surface:
        return draw_unrolled(scene)
    if scene.path.part.turning:
        return draw_face(scene)
    return draw_turn(scene) if scene.is_turned else draw_mill(scene)
