# SPDX-License-Identifier: BSD-3-Clause
"""Nodal elements with plain and with smoothed pressures, from nu 0.3 to 0.49: error of the displacement and CPU time, on one thread. At rest, reached by
implicit steps, beside quadratic tetrahedra of felupe on a refined mesh; in motion, by explicit steps, beside smoothed elements on a mesh refined twice."""
import itertools

import surface_error
from beside_organs import DENSITY, GRAVITY, YOUNG, by_felupe, held_by_edges, quadratic, read_gmsh, refined
from bench import ROOT, Failed, cpu_of_programs, installed, percent, seconds, table
from box_mesh import BoxMesh, write_gmsh

SOURCES, SECONDS = ("core", "kernels", "drivers", "meshes/data/liver_medium.msh"), 900
NUS, PRESSURES = (0.3, 0.4, 0.45, 0.49), ("plain", "smoothed")
SOFT = 5e4  # Young's modulus in motion [Pa]; at rest it is YOUNG, so that strains stay small and every law is the linear one
SCENE = """
name: sagging body
duration: {duration} s
gravity: [{gravity}, 0, 0]
body:
  levels: [{{file: {mesh}}}]
  element: nodal
  volumetric_smoothing: {pressure}
  material: {{model: neo_hookean, young_modulus: {young}, poisson_ratio: {nu}, density: {density}}}
  fixed: [{{group: held}}]
integration: {integration}
output: {{every: {every} s, volume: true}}
"""
IMPLICIT = "{integrator: implicit_euler, macro_step: 1 s, implicit: {relative_residual: 1e-6, max_iterations: 20000, preconditioner: multigrid}}"
EXPLICIT = "{cycle: single, integrator: symplectic_euler}"


def bodies(small):
    """{name: meshes}, each of points, tetrahedra and which points are held; the next one is refined and has the points of the one before first."""
    import numpy
    beam = BoxMesh((0.06, 0.06, 0.24), (2, 2, 8) if small else (3, 3, 12), jitter=0.2)
    coarse = {"beam": (numpy.array(beam.vertices), numpy.array(beam.tets), 0)}  # the last: the part of the height that is held
    if not small:
        coarse["liver"] = (*read_gmsh(ROOT / "meshes/data/liver_medium.msh"), 0.25)
    all_meshes = {}
    for name, (points, tets, part) in coarse.items():
        height = points[:, 2] - points[:, 2].min()
        held = height <= part * height.max()
        meshes = [(points, tets, held)]
        for _ in range(2):
            points, tets, held = (*refined(points, tets), held_by_edges(tets, held))
            meshes.append((points, tets, held))
        all_meshes[name] = meshes
    return all_meshes


def motion(bench, mesh, pressure, nu, explicit):
    """Displacements of all points in each frame after the first, and CPU time."""
    import numpy
    file = bench.scratch / "body.msh"
    write_gmsh(file, mesh[0], mesh[1], mesh[2].nonzero()[0])
    duration, every = (0.2, 0.025) if explicit else (5, 5)
    before = cpu_of_programs()
    said = bench.run(SCENE.format(duration=duration, every=every, gravity=GRAVITY, mesh=file, pressure=pressure, young=SOFT if explicit else YOUNG, nu=nu,
                                  density=DENSITY, integration=EXPLICIT if explicit else IMPLICIT), limit=600)
    film = surface_error.Frames(said["folder"], "volume")
    frames = numpy.array(film.points).reshape(len(film.points), -1, 3)
    return frames[1:] - frames[0], cpu_of_programs() - before


def measure(bench):
    if not installed("felupe"):
        raise Failed("felupe is not installed")
    import numpy
    rows = []
    for name, meshes in bodies(bench.small).items():
        count = len(meshes[0][0])  # of the points that all meshes have
        for nu, explicit in itertools.product(NUS, (False, True)):
            if explicit:
                truth = motion(bench, meshes[2], "smoothed", nu, True)[0]
            else:
                points, tets, held = meshes[1]
                truth = by_felupe(*quadratic(points, tets), nu, held_by_edges(tets, held))[0][None]
            for (points, tets, held), pressure in itertools.product(meshes[:2], PRESSURES):
                row = {"body": name, "nu": nu, "steps": "explicit" if explicit else "implicit", "tets": len(tets), "pressure": pressure}
                try:
                    u, spent = motion(bench, (points, tets, held), pressure, nu, explicit)
                except Failed as error:
                    rows.append({**row, "status": str(error)})
                    continue
                error = numpy.linalg.norm(u[:, :count] - truth[:, :count]) / numpy.linalg.norm(truth[:, :count])
                rows.append({**row, "error": float(error), "seconds": spent})
    return rows


def blocks(rows):
    at = {(r["body"], r["tets"], r["steps"], r["pressure"], r["nu"]): r for r in rows}
    nus = sorted({r["nu"] for r in rows})

    def cell(*key):
        row = at[key]
        return f"{percent(row['error'])} in {seconds(row['seconds'])}" if "error" in row else row["status"]
    kinds = dict.fromkeys((r["body"], r["tets"], r["steps"], r["pressure"]) for r in rows)
    lines = [[body, f"{tets:,}", steps, pressure,
              *(cell(body, tets, steps, pressure, nu) for nu in nus)]
             for body, tets, steps, pressure in sorted(kinds, key=lambda k: (k[0], k[2], k[1], k[3]))]
    return {"smoothing": table(["body", "tetrahedra", "steps", "pressures", *(f"ν {nu:g}: error, CPU time" for nu in nus)], lines, left=4)}
