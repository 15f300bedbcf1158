# SPDX-License-Identifier: BSD-3-Clause
"""Preconditioners of implicit Euler's linear systems on beams of three sizes and on organs: conjugate gradients' iterations to 1e-8 and times."""
from bench import ROOT, Failed, seconds, table

SOURCES, SECONDS = ("core", "kernels", "drivers", "meshes/data/organs"), 200
PRECONDITIONERS = ("block_jacobi", "chebyshev", "multigrid")
BEAMS = {10692: ((9, 9, 22), (5, 5, 12), (3, 3, 6)), 101802: ((19, 19, 47), (10, 10, 24), (5, 5, 12), (3, 3, 6)),
         814416: ((38, 38, 94), (19, 19, 47), (10, 10, 24), (5, 5, 12), (3, 3, 6))}
ORGANS = ("liver", "ventricle", "branch")
SCENE = """
name: solvers
duration: {duration} s
gravity: [0, 0, -9.81]
body:
  levels: [{levels}]
  element: {element}
  material: {{model: neo_hookean, young_modulus: {young}, poisson_ratio: {nu}, density: 1000}}
  fixed: [{{half_space: {{normal: [{normal}]}}}}]
integration:
  macro_step: 10 ms
  integrator: implicit_euler
  implicit: {{relative_residual: 1e-8, max_iterations: 3000, preconditioner: {preconditioner}}}
output: {{every: 1000 s}}
"""


def one(bench, row, levels, young, nu, normal, steps):
    try:
        said = bench.run(SCENE.format(duration=0.01 * steps, levels=levels, young=young, nu=nu, normal=normal, element=row["element"],
                                      preconditioner=row["preconditioner"]), limit=90)
    except Failed as error:
        return {**row, "status": str(error)}
    counters = said["counters"]
    return {**row, "tets": said["levels"][0]["tets"], "iterations": counters.get("cg_iterations", 0) / max(1, counters.get("linear_solves", steps)),
            "misses": counters.get("cg_misses", 0), "step": said["wall_time"] / said["macro_steps"], "setup": said["setup_time"],
            "status": said["status"]}


def measure(bench):
    rows = []
    for tets, meshes in list(BEAMS.items())[:1] if bench.small else BEAMS.items():
        levels = ", ".join(f"{{box: {{size: [0.1, 0.1, 0.25], cells: {list(c)}}}}}" for c in meshes)
        for preconditioner in PRECONDITIONERS if tets < 800000 else PRECONDITIONERS[2:]:
            row = {"body": f"beam, ν 0.45, {tets:,} tetrahedra", "element": "nodal", "preconditioner": preconditioner}
            rows.append(one(bench, row, levels, "100 kPa", 0.45, "0, 0, 1", 20 if tets < 100000 else 3))
    for organ in ORGANS[:1] if bench.small else ORGANS:
        for nu in (0.45, 0.49):
            for preconditioner in PRECONDITIONERS:
                levels = f"{{file: {ROOT}/meshes/data/organs/{organ}.vtk}}" + (", {coarsen: auto}" if preconditioner == "multigrid" else "")
                row = {"body": f"{organ}, ν {nu:g}", "element": "nodal", "preconditioner": preconditioner}
                rows.append(one(bench, row, levels, "20 kPa", nu, "1, 0, 0", 10))
    return rows


def blocks(rows):
    at = {(r["body"], r["preconditioner"]): r for r in rows}

    def cell(body, preconditioner):
        row = at.get((body, preconditioner))
        if row is None:
            return "–"
        if "iterations" not in row:
            return row["status"]
        return f"{row['iterations']:,.0f}, {seconds(row['step'])}" + (f" ({row['misses']} unsolved)" if row["misses"] else "")
    bodies = list(dict.fromkeys(r["body"] for r in rows))
    return {"solvers": "Iterations of a solve, and the time of a step. One thread, double, nodal elements, steps of 10 ms.\n\n"
            + table(["body", *(f"`{p}`" for p in PRECONDITIONERS)], [[body, *(cell(body, p) for p in PRECONDITIONERS)] for body in bodies])}
