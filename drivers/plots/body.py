# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of the body among its obstacles: by VTK off-screen where that works, else by Matplotlib."""
import subprocess
import sys

import numpy
from matplotlib.colors import LinearSegmentedColormap, to_rgb, to_rgba

from obstacles import BACK, FRONT, directions, obstacles

try:
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

    vtk.vtkLogger.SetStderrVerbosity(vtk.vtkLogger.VERBOSITY_ERROR)  # no display is no error to report
except ImportError:
    vtk = None

BODY_MAP = LinearSegmentedColormap.from_list("deformation", ["#3d8fb3", "#8fcfb0", "#f6d365", "#f08a4b", "#b5233b"])
OBSTACLE = "#6f8296"


def normals(points, triangles):
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    normal = numpy.cross(b - a, c - a)
    return normal / numpy.maximum(numpy.linalg.norm(normal, axis=1, keepdims=True), 1e-300)


def vtk_renders():
    """Tried in another process: without OpenGL, VTK ends the whole interpreter."""
    trial = "import vtk; w = vtk.vtkRenderWindow(); w.OffScreenRenderingOn(); w.AddRenderer(vtk.vtkRenderer()); w.Render()"
    return vtk is not None and subprocess.run([sys.executable, "-c", trial], capture_output=True).returncode == 0


def vtk_actor(points, triangles, colours=None):
    """A smoothly shaded surface; colours: red, green and blue of each vertex."""
    data, corners, cells = vtk.vtkPolyData(), vtk.vtkPoints(), vtk.vtkCellArray()
    corners.SetData(numpy_to_vtk(numpy.ascontiguousarray(points), deep=True))
    cells.SetData(3, numpy_to_vtkIdTypeArray(triangles.astype(numpy.int64).ravel(), deep=True))
    data.SetPoints(corners)
    data.SetPolys(cells)
    if colours is not None:
        data.GetPointData().SetScalars(numpy_to_vtk((255 * colours).astype(numpy.uint8), deep=True))
    smooth = vtk.vtkPolyDataNormals()
    smooth.SetInputData(data)
    smooth.SetFeatureAngle(40)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(smooth.GetOutputPort())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetAmbient(0.35)
    look.SetDiffuse(0.7)
    look.SetSpecular(0.12)
    look.SetSpecularPower(30)
    return actor


class View:
    """One camera for all pictures of a run: the smallest parallel projection that shows everything."""

    def __init__(self, run):
        self.shapes = obstacles(run)
        self.forward, self.right, self.up = directions(run.up)
        body = run.points.reshape(-1, 3)
        extent = numpy.ptp(body, axis=0).max()
        moved = [places(points, time) for time in run.times for points, _, _, places in self.shapes]
        seen = [body] + [points for points in moved if numpy.ptp(points, axis=0).max() < 8 * extent]
        points = numpy.concatenate(seen)
        across, height, depth = points @ self.right, points @ self.up, points @ self.forward
        self.half_width, self.half_height = 0.52 * numpy.ptp(across), 0.52 * numpy.ptp(height)
        middles = [(values.min() + values.max()) / 2 for values in (across, height, depth)]
        self.focus = middles[0] * self.right + middles[1] * self.up + middles[2] * self.forward
        self.depth = numpy.ptp(depth) + extent

        self.draw = self._by_vtk if vtk_renders() else self._by_matplotlib

    def aspect(self):
        return self.half_width / self.half_height

    def picture(self, time, points, triangles, values, largest, height=620):
        """An image array of the body at a time [s], coloured by values in [0, largest]."""
        size = (int(height * self.aspect()), height)
        shapes = [(places(corners, time), cells, opacity) for corners, cells, opacity, places in self.shapes]
        return self.draw(points, triangles, shapes, values, largest, size)

    def _by_vtk(self, points, triangles, shapes, values, largest, size):
        renderer = vtk.vtkRenderer()
        renderer.SetBackground(1, 1, 1)
        renderer.SetUseDepthPeeling(True)
        vtk.vtkLightKit().AddLightsToRenderer(renderer)
        renderer.AddActor(vtk_actor(points, triangles, BODY_MAP(values / largest)[:, :3]))
        for shape_points, shape_triangles, opacity in shapes:
            shape = vtk_actor(shape_points, shape_triangles)
            shape.GetProperty().SetColor(to_rgb(OBSTACLE))
            shape.GetProperty().SetOpacity(opacity)
            renderer.AddActor(shape)
        camera = renderer.GetActiveCamera()
        camera.ParallelProjectionOn()
        camera.SetFocalPoint(*self.focus)
        camera.SetPosition(*(self.focus - 2 * self.depth * self.forward))
        camera.SetViewUp(*self.up)
        camera.SetParallelScale(self.half_height)
        camera.SetClippingRange(0.5 * self.depth, 4 * self.depth)
        window = vtk.vtkRenderWindow()
        window.OffScreenRenderingOn()
        window.SetMultiSamples(0)
        window.SetAlphaBitPlanes(True)
        window.SetSize(2 * size[0], 2 * size[1])  # four samples per pixel, averaged below
        window.AddRenderer(renderer)
        window.Render()
        grab = vtk.vtkWindowToImageFilter()
        grab.SetInput(window)
        grab.ReadFrontBufferOff()
        grab.Update()
        pixels = vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars())
        image = pixels.reshape(size[1], 2, size[0], 2, 3)[::-1, ::-1]
        return image.mean(axis=(1, 3)).astype(numpy.uint8)

    def _by_matplotlib(self, points, triangles, shapes, values, largest, size):
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        figure = Figure(figsize=(size[0] / 100, size[1] / 100), dpi=100)
        axes = figure.add_axes((0, 0, 1, 1))
        axes.set(xlim=(-self.half_width, self.half_width), ylim=(-self.half_height, self.half_height))
        axes.axis("off")
        for vertices, cells, opacity in shapes:
            if opacity == BACK:
                self._add_triangles(axes, vertices, cells, to_rgba(OBSTACLE, opacity))
        facing = normals(points, triangles) @ self.forward < 0  # the others are hidden behind them
        self._add_triangles(axes, points, triangles[facing], BODY_MAP(values[triangles[facing]].mean(axis=1) / largest))
        for vertices, cells, opacity in shapes:
            if opacity == FRONT:
                self._add_triangles(axes, vertices, cells, to_rgba(OBSTACLE, opacity))
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        return numpy.asarray(canvas.buffer_rgba())[..., :3]

    def _add_triangles(self, axes, points, triangles, colours):
        from matplotlib.collections import PolyCollection

        corners = points[triangles]
        light = normals(points, triangles) @ (0.8 * self.up - 0.6 * self.forward)
        shaded = numpy.broadcast_to(colours, (len(triangles), 4)).copy()
        solid = (shaded[:, 3] == 1).all()
        shaded[:, :3] *= 0.5 + 0.5 * (0.5 + 0.5 * light if solid else numpy.abs(light))[:, None]
        order = numpy.argsort(-(corners.mean(axis=1) @ self.forward))
        flat = (corners - self.focus) @ numpy.stack([self.right, self.up], axis=1)
        # edges close the seams between triangles; on transparent surfaces they would be drawn twice
        axes.add_collection(PolyCollection(flat[order], facecolors=shaded[order],
                                           edgecolors=shaded[order] if solid else "none", linewidths=0.4))
