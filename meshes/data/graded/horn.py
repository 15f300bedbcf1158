# SPDX-License-Identifier: BSD-3-Clause
"""Makes horn_fine.msh, horn_medium.msh and horn_coarse.msh (pip install gmsh; made with 4.15.2).

A horn that bends upwards and tapers, flat where it may be held (x = 0, the group "base"); metres. Edges grow with the
distance from a spot on its side, 1 : 16 in one mesh, so that the critical step is that of a few elements. Each mesh is made
anew: they share no vertex but by chance.
"""
import math

import gmsh

LENGTH, BEND = 0.16, math.radians(50)
SPOT = (0.11, 0, 0.055)  # where edges are shortest


def section(s):
    """An ellipse across the horn's middle line, an arc, at the part s of its length."""
    turn, radius = s * BEND, LENGTH / BEND
    half_axes = (0.036 - 0.020 * s, 0.028 - 0.016 * s)
    curve = gmsh.model.occ.addEllipse(0, 0, 0, *half_axes)
    gmsh.model.occ.rotate([(1, curve)], 0, 0, 0, 0, 0, 1, math.pi / 2)  # the longer one along y
    gmsh.model.occ.rotate([(1, curve)], 0, 0, 0, 0, 1, 0, math.pi / 2 - turn)
    gmsh.model.occ.translate([(1, curve)], radius * math.sin(turn), 0, radius * (1 - math.cos(turn)))
    return gmsh.model.occ.addCurveLoop([curve])


def nodes():
    tags, places, _ = gmsh.model.mesh.getNodes()
    return [(tag, places[3 * i : 3 * i + 3]) for i, tag in enumerate(tags)]


def make(name, shortest, longest):
    gmsh.model.add(name)
    gmsh.model.occ.addThruSections([section(i / 4) for i in range(5)])
    gmsh.model.occ.remove(gmsh.model.occ.getEntities(1))
    gmsh.model.occ.synchronize()
    small = 1e-3
    base = gmsh.model.getEntitiesInBoundingBox(-small, -1, -1, small, 1, 1, 2)
    for dim, tags, label in ((2, base, "base"), (3, gmsh.model.getEntities(3), "tissue")):
        group = gmsh.model.addPhysicalGroup(dim, [tag for _, tag in tags])
        gmsh.model.setPhysicalName(dim, group, label)
    away = "+".join(f"({axis}-{at})^2" for axis, at in zip("xyz", SPOT))
    size = gmsh.model.mesh.field.add("MathEval")
    gmsh.model.mesh.field.setString(size, "F", f"{shortest}+{longest - shortest}*Sqrt({away})/0.13")
    gmsh.model.mesh.field.setAsBackgroundMesh(size)
    for option in ("MeshSizeExtendFromBoundary", "MeshSizeFromPoints", "MeshSizeFromCurvature"):
        gmsh.option.setNumber("Mesh." + option, 0)
    gmsh.model.mesh.generate(3)
    for tag, at in nodes():
        gmsh.model.mesh.setNode(tag, [round(x, 6) + 0.0 for x in at], [])  # micrometres: short numbers
    gmsh.write(f"horn_{name}.msh")


if __name__ == "__main__":
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    make("fine", 0.0014, 0.0118)
    make("medium", 0.0028, 0.0175)
    make("coarse", 0.0056, 0.027)
    gmsh.finalize()
