"""The cells of poses.pvd in ParaView as ellipsoids of true size and pose, between the walls of the mesh. In the folder of
a case: "paraview --script=FILE" opens them, "pvpython FILE [TIME [PICTURE]]" draws them at a time.
License: GPL-3.0-or-later, see COPYING."""
import glob
import sys

from paraview import simple as pv

POSES = sorted(glob.glob("postProcessing/ellipsoidCloud/*/poses.pvd"), key=lambda name: float(name.split("/")[2]))
if not POSES:
    sys.exit("no postProcessing/ellipsoidCloud/*/poses.pvd in this folder")

cells = pv.OpenDataFile(POSES[-1])
glyphs = pv.TensorGlyph(registrationName="cells", Input=cells, GlyphType="Sphere")
glyphs.Tensors = ["POINTS", "axes"]
glyphs.ScaleFactor = 1          # axes holds the full axes; ParaView itself proposes another factor
glyphs.ColorGlyphs = 0
glyphs.GlyphType.ThetaResolution = glyphs.GlyphType.PhiResolution = 24

marker = "cells.foam"           # by which ParaView knows a case of OpenFOAM
with open(marker, "a", encoding="ascii"):
    pass
mesh = pv.OpenDataFile(marker)
pv.GetTimeKeeper().SuppressedTimeSources = [mesh]
mesh.MeshRegions = ["group/wall"]
mesh.CellArrays = []

view = pv.GetActiveViewOrCreate("RenderView")
view.ViewSize = [1200, 560]
view.UseColorPaletteForBackground = 0
view.Background = [1, 1, 1]
for source, colour in ((glyphs, [0.95, 0.45, 0.1]), (mesh, [0.62, 0.7, 0.82])):
    shown = pv.Show(source, view)
    shown.ColorArrayName = [None, ""]
    shown.AmbientColor = shown.DiffuseColor = colour
shown.BackfaceRepresentation = "Cull Frontface"     # walls between the cells and the eye

scene = pv.GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
scene.AnimationTime = float(sys.argv[1]) if len(sys.argv) > 1 else cells.TimestepValues[len(cells.TimestepValues)//2]
pv.ResetCamera(view)
camera = pv.GetActiveCamera()
camera.Elevation(-45)
camera.OrthogonalizeViewUp()
camera.Zoom(1.7)
pv.Render(view)
if len(sys.argv) > 2:
    pv.SaveScreenshot(sys.argv[2], view)
