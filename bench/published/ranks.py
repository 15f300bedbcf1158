# SPDX-License-Identifier: BSD-3-Clause
"""What up to 1024 ranks would have and receive of bodies of a million and of a hundred million tetrahedra, by plans; no rank runs."""
import json

from bench import number, table

SOURCES, SECONDS = ("drivers/level/part_of_level.cpp", "drivers/elastic/build_patches.cpp", "meshes/reordering.cpp", "bench/ranks.cpp"), 900
NAMES = ("tets", "copies", "vertices", "received", "neighbours")


def measure(bench):
    said = json.loads(bench.call("plica_bench", f"--benchmark_filter=^ranks/[a-z]+/{'998250' if bench.small else '[0-9]+'}/", "--benchmark_format=json"))
    rows = []
    for one in said["benchmarks"]:
        if one.get("error_occurred"):
            continue
        _, element, tets, ranks, *_ = one["name"].split("/")
        rows.append({"element": element, "body": int(tets), "ranks": int(ranks)} | {name: one[name] for name in NAMES}
                    | {f"most {name}": one[f"most {name}"] for name in NAMES})
    return rows


def pair(row, name):
    return f"{number(row[name])} / {number(row[f'most {name}'])}"


def blocks(rows):
    heads = ["tetrahedra", "ranks", "elements", "tetrahedra a rank", "imbalance", "copies over own vertices", "rows received", "from ranks"]
    lines = []
    for r in sorted(rows, key=lambda r: (r["body"], r["element"], r["ranks"])):
        work = "tets" if r["element"] == "linear" else "vertices"
        lines.append([f"{r['body']:,}", r["ranks"], r["element"], f"{number(r['tets'], 3)}", number(r[f"most {work}"] / r[work], 3),
                      number(r["copies"] / r["vertices"]), pair(r, "received"), pair(r, "neighbours")])
    return {"ranks": table(heads, lines, left=0) + "\n\nRows and neighbours: mean / most of a rank."}
