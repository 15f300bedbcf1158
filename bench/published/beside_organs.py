# SPDX-License-Identifier: BSD-3-Clause
"""A liver that sags at rest, by Plica's elements and by linear and quadratic tetrahedra of felupe and CalculiX: error of the displacement against
quadratic tetrahedra on a refined mesh, and CPU time to it, on one thread. The held part is the same in all meshes, that of the coarsest one's
tetrahedra: one that grew with each mesh would make the coarse bodies taller and hide that linear tetrahedra are stiff."""
import itertools
import shutil
import subprocess
import time

import surface_error
from bench import ROOT, Failed, cpu_of_programs, percent, seconds, table
from box_mesh import write_gmsh

SOURCES, SECONDS = ("core", "kernels", "drivers", "meshes/data/organs/liver.vtk"), 300
YOUNG, DENSITY, GRAVITY, NUS = 1e6, 1050.0, 9.81, (0.45, 0.49)  # so stiff that strains are small and every law is the linear one
EDGES = (12, 8)  # of the tetrahedra by Gmsh [mm]
HELD = -0.02  # vertices of the coarsest mesh below this height are fixed, and what lies on edges between such [m]
SCENE = """
name: sagging liver
duration: 5 s
gravity: [{gravity}, 0, 0]
body:
  levels: [{{file: {mesh}}}]
  element: {element}
  material: {{model: linear, young_modulus: {young}, poisson_ratio: {nu}, density: {density}}}
  fixed: [{{group: held}}]
integration:
  integrator: implicit_euler
  macro_step: 1 s
  implicit: {{relative_residual: 1e-6, max_iterations: 20000, preconditioner: multigrid}}
output: {{every: 5 s, volume: true}}
"""


def refined(points, tets):
    """Every tetrahedron in eight, around one diagonal of the octahedron inside."""
    import numpy
    points, tets = quadratic(points, tets)
    m = tets[:, 4:]  # 01 12 02 03 13 23
    corner = tets[:, :4]
    parts = [(corner[:, 0], m[:, 0], m[:, 2], m[:, 3]), (m[:, 0], corner[:, 1], m[:, 1], m[:, 4]), (m[:, 2], m[:, 1], corner[:, 2], m[:, 5]),
             (m[:, 3], m[:, 4], m[:, 5], corner[:, 3])]
    a, b, c, d, e, f = (m[:, k] for k in range(6))
    parts += [(a, b, e, f), (a, b, f, c), (a, c, f, d), (a, d, f, e)]  # round the diagonal from 01 to 23
    tets = numpy.concatenate([numpy.stack(part, axis=1) for part in parts])
    edges = points[tets[:, 1:]] - points[tets[:, :1]]
    flat = numpy.linalg.det(edges) < 0
    tets[flat] = tets[flat][:, [0, 2, 1, 3]]
    return points, tets


def quadratic(points, tets):
    """Points with those of the edges' middles, and tetrahedra of ten points, as VTK and CalculiX order them."""
    import numpy
    pairs = numpy.array([(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)])
    edges = numpy.sort(tets[:, pairs].reshape(-1, 2), axis=1)
    unique, inverse = numpy.unique(edges, axis=0, return_inverse=True)
    middles = (points[unique[:, 0]] + points[unique[:, 1]]) / 2
    numbers = len(points) + inverse.reshape(len(tets), 6)
    return numpy.concatenate([points, middles]), numpy.concatenate([tets, numbers], axis=1)


def held_by_edges(tets, held):
    """Which of the points of quadratic() are held: given ones, and middles of edges between these."""
    import numpy
    edges = numpy.unique(numpy.sort(tets[:, [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]].reshape(-1, 2), axis=1), axis=0)
    return numpy.concatenate([held, held[edges].all(axis=1)])


def by_felupe(points, tets, nu, held):
    import felupe
    import numpy
    ten = tets.shape[1] == 10
    mesh = felupe.Mesh(points, tets, "tetra10" if ten else "tetra")
    region = felupe.RegionQuadraticTetra(mesh) if ten else felupe.RegionTetra(mesh)
    field = felupe.FieldContainer([felupe.Field(region, dim=3)])
    boundary = felupe.Boundary(field[0], mask=held)
    solid = felupe.SolidBody(umat=felupe.LinearElastic(E=YOUNG, nu=nu), field=field)
    weight = felupe.SolidBodyForce(field, values=DENSITY * numpy.array([GRAVITY, 0, 0]))
    start = time.process_time()
    felupe.newtonrhapson(items=[solid, weight], **dict(zip(("dof0", "dof1"), felupe.dof.partition(field, {"held": boundary}))), verbose=0)
    return field[0].values, time.process_time() - start


