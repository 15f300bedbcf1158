# SPDX-License-Identifier: BSD-3-Clause
"""Boxes of tetrahedra as Gmsh files, which every program here reads: six in a cell, vertices moved at random within their faces."""
import itertools
import math
import random

CORNERS = [(0, 1, 3), (0, 3, 2), (0, 2, 6), (0, 6, 4), (0, 4, 5), (0, 5, 1)]  # with corner 7, around the cell's diagonal


def write_gmsh(file, points, tets, held=()):
    """Gmsh 2.2, ASCII. `held`: numbers of the vertices of a group of that name."""
    with open(file, "w") as out:
        out.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n")
        if len(held):
            out.write('$PhysicalNames\n1\n0 1 "held"\n$EndPhysicalNames\n')
        out.write(f"$Nodes\n{len(points)}\n")
        out.writelines(f"{a} {float(x)!r} {float(y)!r} {float(z)!r}\n" for a, (x, y, z) in enumerate(points, 1))
        out.write(f"$EndNodes\n$Elements\n{len(tets) + len(held)}\n")
        out.writelines(f"{t} 4 2 0 0 {' '.join(str(a + 1) for a in tet)}\n" for t, tet in enumerate(tets, 1))
        out.writelines(f"{p} 15 2 1 1 {a + 1}\n" for p, a in enumerate(held, 1 + len(tets)))
        out.write("$EndElements\n")


class BoxMesh:
    """Vertices [m] from the origin to `size`, x slowest, and tetrahedra of positive volume."""

    def __init__(self, size, cells, jitter=0.0, seed=1):
        draw = random.Random(seed)
        self.size, self.cells, self.volume = size, cells, math.prod(size)
        inner = lambda i, k: 0 < i < cells[k]
        self.vertices = [tuple(size[k] / cells[k] * (i[k] + (jitter * draw.uniform(-1, 1) if inner(i[k], k) else 0)) for k in range(3))
                         for i in itertools.product(*(range(n + 1) for n in cells))]
        at = lambda i, c: ((i[0] + (c & 1)) * (cells[1] + 1) + i[1] + (c >> 1 & 1)) * (cells[2] + 1) + i[2] + (c >> 2)
        self.tets = [tuple(at(i, c) for c in (*corners, 7)) for i in itertools.product(*(range(n) for n in cells)) for corners in CORNERS]

    def clamped(self, axis=0):
        """Vertices at the lower end of an axis."""
        return [a for a, x in enumerate(self.vertices) if x[axis] == 0]

    def end_shares(self, axis=0):
        """Of a uniform traction on the upper end of an axis: the part of the load that each vertex there takes."""
        shares, area = {}, 0.0
        for tet in self.tets:
            for face in itertools.combinations(tet, 3):
                if all(abs(self.vertices[a][axis] - self.size[axis]) < 1e-12 for a in face):
                    p, q, r = ([self.vertices[a][k] for k in range(3) if k != axis] for a in face)
                    part = abs((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])) / 2
                    area += part
                    for a in face:
                        shares[a] = shares.get(a, 0) + part / 3
        return {a: part / area for a, part in shares.items()}

    def write(self, file):
        write_gmsh(file, self.vertices, self.tets)


class CookMesh(BoxMesh):
    """Cook's membrane: corners (0, 0), (48, 44), (48, 60), (0, 44) mm in x and z, 10 mm thick."""

    def __init__(self, cells, jitter=0.0, seed=1):
        super().__init__((1, 1, 1), cells, jitter, seed)
        self.vertices = [(0.048 * x, 0.01 * y, 1e-3 * (44 * x + (44 - 28 * x) * z)) for x, y, z in self.vertices]
        self.size, self.volume = (0.048, 0.01, 0.06), 48 * 30 * 10e-9
