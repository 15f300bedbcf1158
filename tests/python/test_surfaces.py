# SPDX-License-Identifier: BSD-3-Clause
"""What a renderer reads of the embedded surface."""
import types

import numpy as np
import plica
import pytest

from cube import CUBE

OCTAHEDRON = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
FACES = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])


def test_normals_and_texture_of_an_embedded_surface():
    points = 0.05 + 0.03 * OCTAHEDRON
    uv = np.arange(48.0).reshape(8, 3, 2) / 64
    scene = {**CUBE, "body": {**CUBE["body"], "surface": plica.Surface(points, FACES, uv)}}
    with plica.Simulation(scene) as sim:
        assert np.array_equal(sim.scene.texture_coordinates(), uv)
        normals = sim.surface_normals()
        assert np.allclose(normals, OCTAHEDRON, atol=1e-12)
        sim.run(0.05)
        x = sim.surface_positions()
        assert np.abs(normals - OCTAHEDRON).max() > 1e-6 and np.allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-12)
        expected = np.zeros_like(x)
        for triangle in FACES:
            for a, b, c in (np.roll(triangle, -k) for k in range(3)):
                one, other = x[b] - x[a], x[c] - x[a]
                normal = np.cross(one, other)
                expected[a] += np.arctan2(np.linalg.norm(normal), one @ other) * normal / np.linalg.norm(normal)
        assert np.allclose(normals, expected / np.linalg.norm(expected, axis=1)[:, None], atol=1e-12)
    with_visual = types.SimpleNamespace(vertices=points, faces=FACES, visual=types.SimpleNamespace(uv=points[:, :2]))
    other = plica.Scene({**CUBE, "body": {**CUBE["body"], "surface": with_visual}})
    assert np.array_equal(other.texture_coordinates(), points[FACES][:, :, :2])
    assert plica.Scene(CUBE).texture_coordinates() is None
    with pytest.raises(plica.InputError, match=r"texture_coordinates: expected an array \[8, 3, 2\]"):
        plica.Surface(points, FACES, uv[:7])
