# SPDX-License-Identifier: BSD-3-Clause
"""Total error against run time, and the error of each mesh alone, both against the limit of refined meshes: a beam and two bodies that are no boxes."""
from bench import percent, seconds, table

SOURCES, SECONDS = ("core", "kernels", "drivers"), 330
SCENES = {"sag": "a beam, ν 0.45", "incompressible": "a beam, ν 0.499", "liver": "a liver with an inclusion, ν 0.49"}
METHODS = "single/symplectic_euler, single/implicit_euler, coarse, cycle/him"
WORDS = {"single/symplectic_euler": "finest mesh, explicit", "single/implicit_euler": "finest mesh, implicit", "cycle/him": "HIM"}


def measure(bench):
    studies = {}
    for scene in list(SCENES)[:1] if bench.small else SCENES:
        said = bench.study(f"drivers/scenes/study/{scene}.yaml", methods=METHODS, budget=100, truth=True)
        keys = ("method", "element", "macro_step_over_critical", "status", "total_error", "space_error", "error", "wall_time", "setup_time")
        studies[scene] = {"tets": said["tets"], "reference": {key: said["reference"][key] for key in ("truth", "meshes")},
                          "rows": [{key: row.get(key) for key in keys} for row in said["rows"] if row["status"] == "completed"]}
    return studies


def words(row):
    name = WORDS.get(row["method"]) or row["method"].replace("coarse/", "mesh of level ").replace("/", ", ")
    step = row["macro_step_over_critical"]
    return f"{name}, {step:.3g} ×" if step and row["method"] == "cycle/him" else name


def front(rows):
    """Rows that no other one beats in both time and error, fastest first."""
    least, out = 1.0, []
    for row in sorted((r for r in rows if r["total_error"]), key=lambda r: r["wall_time"]):
        if row["total_error"] < least:
            least = row["total_error"]
            out.append(row)
    return out


def explicit(rows, element):
    return next((r for r in rows if r["method"] == "single/symplectic_euler" and r["element"] == element and r["total_error"]), None)


def blocks(data):
    parts, spaces = [], []
    for scene, study in data.items():
        rows = front(study["rows"])
        rows += [r for r in (explicit(study["rows"], "nodal"), explicit(study["rows"], "linear")) if r and r not in rows]
        lines = [[words(r), r["element"], percent(r["total_error"]), percent(r["space_error"]), seconds(r["wall_time"])] for r in rows]
        sure = study["reference"]["truth"]["error"]
        parts.append(f"**{scene}**: {SCENES[scene]}, {study['tets'][0]:,} tetrahedra; the reference is uncertain by {percent(sure)}.\n\n"
                     + table(["method", "elements", "total error", "of which the mesh", "run time"], lines, left=2))
        for mesh in study["reference"]["meshes"]:
            spaces.append((scene, mesh["level"], mesh["element"], mesh["error_space"]))
    of = {(s, level, e): error for s, level, e, error in spaces}
    lines = [[SCENES[s], f"{data[s]['tets'][level]:,}", percent(of.get((s, level, "linear"))), percent(of.get((s, level, "nodal")))]
             for s, level in dict.fromkeys((s, level) for s, level, *_ in spaces)]
    sag = next(iter(data.values()))["rows"]
    chosen = [r for r in front(sag) if r["total_error"] < 0.06] + [r for r in (explicit(sag, "nodal"), explicit(sag, "linear")) if r]
    short = table(["", "elements", "total error", "run time"],
                  [[words(r), r["element"], percent(r["total_error"]), seconds(r["wall_time"])] for r in {id(r): r for r in chosen}.values()], left=2)
    return {"error_against_time": "\n\n".join(parts), "error_short": short,
            "elements": table(["body", "tetrahedra", "linear", "nodal"], lines)}
