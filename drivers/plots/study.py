#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws a study of plica: each method's error against its run time, both logarithmic.

    study.py FOLDER          writes FOLDER/study.png
"""
import json
import math
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import command

# Of a family: colour and marker. Their lightness differs too, so that a print in grey tells them apart.
SINGLE = [("#000000", "o"), ("#5a2d82", "s"), ("#7a7a7a", "D"), ("#a05a9a", "h"), ("#3b3b6d", "<"), ("#8d6f8d", ">"),
          ("#555555", "d"), ("#b59ac0", "8")]
COARSE = [("#9a6700", "v"), ("#c78a00", "^"), ("#e0b040", "<"), ("#efd080", ">")]
CYCLES = {"rs": ("#1f77b4", "P"), "rv": ("#d62728", "X"), "rsv": ("#2ca02c", "*"), "rsv_sv": ("#7fc8e8", "p"),
          "fas": ("#f29ac0", "d")}
SPARE = [("#444444", "8"), ("#bbbbbb", "H")]
GREY = "#666666"
RIMS = {"linear": "black", "nodal": "#e00000"}  # of markers, by the elements


def families(rows):
    """method -> (colour, marker), in the order of the rows."""
    methods = list(dict.fromkeys(row["method"] for row in rows))
    methods += ["/".join(method.split("/")[:2]) for method in methods]  # also of a level that only other integrators have run
    methods = sorted(dict.fromkeys(methods), key=lambda method: method.count("/"))
    spare = {"single": iter(SINGLE), "coarse": iter(COARSE), "cycle": iter(SPARE)}
    look = {}
    for method in methods:
        kind, name, *integrator = method.split("/")
        if integrator:  # a coarse level in its colour, with the marker of that integrator
            look[method] = (look[f"coarse/{name}"][0], look.get(f"single/{integrator[0]}", (None, "."))[1])
            continue
        look[method] = (CYCLES.get(name) if kind == "cycle" else None) or next(spare[kind], ("#444444", "."))
    return look


def seconds_per_work(rows):
    """Median wall time per unit of work of the completed rows; it places the other rows on the time axis."""
    rates = sorted(row["wall_time"] / row["work"] for row in rows if row["status"] == "completed" and row["work"])
    return rates[len(rates) // 2] if rates else 1.0


def draw_completed(axes, rows, look):
    for method, (colour, marker) in look.items():
        mine = [row for row in rows if row["method"] == method]
        done = [row for row in mine if row["status"] == "completed" and row["error"] > 0]
        failed = len(mine) - len(done)
        others = len([other for other in look if other.startswith(method + "/")])
        label = method + (" (other markers: as single)" if others else "") + (f" ({failed} of {len(mine)} not completed)" if failed else "")
        for variant in (False, True):  # with settings of its own: hollow
            some = [row for row in done if bool(row["variant"]) == variant]
            rims = [colour if variant else RIMS.get(row["element"], GREY) for row in some]
            axes.scatter([row["wall_time"] for row in some], [row["error"] for row in some],
                         s=95 if marker == "*" else 60, marker=marker, facecolors="none" if variant else colour,
                         edgecolors=rims, linewidths=[1.2 if variant or rim != "black" else 0.6 for rim in rims],
                         label=None if variant or method.count("/") == 2 else label, zorder=3)
    if any(row["element"] == "nodal" for row in rows):
        axes.scatter([], [], s=60, marker="o", facecolors="none", edgecolors=RIMS["nodal"], label="red rim: nodal elements")
    if any(row["variant"] for row in rows):
        axes.scatter([], [], s=60, marker="o", facecolors="none", edgecolors=GREY, label="hollow: a variant of a cycle")
    return [row for row in rows if row["status"] == "completed" and row["error"] > 0]


def draw_parts(axes, rows):
    """Of rows on the front, the part that is of the time step: a dash below the error. The rest is the mesh."""
    front = [row for row in rows if row["pareto"] and row["time_error"]]
    bottom = axes.get_ylim()[0]
    for row in front:
        axes.plot([row["wall_time"]] * 2, [row["error"], max(row["time_error"], bottom)], color=GREY, linewidth=0.8, zorder=1)
    shown = [row for row in front if row["time_error"] > bottom]
    if front:
        axes.plot([row["wall_time"] for row in shown], [row["time_error"] for row in shown], linestyle="none", marker="_",
                  color=GREY, markersize=9, label="of that by the time step")


def name_of(row, rows):
    """The name of a row, with what distinguishes it from other rows of its method."""
    parts = [row["method"], row["distribution"], row["variant"] and "+" + row["variant"]]
    parts += [row["element"]] if len({other["element"] for other in rows}) > 1 else []
    parts += [row["precision"]] if len({other["precision"] for other in rows}) > 1 else []
    parts += [f"{row['threads']} thr."] if len({other["threads"] for other in rows}) > 1 else []
    return ", ".join(part for part in parts if part)


def draw_front(axes, rows):
    front = sorted((row for row in rows if row["pareto"] and row["error"] > 0), key=lambda row: row["wall_time"])
    axes.step([row["wall_time"] for row in front], [row["error"] for row in front], where="post", color="black",
              linewidth=1.4, zorder=2, label="the best for their time")
    places = [axes.transData.transform((row["wall_time"], row["error"])) for row in front]
    for i, row in enumerate(front):
        near = i > 0 and math.dist(places[i], places[i - 1]) < 15  # its number goes to the other side
        axes.annotate(str(i + 1), (row["wall_time"], row["error"]), textcoords="offset points", xytext=(9, 4) if near else (-9, -11),
                      fontsize=9, weight="bold", ha="center", zorder=4)
    return "\n".join(f"{number}  {name_of(row, rows)}: {row['macro_step_over_critical']:.2g}×"
                     for number, row in enumerate(front, 1))


def draw_failed(axes, rows, look, left):
    """In the margin above, a line for each method: crosses where diverged runs would have been, bars for refused ones."""
    rate = seconds_per_work(rows)
    failed = [row for row in rows if row["status"] != "completed"]
    methods = list(dict.fromkeys(row["method"] for row in failed))
    for row in failed:
        diverged = row["status"] == "diverged" and row["work"]
        axes.plot([row["work"] * rate if diverged else left], [1.02 + 0.02 * methods.index(row["method"])],
                  marker="x" if diverged else "|", color=look[row["method"]][0], markersize=7, markeredgewidth=2,
                  transform=axes.get_xaxis_transform(), clip_on=False, linestyle="none")
    kinds = [("× diverged", "diverged"), ("| refused", "refused")]
    text = ", ".join(label for label, status in kinds if any(row["status"] == status for row in failed))
    axes.text(1.01, 1.01 + 0.01 * len(methods), text, transform=axes.transAxes, fontsize=9, va="center", color=GREY)


def lines_in_space(reference):
    """What a mesh alone makes wrong: error, colour, line and words."""
    lines = [(mesh["error_space"], RIMS.get(mesh["element"], GREY), ":", f"level {mesh['level']}, {mesh['element']}: error in space")
             for mesh in reference.get("meshes", [])]
    if reference["space_error"]:
        lines.append((reference["space_error"], GREY, "--", "the finest mesh's own error in space"))
    return sorted(lines)


def draw_limits(axes, reference):
    """Errors below ten times the error of the reference mean nothing. Lines have their words at the left, moved apart."""
    told = 10 * reference["own_error"]
    if told > axes.get_ylim()[0]:
        axes.axhspan(0, told, color="#000000", alpha=0.07, zorder=0, linewidth=0)
        axes.text(0.995, 0.01, "grey: not to be told by this reference", ha="right", va="bottom", fontsize=8, color=GREY,
                  transform=axes.transAxes)
    last = -math.inf  # where the words before stand [points]
    for error, colour, style, words in lines_in_space(reference):
        axes.axhline(error, color=colour, linestyle=style, linewidth=0.8, zorder=1)
        line = axes.transData.transform((1, error))[1] * 72 / axes.figure.dpi
        last = max(line + 2, last + 10)
        axes.annotate(words, (0.005, error), xycoords=axes.get_yaxis_transform(), textcoords="offset points", xytext=(0, last - line),
                      va="bottom", fontsize=8, color=GREY, annotation_clip=True)


def draw(folder):
    study = json.loads((folder / "study.json").read_text())
    rows, reference, machine = study["rows"], study["reference"], study["machine"]
    for row in rows:  # what is drawn: against the truth, where that is the reference; beside it the part of the time step
        row.setdefault("total_error", None), row.setdefault("element", "linear")  # earlier studies
        row["time_error"] = row["error"] if row["total_error"] is not None else None
        row["error"] = row["error"] if row["total_error"] is None else row["total_error"]
    look = families(rows)
    figure, axes = pyplot.subplots(figsize=(11, 7.2))
    figure.subplots_adjust(left=0.08, right=0.7, top=0.8, bottom=0.085)
    axes.set(xscale="log", yscale="log", xlabel="run time of the steps [s]: less to the left",
             ylabel=("total error" if "truth" in reference else "error") + " of displacement (relative, all vertices and times): less below")
    done = draw_completed(axes, rows, look)
    if done:
        errors, times = [row["error"] for row in done], [row["wall_time"] for row in done]
        rate = seconds_per_work(rows)
        times += [row["work"] * rate for row in rows if row["status"] == "diverged" and row["work"]]
        axes.set_ylim(min(errors) / 3, min(max(errors) * 2, 100))
        room = (max(times) / min(times)) ** 0.3 if lines_in_space(reference) else 1  # for words at the left
        axes.set_xlim(min(times) / 1.6 / room, max(times) * 1.6)
    front = draw_front(axes, rows)
    draw_parts(axes, rows)
    draw_limits(axes, reference)
    draw_failed(axes, rows, look, axes.get_xlim()[0])
    axes.grid(which="major", alpha=0.3)
    axes.grid(which="minor", alpha=0.1)
    many = len(axes.get_legend_handles_labels()[0]) > 14
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 0.99), fontsize=8 if many else 9, frameon=False,
                labelspacing=0.4 if many else 0.8)
    figure.text(0.715, 0.1, "The best for their time, and their macro\nstep over the finest critical step:\n" + front,
                fontsize=8.5, va="bottom", linespacing=1.5)
    threads = machine["threads"]
    figure.text(0.08, 0.955, f"{study['name']}: error against run time", fontsize=16, weight="bold")
    figure.text(0.08, 0.922, f"{study['duration']:g} s, {' / '.join(map(str, study['tets']))} tetrahedra; {machine['cpu']}, "
                f"{machine['backend']}, {threads} thread{'s' if threads != 1 else ''}", fontsize=10, color="#444444")
    path = folder / "study.png"
    figure.savefig(path, dpi=110)
    return path


if __name__ == "__main__":
    command.draw_folder(draw, __doc__, "what plica study wrote")
