# SPDX-License-Identifier: BSD-3-Clause
"""Tetrahedral meshes in memory."""

from __future__ import annotations

import importlib
import os
from dataclasses import dataclass, field

import numpy as np

from . import _plica
from ._plica import InputError


def checked(name: str, values, shape: tuple, dtype=np.float64) -> np.ndarray:
    """The values, finite, as a contiguous array of this type; InputError says what was expected and what was given. -1: any length."""
    array = np.asarray(values)
    kinds = "f" if np.dtype(dtype).kind == "f" else "iu"
    fits = array.ndim == len(shape) and all(want in (-1, have) for want, have in zip(shape, array.shape))
    if not fits or array.dtype.kind not in kinds + "iu":
        wanted = ", ".join("n" if size == -1 else str(size) for size in shape)
        number = "floating-point numbers" if "f" in kinds else "whole numbers"
        raise InputError(f"{name}: expected an array [{wanted}] of {number}, got {list(array.shape)} of {array.dtype}")
    if not np.isfinite(array).all():
        place = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise InputError(f"{name}: expected finite numbers, got {array[place]} at {list(place)}")
    return np.ascontiguousarray(array, dtype=dtype)


def whole(name: str, value, least: int = 0) -> int:
    """The value, a whole number; InputError says what was expected and what was given."""
    if isinstance(value, (int, np.integer)) and not isinstance(value, bool) and value >= least:
        return int(value)
    raise InputError(f"{name}: expected a whole number >= {least}, got {value!r}")


def needed(module: str, by: str):
    """A module that Plica itself does without."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise ImportError(f"{by} needs {module}: pip install {module}") from error


@dataclass
class Mesh:
    """Tetrahedra at rest. It may stand for a level of a body, or for a key `file`, in a scene that is given in Python.

    points: [vertices, 3] m.
    tets: [tetrahedra, 4] numbers of vertices, from 0. Inverted ones are turned when a scene takes the mesh.
    region: [tetrahedra] numbers into region_names; empty: one nameless region.
    vertex_sets: named groups of vertices, for selections such as `fixed: [{group: base}]`.
    """

    points: np.ndarray
    tets: np.ndarray
    region: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int32))
    region_names: list = field(default_factory=list)
    vertex_sets: dict = field(default_factory=dict)

    def __post_init__(self):
        self.points = checked("points", self.points, (-1, 3))
        self.tets = checked("tets", self.tets, (-1, 4), np.int32)
        self.region = checked("region", self.region, (-1,), np.int32)
        if self.tets.size and not 0 <= self.tets.min() <= self.tets.max() < len(self.points):
            raise InputError(f"tets: expected numbers of vertices from 0 to {len(self.points) - 1}, got "
                             f"{self.tets.min()} to {self.tets.max()}")
        if self.region.size and len(self.region) != len(self.tets):
            raise InputError(f"region: expected one number for each of {len(self.tets)} tetrahedra, got {len(self.region)}")

    def __repr__(self):
        return f"<plica.Mesh: {len(self.points)} vertices, {len(self.tets)} tetrahedra>"

    @classmethod
    def read(cls, file) -> Mesh:
        """Reads .msh, .vtk, .vtu or TetGen's files, as scenes do: checked and repaired."""
        return cls(*_plica.read_mesh(os.fspath(file)))

    def write(self, file) -> None:
        """Writes a file in the format of its extension."""
        sets = {name: [int(i) for i in vertices] for name, vertices in self.vertex_sets.items()}
        _plica.write_mesh(os.fspath(file), self.points, self.tets, self.region.tolist(), list(self.region_names), sets)

    @classmethod
    def from_meshio(cls, mesh, scale: float = 1.0) -> Mesh:
        """From a meshio.Mesh: its tetrahedra, with Gmsh's physical volumes as regions and point sets as vertex sets.

        scale: metres per unit of its points, such as 0.001.
        """
        if not hasattr(mesh, "cells"):
            raise InputError(f"from_meshio: expected a meshio.Mesh, got {type(mesh).__name__}; plica.Mesh.read(file) reads files")
        blocks = [i for i, block in enumerate(mesh.cells) if block.type == "tetra"]
        if not blocks:
            kinds = ", ".join(sorted({block.type for block in mesh.cells})) or "nothing"
            raise InputError(f"from_meshio: expected cells of type tetra, got {kinds}")
        tets = np.concatenate([mesh.cells[i].data for i in blocks])
        region, names = np.zeros(0, np.int32), []
        physical = mesh.cell_data.get("gmsh:physical")
        if physical is not None:
            tags, region = np.unique(np.concatenate([physical[i] for i in blocks]), return_inverse=True)
            known = {int(tag): name for name, (tag, dimension) in mesh.field_data.items() if dimension == 3}
            names = [known.get(int(tag), f"region_{tag}") for tag in tags]
        sets = {name: np.asarray(points) for name, points in getattr(mesh, "point_sets", {}).items()}
        return cls(np.asarray(mesh.points, float) * scale, tets, region, names, sets)
