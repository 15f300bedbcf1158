# SPDX-License-Identifier: BSD-3-Clause
"""The time of a step beside other programs, one thread each, interleaved: the same clamped beam, material and step."""
import os
import statistics
import subprocess
from pathlib import Path

from bench import cpu_of_programs, installed, number, table
from box_mesh import BoxMesh

SOURCES, SECONDS = ("core", "kernels", "drivers", "bench/mujoco_flex.py", "bench/newton_body.py"), 300
SIZE, YOUNG, NU, DENSITY, GRAVITY = (0.1, 0.1, 0.25), 1e5, 0.45, 1000.0, -9.81
CELLS = {"1k": (4, 4, 10), "10k": (9, 9, 22), "100k": (19, 19, 47)}
STEPS = {"1k": 4e-4, "10k": 2e-4, "100k": 1e-4}  # explicit ones, below every program's limit [s]
LONGER = {"1k": 10, "10k": 5, "100k": 1}
IMPLICIT = 0.01
PLICA = """
name: beam
duration: {duration!r} s
gravity: [0, 0, {gravity}]
body:
  levels: [{{file: {mesh}}}]
  element: {element}
  material: {{model: {material}, young_modulus: {young!r}, poisson_ratio: {nu}, density: {density}}}
  fixed: [{{half_space: {{}}}}]
integration: {{macro_step: {step!r} s, integrator: {integrator}}}
output: {{every: 1000 s}}
"""
SOFA_SCENE = """<Node name="root" dt="{step!r}" gravity="0 0 {gravity}"><RequiredPlugin name="Sofa.Component"/><DefaultAnimationLoop/><Node name="beam">{solver}
<MeshGmshLoader name="mesh" filename="{mesh}"/><TetrahedronSetTopologyContainer src="@mesh"/><TetrahedronSetGeometryAlgorithms template="Vec3"/>
<MechanicalObject template="Vec3"/><DiagonalMass massDensity="{density}"/><FixedProjectiveConstraint indices="{pins}"/>
<TetrahedronHyperelasticityFEMForceField materialName="StVenantKirchhoff" ParameterSet="{mu!r} {lame!r}"/></Node></Node>
"""
EXPLICIT_SOLVER = '<EulerExplicitSolver symplectic="1"/>'
IMPLICIT_SOLVER = '<EulerImplicitSolver/><CGLinearSolver iterations="25" tolerance="1e-12" threshold="1e-12"/>'


class Plica:
    """A round is the steps of a run, less the step of a run of a single one, which prepares: their time without what they waited for a core."""

    def __init__(self, bench, case, element, material, precision, implicit=False):
        self.bench, self.precision, self.step = bench, precision, IMPLICIT if implicit else STEPS[case.size]
        self.steps = (10 if implicit else 400) * LONGER[case.size]
        self.text = PLICA.format(duration="{duration}", mesh=case.file, element=element, material=material, young=YOUNG, nu=NU, density=DENSITY,
                                 gravity=GRAVITY, step=self.step, integrator="implicit_euler" if implicit else "symplectic_euler")

    def round(self):
        one = self.run(1)
        return (self.run(1 + self.steps) - one) / self.steps

    def run(self, steps):
        summary = self.bench.run(self.text.replace("'{duration}'", repr(max(1, steps - 0.5) * self.step)), precision=self.precision)
        return summary["wall_time"] * (1 - (summary["wait_share"] or 0))


class Sofa:
    """runSofa without a window: CPU time; a round is a run, less a run of a single step."""

    def __init__(self, case, root, implicit=False):
        self.steps, self.root = (2 if implicit else 40) * LONGER[case.size], Path(root)
        self.scene = case.file.with_suffix(f".{implicit}.scn")
        mu, lame = YOUNG / (2 * (1 + NU)), YOUNG * NU / ((1 + NU) * (1 - 2 * NU))
        self.scene.write_text(SOFA_SCENE.format(step=IMPLICIT if implicit else STEPS[case.size], gravity=GRAVITY, density=DENSITY, mesh=case.file,
                                                solver=IMPLICIT_SOLVER if implicit else EXPLICIT_SOLVER, mu=mu, lame=lame,
                                                pins=" ".join(map(str, case.mesh.clamped(2)))))

    def round(self):
        return (self.run(1 + self.steps) - self.run(1)) / self.steps

    def run(self, steps):
        before = cpu_of_programs()
        subprocess.run([str(self.root / "bin/runSofa"), "-g", "batch", "-n", str(steps), str(self.scene)], check=True, capture_output=True,
                       env={**os.environ, "OMP_NUM_THREADS": "1"})
        return cpu_of_programs() - before


