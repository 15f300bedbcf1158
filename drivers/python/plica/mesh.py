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
    if array.size == 0 and array.dtype.kind == "f":
        array = array.astype(dtype)  # numpy's type of an empty list
    kinds = "f" if np.dtype(dtype).kind == "f" else "iu"
    fits = array.ndim == len(shape) and all(want in (-1, have) for want, have in zip(shape, array.shape))
    if not fits or array.dtype.kind not in kinds + "iu":
        wanted = ", ".join("n" if size == -1 else str(size) for size in shape)
        number = "floating-point numbers" if "f" in kinds else "whole numbers"
        raise InputError(f"{name}: expected an array [{wanted}] of {number}, got {list(array.shape)} of {array.dtype}")
    if not np.isfinite(array).all():
        place = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise InputError(f"{name}: expected finite numbers, got {array[place]} at {list(place)}")
    if kinds == "iu" and array.size and not np.iinfo(dtype).min <= int(array.min()) <= int(array.max()) <= np.iinfo(dtype).max:
        raise InputError(f"{name}: expected whole numbers of {np.iinfo(dtype).bits} bits, got {array.min()} to {array.max()}")
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


def numbered(name: str, values, count: int, of: str, shape: tuple = (-1,)) -> np.ndarray:
    """The values, numbers from 0 below count; InputError says what was expected and what was given."""
    array = checked(name, values, shape, np.int64)
    if array.size and not 0 <= array.min() <= array.max() < count:
        raise InputError(f"{name}: expected numbers of {of} from 0 to {count - 1}, got {array.min()} to {array.max()}")
    return array.astype(np.int32)


def _selected(name: str, values, count: int) -> np.ndarray:
    """Numbers of vertices, from these or from a mask of all vertices."""
    array = np.asarray(values)
    if array.dtype.kind != "b":
        return numbered(name, array, count, "vertices")
    if array.shape != (count,):
        raise InputError(f"{name}: expected a mask of {count} vertices, got {list(array.shape)}")
    return np.flatnonzero(array).astype(np.int32)


