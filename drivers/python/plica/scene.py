# SPDX-License-Identifier: BSD-3-Clause
"""What is simulated."""

from __future__ import annotations

import json
import os
import re
import tempfile
import warnings
from pathlib import Path

import numpy as np

from . import _plica
from ._plica import InputError
from .mesh import Mesh, as_surface, whole


def keys() -> list[dict]:
    """Every key that a scene may have: its path, what it expects (unit, range, names), what holds otherwise, and its meaning."""
    return [dict(zip(("path", "expects", "otherwise", "help"), row)) for row in _plica.keys()]


class _Plain:
    """Values of Python as the words of a scene; meshes become files that live as long as this does."""

    def __init__(self, folder: str):
        self.folder = Path(folder)

    def named(self, message: str) -> str:
        """The message, with the meshes in place of their files."""
        for pattern, kind in ((r"/mesh_(\d+)\.msh(:\d+)?", "Mesh"), (r"/surface_(\d+)\.obj(:\d+)?", "Surface")):
            message = re.sub(re.escape(str(self.folder)) + pattern, rf"plica.{kind} \1, its numbers from 1", message)
        return message

    def file(self, value) -> str | None:
        """The file that a mesh or surface has become; None: the value is none."""
        mesh = value if isinstance(value, Mesh) else as_surface(value)
        if mesh is None:
            return None
        kind, ending = ("mesh", "msh") if isinstance(mesh, Mesh) else ("surface", "obj")
        file = self.folder / f"{kind}_{len(list(self.folder.glob(kind + '*')))}.{ending}"
        mesh.write(file)
        return str(file)

    def __call__(self, value, key: str = "", beside=()):
        if (file := self.file(value)) is not None:  # lattices have the keys `surface` and `sizes`
            return file if key == "file" or "sizes" in beside else {"file": file}
        if isinstance(value, dict):
            return {str(key): self(one, key, value) for key, one in value.items()}
        if isinstance(value, (list, tuple)):
            return [self(one) for one in value]
        if isinstance(value, (np.ndarray, np.generic)):
            return value.tolist()
        if value is None or isinstance(value, (bool, int, float, str)):
            return value
        if isinstance(value, os.PathLike):
            return os.path.abspath(value)
        raise InputError(f"a scene's values are numbers, text, lists, dicts, arrays and meshes, got {type(value).__name__}")


def _flat(values: dict, path: str = ""):
    """Paths and values: {"body": {"jitter": 0.1}} is body.jitter = 0.1."""
    for key, value in values.items():
        if isinstance(value, dict) and value:
            yield from _flat(value, f"{path}{key}.")
        else:
            yield f"{path}{key}", value


def _words(value) -> str:
    return json.dumps(value, ensure_ascii=False)


