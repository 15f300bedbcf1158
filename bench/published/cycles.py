# SPDX-License-Identifier: BSD-3-Clause
"""The cycles of Wu et al. (2012) beside a coarser mesh alone, HIM and the finest mesh alone: the fastest run of each below an error."""
from bench import percent, seconds, table

SOURCES, SECONDS = ("core", "kernels", "drivers"), 270
SCENES = {"ball": "ball that falls into a bowl", "sag": "beam that sags", "twist": "beam that twists", "poke": "beam, poked"}
KINDS = {"single": "finest mesh alone", "coarse": "a coarser mesh alone", "rs": "`rs`", "rv": "`rv`", "rsv": "`rsv`", "rsv_sv": "`rsv_sv`", "fas": "`fas`",
         "him": "HIM"}
ERRORS = (0.05, 0.01)


def measure(bench):
    rows = []
    for scene in list(SCENES)[1:2] if bench.small else SCENES:
        said = bench.study(f"drivers/scenes/study/{scene}.yaml", methods="single/symplectic_euler, coarse, cycle", budget=65)
        for row in said["rows"]:
            if row["status"] == "completed":
                kind, name, *_ = row["method"].split("/")
                rows.append({"scene": scene, "kind": name if kind == "cycle" else kind, "error": row["error"], "time": row["wall_time"]})
    return rows


def blocks(rows):
    lines = []
    for scene in dict.fromkeys(r["scene"] for r in rows):
        for error in ERRORS:
            cells = []
            for kind in KINDS:
                good = [r for r in rows if (r["scene"], r["kind"]) == (scene, kind) and r["error"] <= error]
                best = min(good, key=lambda r: r["time"], default=None)
                cells.append(f"{seconds(best['time'])} ({percent(best['error'])})" if best else "–")
            lines.append([SCENES[scene], percent(error), *cells])
    return {"cycles": table(["scene", "below", *KINDS.values()], lines, left=2)}
