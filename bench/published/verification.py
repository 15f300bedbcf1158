# SPDX-License-Identifier: BSD-3-Clause
"""What `plica verify` finds: problems with known answers."""
import json

from bench import Failed, number as plain, table

SOURCES, SECONDS = ("core", "kernels", "drivers"), 600


def measure(bench):
    folder = bench.scratch / "verify"
    try:
        bench.call("plica", "verify", *(["--small"] if bench.small else []), "-o", folder, "--quiet", "--threads", 2, threads=2)
    except Failed:  # also where a row is outside its tolerance, which the table then shows
        if not any(folder.glob("*.json")):
            raise
    said = json.loads(next(folder.glob("*.json")).read_text())
    return {"ok": said["ok"], "rows": said["rows"]}


def number(value):
    return "" if value is None else plain(value, 5) if value == 0 or abs(value) >= 1e-9 else f"below {1e-9:.9f}"


def blocks(data):
    rows, lines, details = data["rows"], [], []
    for problem in dict.fromkeys(r["problem"] for r in rows):
        own = [r for r in rows if r["problem"] == problem]
        outcomes = [r["outcome"] for r in own]
        lines.append([f"`{problem}`", len(own), outcomes.count("ok"), outcomes.count("shown"), outcomes.count("not ok")])
        inside = [[r["quantity"], r["element"], r["mesh"], number(r["accepted"]), number(r["ours"][-1]["value"]) if r["ours"] else "", r["outcome"]]
                  for r in own]
        details.append(f"<details><summary>{problem}</summary>\n\n" +
                       table(["quantity", "elements", "mesh", "accepted", "Plica, finest", "outcome"], inside, left=3) + "\n\n</details>")
    judged = sum(r["outcome"] != "shown" for r in rows)
    good = sum(r["outcome"] == "ok" for r in rows)
    total = f"{good} of {judged} judged rows are within their tolerance; {len(rows) - judged} more are shown only."
    return {"verification": "\n\n".join([total, table(["problem", "rows", "ok", "shown only", "not ok"], lines), *details]), "verification_short": total}
