# SPDX-License-Identifier: BSD-3-Clause
"""Meshes in memory and in files: what they keep, and how files are read."""
import numpy as np
import pytest

import plica

CUBE = {"duration": "1 s", "body": {"levels": [{"box": {"size": [0.1, 0.1, 0.1], "cells": [3, 3, 3]}}]}}


def test_meshes_keep_all_that_they_have(tmp_path):
    mesh = plica.Scene(CUBE).mesh()
    count = len(mesh.tets)
    face = [t[list(k)] for t in mesh.tets for k in ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)) if (mesh.points[t[list(k)], 2] == mesh.points[:, 2].max()).all()]
    whole = plica.Mesh(mesh.points, mesh.tets, filled=np.linspace(0.5, 1, count), tet_vectors={"fibres": np.tile([0.0, 0.6, 0.8], (count, 1))},
                       triangle_sets={"top": face[:3]})
    assert set(whole.vertex_sets["top"]) == set(np.ravel(face[:3]))
    whole.write(tmp_path / "whole.msh")
    for again in (plica.Mesh.read(tmp_path / "whole.msh"), plica.Scene(duration=1, body={"levels": [whole]}).mesh()):
        assert np.array_equal(again.filled, whole.filled)
        assert np.array_equal(again.tet_vectors["fibres"], whole.tet_vectors["fibres"])
        assert {tuple(sorted(t)) for t in again.triangle_sets["top"].tolist()} == {tuple(sorted(t)) for t in whole.triangle_sets["top"].tolist()}
    with pytest.raises(plica.InputError, match="filled: expected a number above 0"):
        plica.Mesh(mesh.points, mesh.tets, filled=np.zeros(count))
    with pytest.raises(plica.InputError, match="tet_vectors: f: expected an array"):
        plica.Mesh(mesh.points, mesh.tets, tet_vectors={"f": np.zeros((1, 3))})
    with pytest.raises(plica.InputError, match="triangle_sets: top: expected numbers of vertices"):
        plica.Mesh(mesh.points, mesh.tets, triangle_sets={"top": [[0, 1, len(mesh.points)]]})


def test_meshes_are_read_with_options(tmp_path):
    mesh = plica.Scene(CUBE).mesh()
    plica.Mesh(mesh.points, mesh.tets, np.arange(len(mesh.tets)) % 3).write(tmp_path / "three.msh")
    assert plica.Mesh.read(tmp_path / "three.msh").region_names == ["region_0", "region_1", "region_2"]
    some = plica.Mesh.read(tmp_path / "three.msh", scale=0.001, leave_out=["region_1"])
    assert some.region_names == ["region_0", "region_2"] and len(some.tets) == (2 * len(mesh.tets) + 2) // 3
    assert some.points.max() == pytest.approx(mesh.points.max() / 1000)
    assert plica.Mesh.read(tmp_path / "three.msh", regions="none").region_names == []
    with pytest.raises(plica.InputError, match="did you mean 'linear'"):
        plica.Mesh.read(tmp_path / "three.msh", order="linar")
    with pytest.raises(plica.InputError, match="unknown array of cells"):
        plica.Mesh.read(tmp_path / "three.msh", regions="kind")
