# SPDX-License-Identifier: BSD-3-Clause
"""What contact adds to an explicit step of a liver: tools that are far, near and pressed in, triangles in place of points, and contact with itself."""
import statistics

from bench import ROOT, Failed, number, table

SOURCES, SECONDS = ("core", "kernels", "drivers"), 60
LIVER = ROOT / "meshes/data/organs/liver.vtk"
SCENE = """
name: liver with tools
duration: 0.25 s
body:
  levels: [{{file: {mesh}}}]
  material: {{model: neo_hookean, young_modulus: 10 kPa, poisson_ratio: 0.45, density: 1050 kg/m^3}}
  fixed: [{{half_space: {{point: [0, 0, -2 cm], normal: [0, 0, 1]}}}}]
  damping: {{mass: 5 1/s}}
  surface: {{boundary: true}}
{contact}
"""


def tools(count, height, down=12, more=""):
    """Capsules in a row over the liver [mm], which move down by `down` in 0.2 s."""
    one = lambda i: (f"    - capsule: {{from: [{45 - 25 * i} mm, 0, {height} mm], to: [{45 - 25 * i} mm, 0, {height + 100} mm], radius: 8 mm}}\n"
                     f"      friction: 0.2\n      curve: [{{time: 0 s, displacement: [0, 0, 0]}}, {{time: 0.2 s, displacement: [0, 0, -{down} mm]}}]")
    return "contact:\n" + more + "  obstacles:\n" + "\n".join(one(i) for i in range(count))


CASES = {"no contact": "", "a tool that is far": tools(1, 200), "a tool, pressed in": tools(1, 48), "three tools, pressed in": tools(3, 48),
         "a tool, pressed in; between the points too": tools(1, 48, more="  whole_surface: always\n"),
         "contact with itself": "contact: {self: true}", "contact with itself, and a tool": tools(1, 48, more="  self: true\n")}


def measure(bench):
    rows = []
    for name, contact in CASES.items():
        row = {"case": name}
        try:
            said = bench.steps(SCENE.format(mesh=LIVER, contact=contact), limit=1 if bench.small else 6)
            late = said["working"][len(said["working"]) // 2:]  # where tools touch
            row |= {"step": statistics.median(late), "tets": said["tets"], "status": said["status"]}
        except Failed as error:
            row["status"] = str(error)
        rows.append(row)
    return rows


def blocks(rows):
    if "step" not in rows[0]:
        return {}  # without contact it did not run: there is nothing to compare with
    free = rows[0]["step"]
    lines = [[r["case"], number(1e3 * r["step"], 3), f"{r['step'] / free:.2f}"] if "step" in r else [r["case"], r["status"], ""] for r in rows]
    return {"contact_cost": f"Explicit, nodal, {rows[0]['tets']:,} tetrahedra, one thread.\n\n"
            + table(["", "a step, ms", "over the first line"], lines)}
