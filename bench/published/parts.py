# SPDX-License-Identifier: BSD-3-Clause
"""A finer mesh in a part of an organ with a tumour, beside the mesh that is as fine everywhere and the coarse mesh alone: elements, run time, and errors of the
tool's force and of the displacement in the part. The fine mesh is the coarse one with each tetrahedron cut in eight twice, as the parts are; so all have one skin."""
import csv
import math

import surface_error
from beside_organs import held_by_edges, quadratic, read_gmsh
from bench import ROOT, Failed, number, percent, seconds, table
from box_mesh import write_gmsh

SOURCES, SECONDS = ("core", "kernels", "drivers", "meshes"), 300
HELD = -0.02  # vertices of the coarse mesh below this height are fixed, and what lies on edges between such [m]
MESHES = {"fine": "the fine mesh everywhere", "parts": "parts", "coarse": "the coarse mesh alone"}
FORCE, DISPLACEMENT, TIME = 0.02, 0.03, 0.2  # goals: errors, and the run time over that of the fine mesh
# Balls of the parts, finest first, centre and radius [mm]; the tumour; the tool, and by how much it is pressed in
CASES = {
    "poke": {"parts": (((20, 0, 40), 34), ((20, 0, 36), 56)), "tumour": ((20, 0, 26), 12),
             "tool": "sphere: {centre: [20 mm, 0, 64 mm], radius: 15 mm}", "down": 15},
    "corridor": {"parts": (((20, 0, 36), 30), ((20, 0, 32), 52)), "tumour": ((20, 0, 18), 12),
                 "tool": "capsule: {from: [20 mm, 0, 56 mm], to: [20 mm, 0, 156 mm], radius: 7 mm}", "down": 14}}
WORDS = {"poke": "a round tool pressed on the organ, over the tumour", "corridor": "a thin rod pressed in towards the tumour"}
SCENE = """
name: organ with a tumour
duration: 0.3 s
body:
  levels: [{levels}]
  element: nodal
  material: {{model: neo_hookean, young_modulus: 10 kPa, poisson_ratio: 0.45, density: 1050 kg/m^3}}
  regions: {{tumour: {{where: {tumour}, young_modulus: 100 kPa}}}}
  fixed: [{{group: held}}]
  damping: {{mass: 40 1/s}}
contact:
  stiffness_scale: 10
  obstacles:
    - name: tool
      {tool}
      friction: 0.3
      curve: [{{time: 0 s, displacement: [0, 0, 0]}}, {{time: 0.2 s, displacement: [0, 0, -{down} mm]}}]
integration: {{cycle: single}}
output: {{every: 50 ms, volume: true}}
"""


def refined(points, tets):
    """Each tetrahedron in eight, round the shortest diagonal of the octahedron inside: the cut of `refine` in scenes."""
    import numpy
    points, tets = quadratic(points, tets)
    corner, m01, m12, m02, m03, m13, m23 = tets[:, :4], *tets[:, 4:].T
    cut = [(corner[:, 0], m01, m02, m03), (m01, corner[:, 1], m12, m13), (m02, m12, corner[:, 2], m23), (m03, m13, m23, corner[:, 3])]
    diagonals = ((m01, m23, (m02, m03, m13, m12)), (m02, m13, (m03, m01, m12, m23)), (m03, m12, (m01, m02, m23, m13)))
    shortest = numpy.argmin([numpy.linalg.norm(points[a] - points[b], axis=1) for a, b, _ in diagonals], axis=0)
    for i in range(4):
        choices = [numpy.stack([a, b, ring[i], ring[(i + 1) % 4]], axis=1) for a, b, ring in diagonals]
        cut.append(tuple(numpy.choose(shortest[:, None], choices).T))
    return points, numpy.concatenate([numpy.stack(part, axis=1) for part in cut])


def ball(centre, radius):
    return f"{{sphere: {{centre: [{', '.join(f'{c} mm' for c in centre)}], radius: {radius} mm}}}}"


def keys(points):
    return [tuple(row) for row in (points * 1e7).round().astype(int).tolist()]


