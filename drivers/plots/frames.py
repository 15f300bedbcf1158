# SPDX-License-Identifier: BSD-3-Clause
"""Reads what a run of plica wrote, with NumPy alone."""
import base64
import csv
import json
import pathlib
import xml.etree.ElementTree

import numpy

TYPES = {"Float64": "f8", "Float32": "f4", "Int32": "i4", "Int64": "i8", "UInt8": "u1"}


def read_vtu(path):
    """Every array of a .vtu file as plica writes it (appended in base64), by name."""
    root = xml.etree.ElementTree.parse(path).getroot()
    appended = root.find("AppendedData").text.strip()[1:]
    order = "<" if root.get("byte_order") == "LittleEndian" else ">"
    arrays = {}
    for tag in root.iterfind(".//DataArray[@format='appended']"):
        at = int(tag.get("offset"))
        size = int(numpy.frombuffer(base64.b64decode(appended[at:at + 12]), order + "u8", 1)[0])
        content = base64.b64decode(appended[at:at + (8 + size + 2) // 3 * 4])
        values = numpy.frombuffer(content, order + TYPES[tag.get("type")], offset=8)
        columns = int(tag.get("NumberOfComponents"))
        arrays[tag.get("Name")] = values.reshape(-1, columns) if columns > 1 else values
    return arrays


class Run:
    """summary: the JSON; history: its columns; times and points [frame, vertex, axis]; triangles; up: against gravity."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        summary = self.folder / "summary.json"
        self.summary = json.loads(summary.read_text()) if summary.exists() else {}
        gravity = numpy.array(self.summary.get("gravity", [0, 0, 0]), float)
        self.up = -gravity if gravity.any() else numpy.array([0.0, 0, 1])
        with open(self.folder / "history.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.history = {key: numpy.array([float(row[key]) for row in rows]) for key in rows[0]}
        sets = list(xml.etree.ElementTree.parse(self.folder / "frames.pvd").iter("DataSet"))
        self.times = numpy.array([float(entry.get("timestep")) for entry in sets])
        frames = [read_vtu(self.folder / entry.get("file")) for entry in sets]
        self.triangles = frames[0]["connectivity"].reshape(-1, 3)
        self.points = numpy.array([frame["Points"] for frame in frames])

        # whether some point of it never moves
        self.held = bool((numpy.ptp(self.points, axis=0).max(axis=1) < 1e-6 * numpy.ptp(self.points[0], axis=0).max()).any())

    def displacement(self, frame):
        """How far each point is from where it started [m]; of a free body, from where it would be if it had moved
        rigidly since (least squares)."""
        rest, now = self.points[0], self.points[frame]
        if self.held:
            return numpy.linalg.norm(now - rest, axis=1)
        rest, now = rest - rest.mean(axis=0), now - now.mean(axis=0)
        u, _, v = numpy.linalg.svd(rest.T @ now)
        flip = numpy.diag([1, 1, numpy.sign(numpy.linalg.det(u @ v))])
        return numpy.linalg.norm(now - rest @ (u @ flip @ v), axis=1)

    def telling_frames(self, count):
        """Frames with about equal motion between them; the first, the last and the most deformed one are among them."""
        moved = numpy.sqrt(((self.points[1:] - self.points[:-1]) ** 2).sum(axis=2).mean(axis=1))
        path = numpy.concatenate([[0], numpy.cumsum(moved)])
        chosen = {int(numpy.abs(path - length).argmin()) for length in numpy.linspace(0, path[-1], count)[:-1]}
        chosen.add(len(path) - 1)
        peak = int(numpy.argmax([self.displacement(frame).mean() for frame in range(len(path))]))
        between = chosen - {0, len(path) - 1}
        if between and peak not in chosen:
            chosen.remove(min(between, key=lambda frame: abs(frame - peak)))
            chosen.add(peak)
        return sorted(chosen)
