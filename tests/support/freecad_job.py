# SPDX-License-Identifier: GPL-2.0-or-later
"""Run by freecadcmd: a pocket, a profile and three holes on a bar's face, posted for LinuxCNC.

The environment says where the program goes, in G12_POSTED. FreeCAD 0.20 to 1.0.
"""

import os
from math import cos, radians, sin

import FreeCAD
import Part

try:
    from Path.Main import Job
    from Path.Op import Drilling, PocketShape, Profile
    from Path.Post.scripts import linuxcnc_post
    from Path.Tool import Bit, Controller
except ImportError:  # before 1.0
    from PathScripts import PathDrilling as Drilling
    from PathScripts import PathJob as Job
    from PathScripts import PathPocketShape as PocketShape
    from PathScripts import PathProfile as Profile
    from PathScripts import PathToolBit as Bit
    from PathScripts import PathToolController as Controller
    from PathScripts.post import linuxcnc_post

HOLES, POCKET, ACROSS, DRILL = 11.0, 6.0, 28.0, 3.0
DEPTHS = {"profile": -4.0, "pocket": -3.0, "holes": -6.0}
SAFE, CLEARANCE = 3.0, 5.0


def bar():
    """Return a bar of 40 whose end is a hexagon with a pocket and three holes."""
    corners = [radians(60 * k) for k in range(7)]
    corner = ACROSS / 2 / cos(radians(30))
    points = [FreeCAD.Vector(corner * cos(a), corner * sin(a), 0) for a in corners]
    end = Part.Face(Part.makePolygon(points)).extrude(FreeCAD.Vector(0, 0, DEPTHS["profile"]))
    shape = Part.makeCylinder(20, 30, FreeCAD.Vector(0, 0, DEPTHS["profile"] - 30)).fuse(end)
    shape = shape.cut(round_hole(0, 0, POCKET, DEPTHS["pocket"]))
    for k in range(3):
        angle = radians(120 * k)
        place = HOLES * cos(angle), HOLES * sin(angle)
        shape = shape.cut(round_hole(*place, DRILL / 2, DEPTHS["holes"]))
    return shape.removeSplitter()


def round_hole(x, y, radius, depth):
    """Return what is drilled or milled out, from the face down."""
    return Part.makeCylinder(radius, -depth, FreeCAD.Vector(x, y, depth))


def faces_at(model, z, turned=False):
    """Return the names of a model's flat faces at a level, or of its drilled walls."""
    found = []
    for number, face in enumerate(model.Shape.Faces, 1):
        box, round_wall = face.BoundBox, isinstance(face.Surface, Part.Cylinder)
        drilled = round_wall and abs(face.Surface.Radius - DRILL / 2) < 1e-6
        flat = abs(box.ZMax - z) < 1e-6 and abs(box.ZMin - z) < 1e-6
        if drilled if turned else flat:
            found.append(f"Face{number}")
    return found


def with_feeds(controller):
    """Return a tool controller with its feeds and speed."""
    controller.HorizFeed, controller.VertFeed = "300 mm/min", "120 mm/min"
    controller.HorizRapid = controller.VertRapid = "3000 mm/min"
    controller.SpindleSpeed = 2000
    return controller


def drill():
    """Return the second tool."""
    bit = Bit.Factory.Create("drill", "drill.fcstd")
    bit.Diameter = DRILL
    return Controller.Create("drill", bit, 2)


def operation(kind, name, *base):
    """Return an operation on some faces, with the job's only tool."""
    found = kind.Create(name)
    found.Base = [base]
    for field, value in {
        "ClearanceHeight": CLEARANCE,
        "SafeHeight": SAFE,
        "StartDepth": 0.0,
        "FinalDepth": DEPTHS[name],
        "StepDown": 2.0,
    }.items():
        if hasattr(found, field):
            found.setExpression(field, None)
            setattr(found, field, value)
    return found


def posted(job):
    """Return the objects that the post writes out: each tool before its first operation."""
    found = []
    for done in job.Operations.Group:
        if done.ToolController not in found:
            found.append(done.ToolController)
        found.append(done)
    return found


def main():
    """Make the job and write its program."""
    document = FreeCAD.newDocument("bar")
    solid = document.addObject("Part::Feature", "bar")
    solid.Shape = bar()
    document.recompute()
    job = Job.Create("Job", [solid])
    model = job.Model.Group[0]
    with_feeds(job.Tools.Group[0])  # an end mill of 5 mm, tool 1
    operation(Profile, "profile", model, faces_at(model, 0)).Side = "Outside"
    pocket = operation(PocketShape, "pocket", model, faces_at(model, DEPTHS["pocket"]))
    pocket.StepOver = 60
    holes = operation(Drilling, "holes", model, faces_at(model, 0, turned=True))
    holes.ToolController = with_feeds(drill())  # after it an operation would ask which tool
    job.Proxy.addToolController(holes.ToolController)
    document.recompute()
    linuxcnc_post.export(posted(job), os.environ["G12_POSTED"], "--no-header --no-show-editor")


main()
