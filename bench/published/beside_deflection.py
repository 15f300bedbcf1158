# SPDX-License-Identifier: BSD-3-Clause
"""Deflections of clamped beams and of Cook's membrane at rest under an end load beside MuJoCo's, on the same irregular meshes: accuracy, and CPU time
to it."""
import csv
import itertools
import math
import time

from bench import Failed, cpu_of_programs, installed, seconds, table
from box_mesh import BoxMesh, CookMesh

mujoco_flex = installed("mujoco_flex")
SOURCES, SECONDS = ("core", "kernels", "drivers", "bench/mujoco_flex.py", "bench/box_mesh.py"), 420
YOUNG, DENSITY, NUS = 1e7, 1000.0, (0.3, 0.45, 0.49, 0.4999)  # SI


class Beam(BoxMesh):
    """1 m long, of square section."""

    def __init__(self, side, cells):
        super().__init__((1.0, side, side), cells, jitter=0.2)
        self.omega = 1.8751**2 * math.sqrt(YOUNG * side**2 / 12 / DENSITY)


class Cook(CookMesh):
    def __init__(self, cells):
        super().__init__(cells, jitter=0.2)
        self.omega = 1241.0  # of its second mode, the first in its plane


# Mesh, area of its end [m^2], load [N], deflections [m], cells. Deflections: quadratic elements with linear pressures, extrapolated, of beams as in
# `plica verify bending`, of Cook's membrane by scikit-fem
BODIES = {"slender beam": (lambda cells: Beam(0.05, cells), 0.05**2, 0.01, (6.3884e-4, 6.3560e-4, 6.3438e-4, 6.3405e-4), ((40, 2, 2), (80, 4, 4))),
          "thick beam": (lambda cells: Beam(0.25, cells), 0.25**2, 1.0, (1.0557e-4, 1.0364e-4, 1.0288e-4, 1.0267e-4), ((16, 4, 4), (32, 8, 8))),
          "Cook's membrane": (Cook, 1.6e-4, 0.0256, (6.110e-6, 6.119e-6, 6.113e-6, 6.110e-6), ((8, 2, 8), (16, 4, 16)))}
CASES = [("thick beam", 0.45, 0), ("thick beam", 0.4999, 0), ("slender beam", 0.45, 0), ("Cook's membrane", 0.45, 0), ("thick beam", 0.45, 1),
         ("Cook's membrane", 0.45, 1)]  # which mesh
SETTLED = 2e-3  # change of the deflection over the last fifth of a run, relative, below which it is at rest
LIMIT = 20  # CPU seconds of a run
SCENE = """
name: at rest
duration: {duration!r} s
body:
  levels: [{{file: {mesh}}}]
  element: {element}
  material: {{model: st_venant_kirchhoff, young_modulus: {young!r}, poisson_ratio: {nu!r}, density: {density!r}}}
  fixed: [{{half_space: {{point: [0, 0, 0], normal: [1, 0, 0]}}}}]
  loads: [{{half_space: {{point: [{length!r}, 0, 0], normal: [-1, 0, 0]}}, traction: [0, 0, {traction!r}]}}]
  damping: {{mass: {damping!r}}}
integration: {{{integration}}}
output: {{every: 1000 s, probe_every: {every!r} s, probes: {{{probes}}}}}
"""
# Name: what the scene says, and its duration in the case's
STEPPERS = {"explicit": ("macro_step: auto", 1), "HIM": ("cycle: him", 1),
            "implicit, 5 steps": ("integrator: implicit_euler, macro_step: {duration!r} s, "
                                  "implicit: {{relative_residual: 1e-5, max_iterations: 20000, preconditioner: multigrid}}", 5)}


class Case:
    """A body at one Poisson's ratio on one mesh. Its first mode is critically damped by mass, explicit runs end after 12 / omega of it."""

    def __init__(self, body, nu, fine, folder):
        mesh, area, self.load, accepted, meshes = BODIES[body]
        self.body, self.nu, self.traction, self.accepted = body, nu, self.load / area, accepted[NUS.index(nu)]
        self.mesh = mesh(meshes[fine])
        self.shares, self.file = self.mesh.end_shares(), folder / f"{len(self.mesh.tets)}_{self.load}.msh"
        self.mesh.write(self.file)
        self.duration, self.damping = 12 / self.mesh.omega, 2 * self.mesh.omega

    def row(self, program, stepper, deflection, before, spent, **more):
        change = abs(deflection / before - 1) if before else math.inf
        return {"body": self.body, "nu": self.nu, "tets": len(self.mesh.tets), "program": program, "stepper": stepper,
                "ratio": deflection / self.accepted, "settled": bool(change < SETTLED), "change": min(change, 1e9), "seconds": spent, **more}

    def failed(self, program, stepper, why):
        return {"body": self.body, "nu": self.nu, "tets": len(self.mesh.tets), "program": program, "stepper": stepper, "settled": False, "why": why}


