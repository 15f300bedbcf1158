# SPDX-License-Identifier: BSD-3-Clause
"""What contact adds to an explicit step: tools that are far, near and pressed in, triangles in place of points, folds, and two bodies."""
import statistics

from bench import ROOT, Failed, number, table

SOURCES, SECONDS = ("core", "kernels", "drivers"), 90
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


def liver(contact):
    return SCENE.format(mesh=LIVER, contact=contact)


def tube(contact):
    text = (ROOT / "drivers/scenes/organs/folded_tube.yaml").read_text()
    return text.replace("contact: {self: true, friction: 0.3}", contact)


def two_organs(height):
    text = (ROOT / "drivers/scenes/organs/two_organs.yaml").read_text()
    return text.replace("../../../meshes", str(ROOT / "meshes")).replace("[1 cm, 0, 11 cm]", f"[1 cm, 0, {height} cm]")


# Groups of scenes; each is compared with the first of its group.
CASES = [
    ("liver", {"no contact": liver(""), "a tool that is far": liver(tools(1, 200)), "a tool, pressed in": liver(tools(1, 48)),
               "three tools, pressed in": liver(tools(3, 48)),
               "a tool, pressed in; between the points too": liver(tools(1, 48, more="  whole_surface: always\n")),
               "contact with itself": liver("contact: {self: true}"), "contact with itself, and a tool": liver(tools(1, 48, more="  self: true\n"))}),
    ("gut that folds onto itself", {"no contact": tube(""), "contact with itself": tube("contact: {self: true, friction: 0.3}")}),
    ("ventricle on a liver", {"far from each other": two_organs(100), "one on the other": two_organs(11)}),
]


def measure(bench):
    rows = []
    for body, scenes in CASES:
        for name, scene in scenes.items():
            row = {"body": body, "case": name}
            try:
                said = bench.steps(scene, limit=1 if bench.small else 6)
                late = said["working"][len(said["working"]) // 2:]  # where they touch
                row |= {"step": statistics.median(late), "tets": said["tets"], "status": said["status"]}
            except Failed as error:
                row["status"] = str(error)
            rows.append(row)
    return rows


def blocks(rows):
    free = {}
    lines = []
    for row in rows:
        if "step" not in row:
            lines.append([row["body"], row["case"], row["status"], ""])
            continue
        first = free.setdefault(row["body"], row["step"])
        lines.append([f"{row['body']}, {row['tets']:,} tetrahedra", row["case"], number(1e3 * row["step"], 3), f"{row['step'] / first:.2f}"])
    return {"contact_cost": "Explicit, nodal, one thread.\n\n" + table(["body", "", "a step, ms", "over its first line"], lines, left=2)}
