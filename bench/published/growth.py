# SPDX-License-Identifier: BSD-3-Clause
"""Time of an explicit step from a thousand to ten million tetrahedra, with linear and nodal elements, one and two threads, and its share of the limit
by bytes."""
import figure as look
from bench import number, table

SOURCES, SECONDS = ("core", "kernels", "drivers", "bench/growth.cpp", "bench/limits.cpp", "bench/compulsory.hpp"), 900
ELEMENTS, THREADS = ("linear", "nodal"), (1, 2)


def measure(bench):
    rows = []
    for threads in THREADS:
        for name, row in bench.kernels("^growth/[a-z]+/(960|10692)$" if bench.small else "^growth/", threads=threads).items():
            _, element, tets = name.split("/")
            rows.append({"element": element, "tets": int(tets), "threads": threads, "seconds": row["median"], "share": row["share"]})
    return rows


def nanoseconds(row):
    return 1e9 * row["seconds"] / row["tets"]


def blocks(rows):
    at = {(r["element"], r["threads"], r["tets"]): r for r in rows}
    kinds = [(element, threads) for element in ELEMENTS for threads in THREADS]

    def cell(kind, tets):
        row = at.get((*kind, tets))
        return f"{number(nanoseconds(row), 3)} ({100 * row['share']:.0f} %)" if row else "–"
    heads = ["tetrahedra", *(f"{element}, {threads} thread{'s' * (threads > 1)}" for element, threads in kinds)]
    lines = [[f"{tets:,}", *(cell(kind, tets) for kind in kinds)] for tets in sorted({r["tets"] for r in rows})]
    return {"growth": "![Time of an explicit step for each tetrahedron, and its share of the limit by bytes](../pictures/growth.png)\n\n"
            "Nanoseconds a tetrahedron of an explicit step in double, and in brackets the share of the limit by bytes.\n\n" + table(heads, lines)}


def figure(rows):
    drawn, (left, right) = look.panels("An explicit step, by the size of the body", 2, sharex=True)
    for element, colour, marker in (("linear", look.BLUE, "o"), ("nodal", look.ORANGE, "s")):
        for threads, line in ((1, "-"), (2, "--")):
            own = sorted((r for r in rows if (r["element"], r["threads"]) == (element, threads)), key=lambda r: r["tets"])
            tets, label = [r["tets"] for r in own], f"{element} elements, {threads} thread{'s' * (threads > 1)}"
            left.plot(tets, [nanoseconds(r) for r in own], line, color=colour, marker=marker, label=label)
            right.plot(tets, [100 * r["share"] for r in own], line, color=colour, marker=marker, label=label)
    left.set(xscale="log", xlabel="tetrahedra", ylabel="time of a step [ns a tetrahedron]", title="time")
    right.set(xlabel="tetrahedra", ylabel="part of the limit by bytes [%]", title="share of what memory allows")
    left.set_ylim(bottom=0), right.set_ylim(bottom=0)
    look.plain_numbers(left.xaxis)
    left.legend(frameon=False, fontsize=9)
    return drawn
