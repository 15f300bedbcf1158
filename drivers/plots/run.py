#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws one picture of a run of plica: the body at several times, its energies, and where the time went.

    run.py FOLDER          writes FOLDER/run.png
"""
import pathlib
import re
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import body
import command
import frames

WIDTH = 14  # inches
ROWS, COLUMNS = 2, 3
ENERGIES = [("kinetic_energy", "kinetic", "#1f77b4"), ("elastic_energy", "elastic", "#d95f02"),
            ("potential_energy", "potential", "#4d9a4d"), ("contact_energy", "contact", "#9467bd"),
            ("total_energy", "total", "#222222")]
STAGE_COLOURS = {"force": "#4c78a8", "contact": "#9467bd", "solve": "#d95f02", "integrate": "#9ecae9",
                 "restrict": "#54a24b", "interpolate": "#88d27a", "other": "#b9b9b9"}
INSIDE_INTEGRATE = ("force", "contact", "solve")
SPARE_COLOURS = ["#eeca3b", "#ff9da6", "#79706e", "#bab0ac"]


def draw_bodies(figure, run, view, box):
    """The film: pictures in two rows, with one colour bar."""
    left, bottom, right, top = box
    chosen = run.telling_frames(ROWS * COLUMNS)
    moved = {frame: run.displacement(frame) for frame in chosen}
    largest = max(numpy.percentile(values, 98) for values in moved.values()) or 1e-3  # nothing moved: a millimetre
    grid = figure.add_gridspec(ROWS, COLUMNS, left=left, right=right - 0.075, top=top, bottom=bottom,
                               wspace=0.03, hspace=0.1)
    for place, frame in zip(grid, chosen):
        axes = figure.add_subplot(place)
        axes.imshow(view.picture(run.times[frame], run.points[frame], run.triangles, moved[frame], largest))
        axes.set_title(f"{run.times[frame]:.3g} s", fontsize=11, pad=2)
        axes.axis("off")
    colours = matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(0, 1e3 * largest), body.BODY_MAP)
    middle = (bottom + top) / 2
    bar = figure.colorbar(colours, cax=figure.add_axes((right - 0.06, middle - 0.14, 0.012, 0.28)), extend="max")
    what = "displacement" if run.held else "deformation: distance from the best rigid fit"
    most = 1e3 * max(values.max() for values in moved.values())
    bar.set_label(f"{what} [mm], at most {most:.3g}", fontsize=9)


def draw_energies(axes, run):
    for column, label, colour in ENERGIES:
        if column in run.history and numpy.abs(run.history[column]).max() > 0:
            axes.plot(run.history["time"], run.history[column], color=colour, label=label,
                      linewidth=2.2 if label == "total" else 1.4)
    axes.set(xlabel="time [s]", title="Energy of level 0 [J]", xlim=(0, max(run.history["time"].max(), 1e-12)))
    axes.axhline(0, color="black", linewidth=0.6)
    axes.grid(alpha=0.25)
    axes.legend(ncols=5, fontsize=9, loc="upper center", bbox_to_anchor=(0.5, -0.16), frameon=False)


def stage_times(summary):
    """level -> stage -> seconds, none of them inside another."""
    levels = {}
    for name, seconds in summary.get("stages", {}).items():
        match = re.fullmatch(r"(.*) (\d+)", name)
        if match:
            levels.setdefault(int(match[2]), {})[match[1]] = seconds
    for stages in levels.values():
        if "integrate" in stages:
            stages["integrate"] -= sum(stages.get(stage, 0) for stage in INSIDE_INTEGRATE)
            stages["integrate"] = max(stages["integrate"], 0.0)
    return dict(sorted(levels.items()))


def draw_stages(axes, summary):
    levels = stage_times(summary)
    stages = [stage for stage in STAGE_COLOURS if any(stage in parts for parts in levels.values())]
    stages += sorted({stage for parts in levels.values() for stage in parts} - set(stages))
    spare = iter(SPARE_COLOURS * 4)
    left = {level: 0.0 for level in levels}
    for stage in stages:
        colour = STAGE_COLOURS.get(stage) or next(spare)
        widths = [levels[level].get(stage, 0.0) for level in levels]
        axes.barh(list(levels), widths, left=list(left.values()), color=colour, height=0.7,
                  label="integrate: the rest" if stage == "integrate" else stage)
        left = {level: left[level] + width for level, width in zip(levels, widths)}
    for level, total in left.items():
        tets = summary["levels"][level]["tets"]
        axes.text(total, level, f"  {total:.2g} s, {tets} tets", va="center", fontsize=9)
    axes.set(xlabel="wall time [s]", yticks=list(levels), yticklabels=[f"level {level}" for level in levels],
             title=f"Wall time: {summary.get('wall_time', 0):.3g} s of stepping, {sum(left.values()):.3g} s in these stages",
             xlim=(0, 1.3 * max([*left.values(), 1e-9])), ylim=(max(len(levels), 3) - 0.5, -0.5))
    axes.grid(alpha=0.25, axis="x")
    if stages:
        axes.legend(ncols=4, fontsize=9, loc="upper center", bbox_to_anchor=(0.5, -0.16), frameon=False)


def head_lines(summary):
    if not summary:
        return "a run without summary.json: it was killed, or goes on", ""
    levels = " + ".join(str(level["tets"]) for level in summary["levels"] if level["tets"])  # spaces have none
    wall = summary["wall_time"]
    speed = f" ({summary['simulated_time'] / wall:.2g} x real time)" if wall > 0 else ""
    first = f"{summary['name']}: {summary['status']}"
    second = (f"{levels} tetrahedra, cycle {summary['cycle']}, macro step {1e3 * summary['macro_step']:.3g} ms;  "
              f"{summary['simulated_time']:.3g} s in {wall:.3g} s{speed}, {summary['precision']} on "
              f"{summary['backend']}, {summary['threads']} thread{'s' if summary['threads'] != 1 else ''}")
    return first, second


def draw(folder):
    run = frames.Run(folder)
    view = body.View(run)
    film = WIDTH * 0.9 / COLUMNS / view.aspect() * ROWS * 1.12  # inches high, so that the pictures fill it
    film = min(max(film, 2.5), 9)
    height = film + 5.2
    figure = pyplot.figure(figsize=(WIDTH, height))
    first, second = head_lines(run.summary)
    unfinished = run.summary.get("status") != "completed"
    figure.text(0.03, 1 - 0.38 / height, first, fontsize=17, weight="bold", color="#b22222" if unfinished else "black")
    figure.text(0.03, 1 - 0.68 / height, second, fontsize=11, color="#444444")
    draw_bodies(figure, run, view, (0.02, 4.2 / height, 0.985, 1 - 1.0 / height))
    charts = figure.add_gridspec(1, 2, left=0.06, right=0.975, top=3.6 / height, bottom=1.1 / height, wspace=0.17)
    draw_energies(figure.add_subplot(charts[0]), run)
    draw_stages(figure.add_subplot(charts[1]), run.summary)
    path = run.folder / "run.png"
    figure.savefig(path, dpi=110)
    return path


if __name__ == "__main__":
    command.draw_folder(draw, __doc__, "what plica run wrote")