class Scene:
    """A scene, read and checked, with its meshes.

    source: a YAML file, or a dict that says the same; left out, the keyword arguments are all of it.
    set: values put over it, by path: {"body.material.young_modulus": "20 kPa", "body.levels.0.box.cells": [8, 8, 8]}.

    Keyword arguments do the same for the keys of the top level, and dicts reach further down:
    Scene("ball.yaml", duration="0.5 s", integration={"macro_step": "1 ms"}).

    A plica.Mesh may stand for a level of the body, a plica.Surface for a surface. File names in a dict are relative to the working
    directory. `plica.keys()` lists all keys with units, ranges and defaults. InputError names the place, the value, what was
    expected and the nearest name.

    A scene pickles as what it was made of: files are read again, from where they were.
    """

    _scene = None  # until it is read

    def __init__(self, source=None, *, set: dict | None = None, **overrides):
        if set is not None and not isinstance(set, dict):
            raise InputError(f'set: expected a dict such as {{"body.levels.0.box.cells": [8, 8, 8]}}, got {type(set).__name__}')
        values, file, text = dict(overrides), "", ""
        self._made_of = os.path.abspath(source) if isinstance(source, (str, os.PathLike)) else _kept(source), _kept(set or {}), _kept(overrides)
        with tempfile.TemporaryDirectory(prefix="plica_") as folder:
            plain = _Plain(folder)
            if source is None:
                source, values = values, {}
            if isinstance(source, dict):
                text = _words(_text(plain(source)))
            elif isinstance(source, (str, os.PathLike)):
                file = os.fspath(source)
            else:
                raise InputError(f"Scene: expected the name of a YAML file or a dict, got {type(source).__name__}")
            changes = [*_flat(plain(values)), *((path, plain(value)) for path, value in (set or {}).items())]
            try:
                self._scene = _plica.load(file, text, "scene", [(path, _words(value)) for path, value in changes])
            except InputError as error:
                raise InputError(plain.named(str(error))) from None
        self._folder = folder
        for warning in self._scene.warnings:
            warnings.warn(plain.named(warning), stacklevel=2)

    @property
    def name(self) -> str:
        """Its title; without one, its file's name."""
        return self._scene.name

    @property
    def duration(self) -> float:
        """Simulated time of a whole run [s]."""
        return self._scene.duration

    @property
    def levels(self) -> int:
        """Number of the body's meshes."""
        return self._scene.levels

    def mesh(self, level: int = 0) -> Mesh:
        """A level's mesh at rest, as its file has it; 0 is the finest."""
        return Mesh(*self._scene.mesh(level))

    def rows(self, level: int = 0) -> np.ndarray:
        """[vertices] of a level: which point each row of positions() is. Of a plica.Mesh it is the row in its points, of a file the
        number that it has there. Points that no tetrahedron uses have no row."""
        count = len(self._scene.mesh(whole("level", level))[0])
        file, numbers = self._scene.rows(level)
        if not len(numbers):
            return np.arange(count)
        return numbers - 1 if os.path.dirname(file) == self._folder else numbers

    def changed(self, *, set: dict | None = None, **overrides) -> Scene:
        """Another scene: this one with other values put over it, as when it was made."""
        source, before, keywords = self._made_of
        return Scene(source, set={**before, **dict(_flat(overrides)), **(set or {})}, **keywords)

    def __reduce__(self):
        return _again, self._made_of

    def surface_triangles(self) -> np.ndarray | None:
        """[triangles, 3] points of the embedded surface, counter-clockwise seen from outside; None: the body has no surface."""
        return self._scene.surface()

    def texture_coordinates(self) -> np.ndarray | None:
        """[triangles, 3, 2] u and v at the corners of surface_triangles(), as the `vt` of an OBJ file or plica.Surface have them; None:
        the surface has none. At a seam, corners at one point differ: give a renderer each corner as a vertex of its own."""
        values = self._scene.texture()
        return values.reshape(-1, 3, 2) if len(values) else None

    def __repr__(self):
        if self._scene is None:
            return "<plica.Scene: refused>"
        return f"<plica.Scene {self.name!r}: {self.duration:g} s, {self.levels} level{'s' * (self.levels != 1)}>"


def _again(source, set: dict, overrides: dict) -> Scene:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it has said them once
        return Scene(source, set=set, **overrides)


def _kept(value):
    """Dicts and lists of their own, which nobody else changes."""
    if isinstance(value, dict):
        return {key: _kept(one) for key, one in value.items()}
    return [_kept(one) for one in value] if isinstance(value, (list, tuple)) else value


def made(what: str, scene, set: dict | None, overrides: dict) -> Scene:
    """The scene, or one of it; InputError where `what` was to change one that is made already."""
    if not isinstance(scene, Scene):
        return Scene(scene, set=set, **overrides)
    if set or overrides:
        raise InputError(f"{what}: the scene is made already; give `set` and keyword arguments to plica.Scene")
    return scene


def words(value) -> str:
    """JSON of a value as it may stand in a scene."""
    return _words(_text(_Plain("")(value)))


def _text(value):
    """All scalars as words, as they stand in a file."""
    if isinstance(value, dict):
        return {key: _text(one) for key, one in value.items()}
    if isinstance(value, list):
        return [_text(one) for one in value]
    if isinstance(value, bool):
        return "true" if value else "false"
    return value if value is None or isinstance(value, str) else repr(value)
