#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws a stability search of plica: each method's largest stable macro step, predicted and measured.

    stability.py FOLDER          writes FOLDER/stability.png
"""
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import command

COLOURS = {"single": "#000000", "coarse": "#9a6700", "cycle": "#1f77b4"}
GREY = "#666666"
RED = "#d62728"


def name_of(row):
    name = row["method"] + ("/" + row["distribution"] if row["distribution"] else "")
    name += "+" + row["variant"] if row["variant"] else ""
    other = row["method"].startswith("coarse/") and row["integrator"] != "symplectic_euler"
    return name + (", " + row["integrator"] if other else "")


def words_of(row):
    """The text at the right: measured over predicted, growth, how the scene failed."""
    words = []
    if row["ratio"]:
        words.append(f"{row['ratio']:.3f}")
    if row["status"] == "growing":
        words.append("grows at every step")
    if row["status"] == "refused":
        words.append("refused")
    if row["stable_up_to"]:
        words.append("no limit found")
    if row["growth_per_second"] and row["spectral_radius"] > 1 + 1e-6:
        words.append(f"{row['growth_per_second']:.2g}/s")
    if row["scene_kind"]:
        j = "" if row["scene_J"] is None else f", J = {row['scene_J']:.2g}"
        words.append(f"scene: {row['scene_kind']}{j}")
    return "  ".join(words)


def draw_row(axes, y, row, unit):
    colour = COLOURS[row["method"].split("/")[0]]
    if row["status"] == "growing":
        axes.plot([(row["growth_step"] or row["critical_step"]) / unit], [y], marker="x", color=colour, markersize=8,
                  markeredgewidth=2)
    if row["predicted"]:
        axes.plot([row["predicted"] / unit], [y], marker="|", color=colour, markersize=16, markeredgewidth=2)
    if row["measured"]:
        axes.plot([row["measured"] / unit], [y], marker="o", color=colour, markersize=7)
    if row["stable_up_to"]:
        axes.plot([row["stable_up_to"] / unit], [y], marker=">", color=colour, markersize=9)
    if row["scene_measured"]:
        face = RED if row["scene_failed_step"] else "none"
        axes.plot([row["scene_measured"] / unit], [y], marker="d", color=RED, markerfacecolor=face, markersize=7)


def legend(axes, rows):
    entries = [("|", GREY, GREY, "predicted"), ("o", GREY, GREY, "measured, small motions"),
               ("x", GREY, GREY, "grows at every step"), (">", GREY, GREY, "stable as far as was looked")]
    if any(row["scene_measured"] for row in rows):
        entries += [("d", RED, RED, "the scene itself"), ("d", RED, "none", "the scene itself, no further tried")]
    for marker, colour, face, label in entries:
        axes.plot([], [], marker=marker, color=colour, markerfacecolor=face, linestyle="none", markersize=8,
                  markeredgewidth=2 if marker in "|x" else 1, label=label)
    axes.legend(loc="lower left", bbox_to_anchor=(0, 1.0), ncol=3, fontsize=9, frameon=False)


def draw(folder):
    found = json.loads((folder / "stability.json").read_text())
    rows = found["rows"]
    unit = rows[0]["critical_step"] if rows else 1
    figure, axes = pyplot.subplots(figsize=(11, 2.4 + 0.3 * len(rows)))
    top = 1 - 1.3 / figure.get_figheight()
    figure.subplots_adjust(left=0.22, right=0.66, top=top, bottom=0.6 / figure.get_figheight())
    for y, row in enumerate(rows):
        draw_row(axes, y, row, unit)
        axes.text(1.02, y, words_of(row), transform=axes.get_yaxis_transform(), va="center", fontsize=8.5, color="#444444")
    axes.set(xscale="log", yticks=range(len(rows)), yticklabels=[name_of(row) for row in rows],
             xlabel="macro step over the finest level's critical step")
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.grid(which="major", alpha=0.3)
    axes.grid(which="minor", axis="x", alpha=0.1)
    axes.axvline(1, color=GREY, linewidth=1)
    legend(axes, rows)
    height = figure.get_figheight()
    figure.text(0.02, 1 - 0.35 / height, f"{found['name']}: largest stable macro step", fontsize=16, weight="bold")
    figure.text(0.02, 1 - 0.6 / height, f"{found['material']}, {' / '.join(map(str, found['tets']))} tetrahedra; critical "
                f"step {unit:.3g} s; right: measured over predicted, growth of small motions", fontsize=10, color="#444444")
    path = folder / "stability.png"
    figure.savefig(path, dpi=110)
    return path


if __name__ == "__main__":
    command.draw_folder(draw, __doc__, "what plica stability wrote")
