# SPDX-License-Identifier: BSD-3-Clause
"""The Python package against the program and against itself. PLICA_EXECUTABLE names the program, PLICA_SOURCE_DIR its sources."""
import gc
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from pathlib import Path

import numpy as np
import plica
import pytest

SOURCES = Path(os.environ["PLICA_SOURCE_DIR"])
SCENES = SOURCES / "drivers" / "scenes"
sys.path.insert(0, str(SOURCES / "drivers" / "plots"))

CUBE = {
    "duration": "1 s",
    "gravity": [0, 0, -9.81],
    "body": {
        "levels": [{"box": {"size": [0.1, 0.1, 0.1], "cells": [3, 3, 3]}}],
        "fixed": [{"box": {"min": [0, 0, 0], "max": [0, 0.1, 0.1]}}],
    },
}


@pytest.fixture
def cube():
    with plica.Simulation(CUBE) as simulation:
        yield simulation


def program(*arguments):
    return subprocess.run([os.environ["PLICA_EXECUTABLE"], *map(str, arguments)], check=True, capture_output=True, text=True)


# -- the same as the program


@pytest.mark.parametrize("scene, duration, overrides", [
    ("smallest", "0.05s", {}),
    ("study/liver", "5ms", {}),
    ("ball_in_bowl_coarse", "0.02s", {"integration.macro_step": "0.5 ms"}),
])
def test_runs_are_the_programs_bit_for_bit(scene, duration, overrides, tmp_path):
    from frames import read_vtu

    file = SCENES / f"{scene}.yaml"
    words = [word for path, value in overrides.items() for word in ("--set", f"{path}={value}")]
    program("run", file, "-o", tmp_path, "--quiet", "--duration", duration, "--set", "output.volume=true", *words)
    sim = plica.Simulation(file, duration=duration, set=overrides)
    sim.run()
    frame = read_vtu(sorted(tmp_path.glob("frames/volume_*.vtu"))[-1])
    assert np.array_equal(frame["Points"], sim.positions())
    assert np.array_equal(frame["velocity"], sim.velocities())
    assert np.array_equal(frame["connectivity"].reshape(-1, 4), sim.scene.mesh().tets)
    assert np.array_equal(frame["von_mises"], sim.von_mises())
    assert np.array_equal(frame["J"], sim.J())


def test_frames_do_not_change_a_run():
    at_once, in_frames = plica.Simulation(CUBE), plica.Simulation(CUBE)
    at_once.run(0.1)
    run = in_frames.run("100 ms", every="30 ms")
    times = [frame.time for frame in run]
    assert len(times) == len(run) == 4
    assert all(at <= t < at + in_frames.macro_step for at, t in zip((0.03, 0.06, 0.09), times))
    assert times[-1] == at_once.time == pytest.approx(0.1, abs=1e-15)
    assert np.array_equal(at_once.positions(), in_frames.positions())


def test_frames_by_macro_steps(cube):
    run = cube.run(10 * cube.macro_step, every="4 steps")
    assert [frame.macro_steps for frame in run] == [4, 8, 10] and len(run) == 3


# -- arrays


def test_arrays_follow_the_simulation_without_a_copy(cube):
    x, v = cube.positions(), cube.velocities()
    assert x.shape == (64, 3) and x.dtype == np.float64
    address, before = x.ctypes.data, x.copy()
    cube.step(20)
    assert cube.positions().ctypes.data == x.ctypes.data == address
    assert np.abs(x - before).max() > 1e-5 and np.abs(v).max() > 0
    assert np.from_dlpack(x.base).ctypes.data == address


def test_arrays_outlive_the_simulation():
    sim = plica.Simulation(CUBE)
    sim.step(5)
    x = sim.positions()
    copy = x.copy()
    sim.close()
    del sim
    gc.collect()
    assert np.array_equal(x, copy)


def resident():
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE")


def test_memory_does_not_grow():
    sim = plica.Simulation(CUBE, set={"body.levels.0.box.cells": [2, 2, 2]})

    def some_steps(count):
        for _ in range(count):
            sim.step()
            sim.positions(), sim.von_mises(), sim.energies()

    some_steps(1000)
    before = resident()
    some_steps(10000)
    assert resident() - before < 2e6


def test_simulations_that_are_gone_leave_nothing():
    def some(count):
        for _ in range(count):
            plica.Simulation(CUBE).step()
        gc.collect()

    some(10)
    before = resident()
    some(40)
    assert resident() - before < 4e6


