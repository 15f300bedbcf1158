# SPDX-License-Identifier: BSD-3-Clause
"""Total error against run time, and the error of each mesh alone, both against the limit of refined meshes: a beam and two bodies that are no boxes."""
import figure as look
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


def him_of(rows, multiples):
    """HIM's rows of nodal elements at so many critical steps."""
    own = [r for r in rows if r["method"] == "cycle/him" and r["element"] == "nodal" and r["total_error"]]
    return [r for m in multiples for r in own if abs(r["macro_step_over_critical"] / m - 1) < 0.05]


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
    chosen = [*him_of(sag, (16, 8)), *(r for r in (explicit(sag, "nodal"), explicit(sag, "linear")) if r)]
    short = table(["", "elements", "total error", "run time"],
                  [[words(r), r["element"], percent(r["total_error"]), seconds(r["wall_time"])] for r in chosen], left=2)
    picture = "![Total error against run time of the beam, nodal elements and linear ones](../pictures/error_against_time.png)"
    return {"error_against_time": "\n\n".join([picture, *parts]), "error_short": short,
            "elements": table(["body", "tetrahedra", "linear", "nodal"], lines)}


FAMILIES = {"single/symplectic_euler": ("finest mesh, explicit", look.BLUE, "o"), "single/implicit_euler": ("finest mesh, implicit", look.GREEN, "s"),
            "coarse": ("coarser meshes, explicit", look.PURPLE, "^"), "cycle/him": ("HIM on the finest mesh", look.ORANGE, "D")}


def figure(data):
    """The first scene, a panel for each kind of elements."""
    scene, study = next(iter(data.items()))
    drawn, axes = look.panels(f"Total error against run time: {SCENES[scene]}, {study['tets'][0]:,} tetrahedra", 2, sharex=True, sharey=True)
    for panel, element in zip(axes, ("nodal", "linear")):
        for family, (label, colour, marker) in FAMILIES.items():
            own = sorted((r for r in study["rows"] if r["method"].startswith(family) and r["element"] == element and r["total_error"]),
                         key=lambda r: r["wall_time"])
            line = "none" if family == "coarse" else "-"  # two meshes are two runs, not a row of steps
            panel.plot([r["wall_time"] for r in own], [100 * r["total_error"] for r in own], linestyle=line, color=colour, marker=marker, label=label)
            for row in (own[0], own[-1]) if family == "cycle/him" and own else ():
                panel.annotate(f"{row['macro_step_over_critical']:.3g} ×", (row["wall_time"], 100 * row["total_error"]), textcoords="offset points",
                               xytext=(0, 9), ha="center", fontsize=8, color=colour)
        space = next(m["error_space"] for m in study["reference"]["meshes"] if (m["level"], m["element"]) == (0, element))
        panel.axhline(100 * space, color=look.GREY, linestyle=":", label="error of the finest mesh itself")
        panel.set(xscale="log", yscale="log", xlabel="run time of the steps [s]", title=f"{element} elements")
        look.plain_numbers(panel.xaxis), look.plain_numbers(panel.yaxis, (1, 2, 5))
    axes[0].set_ylabel("total error of displacement [%]")
    axes[0].legend(frameon=False, fontsize=9)
    return drawn
