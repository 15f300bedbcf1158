#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws one picture of the body among its obstacles at one time of a run of plica, coloured by how far its points have moved.

    picture.py FOLDER [--time SECONDS] [-o FILE]          writes FOLDER/picture.png
"""
import argparse
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import body
import frames


def trimmed(pixels, margin=12):
    """Without the white borders, but for a margin."""
    ink = (pixels < 250).any(axis=2)
    (top, bottom), (left, right) = (numpy.flatnonzero(ink.any(axis=axis))[[0, -1]] for axis in (1, 0))
    return pixels[max(top - margin, 0):bottom + margin, max(left - margin, 0):right + margin]


def draw(folder, time, file):
    run = frames.Run(folder)
    frame = int(numpy.abs(run.times - (run.times[-1] if time is None else time)).argmin())
    view = body.View(run)
    moved = run.displacement(frame)
    largest = numpy.percentile(moved, 99.5) or 1e-3
    pixels = trimmed(view.picture(run.times[frame], run.points[frame], run.triangles, numpy.minimum(moved, largest), largest, height=680))
    figure = pyplot.figure(figsize=(pixels.shape[1] / 100 + 1.1, pixels.shape[0] / 100), dpi=100)
    axes = figure.add_axes((0, 0, pixels.shape[1] / 100 / figure.get_figwidth(), 1))
    axes.imshow(pixels)
    axes.axis("off")
    bar = figure.add_axes((1 - 0.85 / figure.get_figwidth(), 0.2, 0.18 / figure.get_figwidth(), 0.6))
    scale = matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(0, 1e3 * largest), body.BODY_MAP)
    figure.colorbar(scale, cax=bar, label="displacement, mm")
    figure.savefig(file)
    return file


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path, help="of the run")
    parser.add_argument("--time", type=float, help="the nearest frame to it [s]; else the last")
    parser.add_argument("-o", type=pathlib.Path, help="the picture; else picture.png in the folder")
    arguments = parser.parse_args()
    try:
        print(draw(arguments.folder, arguments.time, arguments.o or arguments.folder / "picture.png"))
    except OSError as error:
        sys.exit(f"error: {error.filename}: {error.strerror}")


if __name__ == "__main__":
    main()
