# SPDX-License-Identifier: BSD-3-Clause
"""summary.md, of the records and raw files that the stages leave."""
import json
import re

# Of issues and papers: for a GPU of Hopper's kind, in float. Name of the benchmark, what is read of it, the goal, how it is said.
GOALS = (
    ("scale/explicit/float/1018686", "median", 60e-6, "explicit step, 1 million tetrahedra"),
    ("scale/rsv/float/1018686", "median", 200e-6, "rsv of four levels, 1 million"),
    ("scale/him/float/1018686", "median", 150e-6, "him of four levels, 1 million, a macro step"),
    ("force/neo_hookean/float/1018686", "fraction_of_limit", 0.6, "forces, share of the bandwidth, 1 million"),
    ("scale/sofa_beam/float/101250", "median", 0.5e-3, "beam of SOFA's plugin, 10 iterations"),
    ("scale/sofa_beam_converged/double/101250", "median", 5e-3, "the same, to a residual of 1e-8"),
)


def seconds(time):
    unit, size = next(((unit, size) for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)) if time >= size), ("ns", 1e-9))
    return f"{time / size:.3g} {unit}"


def read_bench(file):
    """Benchmarks of a file of Google Benchmark. One that was cut off lacks its end."""
    text = file.read_text()
    for end in ("", "\n]}", "]}"):
        try:
            return json.loads(re.sub(r",\s*$", "", text) + end if end else text)["benchmarks"]
        except (ValueError, KeyError):
            continue
    # the last entry itself is not whole
    cut = text.rfind("},")
    try:
        return json.loads(text[:cut + 1] + "]}")["benchmarks"]
    except (ValueError, KeyError):
        return []


def benchmarks(folder):
    """{name: row} of all that were measured."""
    rows = {}
    for file in sorted(folder.glob("*.bench.json")):
        for row in read_bench(file):
            if not row.get("error_occurred") and row.get("run_type", "iteration") == "iteration":
                rows[re.sub("/(min_time|iterations|repeats).*", "", row["name"])] = row
    return rows


def failed_tests(folder):
    """[(file, tests, names of those that failed)]."""
    result = []
    for file in sorted(folder.glob("*.tests.json")):
        try:
            suites = json.loads(file.read_text())["testsuites"]
        except (ValueError, KeyError):
            result.append((file.name, 0, ["its file is not whole"]))
            continue
        tests = [(f"{suite['name']}.{test['name']}", test) for suite in suites for test in suite["testsuite"]]
        result.append((file.name, len(tests), [name for name, test in tests if test.get("failures")]))
    return result


def table(heads, rows):
    return ["| " + " | ".join(map(str, line)) + " |" for line in (heads, ["---"] * len(heads), *rows)]


def summary(records, folder, about):
    """The text of summary.md. `records`: those of all stages, by name; None for one that did not begin."""
    lines = [f"# On {about['gpu'] or 'a machine without a GPU'}", "", f"{about['program']}. {about['driver']}. By `bench/gpu`.", "", "## Stages", ""]
    lines += table(["stage", "", "time", "parts that are not well"], [
        [name, record["status"] if record else "not begun", f"{record['seconds']:.0f} s" if record else "",
         "; ".join(f"{part['name']}: {part['status']}" for part in record["parts"] if part["status"] != "passed") if record else ""]
        for name, record in records.items()])
    tests = failed_tests(folder)
    if tests:
        lines += ["", "## Tests", "", *table(["", "tests", "failed"], [[name.split(".")[0], count, ", ".join(bad[:12]) or "none"] for name, count, bad in tests])]
    rows = benchmarks(folder)
    goals = []
    for name, what, goal, words in GOALS:
        value = rows.get(name, {}).get(what)
        good = value is not None and (value >= goal if what == "fraction_of_limit" else value <= goal)
        show = (lambda x: f"{100 * x:.0f} %") if what == "fraction_of_limit" else seconds
        goals.append([words, show(goal), "not measured" if value is None else show(value), "" if value is None else "reached" if good else "missed"])
    lines += ["", "## Goals", "", *table(["", "goal", "measured", ""], goals)]
    if rows:
        one = "/one_by_one"
        lines += ["", "## Measured", "", *table(["benchmark", "median", "launched one by one", "share of the limit", "iterations"], [
            [name, seconds(row["median"]) if "median" in row else "", seconds(rows[name + one]["median"]) if name + one in rows else "",
             f"{100 * row['fraction_of_limit']:.0f} %" if "fraction_of_limit" in row else "", f"{row['cg_iterations']:.3g}" if row.get("cg_iterations") else ""]
            for name, row in rows.items() if not name.endswith(one) and not name.startswith("limit/")])]
        lines += ["", *table(["limit", ""], [[name.removeprefix("limit/"), f"{(row.get('bytes_per_second') or row.get('flops_per_second') or 0) / 1e9:.4g} G/s"]
                                            for name, row in rows.items() if name.startswith("limit/")])]
    parity = [line for file in sorted(folder.glob("parity_*.txt")) for line in file.read_text().splitlines() if "of the motion" in line]
    if parity:
        lines += ["", "## Scenes beside the CPU", "", *(f"* {line}" for line in parity)]
    return "\n".join(lines) + "\n"