def test_in_float():
    try:
        in_float = plica.Simulation(CUBE, precision="float")
    except plica.InputError as error:  # as of the wheel
        assert "this build has double alone" in str(error)
        pytest.skip(str(error))
    in_double = plica.Simulation(CUBE)
    for sim in (in_float, in_double):
        sim.run(0.02)
    assert in_float.precision == "float" and in_float.positions().dtype == np.float64
    difference = np.abs(in_float.positions() - in_double.positions()).max()
    assert 0 < difference < 1e-6


# -- scenes and meshes


def test_a_scene_in_keywords_with_units():
    by_keywords = plica.Scene(duration=0.5, body={"levels": [{"box": {"size": ["10 cm", 0.1, np.float64(0.1)], "cells": np.array([2, 2, 2])}}]})
    assert by_keywords.duration == 0.5 and by_keywords.levels == 1
    assert by_keywords.mesh().points.max() == pytest.approx(0.1)
    changed = plica.Scene(SCENES / "smallest.yaml", duration="20 ms", body={"material": {"young_modulus": "50 kPa"}},
                          set={"body.levels.0.box.cells": [2, 2, 2]})
    assert changed.duration == 0.02 and len(changed.mesh().points) == 27
    assert any(key["path"] == "body.material.young_modulus" and "Pa" in key["expects"] for key in plica.keys())


def test_a_simulation_in_keywords():
    with plica.Simulation(**CUBE) as by_keywords:
        assert np.array_equal(by_keywords.step().positions(), plica.Simulation(CUBE).step().positions())


def shuffled_cube():
    mesh = plica.Scene(CUBE).mesh()
    order = np.random.default_rng(1).permutation(len(mesh.points))
    number = np.argsort(order)
    return mesh, plica.Mesh(mesh.points[order], number[mesh.tets][::-1]), order


def test_a_mesh_in_memory_keeps_its_order():
    mesh, shuffled, order = shuffled_cube()
    steps = {"integration.macro_step": "2 ms"}  # an automatic one depends a little on the order
    ours, same = plica.Simulation(CUBE, body={"levels": [shuffled]}, set=steps), plica.Simulation(CUBE, set=steps)
    assert np.array_equal(ours.positions(), shuffled.points)
    assert np.array_equal(ours.scene.mesh().tets, shuffled.tets)
    for sim in (ours, same):
        sim.run(0.05)
    assert np.abs(ours.positions() - same.positions()[order]).max() < 1e-9
    assert np.abs(ours.von_mises() - same.von_mises()[order]).max() < 1e-4 * same.von_mises().max()


def test_states_in_the_order_of_the_mesh():
    _, shuffled, _ = shuffled_cube()
    sim = plica.Simulation({**CUBE, "gravity": [0, 0, 0]}, body={"levels": [shuffled]})
    x, v = shuffled.points.copy(), np.random.default_rng(2).normal(size=shuffled.points.shape)
    v[x[:, 0] == 0] = 0
    sim.set_state(x, v)
    assert np.allclose(sim.positions(), x, atol=1e-15) and np.array_equal(sim.velocities(), v)
    saved = sim.save()
    sim.step(3)
    after = sim.positions().copy()
    sim.restore(saved)
    assert np.array_equal(sim.velocities(), v)
    sim.step(3)
    assert np.array_equal(sim.positions(), after)


def test_meshes_from_meshio(tmp_path):
    meshio = pytest.importorskip("meshio")
    mesh = plica.Scene(CUBE).mesh()
    region = (np.arange(len(mesh.tets)) % 2 + 7).astype(np.int32)
    theirs = meshio.Mesh(mesh.points * 1000, [("triangle", mesh.tets[:2, :3]), ("tetra", mesh.tets)],
                         cell_data={"gmsh:physical": [np.zeros(2, np.int32), region]},
                         field_data={"hard": np.array([8, 3])}, point_sets={"base": np.array([0, 1, 2])})
    ours = plica.Mesh.from_meshio(theirs, scale=0.001)
    assert np.allclose(ours.points, mesh.points) and np.array_equal(ours.tets, mesh.tets)
    assert ours.region_names == ["region_7", "hard"]
    ours.write(tmp_path / "cube.msh")
    again = plica.Mesh.read(tmp_path / "cube.msh")
    assert np.array_equal(again.points, ours.points) and again.region_names == ours.region_names
    scene = plica.Scene(duration=1, body={"levels": [ours], "fixed": [{"group": "base"}], "regions": {"hard": {"young_modulus": "1 MPa"}}})
    assert scene.levels == 1
    with pytest.raises(plica.InputError, match="type tetra, got triangle"):
        plica.Mesh.from_meshio(meshio.Mesh(mesh.points, [("triangle", mesh.tets[:, :3])]))