def plica(bench, case, element, stepper):
    integration, length = STEPPERS[stepper]
    duration = length * case.duration
    ends = {f"p{a}": case.mesh.vertices[a] for a in case.shares}
    scene = SCENE.format(duration=duration, mesh=case.file, element=element, young=YOUNG, nu=case.nu, density=DENSITY, traction=-case.traction,
                         length=case.mesh.size[0], damping=case.damping if length == 1 else 0.0,
                         integration=integration.format(duration=case.duration), every=duration / 5,
                         probes=", ".join(f"{p}: [{x[0]!r}, {x[1]!r}, {x[2]!r}]" for p, x in ends.items()))
    spent = []
    while len(spent) < 3 and sum(spent) < LIMIT / 10:
        before = cpu_of_programs()
        try:
            summary = bench.run(scene, limit=2 * LIMIT)
        except Failed as error:
            return case.failed(f"Plica, {element}", stepper, str(error))
        spent.append(cpu_of_programs() - before)
    if misses := summary["counters"].get("cg_misses"):
        return case.failed(f"Plica, {element}", stepper, f"{misses} linear solves did not converge")
    with open(f"{summary['folder']}/probes.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    at = [-sum(share * (float(r[f"p{a}_z"]) - case.mesh.vertices[a][2]) for a, share in case.shares.items()) for r in rows]
    return case.row(f"Plica, {element}", stepper, at[-1], at[-2], min(spent), critical_step=summary["levels"][0]["critical_step"])


def mujoco_run(case, integrator, stepper, step, length, trial=200):
    """A row; None where it blew up."""
    start = time.process_time()
    damping = case.damping if integrator == "Euler" else 0.0
    body = mujoco_flex.Flex(case.mesh, case.file, YOUNG, case.nu, DENSITY, step, integrator, damping=damping,
                            forces={a: -case.load * share for a, share in case.shares.items()})
    set_up = time.process_time() - start
    count = max(1, math.ceil(length * case.duration / step / 5))  # steps in a fifth of the run
    trial = min(trial, count)
    first = body.run(trial)
    if first is None:
        return None
    if 5 * count * first / trial > LIMIT:
        return case.failed("MuJoCo", stepper, f"{5 * count} steps would take {5 * count * first / trial:.0f} s")
    before, spent = 0.0, [first, body.run(count - trial)]
    for _ in range(4):
        before = -body.deflection(case.shares)
        spent.append(body.run(count))
    return None if None in spent else case.row("MuJoCo", stepper, -body.deflection(case.shares), before, set_up + sum(spent))


def mujoco_rows(case, critical):
    """It states no largest stable step; so that is searched in tenths of Plica's, and the search is not counted."""
    for part in (1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4):
        if row := mujoco_run(case, "Euler", "explicit", part * critical, 1):
            yield row
            break
    for parts in (1, 12, 60):
        stepper = f"implicit, {5 * parts} steps"
        yield mujoco_run(case, "discrete", stepper, case.duration / parts, 5, 1) or case.failed("MuJoCo", stepper, "blew up")


def measure(bench):
    rows = []
    for body, nu, fine in CASES[:1] if bench.small else CASES:
        case = Case(body, nu, fine, bench.scratch)
        own = [plica(bench, case, element, stepper) for element, stepper in itertools.product(("linear", "nodal"), STEPPERS)]
        rows += own
        critical = next((r["critical_step"] for r in own if r["program"] == "Plica, linear" and "critical_step" in r), None)
        if mujoco_flex and critical:
            rows += mujoco_rows(case, critical)
    return {"rows": rows, "MuJoCo": mujoco_flex.VERSION if mujoco_flex else None}


def best(rows):
    """The fastest that is at rest; or else the one that is nearest to it."""
    settled = [r for r in rows if r["settled"]]
    return min(settled, key=lambda r: r["seconds"]) if settled else min(rows, key=lambda r: r.get("change", math.inf))


def cell(rows):
    if not rows:
        return "not installed"
    row = best(rows)
    if "why" in row:
        return row["why"]
    return f"**{row['ratio']:.2f}** in {seconds(row['seconds'])} ({row['stepper']}{'' if row['settled'] else ', not at rest'})"


def blocks(data):
    rows, programs = data["rows"], ("Plica, nodal", "Plica, linear", "MuJoCo")
    cases = list(dict.fromkeys((r["body"], r["nu"], r["tets"]) for r in rows))
    of = lambda case, program: [r for r in rows if (r["body"], r["nu"], r["tets"], r["program"]) == (*case, program)]
    line = lambda case: [f"{case[0]}, ν {case[1]:g}, {case[2]:,}", *(cell(of(case, program)) for program in programs)]
    heads = ["body, tetrahedra", *programs]
    full = table(heads, [line(case) for case in cases])
    return {"beside_deflection": full, "deflection_short": table(["deflection over that of refined quadratic elements, CPU time to rest", *programs], [[f"{line(cases[0])[0]} tetrahedra", *line(cases[0])[1:]]])}