def last(said):
    """The displacement at the end by place at rest, and the tool's force."""
    import numpy
    film = surface_error.Frames(said["folder"], "volume")
    rest = numpy.array(film.rest).reshape(-1, 3)
    with open(f"{said['folder']}/history.csv", encoding="utf-8") as file:
        row = list(csv.DictReader(file))[-1]
    return dict(zip(keys(rest), numpy.array(film.points[-1]).reshape(-1, 3) - rest)), [float(row[f"tool.force_{k}"]) for k in "xyz"]


def measure(bench):
    try:
        import numpy
    except ImportError:
        raise Failed("NumPy is not installed") from None
    mesh = "meshes/data/liver_coarse.msh" if bench.small else "meshes/data/liver_fine.msh"
    points, tets = read_gmsh(ROOT / mesh)
    held = points[:, 2] < HELD
    write_gmsh(bench.scratch / "coarse.msh", points, tets, held.nonzero()[0])
    finer = []  # the edges' middles of each refinement: what a motion of the coarse mesh is there
    for _ in range(2):
        before = len(points)
        pairs = numpy.unique(numpy.sort(tets[:, [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]].reshape(-1, 2), axis=1), axis=0)
        held = held_by_edges(tets, held)
        points, tets = refined(points, tets)
        finer.append((before, pairs))
    write_gmsh(bench.scratch / "fine.msh", points, tets, held.nonzero()[0])
    names, rows = keys(points), []
    for case, what in CASES.items():
        refine = [f"{{refine: {ball(*part)}}}" for part in what["parts"]]
        levels = {"fine": [f"{{file: {bench.scratch}/fine.msh}}"], "parts": [*refine, f"{{file: {bench.scratch}/coarse.msh}}"],
                  "coarse": [f"{{file: {bench.scratch}/coarse.msh}}"]}
        truth = None
        for name in MESHES:
            row = {"case": case, "mesh": name}
            rows.append(row)
            try:
                said = bench.run(SCENE.format(levels=", ".join(levels[name]), tumour=ball(*what["tumour"]), tool=what["tool"], down=what["down"]), limit=200)
            except Failed as error:
                row["status"] = str(error)
                continue
            u, force = last(said)
            row |= {"status": said["status"], "tets": said["levels"][0]["tets"], "run": said["wall_time"], "setup": said["setup_time"],
                    "steps": said["macro_steps"], "force": math.hypot(*force)}
            if name == "coarse":
                field = numpy.array([u[key] for key in names[:finer[0][0]]])
                for _, pairs in finer:
                    field = numpy.concatenate([field, field[pairs].mean(axis=1)])
                u = dict(zip(names, field))
            if name == "fine":
                truth = u, force
            elif truth:
                (centre, radius), *_ = what["parts"]
                inside = [key for key in names if key in u and math.dist(key, [1e4 * c for c in centre]) < 1e4 * radius]
                there = numpy.array([truth[0][key] for key in inside])
                row["error"] = float(numpy.linalg.norm(numpy.array([u[key] for key in inside]) - there) / numpy.linalg.norm(there))
                row["force_error"] = math.dist(force, truth[1]) / math.hypot(*truth[1])
                row["points"] = len(inside)
    return rows


def blocks(rows):
    texts = []
    for case in dict.fromkeys(r["case"] for r in rows):
        own = {r["mesh"]: r for r in rows if r["case"] == case}
        fine, lines = own["fine"], []
        for mesh, r in own.items():
            if "run" not in r:
                lines.append([MESHES[mesh], r["status"], "", "", "", ""])
                continue
            over = r["run"] / fine["run"] if "run" in fine else None
            lines.append([MESHES[mesh], f"{r['tets']:,}", seconds(r["run"]), "" if over is None else number(over), percent(r.get("force_error")),
                          percent(r.get("error"))])
        part = own["parts"]
        met = ""
        if "error" in part:
            says = lambda good: "met" if good else "missed"
            met = (f"\n\nGoals: force within {percent(FORCE)}, {says(part['force_error'] <= FORCE)}; displacement within {percent(DISPLACEMENT)}, "
                   f"{says(part['error'] <= DISPLACEMENT)}; {number(TIME)} of the run time, {says(part['run'] <= TIME * fine['run'])}.")
        texts.append(f"**{case}**: {WORDS[case]}.\n\n" + table(["", "tetrahedra", "run time", "over the fine mesh", "error of the force", "of displacement in the part"],
                                                               lines) + met)
    return {"parts": "\n\n".join(texts)}
