#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the meshes of this folder: Delaunay tetrahedra, slivers and all, of the vertices of a grid moved at random by up to 0.35 of a cell within their
faces. Cells are cubes of 1; `plica verify` scales them. Needs numpy and scipy:

    python3 make_delaunay.py FOLDER
"""
import itertools
import sys
from pathlib import Path

import numpy as np
from scipy.spatial import Delaunay

GRIDS = [(8, 2, 2), (16, 4, 4), (4, 4, 2), (8, 8, 2), (4, 4, 4), (6, 6, 6)]


def delaunay(cells, seed=1):
    grid = np.array(list(itertools.product(*(range(n + 1) for n in cells))), float)
    moves = np.random.default_rng(seed).uniform(-0.35, 0.35, grid.shape)
    points = np.round(grid + moves * ((grid > 0) & (grid < np.array(cells))), 3)
    tets = Delaunay(points).simplices
    on_face = [np.abs(points[tets][:, :, k] - end) < 1e-9 for k in range(3) for end in (0, cells[k])]
    tets = tets[~np.any([face.all(axis=1) for face in on_face], axis=0)]  # flat ones
    edges = points[tets[:, 1:]] - points[tets[:, :1]]
    turned = np.linalg.det(edges) < 0
    tets[turned] = tets[turned][:, [0, 1, 3, 2]]
    assert len(np.unique(tets)) == len(points)
    assert abs(np.abs(np.linalg.det(edges)).sum() / 6 - np.prod(cells)) < 1e-9
    return points, tets


def rows(values, form):
    return ",\n".join(", ".join("{" + ", ".join(form(v) for v in row) + "}" for row in values[i:i + 8]) for i in range(0, len(values), 8))


def main():
    for cells in GRIDS:
        name = "x".join(map(str, cells))
        points, tets = delaunay(cells)
        (Path(sys.argv[1]) / f"{name}.inc").write_text(
            f"// By make_delaunay.py: {len(points)} vertices, {len(tets)} tetrahedra of a box of {name} cells\n"
            f"constexpr double vertices_{name}[][3] = {{\n{rows(points, lambda v: f'{v:g}')}}};\n"
            f"constexpr int tets_{name}[][4] = {{\n{rows(tets, str)}}};\n")


main()