def test_stress_tensors(tmp_path):
    from frames import read_vtu

    _, shuffled, _ = shuffled_cube()
    scene = {**CUBE, "output": {"volume": True, "fields": ["stress", "pressure", "principal_stretches"]}}
    for element in ("linear", "nodal"):
        sim = plica.Simulation(scene, body={"levels": [shuffled], "element": element})
        list(sim.run(0.05, every="50 ms", folder=tmp_path / element))
        s = sim.stress()
        n = len(sim.von_mises())
        assert s.shape == (n, 6) and sim.principal_stretches().shape == (n, 3)
        xx, yy, zz, xy, yz, xz = s.T
        equivalent = np.sqrt(((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * (xy**2 + yz**2 + xz**2))
        assert np.allclose(equivalent, sim.von_mises(), rtol=1e-9)
        assert np.allclose(sim.pressure(), -(xx + yy + zz) / 3, rtol=1e-9, atol=1e-9)
        assert np.allclose(sim.principal_stretches().prod(axis=1), sim.J(), rtol=1e-9)
        assert np.all(np.diff(sim.principal_stretches(), axis=1) <= 0)
        frame = read_vtu(sorted((tmp_path / element).glob("frames/volume_*.vtu"))[-1])
        assert np.array_equal(frame["stress"].ravel(), s.ravel())
        assert np.array_equal(frame["pressure"], sim.pressure())
        assert np.array_equal(frame["principal_stretches"].ravel(), sim.principal_stretches().ravel())


def test_contact_pressure():
    floor = {"obstacles": [{"plane": {"point": [0, 0, 0]}}]}
    body = {"levels": CUBE["body"]["levels"], "damping": {"mass": 40}}
    sim = plica.Simulation({"duration": 1, "gravity": [0, 0, -9.81], "body": body, "contact": floor})
    assert np.array_equal(sim.contact_pressure(), np.zeros(len(sim.surface_positions())))
    sim.run(0.5)
    x, p = sim.surface_positions(), sim.contact_pressure()
    assert p.shape == (len(x),) and np.all(p >= 0) and np.all(p[x[:, 2] > 0.01] == 0)
    surface = sim.scene.surface_triangles()
    corners = x[surface]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 6
    force = (np.bincount(surface.ravel(), np.repeat(area, 3), len(x)) * p).sum()
    assert force == pytest.approx(9.81, rel=0.01)
    with plica.Simulation(CUBE) as free:
        assert len(free.contact_pressure()) == 0


def test_to_pyvista(cube):
    pytest.importorskip("pyvista")
    cube.run(0.02)
    grid = cube.to_pyvista()
    assert grid.n_points == 64 and grid.n_cells == 162
    assert np.array_equal(grid.points, cube.positions())
    assert np.array_equal(grid["von_mises"], cube.von_mises())


# -- forces of one's own


def lumped_masses(mesh, density):
    corners = mesh.points[mesh.tets]
    volumes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6
    return np.bincount(mesh.tets.ravel(), np.repeat(volumes * density / 4, 4))


def test_a_force_is_gravity_where_it_says_the_same():
    _, shuffled, _ = shuffled_cube()
    by_key = plica.Simulation(CUBE, body={"levels": [shuffled]})
    by_force = plica.Simulation({**CUBE, "gravity": [0, 0, 0]}, body={"levels": [shuffled]})
    weight = np.outer(lumped_masses(shuffled, 1000), [0, 0, -9.81])
    seen = []

    def forces(level, at, positions, velocities, out):
        seen.append((level, at, positions.shape, velocities.shape))
        out += weight

    by_force.set_forces(forces)
    for sim in (by_key, by_force):
        sim.run(0.02)
    assert seen[0] == (0, 0.0, (64, 3), (64, 3)) and len(seen) >= by_force.macro_steps
    assert np.abs(by_key.positions() - by_force.positions()).max() < 1e-12
    by_force.set_forces(None)
    count = len(seen)
    by_force.step()
    assert len(seen) == count


def test_what_a_force_raises_comes_out(cube):
    def forces(level, at, positions, velocities, out):
        raise KeyError("mine")

    cube.step(3)
    before = cube.time
    cube.set_forces(forces)
    with pytest.raises(KeyError, match="mine"):
        cube.step()
    cube.set_forces(None)
    assert cube.time == before
    cube.step(3)


# -- errors


@pytest.mark.parametrize("make, message", [
    (lambda s: plica.Scene("nowhere.yaml"), "nowhere.yaml: there is no such file"),
    (lambda s: plica.Scene(CUBE, integration={"cycle": "rvs"}), "did you mean 'rsv'"),
    (lambda s: plica.Scene(CUBE, integration={"cicle": "rsv"}), "did you mean 'cycle'"),
    (lambda s: plica.Scene(CUBE, gravity=[0, 0]), "gravity"),
    (lambda s: plica.Scene(CUBE, gravity=object()), "got object"),
    (lambda s: plica.Scene(3), "expected the name of a YAML file or a dict, got int"),
    (lambda s: plica.Simulation(CUBE, precision="half"), "unknown precision 'half'"),
    (lambda s: plica.Simulation(s.scene, duration=1), "Simulation: the scene is made already"),
    (lambda s: plica.study(s.scene, duration=1), "study: the scene is made already"),
    (lambda s: s.positions("finest"), "level: expected a whole number >= 0, got 'finest'"),
    (lambda s: s.step(1.5), "macro_steps: expected a whole number >= 0, got 1.5"),
    (lambda s: s.step("2 ms"), "macro_steps: expected a whole number >= 0, got '2 ms'"),
    (lambda s: s.positions(1), "there is no level 1; the simulation has 1"),
    (lambda s: s.run(-1), "duration: expected a time"),
    (lambda s: s.run("10 steps"), "step\\(\\) takes macro steps"),
    (lambda s: s.run("5 kg"), "duration: expected a time such as '20 ms', got '5 kg', a mass"),
    (lambda s: s.run(1, every="10 m"), "every: expected"),
    (lambda s: s.run(1, every=[1]), "every: expected"),
    (lambda s: s.set_state(np.zeros((63, 3))), r"expected an array \[64, 3\] of floating-point numbers, got \[63, 3\] of float64"),
    (lambda s: s.set_state(np.zeros((64, 3), complex)), r"got \[64, 3\] of complex128"),
    (lambda s: s.set_state(np.zeros((64, 3)), np.zeros(64)), r"velocities: expected .* got \[64\]"),
    (lambda s: s.set_state(np.full((64, 3), np.nan)), r"positions: expected finite numbers, got nan at \[0, 0\]"),
    (lambda s: s.set_forces(3), "forces: expected a function, or None, got int"),
    (lambda s: s.restore(b"nothing"), "state"),
    (lambda s: s.report(), "nothing was written"),
    (lambda s: s.run(1, folder="out"), "only where `every` says when"),
    (lambda s: plica.report("nowhere"), "there is no folder nowhere"),
    (lambda s: plica.Mesh(np.zeros((4, 2)), [[0, 1, 2, 3]]), r"points: expected an array \[n, 3\]"),
    (lambda s: plica.Mesh(np.zeros((4, 3)), [[0, 1, 2, 4]]), "from 0 to 3, got 0 to 4"),
    (lambda s: plica.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, np.inf]], [[0, 1, 2, 3]]), r"got inf at \[3, 2\]"),
    (lambda s: plica.Scene(duration=1, body={"levels": [plica.Mesh(np.zeros((4, 3)), [[0, 1, 2, 3]])]}),
     "^scene: plica.Mesh 0, its numbers from 1: tetrahedron 1 .* has no volume"),
    (lambda s: plica.Scene(CUBE, set=["duration=1"]), "set: expected a dict such as .* got list"),
    (lambda s: plica.Mesh.from_meshio("liver.vtu"), "expected a meshio.Mesh, got str"),
    (lambda s: (s.set_forces(lambda level, time, x, v, out: np.zeros_like(out)), s.step()), "expected it to add to `out` .* got ndarray"),
    (lambda s: plica.init(threads=-1), "threads: expected a whole number >= 0, got -1"),
    (lambda s: plica.init(threads=plica.info()["threads"] + 1), "already runs with"),
])
def test_bad_input_says_what_was_expected(cube, make, message):
    with pytest.raises(plica.InputError, match=message):
        make(cube)
    assert issubclass(plica.InputError, ValueError)


