# SPDX-License-Identifier: BSD-3-Clause
"""The hierarchical inverse mass beside explicit steps of the finest mesh: errors and run times by the length of the macro step."""
import math

from bench import number, percent, seconds, table

SOURCES, SECONDS = ("core", "kernels", "drivers"), 330
BEAM = ((48, 12, 12), (24, 6, 6), (12, 3, 3))
LEVELS = "body.levels=[" + ", ".join(f"{{box: {{size: [0.4, 0.1, 0.1], cells: {list(c)}}}}}" for c in BEAM) + "]"
SCENES = {"sag": "beam that sags", "poke": "beam, poked", "inclusion": "beam with a stiff inclusion", "twist": "beam that twists", "graded": "graded cone",
          "pulse": "pulse along a bar", "ball": "ball that falls into a bowl"}
STEPS = (2, 4, 8, 16, 32)


def measure(bench):
    studies = {}
    for scene in list(SCENES)[:1] if bench.small else SCENES:
        settings = [LEVELS] if scene in ("sag", "poke", "inclusion", "twist") and not bench.small else []
        said = bench.study(f"drivers/scenes/study/{scene}.yaml", *settings, methods="single/symplectic_euler, coarse, cycle/him", budget=45)
        keys = ("method", "macro_step", "macro_step_over_critical", "automatic", "status", "error", "error_velocity", "wall_time", "setup_time")
        studies[scene] = {"tets": said["tets"], "rows": [{key: row.get(key) for key in keys} for row in said["rows"]]}
    return studies


def near(rows, multiple):
    """The row of HIM at so many critical steps."""
    return next((r for r in rows if r["method"] == "cycle/him" and r["macro_step_over_critical"]
                 and abs(r["macro_step_over_critical"] / multiple - 1) < 0.05), None)


def blocks(data):
    lines = []
    for scene, study in data.items():
        rows = study["rows"]
        one = next(r for r in rows if r["method"] == "single/symplectic_euler" and r["automatic"])
        cells = []
        for multiple in STEPS:
            row = near(rows, multiple)
            cells.append("–" if row is None else row["status"] if row["status"] != "completed"
                         else f"{percent(row['error'])} in {number(row['wall_time'] / one['wall_time'])}")
        coarse = [r for r in rows if r["method"].startswith("coarse/1") and r["status"] == "completed" and "/implicit" not in r["method"]]
        alone = min(coarse, key=lambda r: r["error"], default=None)
        lines.append([SCENES[scene], f"{study['tets'][0]:,}", seconds(one["wall_time"]), *cells,
                      f"{percent(alone['error'])} in {number(alone['wall_time'] / one['wall_time'])}" if alone else "–"])
    scenes = table(["scene", "tetrahedra", "explicit", *(f"HIM, {m} ×" for m in STEPS), "next coarser mesh alone"], lines)
    sag, rates = data["sag"]["rows"], []
    done = [row for row in (near(sag, m) for m in STEPS) if row and row["status"] == "completed"]
    for before, row in zip([None, *done], done):
        order = math.log(row["error"] / before["error"]) / math.log(row["macro_step"] / before["macro_step"]) if before else None
        rates.append([f"{row['macro_step_over_critical']:.3g}", seconds(row["macro_step"]), percent(row["error"]), percent(row["error_velocity"]),
                      f"{order:.2f}" if order else ""])
    rate = table(["macro step over the critical one", "macro step", "error of displacement", "of velocity", "order since the line above"], rates)
    return {"him_scenes": scenes, "him_rate": rate}
