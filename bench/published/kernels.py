# SPDX-License-Identifier: BSD-3-Clause
"""What the machine can do, and which share of that the kernels of an explicit step reach, on one thread."""
from bench import number, seconds, table

SOURCES, SECONDS = ("core", "kernels", "bench/kernels.cpp", "bench/steps.cpp", "bench/levels.cpp", "bench/limits.cpp", "bench/compulsory.hpp"), 120
KERNELS = {"force": "forces, linear elements", "nodal_force": "forces, nodal elements", "explicit_step": "an explicit step"}


def measure(bench):
    tets = "10692" if bench.small else "(10692|101802)"
    return bench.kernels(rf"^(limit/.*|({'|'.join(KERNELS)})/neo_hookean/(double|float)/{tets}|transfer/.*)", seconds=0.3)


def blocks(rows):
    limits = [[name.removeprefix("limit/"), f"{number(row['rate'] / 1e9, 3)} G{'B' if 'triad' in name else 'flop'}/s"]
              for name, row in rows.items() if name.startswith("limit/") and row["rate"]]
    lines = []
    for name, row in rows.items():
        if not name.startswith("limit/"):
            kernel, *more = name.split("/")
            lines.append([KERNELS.get(kernel, kernel), ", ".join(more), seconds(row["seconds"]), f"{100 * row['share']:.0f} %" if row["share"] else ""])
    return {"kernels": table(["limit", ""], limits) + "\n\n" + table(["kernel", "case", "time", "share of the limit"], lines, left=2)}