@dataclass
class Mesh:
    """Tetrahedra at rest. It may stand for a level of a body, or for a key `file`, in a scene that is given in Python.

    points: [vertices, 3] m. Those that no tetrahedron uses are dropped by a scene, see Scene.rows().
    tets: [tetrahedra, 4] numbers of vertices, from 0. Inverted ones are turned when a scene takes the mesh.
    region: [tetrahedra] numbers into region_names; empty: one nameless region.
    region_names: left out: each number of region gets one, region_0 and so on, and region counts them.
    vertex_sets: named groups of vertices, numbers or masks, for selections such as `fixed: [{group: base}]`.
    filled: [tetrahedra] part of each that is body, above 0, at most 1; empty: all of each. Of files, .msh holds it.
    tet_vectors: named vectors [tetrahedra, 3], such as directions of fibres.
    triangle_sets: named groups of triangles [n, 3], numbers of vertices, for tractions and pressures; their vertices are a set, too.
    """

    points: np.ndarray
    tets: np.ndarray
    region: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int32))
    region_names: list = field(default_factory=list)
    vertex_sets: dict = field(default_factory=dict)
    filled: np.ndarray = field(default_factory=lambda: np.zeros(0))
    tet_vectors: dict = field(default_factory=dict)
    triangle_sets: dict = field(default_factory=dict)

    def __post_init__(self):
        self.points = checked("points", self.points, (-1, 3))
        self.tets = numbered("tets", self.tets, len(self.points), "vertices", (-1, 4))
        self.region = checked("region", self.region, (-1,), np.int32)
        self.region_names = [str(name) for name in self.region_names]
        if self.region.size and len(self.region) != len(self.tets):
            raise InputError(f"region: expected one number for each of {len(self.tets)} tetrahedra, got {len(self.region)}")
        if self.region_names:
            self.region = numbered("region", self.region, len(self.region_names), "region_names")
        elif self.region.size:
            tags, region = np.unique(self.region, return_inverse=True)
            if tags[0] < 0:
                raise InputError(f"region: expected numbers from 0, got {tags[0]}")
            self.region, self.region_names = region.astype(np.int32), [f"region_{tag}" for tag in tags]
        self.vertex_sets = {str(name): _selected(f"vertex_sets: {name}", one, len(self.points)) for name, one in self.vertex_sets.items()}
        self._check_more()

    def _check_more(self):
        count = len(self.tets)
        self.filled = checked("filled", self.filled, (-1,))
        if self.filled.size and (len(self.filled) != count or not 0 < self.filled.min() <= self.filled.max() <= 1):
            raise InputError(f"filled: expected a number above 0, at most 1, for each of {count} tetrahedra, got {len(self.filled)} "
                             f"from {self.filled.min()} to {self.filled.max()}")
        self.tet_vectors = {str(name): checked(f"tet_vectors: {name}", one, (count, 3)) for name, one in self.tet_vectors.items()}
        self.triangle_sets = {str(name): numbered(f"triangle_sets: {name}", one, len(self.points), "vertices", (-1, 3))
                              for name, one in self.triangle_sets.items()}
        for name, one in self.triangle_sets.items():
            self.vertex_sets[name] = np.union1d(self.vertex_sets.get(name, np.zeros(0, np.int32)), one).astype(np.int32)

    def __repr__(self):
        return f"<plica.Mesh: {len(self.points)} vertices, {len(self.tets)} tetrahedra>"

    @classmethod
    def read(cls, file, *, scale: float = 1.0, regions: str = "", leave_out=(), order: str = "split") -> Mesh:
        """Reads .msh, .mesh, .vtk, .vtu, .inp, .feb or TetGen's files, as scenes do: checked, with the options of a level's `file`.

        scale: metres per unit of the file, such as 0.001.
        regions: array of cells that numbers the regions; "none": no regions; "": the format's own, or an array with a usual name.
        leave_out: names or numbers of regions that are no body.
        order: of second-order tetrahedra: "split", in eight, or "linear", by their corners.
        """
        out = [leave_out] if isinstance(leave_out, (str, int, np.integer)) else leave_out
        mesh = cls(*_plica.read_mesh(os.fspath(file), regions, [str(one) for one in out], order))
        mesh.points *= scale
        return mesh

    def write(self, file) -> None:
        """Writes a file in the format of its extension."""
        sets = {name: [int(i) for i in vertices] for name, vertices in self.vertex_sets.items()}
        vectors = {name: one.tolist() for name, one in self.tet_vectors.items()}
        triangles = {name: one.tolist() for name, one in self.triangle_sets.items()}
        _plica.write_mesh(os.fspath(file), self.points, self.tets, self.region.tolist(), list(self.region_names), sets,
                          self.filled.tolist(), vectors, triangles)

    @classmethod
    def from_meshio(cls, mesh, scale: float = 1.0) -> Mesh:
        """From a meshio.Mesh: its tetrahedra, with Gmsh's physical volumes as regions, its physical surfaces as triangle
        sets and point sets as vertex sets.

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
        surfaces = {int(tag): name for name, (tag, dimension) in mesh.field_data.items() if dimension == 2}
        triangles = {name: np.concatenate([block.data[physical[i] == tag] for i, block in enumerate(mesh.cells) if block.type == "triangle"]
                                          or [np.zeros((0, 3), np.int32)]) for tag, name in surfaces.items() if physical is not None}
        return cls(np.asarray(mesh.points, float) * scale, tets, region, names, sets, triangle_sets=triangles)


@dataclass
class Surface:
    """Triangles. It may stand for `body.surface`, for the `surface` of an obstacle, or for a key `file`, in a scene that is given in
    Python. So may what has `vertices` and `faces`, as trimesh's meshes have, and pyvista's PolyData of triangles.

    points: [points, 3] m.
    triangles: [triangles, 3] numbers of points, from 0, counter-clockwise seen from outside.
    texture_coordinates: [triangles, 3, 2] u and v at the corners of the triangles; None: there are none.
    """

    points: np.ndarray
    triangles: np.ndarray
    texture_coordinates: np.ndarray | None = None

    def __post_init__(self):
        self.points = checked("points", self.points, (-1, 3))
        self.triangles = numbered("triangles", self.triangles, len(self.points), "points", (-1, 3))
        if self.texture_coordinates is not None:
            self.texture_coordinates = checked("texture_coordinates", self.texture_coordinates, (len(self.triangles), 3, 2))

    def __repr__(self):
        return f"<plica.Surface: {len(self.points)} points, {len(self.triangles)} triangles>"

    def write(self, file) -> None:
        """Writes a file in Wavefront's format, OBJ."""
        with open(file, "w", encoding="ascii") as out:
            out.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in self.points.tolist())
            if self.texture_coordinates is None:
                out.writelines(f"f {a} {b} {c}\n" for a, b, c in (self.triangles + 1).tolist())
                return
            out.writelines(f"vt {u!r} {v!r}\n" for u, v in self.texture_coordinates.reshape(-1, 2).tolist())
            out.writelines(f"f {a}/{3 * t + 1} {b}/{3 * t + 2} {c}/{3 * t + 3}\n" for t, (a, b, c) in enumerate((self.triangles + 1).tolist()))


def as_surface(value) -> Surface | None:
    """The surface that a value of another library is; None: it is none."""
    if isinstance(value, Surface):
        return value
    if hasattr(value, "vertices") and hasattr(value, "faces"):  # trimesh
        uv = getattr(getattr(value, "visual", None), "uv", None)
        return Surface(value.vertices, value.faces, None if uv is None else np.asarray(uv)[np.asarray(value.faces)])
    if hasattr(value, "points") and hasattr(value, "faces"):  # pyvista: sizes stand before each face's numbers
        faces = np.asarray(value.faces).reshape(-1)
        if faces.size % 4 or (faces[::4] != 3).any():
            raise InputError("surface: expected triangles alone, as PolyData.triangulate() makes them")
        return Surface(value.points, faces.reshape(-1, 4)[:, 1:])
    return None
