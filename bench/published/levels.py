# SPDX-License-Identifier: BSD-3-Clause
"""Coarse levels that are made of one mesh of an organ: what they are, what they cost, and the error of HIM's steps on them."""
from bench import ROOT, number, percent, seconds, table

SOURCES, SECONDS = ("core", "kernels", "drivers", "meshes"), 220
ORGANS = {"liver": ("20 kPa", "{box: {min: [0.06, -1, -1], max: [1, 1, 1]}}", 0.3),
          "branch": ("50 kPa", "{box: {min: [-1, -1, -1], max: [-0.045, 1, 1]}}", 0.15),
          "ventricle": ("5 kPa", "{box: {min: [-1, -1, 0.015], max: [1, 1, 1]}}", 0.3)}
STEPS = (4, 8, 16, 32)
SCENE = """
name: {organ} of one mesh
duration: {duration} s
gravity: [0, 0, -9.81]
body:
  levels: [{{file: {mesh}}}, {{coarsen: auto}}]
  material: {{model: neo_hookean, young_modulus: {young}, poisson_ratio: 0.45, density: 1050}}
  fixed: [{fixed}]
"""


def measure(bench):
    rows = []
    for organ, (young, fixed, duration) in list(ORGANS.items())[:1] if bench.small else ORGANS.items():
        scene = SCENE.format(organ=organ, duration=duration / 10 if bench.small else duration, young=young, fixed=fixed,
                             mesh=ROOT / f"meshes/data/organs/{organ}.vtk")
        short = bench.run(scene, "integration.cycle=him", "duration=5 ms")
        said = bench.study(scene, methods="single/symplectic_euler, cycle/him", budget=90)
        one = next(r for r in said["rows"] if r["method"] == "single/symplectic_euler" and r["automatic"])
        him = {}
        for row in said["rows"]:
            if row["method"] == "cycle/him" and row["status"] == "completed" and row["macro_step_over_critical"]:
                multiple = min(STEPS, key=lambda m: abs(m - row["macro_step_over_critical"]))
                if abs(row["macro_step_over_critical"] / multiple - 1) < 0.05:
                    him[multiple] = {"error": row["error"], "part": row["wall_time"] / one["wall_time"]}
        rows.append({"organ": organ, "levels": [{key: level[key] for key in ("kind", "vertices", "tets", "inertia")} for level in short["levels"]],
                     "setup": short["setup_time"], "explicit": one["wall_time"], "him": him})
    return rows


def blocks(rows):
    lines = []
    for row in rows:
        him = {int(multiple): value for multiple, value in row["him"].items()}
        cells = [f"{percent(him[m]['error'])} in {number(him[m]['part'])}" if m in him else "–" for m in STEPS]
        lines.append([row["organ"], f"{row['levels'][0]['tets']:,}", ", ".join(f"{level['vertices']:,}" for level in row["levels"]),
                      seconds(row["setup"]), seconds(row["explicit"]), *cells])
    return {"levels": table(["organ", "tetrahedra", "points of the levels", "set-up", "explicit", *(f"HIM, {m} ×" for m in STEPS)], lines)}
