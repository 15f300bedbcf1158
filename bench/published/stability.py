# SPDX-License-Identifier: BSD-3-Clause
"""The largest stable macro step of each method, found by runs, beside the one that Plica predicts."""
import json
import tempfile

from bench import number, seconds, table

SOURCES, SECONDS = ("core", "kernels", "drivers"), 330
SCENES = {"beam": "beam", "ball": "free ball", "slivers": "sheet of flat elements"}


def measure(bench):
    rows = []
    for scene in list(SCENES)[:1] if bench.small else SCENES:
        folder = tempfile.mkdtemp(dir=bench.scratch)
        bench.call("plica", "stability", bench.scene(f"drivers/scenes/stability/{scene}.yaml"), "-o", folder, "--quiet", "--threads", 1,
                   "--budget", "120s")
        with open(f"{folder}/stability.json", encoding="utf-8") as file:
            said = json.load(file)
        keys = ("method", "distribution", "integrator", "variant", "status", "critical_step", "predicted", "measured", "stable_up_to")
        rows += [{"scene": scene, **{key: row[key] for key in keys}} for row in said["rows"]]
    return rows


def blocks(rows):
    lines = []
    for r in rows:
        if r["variant"] or (r["method"].startswith("coarse") and r["integrator"] != "symplectic_euler"):
            continue
        over = lambda step: "–" if step is None else f"{number(step / r['critical_step'], 3)} ×"
        found = over(r["measured"]) if r["measured"] is not None else f"above {over(r['stable_up_to'])}" if r["stable_up_to"] else r["status"]
        lines.append([SCENES[r["scene"]], "/".join(filter(None, (r["method"], r["distribution"]))), seconds(r["critical_step"]), over(r["predicted"]), found])
    return {"stability": table(["scene", "method", "critical step", "predicted", "found by runs"], lines, left=2)}