@pytest.mark.parametrize("kind", [plica.Scene, plica.Simulation])
def test_what_was_refused_can_be_shown(kind):
    refused = kind.__new__(kind)  # as debuggers and tracebacks with locals meet it
    with pytest.raises(plica.InputError):
        refused.__init__(CUBE, gravity=[0, 0])
    assert repr(refused) == f"<plica.{kind.__name__}: refused>"


def test_a_closed_simulation_says_so(cube):
    cube.close()
    with pytest.raises(RuntimeError, match="closed"):
        cube.step()
    assert "closed" in repr(cube)


def test_divergence_has_a_diagnosis():
    sim = plica.Simulation(CUBE, integration={"macro_step": "20 ms", "substeps": 1, "allow_unstable": True})
    with pytest.raises(plica.Diverged) as caught:
        sim.run()
    assert caught.value.diagnosis.kind in ("non_finite", "inverted", "energy", "speed")
    assert caught.value.diagnosis.remedy and str(caught.value.diagnosis) == str(caught.value)
    assert sim.time < 1 and np.isfinite(sim.positions()).all()


# -- the interpreter around it


def test_other_threads_run_while_it_steps(cube):
    thread = threading.Thread(target=cube.step, args=(20000,))
    beats = 0
    thread.start()
    while thread.is_alive():
        time.sleep(0.001)
        beats += 1
    assert beats > 20


