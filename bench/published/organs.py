# SPDX-License-Identifier: BSD-3-Clause
"""Time steppers on organs with tools: error, tool's impulse and CPU time beside explicit steps on the same mesh."""
import csv
import math

import surface_error
from bench import Failed, cpu_of_programs, percent, seconds, table

SOURCES, SECONDS = ("core", "kernels", "drivers", "meshes/data/organs"), 420
SCENES = {"drop": "liver, dropped", "poke": "liver, poked", "drag": "a tool drawn along a liver", "needle": "a needle pressed in", "grasp": "ventricle, grasped",
          "swing": "liver, swung", "two_organs": "an organ falls on another", "folded_tube": "a tube that folds"}
METHODS = {"explicit": ["integration.cycle=single"], "HIM": ["integration.cycle=him"], "auto": ["integration.cycle=auto"],
           "implicit, 5 ms": ["integration.cycle=single", "integration.integrator=implicit_euler", "integration.macro_step=5 ms"],
           "BDF2, 5 ms": ["integration.cycle=single", "integration.integrator=bdf2", "integration.macro_step=5 ms"]}


def impulse(folder):
    """Time integral of the magnitude of the tool's mean force over each macro step [N s]; None: the scene has no tool."""
    with open(f"{folder}/history.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    if not rows or "tool.force_x" not in rows[0]:
        return None
    times = [0.0, *(float(row["time"]) for row in rows)]
    return sum(math.hypot(*(float(row[f"tool.force_{k}"]) for k in "xyz")) * (b - a) for row, a, b in zip(rows, times, times[1:]))


def measure(bench):
    rows = []
    for scene in list(SCENES)[1:2] if bench.small else SCENES:
        reference = given = None
        for method, settings in METHODS.items():
            row = {"scene": scene, "method": method}
            before = cpu_of_programs()
            try:
                said = bench.run(f"drivers/scenes/organs/{scene}.yaml", *settings, limit=60)
            except Failed as error:
                rows.append({**row, "status": str(error)})
                continue
            row |= {"status": said["status"], "cpu": cpu_of_programs() - before, "counters": said["counters"],
                    "chosen": (said.get("choice") or {}).get("cycle"), "tets": said["levels"][0]["tets"]}
            frames, force = surface_error.Frames(said["folder"]), impulse(said["folder"])
            if reference is None:
                reference, given = frames, force
            else:
                row["error"] = surface_error.errors(frames, reference)["displacement"]
                row["impulse"] = force / given if given else None
            rows.append(row)
    return rows


def blocks(rows):
    at = {(r["scene"], r["method"]): r for r in rows}

    def cell(scene, method):
        row = at.get((scene, method))
        if row is None or "cpu" not in row:
            return row["status"] if row else "–"
        words = [seconds(row["cpu"])]
        words += [percent(row["error"])] if "error" in row else []
        words += [f"{row['impulse']:.2f}"] if row.get("impulse") else []
        return ", ".join(words)
    scenes = list(dict.fromkeys(r["scene"] for r in rows))
    return {"organs": "CPU time of the whole run, error of the surface's displacement, the tool's impulse; the last two beside explicit steps.\n\n"
            + table(["scene", *METHODS], [[SCENES[scene], *(cell(scene, m) for m in METHODS)] for scene in scenes])}
