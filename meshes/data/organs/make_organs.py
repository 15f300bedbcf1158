#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the meshes of this folder: three bodies like organs, of our own making, from surfaces that are formulas.

liver      a thick lobe that thins out to an edge, 16 cm long, with a furrow
ventricle  a thick-walled cup, 8 cm high, thin at its tip
branch     a pipe that forks, 10 cm long, its walls 2 mm to 3 mm thin

Needs numpy, scikit-image and pytetwild (fTetWild: Hu et al. 2020, ACM Trans. Graph. 39:117). The mesher is stopped early, so that
the meshes keep slivers as meshes from scans have them:

    python3 make_organs.py FOLDER
"""

import struct
import sys

import numpy as np
import pytetwild
from skimage.measure import marching_cubes


def smooth_min(a, b, k):
    h = np.clip(0.5 + 0.5 * (b - a) / k, 0, 1)
    return b * (1 - h) + a * h - k * h * (1 - h)


def ellipsoid(p, centre, radii):
    q = (p - centre) / radii
    k0 = np.linalg.norm(q, axis=-1)
    k1 = np.linalg.norm(q / radii, axis=-1)
    return k0 * (k0 - 1) / np.maximum(k1, 1e-9)


def capsule(p, a, b, radius):
    d = b - a
    t = np.clip(((p - a) @ d) / (d @ d), 0, 1)
    return np.linalg.norm(p - a - t[..., None] * d, axis=-1) - radius


def liver(p):
    right = ellipsoid(p, np.array([0.045, 0, 0]), np.array([0.055, 0.045, 0.038]))
    middle = ellipsoid(p, np.array([-0.01, 0.006, 0.004]), np.array([0.05, 0.034, 0.02]))
    left = ellipsoid(p, np.array([-0.06, 0.012, 0.008]), np.array([0.045, 0.026, 0.0055]))
    body = smooth_min(smooth_min(right, middle, 0.02), left, 0.012)
    furrow = capsule(p, np.array([0.01, -0.06, 0.03]), np.array([0.0, 0.06, 0.036]), 0.012)
    return np.maximum(body, -furrow)


def ventricle(p):
    outer = ellipsoid(p, np.zeros(3), np.array([0.034, 0.034, 0.06]))
    inner = ellipsoid(p, np.array([0, 0, 0.004]), np.array([0.022, 0.022, 0.0605]))
    return np.maximum(np.maximum(outer, -inner), p[..., 2] - 0.02)


def branch(p):
    stem = [np.array([-0.05, 0, 0]), np.array([0, 0, 0])]
    arms = [np.array([0.045, 0.028, 0.006]), np.array([0.05, -0.022, -0.004])]
    outer = capsule(p, *stem, 0.0095)
    inner = capsule(p, stem[0] - np.array([0.03, 0, 0]), stem[1], 0.0068)
    for end, radius in zip(arms, (0.0072, 0.0062)):
        outer = smooth_min(outer, capsule(p, stem[1], end, radius), 0.004)
        inner = smooth_min(inner, capsule(p, stem[1], 1.5 * end, radius - 0.0022), 0.003)
    body = np.maximum(outer, -inner)
    body = np.maximum(body, -0.05 - p[..., 0])
    for end in arms:
        along = end / np.linalg.norm(end)
        body = np.maximum(body, (p - end) @ along)
    return body


def surface(distance, low, high, step):
    axes = [np.arange(a - 2 * step, b + 3 * step, step) for a, b in zip(low, high)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    points, faces, _, _ = marching_cubes(distance(grid), 0, spacing=(step,) * 3)
    return points + [a[0] for a in axes], faces[:, ::-1]


def write_vtk(path, title, points, tets):
    with open(path, "wb") as f:
        f.write(f"# vtk DataFile Version 3.0\n{title}\nBINARY\nDATASET UNSTRUCTURED_GRID\n".encode())
        f.write(f"POINTS {len(points)} float\n".encode() + points.astype(">f4").tobytes())
        cells = np.column_stack([np.full(len(tets), 4), tets])
        f.write(f"\nCELLS {len(tets)} {cells.size}\n".encode() + cells.astype(">i4").tobytes())
        f.write(f"\nCELL_TYPES {len(tets)}\n".encode() + struct.pack(">i", 10) * len(tets) + b"\n")


ORGANS = {
    "liver": (liver, (-0.11, -0.06, -0.05), (0.11, 0.06, 0.05), 0.0025, 0.0060),
    "ventricle": (ventricle, (-0.04, -0.04, -0.065), (0.04, 0.04, 0.025), 0.0015, 0.0039),
    "branch": (branch, (-0.055, -0.04, -0.02), (0.06, 0.045, 0.02), 0.0008, 0.0016),
}

if __name__ == "__main__":
    for name, (distance, low, high, step, edge) in ORGANS.items():
        points, tets = pytetwild.tetrahedralize(
            *surface(distance, low, high, step), edge_length_abs=edge, stop_energy=60, num_opt_iter=10, epsilon=2e-3, num_threads=1
        )
        corners = points[tets]
        volumes = np.einsum("ij,ij->i", np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), corners[:, 3] - corners[:, 0])
        tets[volumes < 0] = tets[volumes < 0][:, [0, 2, 1, 3]]
        write_vtk(f"{sys.argv[1]}/{name}.vtk", f"{name}, made by make_organs.py", points, tets)
        print(name, len(points), "vertices", len(tets), "tetrahedra")