def test_ctrl_c_ends_a_run():
    code = f"import plica; sim = plica.Simulation({CUBE!r}); print('on', flush=True); sim.run(1e6)"
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "on\n"
    time.sleep(0.3)
    child.send_signal(signal.SIGINT)
    _, errors = child.communicate(timeout=20)
    assert errors.rstrip().endswith("KeyboardInterrupt") and child.returncode != 0


def test_ctrl_c_ends_a_long_macro_step():
    scene = {**CUBE, "duration": "1000 s", "integration": {"macro_step": "1000 s", "substeps": 10000000}}
    code = textwrap.dedent(f"""
        import plica
        sim = plica.Simulation({scene!r})
        print("on", flush=True)
        try:
            sim.step()
        except KeyboardInterrupt:
            print("left at", sim.time, flush=True)
    """)
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "on\n"
    time.sleep(0.5)
    child.send_signal(signal.SIGINT)
    output, errors = child.communicate(timeout=10)
    assert output == "left at 0.0\n" and child.returncode == 0, errors


def test_threads_are_chosen_first_and_the_end_is_quiet():
    code = textwrap.dedent(f"""
        import plica
        plica.init(threads=1)
        assert plica.info()["threads"] == 1
        kept = plica.Simulation({CUBE!r}).step()
    """)
    child = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert (child.returncode, child.stdout, child.stderr) == (0, "", "")


def test_a_study_is_a_table():
    pandas = pytest.importorskip("pandas")
    table = plica.study(CUBE, duration="5 ms", study={"methods": ["single/symplectic_euler"], "samples": 3, "timed_runs": 1})
    assert isinstance(table, pandas.DataFrame) and {"method", "macro_step", "error", "wall_time", "pareto"} <= set(table.columns)
    assert (table.status == "completed").any()


# -- equilibrium


def test_solve_is_the_state_at_rest():
    bar = {
        "duration": "1 s",
        "body": {
            "levels": [{"box": {"size": [0.4, 0.1, 0.1], "cells": [8, 2, 2]}}],
            "material": {"model": "neo_hookean", "young_modulus": "20 kPa", "poisson_ratio": 0.3},
            "fixed": [{"half_space": {"normal": [1, 0, 0]}}],
            "loads": [{"half_space": {"point": [0.4, 0, 0], "normal": [-1, 0, 0]}, "traction": [0, 0, -60]}],
        },
    }
    with plica.solve(bar, tolerance=1e-7, integration={"cycle": "rest"}) as rest:
        assert rest.time == pytest.approx(1) and 0 <= rest.residual <= 1e-7
        assert not rest.velocities().any()
        # of another cycle, what is said of its integration is left out
        with plica.solve(bar, tolerance=1e-7, integration={"integrator": "bdf2", "macro_step": "1 ms"}) as same:
            assert np.array_equal(same.positions(), rest.positions())
        moved = rest.positions() - rest.scene.mesh().points
    assert moved[:, 2].min() < -0.02
    with pytest.raises(plica.InputError, match="nothing holds the body"):
        plica.solve(bar, set={"body.fixed": []})
    with pytest.raises(plica.InputError, match="made already"):
        plica.solve(plica.Scene(bar))


def test_solve_says_where_there_is_no_equilibrium():
    lifted = CUBE | {"gravity": [0, 0, 1], "contact": {"obstacles": [{"plane": {"point": [0, 0, -0.001]}}]}, "body": {"levels": CUBE["body"]["levels"]}}
    with pytest.raises(plica.Diverged, match="no equilibrium was found") as error:
        plica.solve(lifted)
    assert error.value.diagnosis.vertex >= 0
    assert error.value.simulation.time == 0
    error.value.simulation.close()
