# SPDX-License-Identifier: BSD-3-Clause
"""How far one run's embedded surface is from another's: reads the frames of `plica run` and compares them."""
import base64
import bisect
import math
import struct
import xml.etree.ElementTree as xml
from pathlib import Path


def read_points(file):
    """The points of a frame (appended in base64, Float64), as a flat tuple x y z x y z ..."""
    root = xml.parse(file).getroot()
    count, offset = int(root.find(".//Piece").get("NumberOfPoints")), int(root.find(".//Points/DataArray").get("offset"))
    size = 8 + 24 * count  # the array comes after its length in bytes
    text = root.find("AppendedData").text.strip()[1 + offset:]
    return struct.unpack_from(f"<{3 * count}d", base64.b64decode(text[:(size + 2) // 3 * 4]), 8)


class Frames:
    """Positions over time, of the surface or of the finest mesh ("volume"). `rest`: those of the first frame."""

    def __init__(self, folder, film="frames"):
        sets = xml.parse(Path(folder) / f"{film}.pvd").getroot().iter("DataSet")
        self.times, self.files = zip(*((float(d.get("timestep")), Path(folder) / d.get("file")) for d in sets))
        self.points = [read_points(f) for f in self.files]
        self.rest = self.points[0]

    def at(self, time):
        """Interpolated linearly."""
        i = min(max(bisect.bisect_right(self.times, time), 1), len(self.times) - 1)
        t0, t1 = self.times[i - 1], self.times[i]
        w = (time - t0) / (t1 - t0)
        return [a + w * (b - a) for a, b in zip(self.points[i - 1], self.points[i])]


def centre(points):
    n = len(points) // 3
    return [sum(points[k::3]) / n for k in range(3)]


def rotation(H):
    """The orthogonal polar factor of a 3x3 matrix of positive determinant, by Newton's method (Higham 1986): the best
    rotation of Kabsch's problem, whose covariance H is."""
    for _ in range(60):
        c = [[H[(i + 1) % 3][(j + 1) % 3] * H[(i + 2) % 3][(j + 2) % 3]
              - H[(i + 1) % 3][(j + 2) % 3] * H[(i + 2) % 3][(j + 1) % 3] for j in range(3)] for i in range(3)]
        det = sum(H[0][j] * c[0][j] for j in range(3))
        if det <= 0:
            raise ValueError("the surface has been turned inside out")
        size = math.sqrt(sum(x * x for r in H for x in r))
        g = math.sqrt(math.sqrt(sum(x * x for r in c for x in r)) / det / size)
        new = [[0.5 * (g * H[i][j] + c[i][j] / (g * det)) for j in range(3)] for i in range(3)]
        change = max(abs(new[i][j] - H[i][j]) for i in range(3) for j in range(3))
        H = new
        if change < 1e-14:
            break
    return H


def deformation(points, rest_about_centre, middle):
    """Displacements from rest of a surface moved back without its translation and best rotation."""
    x, y, z = (([p - m for p in points[k::3]]) for k, m in zip(range(3), middle))
    X = [rest_about_centre[k::3] for k in range(3)]
    H = [[sum(a * b for a, b in zip(row, column)) for column in X] for row in (x, y, z)]
    R = rotation(H)
    return [[R[0][k] * a + R[1][k] * b + R[2][k] * c - r for a, b, c, r in zip(x, y, z, X[k])] for k in range(3)]


def square(values):
    return sum(v * v for v in values)


def errors(run, reference):
    """Relative differences over the whole run, in the mean square over its frames and all points: of the displacement, of
    its mean (centre), and of the shape: what is left without translation and rotation."""
    middle = centre(run.rest)
    rest = [p - middle[i % 3] for i, p in enumerate(run.rest)]
    total, mean, shape = [0.0, 0.0], [0.0, 0.0], [0.0, 0.0]
    for time, points in zip(run.times, run.points):
        if time > reference.times[-1]:
            break
        truth = reference.at(time)
        total[0] += square(a - b for a, b in zip(points, truth))
        total[1] += square(b - r for b, r in zip(truth, run.rest))
        c, c_true = centre(points), centre(truth)
        mean[0] += square(a - b for a, b in zip(c, c_true))
        mean[1] += square(b - m for b, m in zip(c_true, middle))
        d, d_true = deformation(points, rest, c), deformation(truth, rest, c_true)
        shape[0] += sum(square(a - b for a, b in zip(u, v)) for u, v in zip(d, d_true))
        shape[1] += sum(square(v) for v in d_true)
    ratio = lambda pair: math.sqrt(pair[0] / pair[1]) if pair[1] > 0 else math.nan
    return {"displacement": ratio(total), "centre": ratio(mean), "shape": ratio(shape)}