def by_calculix(points, tets, nu, held, folder):
    import numpy
    job = folder / "body"
    with open(job.with_suffix(".inp"), "w") as out:
        out.write("*NODE, NSET=ALL\n" + "".join(f"{i}, {x:.12g}, {y:.12g}, {z:.12g}\n" for i, (x, y, z) in enumerate(points, 1)))
        kind = "C3D10" if tets.shape[1] == 10 else "C3D4"
        out.write(f"*ELEMENT, TYPE={kind}, ELSET=BODY\n" + "".join(f"{e}, {', '.join(str(a + 1) for a in t)}\n" for e, t in enumerate(tets, 1)))
        out.write("*NSET, NSET=HELD\n" + "".join(f"{i + 1},\n" for i in held.nonzero()[0]))
        out.write(f"*MATERIAL, NAME=M\n*ELASTIC\n{YOUNG}, {nu}\n*DENSITY\n{DENSITY}\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n*BOUNDARY\nHELD, 1, 3\n"
                  f"*STEP\n*STATIC\n*DLOAD\nBODY, GRAV, {GRAVITY}, 1, 0, 0\n*NODE PRINT, NSET=ALL\nU\n*END STEP\n")
    before = cpu_of_programs()
    subprocess.run(["ccx", str(job)], check=True, capture_output=True, cwd=folder, env={"OMP_NUM_THREADS": "1", "PATH": "/usr/bin:/bin:/usr/local/bin"})
    lines = [line.split() for line in job.with_suffix(".dat").read_text().splitlines()]
    u = numpy.zeros_like(points)
    for line in lines:
        if len(line) == 4 and line[0].isdigit():
            u[int(line[0]) - 1] = [float(value) for value in line[1:]]
    return u, cpu_of_programs() - before


def by_plica(bench, mesh, element, nu):
    import numpy
    before = cpu_of_programs()
    summary = bench.run(SCENE.format(gravity=GRAVITY, mesh=mesh, element=element, young=YOUNG, nu=nu, density=DENSITY), limit=120)
    film = surface_error.Frames(summary["folder"], "volume")
    return numpy.array(film.points[-1]).reshape(-1, 3) - numpy.array(film.rest).reshape(-1, 3), cpu_of_programs() - before


def read_gmsh(file):
    """Points and tetrahedra of an ASCII file of version 2."""
    import numpy
    lines = iter(file.read_text().splitlines())
    next(line for line in lines if line == "$Nodes")
    points = numpy.array([[float(v) for v in next(lines).split()[1:4]] for _ in range(int(next(lines)))])
    next(line for line in lines if line == "$Elements")
    rows = [[int(v) for v in next(lines).split()] for _ in range(int(next(lines)))]
    return points, numpy.array([row[-4:] for row in rows if row[1] == 4]) - 1


def measure(bench):
    try:
        import felupe
        import numpy
    except ImportError:
        raise Failed("felupe and NumPy are not installed") from None
    if not shutil.which("gmsh"):
        raise Failed("Gmsh is not installed")
    surface, rows = bench.scratch / "liver.stl", []
    bench.call("plica", "mesh", "convert", ROOT / "meshes/data/organs/liver.vtk", surface)
    meshes = []
    file = bench.scratch / "0.msh"
    bench.call("plica", "mesh", "fill", surface, "-o", file, "--size", f"{EDGES[0] if bench.small else EDGES[1]} mm", "--with", "gmsh")
    bench.call("plica", "mesh", "convert", file, bench.scratch / "plain.msh", "--format", "msh22")
    points, tets = read_gmsh(bench.scratch / "plain.msh")
    held = points[:, 2] < HELD
    meshes = [(points, tets, held), (*refined(points, tets), held_by_edges(tets, held))]
    with_middles = lambda p, t, h: (*quadratic(p, t), held_by_edges(t, h))
    count = len(points)  # of the vertices that all meshes have, the first ones
    for nu in NUS:
        fine = with_middles(*meshes[1])
        solve = (lambda p, t, h: by_calculix(p, t, nu, h, bench.scratch)) if shutil.which("ccx") else (lambda p, t, h: by_felupe(p, t, nu, h))
        reference = solve(*fine)[0][:count]
        error = lambda u: float(numpy.linalg.norm(u[:count] - reference) / numpy.linalg.norm(reference))
        for (p, t, h), element in itertools.product(meshes, ("nodal", "linear")):
            write_gmsh(bench.scratch / "body.msh", p, t, h.nonzero()[0])
            u, spent = by_plica(bench, bench.scratch / "body.msh", element, nu)
            rows.append({"nu": nu, "tets": len(t), "program": f"Plica, {element}", "error": error(u), "seconds": spent})
        for (p, t, h), ten in ((meshes[0], False), (meshes[1], False), (meshes[0], True)):
            if ten:
                p, t, h = with_middles(p, t, h)
            kind = "quadratic" if ten else "linear"
            u, spent = by_felupe(p, t, nu, h)
            rows.append({"nu": nu, "tets": len(t), "program": f"felupe, {kind}", "error": error(u), "seconds": spent})
            if shutil.which("ccx"):
                u, spent = by_calculix(p, t, nu, h, bench.scratch)
                rows.append({"nu": nu, "tets": len(t), "program": f"CalculiX, {kind}", "error": error(u), "seconds": spent})
    version = subprocess.run(["ccx", "-v"], capture_output=True, text=True).stdout.split() if shutil.which("ccx") else ["none"]
    return {"rows": rows, "versions": f"felupe {felupe.__version__}, CalculiX {version[-1]}"}


def blocks(data):
    rows = data["rows"]
    kinds = list(dict.fromkeys((r["program"], r["tets"]) for r in sorted(rows, key=lambda r: r["program"])))
    nus = sorted({r["nu"] for r in rows})
    at = {(r["program"], r["tets"], r["nu"]): r for r in rows}
    lines = [[program, f"{tets:,}", *(f"{percent(at[program, tets, nu]['error'])} in {seconds(at[program, tets, nu]['seconds'])}" for nu in nus)]
             for program, tets in kinds]
    return {"beside_organs": table(["elements", "tetrahedra", *(f"ν {nu:g}: error, CPU time" for nu in nus)], lines, left=2) + f"\n\n{data['versions']}."}