class Inside:
    """A body of another program in this process."""

    def __init__(self, body, steps):
        self.body, self.steps = body, steps
        body.run(2)

    def round(self):
        return self.body.run(self.steps) / self.steps


class Case:
    def __init__(self, size, folder):
        self.size, self.mesh, self.file = size, BoxMesh(SIZE, CELLS[size]), folder / f"{size}.msh"
        self.mesh.write(self.file)


def contestants(bench, case, others):
    """{kind of step: {program: what is timed}}"""
    step, law, longer = STEPS[case.size], "st_venant_kirchhoff", LONGER[case.size]
    plica = lambda *words: Plica(bench, case, *words)
    double = {"Plica, linear": plica("linear", law, "double"), "Plica, nodal": plica("nodal", law, "double")}
    single = {"Plica, linear": plica("linear", "neo_hookean", "float"), "Plica, nodal": plica("nodal", "neo_hookean", "float")}
    implicit = {"Plica, linear": plica("linear", law, "double", True), "Plica, nodal": plica("nodal", law, "double", True)}
    if flex := others["MuJoCo"]:
        body = lambda dt, how, n: Inside(flex.Flex(case.mesh, case.file, YOUNG, NU, DENSITY, dt, how, gravity=GRAVITY, axis=2), n * longer)
        double["MuJoCo"], implicit["MuJoCo"] = body(step, "Euler", 20), body(IMPLICIT, "discrete", 1)
    if (newton := others["Newton"]) and case.size != "100k":
        single["Newton (CPU)"] = Inside(newton.Body(case.mesh, YOUNG, NU, DENSITY, step, GRAVITY, 2), 10 * longer)
    if root := others["SOFA"]:
        double["SOFA"], implicit["SOFA"] = Sofa(case, root), Sofa(case, root, True)
    return {"explicit, double": double, "explicit, float": single, "implicit, 10 ms, double": implicit}


def measure(bench):
    others = {"MuJoCo": installed("mujoco_flex"), "Newton": installed("newton_body"), "SOFA": os.environ.get("SOFA_ROOT")}
    rows = []
    for size in ("1k",) if bench.small else ("10k", "100k"):
        case = Case(size, bench.scratch)
        kinds = contestants(bench, case, others)
        times = {kind: {name: [] for name in members} for kind, members in kinds.items()}
        for _ in range(1 if bench.small else 5):
            for kind, members in kinds.items():
                for name, member in members.items():
                    times[kind][name].append(member.round())
        rows += [{"tets": len(case.mesh.tets), "step": kind, "program": name, "seconds": spent}
                 for kind, members in times.items() for name, spent in members.items()]
    return {"rows": rows, "versions": {name: getattr(found, "VERSION", "") for name, found in others.items() if found}}


def blocks(data):
    rows = data["rows"]
    programs = list(dict.fromkeys(row["program"] for row in rows))
    at = {(r["tets"], r["step"], r["program"]): r["seconds"] for r in rows}
    cases = list(dict.fromkeys((r["tets"], r["step"]) for r in rows))

    def cell(case, program):
        spent = at.get((*case, program))
        return number(1e3 * statistics.median(spent)) if spent else "–"

    lines = [[f"{tets:,}", step, *(cell((tets, step), p) for p in programs)] for tets, step in cases]
    versions = ", ".join(f"{name} {version}" for name, version in data["versions"].items()) or "no other program was installed"
    full = table(["tetrahedra", "step", *(f"{p}, ms" for p in programs)], lines, left=2) + f"\n\nMedian of five rounds. {versions}."
    most = max(tets for tets, _ in cases)
    shown = [p for p in programs if any(cell(case, p) != "–" for case in cases if case[0] == most)]
    short = table([f"a step of {most:,} tetrahedra, ms", *shown], [[case[1], *(cell(case, p) for p in shown)] for case in cases if case[0] == most])
    return {"beside_steps": full, "beside_short": short}
