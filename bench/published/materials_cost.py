# SPDX-License-Identifier: BSD-3-Clause
"""Nanoseconds a tetrahedron that each law takes: its force and the product with its tangent, of both elements, in both precisions."""
from bench import number, table

SOURCES, SECONDS = ("core", "kernels", "bench/kernels.cpp"), 100
KINDS = {"force": "linear: force", "tangent": "linear: tangent", "nodal_force": "nodal: force", "nodal_tangent": "nodal: tangent"}
TETS = 10692


def measure(bench):
    times = bench.kernels(rf"^({'|'.join(KINDS)})/[a-z_]+/(double|float)/{TETS}$", seconds=0.2)
    rows = {}
    for name, row in times.items():
        kind, law, precision, _ = name.split("/")
        rows.setdefault(law, {})[f"{kind}/{precision}"] = row["seconds"]
    return rows


def blocks(rows):
    def cell(row, kind):
        return " / ".join(number(1e9 * row[f"{kind}/{p}"] / TETS, 3) if f"{kind}/{p}" in row else "–" for p in ("double", "float"))
    return {"materials_cost": f"ns a tetrahedron, double / float, {TETS:,} tetrahedra, one thread.\n\n"
            + table(["law", *KINDS.values()], [[f"`{law}`", *(cell(row, kind) for kind in KINDS)] for law, row in rows.items()])}
