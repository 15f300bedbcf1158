# SPDX-License-Identifier: BSD-3-Clause
"""How large a liver runs in real time while a tool is pressed into it and drawn along it, and how long a macro step of 1 ms takes with the tool's wrench
read after it."""
import math
import shutil
import statistics

from bench import ROOT, Failed, number, table

SOURCES, SECONDS = ("core", "kernels", "drivers"), 600
LIVER = ROOT / "meshes/data/organs/liver.vtk"
LATTICES = (9.5, 5.8, 3.3, 1.5)  # [mm]: 5 000, 20 000, 97 000, 1 000 000 tetrahedra
FITTED = (8, 5, 2.85)  # [mm]
COARSEST = 18  # at least so large are the cells of him's coarsest lattice [mm]
METHODS = {"explicit": "{cycle: single}", "HIM": "{cycle: him}", "implicit": "{integrator: implicit_euler, macro_step: 10 ms}"}
SCENE = """
name: pressed liver
duration: 0.5 s
body:
  levels: {levels}
  material: {{model: neo_hookean, young_modulus: 10 kPa, poisson_ratio: 0.45, density: 1050 kg/m^3}}
  fixed: [{{half_space: {{point: [0, 0, -2 cm], normal: [0, 0, 1]}}}}]
  damping: {{mass: 5 1/s}}
contact:
  obstacles:
    - capsule: {{from: [45 mm, 0, 48 mm], to: [45 mm, 0, 148 mm], radius: 8 mm}}
      friction: 0.2
      curve: [{{time: 0 s, displacement: [0, 0, 0]}}, {{time: 0.2 s, displacement: [0, 0, -12 mm]}}, {{time: 0.5 s, displacement: [-2 cm, 0, -12 mm]}}]
integration: {integration}
"""


def of_file(file):
    return lambda method: f"[{{file: {file}}}{', {coarsen: auto}' if method == 'HIM' else ''}]"


def of_lattices(edge):
    def levels(method):
        sizes = [edge]
        while method == "HIM" and sizes[-1] < COARSEST:
            sizes.append(2 * sizes[-1])
        return f"{{surface: {LIVER}, sizes: [{', '.join(f'{size} mm' for size in sizes)}]}}"
    return levels


def bodies(bench):
    """Name and levels: the repository's mesh, meshes by Gmsh where it is, lattices over the surface."""
    yield "liver.vtk", of_file(LIVER)
    if shutil.which("gmsh"):
        surface = bench.scratch / "liver.stl"
        bench.call("plica", "mesh", "convert", LIVER, surface)
        for edge in FITTED[:1] if bench.small else FITTED:
            mesh = bench.scratch / f"{edge}.vtu"
            bench.call("plica", "mesh", "fill", surface, "-o", mesh, "--size", f"{edge} mm", "--with", "gmsh")
            yield "by Gmsh", of_file(mesh)
    for edge in LATTICES[:1] if bench.small else LATTICES:
        yield "lattice", of_lattices(edge)


def one(bench, body, levels, method, threads, step=None):
    integration = METHODS[method] if not step else METHODS[method].split(", macro_step")[0].rstrip("}") + f", macro_step: {step}}}"
    row = {"body": body, "method": method, "threads": threads, "status": "", "factor": None}
    try:
        said = bench.steps(SCENE.format(levels=levels(method), integration=integration), threads=threads, limit=2 if bench.small else 12)
    except Failed as error:
        return {**row, "status": str(error)}
    touching = sorted(time for time, touches in zip(said["working"], said["touches"]) if touches)
    row |= {key: said[key] for key in ("status", "diagnosis", "tets", "macro_step", "simulated", "set_up", "force", "counters")}
    row |= {"factor": said["simulated"] / sum(said["working"]), "waited": sum(said["waited"]) / sum(said["wall"])}
    if touching:
        row |= {"median": statistics.median(touching), "late": touching[math.ceil(0.99 * len(touching)) - 1], "longest": touching[-1]}
    return row


def measure(bench):
    sizes, steps = [], []
    for number, (body, levels) in enumerate(bodies(bench)):
        for method in METHODS:
            for threads in (1, 2):
                row = one(bench, body, levels, method, threads)
                sizes.append({"mesh": number, **row})
                if threads == 1 and row["factor"] and row["factor"] < 5e-3:
                    break  # too slow to be told apart
        if body == "liver.vtk":
            steps = [one(bench, body, levels, method, 1, step="1 ms") for method in METHODS]
    return {"sizes": sizes, "steps": steps}


def cell(row):
    if row is None or row["factor"] is None:
        return "–"
    return "diverged" if row["status"] == "diverged" else number(row['factor'])


def size_rows(sizes, meshes=("liver.vtk", "by Gmsh", "lattice"), methods=tuple(METHODS)):
    """A line for each mesh: its size, where it is from, and its factors by method, with one and with two threads."""
    for mesh in dict.fromkeys(row["mesh"] for row in sizes if row["body"] in meshes):
        rows = [row for row in sizes if row["mesh"] == mesh]
        by = {(row["method"], row["threads"]): row for row in rows}
        yield [f"{max(row.get('tets', 0) for row in rows):,}", rows[0]["body"], *(cell(by.get((m, t))) for m in methods for t in (1, 2))]


def largest(sizes, method, threads, body):
    """The number of tetrahedra at which a run takes as long as it simulates: on straight lines in logarithms between the sizes."""
    known = sorted((r["tets"], r["factor"]) for r in sizes if (r["method"], r["threads"], r["body"]) == (method, threads, body) and r["factor"]
                   and r["status"] != "diverged")
    for (n, f), (more, slower) in reversed(list(zip(known, known[1:]))):
        if f >= 1 > slower:
            return number(n * (more / n) ** (math.log(f) / math.log(f / slower)))
    return "–"


def blocks(data):
    sizes, steps = data["sizes"], data["steps"]
    heads = ["tetrahedra", "mesh", *(f"{m}, {t} core{'s' * (t > 1)}" for m in METHODS for t in (1, 2))]
    family = "by Gmsh" if any(r["body"] == "by Gmsh" for r in sizes) else "lattice"
    bound = ["**largest in real time**", family, *(f"**{largest(sizes, m, t, family)}**" for m in METHODS for t in (1, 2))]
    full = table(heads, [*size_rows(sizes), bound], left=2)
    of_touch = table(["macro steps of 1 ms", "median, ms", "99 % below", "longest"],
                     [[r["method"], *(number(1e3 * r[key]) for key in ("median", "late", "longest"))] for r in steps if r.get("median")])
    notes = [f"* {r['tets']:,} {r['body']}, {r['method']}: {r['diagnosis']}" for r in sizes if r.get("diagnosis")]
    brief = ("explicit", "HIM")  # of the whole table, for README
    lines = [[f"{size}, {'with slivers' if body == 'liver.vtk' else 'well shaped'}", *factors]
             for size, body, *factors in size_rows(sizes, (family, "liver.vtk"), brief)]
    short = table(["tetrahedra", *(f"{m}, {t} core{'s' * (t > 1)}" for m in brief for t in (1, 2))],
                  [*lines, ["**well shaped, real time to**", *(f"**{largest(sizes, m, t, family)}**" for m in brief for t in (1, 2))]])
    return {"real_time": "\n\n".join([full, *(["\n".join(notes)] if notes else []),
                                      f"A step of `liver.vtk`, {steps[0].get('tets', 0):,} tetrahedra, while the tool touches:\n\n{of_touch}"]),
            "real_time_short": short}
