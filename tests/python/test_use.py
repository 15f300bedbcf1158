# SPDX-License-Identifier: BSD-3-Clause
"""What surrounds a run in Python: threads, processes, resets, other libraries' meshes, and mistakes that would say nothing."""
import gc
import importlib.util
import inspect
import json
import os
import pickle
import subprocess
import sys
import textwrap
import threading
import types
import warnings
from pathlib import Path

import numpy as np
import plica
import pytest

from cube import CUBE

SOURCES = Path(os.environ["PLICA_SOURCE_DIR"])
SMALLEST = SOURCES / "drivers" / "scenes" / "smallest.yaml"

SLAB = {
    "duration": 1,
    "body": {
        "levels": [{"box": {"size": [0.06, 0.06, 0.03], "cells": [6, 6, 3]}}],
        "fixed": [{"half_space": {"normal": [0, 0, 1]}}],
        "damping": {"mass": 40},
    },
    "contact": {"obstacles": [{"name": "tool", "sphere": {"centre": [0.03, 0.03, 0.039], "radius": 0.008}}]},
}
OCTAHEDRON = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
FACES = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])


def python(code, **options):
    return subprocess.run([sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, timeout=120, **options)


def alone(steps):
    return plica.Simulation(CUBE).step(steps).positions().copy()


# -- threads and processes


def test_a_thread_that_reads_leaves_the_one_that_steps_alone():
    sim, ended = plica.Simulation(CUBE), []

    def stepper():
        for _ in range(200):
            sim.step()
        ended.append(sim.macro_steps)

    thread = threading.Thread(target=stepper)
    thread.start()
    reads = 0
    while thread.is_alive():
        assert np.isfinite(sim.positions()).all() and sim.von_mises().min() >= 0 and sim.energies().kinetic >= 0
        reads += 1
    assert ended == [200] and reads > 0
    assert np.array_equal(sim.positions(), alone(200))


def test_threads_that_step_one_simulation_take_turns():
    sim = plica.Simulation(CUBE)
    threads = [threading.Thread(target=lambda: [sim.step() for _ in range(100)]) for _ in range(2)]
    threads.append(threading.Thread(target=sim.step, args=(100,)))
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sim.macro_steps == 300 and np.array_equal(sim.positions(), alone(300))


def test_threads_with_a_simulation_each():
    sims = [plica.Simulation(CUBE) for _ in range(3)]
    threads = [threading.Thread(target=sim.step, args=(100,)) for sim in sims]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(sim.positions(), alone(100)) for sim in sims)


def test_a_long_run_lets_others_in():
    sim = plica.Simulation(CUBE)
    thread = threading.Thread(target=sim.step, args=(2000,))
    thread.start()
    while (seen := sim.macro_steps) == 0:
        pass
    thread.join()
    assert seen < sim.macro_steps == 2000


def test_python_may_end_while_a_daemon_thread_steps():
    child = python(f"""
        import threading, time, plica
        sim = plica.Simulation({CUBE!r})
        threading.Thread(target=lambda: sim.run(1e5), daemon=True).start()
        time.sleep(0.3)
        print(sim.macro_steps > 0)
    """)
    assert (child.returncode, child.stdout, child.stderr) == (0, "True\n", "")


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
@pytest.mark.parametrize("threads", [1, 2])
def test_a_fork_says_what_it_lacks(threads):
    child = python(f"""
        import os, sys, plica
        plica.init(threads={threads})
        sim = plica.Simulation({CUBE!r}).step()
        sys.stdout.flush()
        if (process := os.fork()) == 0:
            for use in (sim.step, lambda: plica.Simulation({CUBE!r})):
                try:
                    use()
                    print("works", flush=True)
                except RuntimeError as error:
                    print(error, flush=True)
            sys.exit(0)
        print("status", os.waitpid(process, 0)[1], sim.step().macro_steps)
    """)
    said = child.stdout.splitlines()
    assert said[-1] == "status 0 2", child.stderr
    assert said[:2] == ["works"] * 2 if threads == 1 else all("expected multiprocessing's start method 'spawn'" in line for line in said[:2])


def test_what_a_process_hands_to_another():
    sim = plica.Simulation(CUBE, integration={"macro_step": "20 ms", "substeps": 1, "allow_unstable": True})
    with pytest.raises(plica.Diverged) as caught:
        sim.run()
    again = pickle.loads(pickle.dumps(caught.value))
    assert type(again) is plica.Diverged and str(again) == str(caught.value)
    assert (again.diagnosis.kind, again.diagnosis.remedy) == (caught.value.diagnosis.kind, caught.value.diagnosis.remedy)
    energies = plica.Simulation(CUBE).step(20).energies()
    other = pickle.loads(pickle.dumps(energies))
    assert [other.kinetic, other.elastic, other.potential, other.total] == [energies.kinetic, energies.elastic, energies.potential, energies.total]
    with pytest.raises(TypeError, match="its scene does"):
        pickle.dumps(sim)


def test_scenes_pickle_with_their_meshes():
    mesh = plica.Scene(CUBE).mesh()
    scene = plica.Scene(CUBE, body={"levels": [mesh]}, set={"body.material.young_modulus": "5 kPa"})
    again = pickle.loads(pickle.dumps(scene))
    assert np.array_equal(plica.Simulation(again).step(10).positions(), plica.Simulation(scene).step(10).positions())
    assert pickle.loads(pickle.dumps(plica.Scene(SMALLEST))).name == plica.Scene(SMALLEST).name


# -- there and back


def press(sim, depth=1e-4):
    forces = []
    for k in range(50):
        sim.move_obstacle("tool", [0, 0, -depth * k])
        forces.append(sim.step().wrenches()["tool"].force[2])
    return np.array(forces)


def test_a_saved_state_has_its_obstacles():
    sim = plica.Simulation(SLAB)
    saved = sim.save()
    first = press(sim)
    assert first.min() < -1e-3 and sim.obstacles()["tool"].displacement[2] == pytest.approx(-4.9e-3)
    sim.restore(saved)
    assert np.array_equal(sim.obstacles()["tool"].displacement, np.zeros(3))
    assert np.array_equal(press(sim), first)


@pytest.mark.parametrize("early", [True, False])
def test_reset_is_the_start_with_the_same_bits(early):
    sim = plica.Simulation(SLAB)
    x = sim.positions()
    if early:
        sim.reset()
    first = press(sim)
    end = x.copy()
    assert sim.reset() is sim and sim.time == 0 and sim.macro_steps == 0
    assert np.array_equal(x, sim.scene.mesh().points), "arrays follow"
    assert np.array_equal(press(sim), first) and np.array_equal(x, end)
    sim.run(0.01)
    assert np.array_equal(press(sim.reset()), first)


def test_obstacles_get_motions_of_a_scenes_keys():
    sim = plica.Simulation(SLAB)
    sim.set_obstacle_motion("tool", {"velocity": [0, "10 mm/s", 0]}, {"axis": [0, 0, 1], "angular_velocity": "90 deg/s"})
    sim.run(0.1)
    tool = sim.obstacles()["tool"]
    assert tool.displacement == pytest.approx([0, 0.01 * sim.time, 0]) and tool.rotation == pytest.approx([0, 0, np.pi / 2 * sim.time])
    assert tool.origin == pytest.approx([0.03, 0.03 + 0.01 * sim.time, 0.039])
    sim.set_obstacle_motion("tool", {"curve": [{"time": 0, "displacement": np.array([0, 0, 0.02])}]})
    assert sim.obstacles()["tool"].displacement == pytest.approx([0, 0, 0.02])
    for motion, message in (({"velocty": [0, 0, 0]}, "velocity"), ({}, "velocity"), ([0, 0, 1], "expected motion as a dict")):
        with pytest.raises(plica.InputError, match=message):
            sim.set_obstacle_motion("tool", motion)
    with pytest.raises(plica.InputError, match="unknown obstacle 'thumb'"):
        sim.set_obstacle_motion("thumb", {"velocity": [0, 0, 0]})


def test_gravity_changes_within_a_run():
    free = {"duration": 1, "body": {"levels": CUBE["body"]["levels"]}}
    sim = plica.Simulation(free, gravity=[0, 0, -9.81]).step(10)
    sim.set_gravity([1, 0, 2])
    sim.step(20)
    assert np.allclose(sim.velocities(), sim.macro_step * (10 * np.array([0, 0, -9.81]) + 20 * np.array([1, 0, 2])), rtol=1e-9, atol=1e-12)
    with pytest.raises(plica.InputError, match=r"gravity: expected an array \[3\]"):
        sim.set_gravity(9.81)


def test_what_is_fixed_changes_in_a_simulation_that_goes_on():
    sim = plica.Simulation(SLAB)
    press(sim)
    softer = sim.changed(body={"material": {"young_modulus": "1 kPa"}})
    assert softer.time == sim.time and np.allclose(softer.positions(), sim.positions(), atol=1e-15)
    assert np.array_equal(softer.velocities(), sim.velocities())
    assert softer.obstacles()["tool"].displacement == pytest.approx(sim.obstacles()["tool"].displacement, abs=1e-15)
    forces = [one.run(0.5).wrenches()["tool"].force[2] for one in (sim, softer)]
    assert forces[0] < 4 * forces[1] < 0
    assert softer.scene.changed(set={"body.material.young_modulus": "3 kPa"}).levels == 1


# -- callbacks


def test_a_force_that_knows_its_simulation_goes_with_it():
    class Task:
        def __init__(self):
            self.sim = plica.Simulation(CUBE)
            self.sim.set_forces(self.force)

        def force(self, level, time, x, v, out):
            out[:, 0] += 1e-6

    gc.collect()
    before = len(plica.simulation._all)
    for _ in range(20):
        Task().sim.step()
    gc.collect()
    assert len(plica.simulation._all) <= before


def test_an_exception_takes_back_its_step_alone():
    sim = plica.Simulation(CUBE).step(33)
    before = sim.time, sim.macro_steps, sim.positions().copy(), sim.velocities().copy()

    def mine(level, time, x, v, out):
        raise KeyError("mine")

    for again in range(2):
        sim.set_forces(mine)
        with pytest.raises(KeyError):
            sim.step()
        assert (sim.time, sim.macro_steps) == before[:2]
        assert np.array_equal(sim.positions(), before[2]) and np.array_equal(sim.velocities(), before[3])
    sim.set_forces(None)
    assert sim.step().macro_steps == 34


def test_a_callback_reads_and_does_not_change():
    sim = plica.Simulation(CUBE)
    seen = []

    def force(level, time, x, v, out):
        seen.append(sim.time)
        with pytest.raises(RuntimeError, match="within a step"):
            sim.step()
        with pytest.raises(RuntimeError, match="within a step"):
            sim.set_gravity([0, 0, 0])

    sim.set_forces(force)
    sim.step(2)
    assert seen[0] == 0 and sim.macro_steps == 2


# -- what would say nothing


def test_arrays_cannot_be_written_to():
    sim = plica.Simulation(SLAB)
    for array in (sim.positions(), sim.velocities(), sim.surface_positions(), sim.surface_velocities()):
        with pytest.raises(ValueError, match="read-only"):
            array *= 1000
    x = sim.positions()
    assert np.from_dlpack(x.base).ctypes.data == x.ctypes.data


def test_a_run_that_nobody_goes_through_warns():
    sim = plica.Simulation(CUBE)
    with pytest.warns(RuntimeWarning, match="go through its frames"):
        sim.run(0.05, every="10 ms")
        gc.collect()
    assert sim.time == 0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for _ in sim.run(0.05, every="10 ms"):
            break
        sim.run(0.05)


def block():
    mesh = plica.Scene(CUBE).mesh()
    return mesh.points, mesh.tets


@pytest.mark.parametrize("more, message", [
    ({"region": np.full(384, -1)}, "region: expected numbers from 0, got -1"),
    ({"region": np.arange(384) % 3, "region_names": ["a"]}, "region: expected numbers of region_names from 0 to 0, got 0 to 2"),
    ({"region": np.full(384, 10**6), "region_names": ["a"]}, "region: expected numbers of region_names"),
    ({"region": np.arange(384) % 3 + 2**40}, "region: expected whole numbers of 32 bits, got 1099511627776 to"),
    ({"region": np.zeros(383, int)}, "region: expected one number for each of 384"),
    ({"vertex_sets": {"a": np.array([0.5, 1.7])}}, r"vertex_sets: a: expected an array \[n\] of whole numbers, got \[2\] of float64"),
    ({"vertex_sets": {"a": [0, 125]}}, "vertex_sets: a: expected numbers of vertices from 0 to 124, got 0 to 125"),
    ({"vertex_sets": {"a": np.ones(7, bool)}}, r"vertex_sets: a: expected a mask of 125 vertices, got \[7\]"),
])
def test_meshes_of_wrong_numbers_are_refused(more, message):
    with pytest.raises(plica.InputError, match=message):
        plica.Mesh(*block(), **more)


def test_numbers_beyond_32_bits_do_not_wrap():
    with pytest.raises(plica.InputError, match="expected numbers of vertices from 0 to 3, got 0 to 4294967299"):
        plica.Mesh(np.eye(4, 3), np.array([[0, 1, 2, 2**32 + 3]]))


def test_regions_without_names_get_them(tmp_path):
    points, tets = block()
    region = np.arange(len(tets)) % 3 * 5
    mesh = plica.Mesh(points, tets, region=region)
    assert mesh.region_names == ["region_0", "region_5", "region_10"] and np.array_equal(mesh.region, np.arange(len(tets)) % 3)
    for name in ("m.msh", "m.vtk", "m.vtu", "m.mesh"):
        mesh.write(tmp_path / name)
        assert np.array_equal(plica.Mesh.read(tmp_path / name).region, mesh.region)
    scene = plica.Scene(duration=1, body={"levels": [mesh], "regions": {"region_5": {"young_modulus": "1 MPa"}}})
    assert scene.mesh().region_names == mesh.region_names


def test_masks_select_where_they_are_true():
    points, tets = block()
    base = points[:, 2] < 1e-9
    mesh = plica.Mesh(points, tets, vertex_sets={"base": base, "none": []})
    sim = plica.Simulation(duration=1, gravity=[0, 0, -9.81], body={"levels": [mesh], "fixed": [{"group": "base"}]})
    sim.step(20)
    held = np.abs(sim.positions() - points).max(axis=1) == 0
    assert np.array_equal(held, base)


def test_rows_tell_which_points_a_mesh_with_unused_ones_keeps():
    points, tets = block()
    mesh = plica.Mesh(np.vstack([[9, 9, 9], points, [8, 8, 8]]), tets + 1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        sim = plica.Simulation(duration=1, body={"levels": [mesh]})
    rows = sim.scene.rows()
    assert np.array_equal(rows, np.arange(1, len(points) + 1))
    assert np.array_equal(mesh.points[rows], sim.positions())
    order = np.random.default_rng(3).permutation(len(points))
    shuffled = plica.Mesh(points[order], np.argsort(order)[tets])
    assert np.array_equal(plica.Scene(duration=1, body={"levels": [shuffled]}).rows(), np.arange(len(points)))
    assert np.array_equal(plica.Scene(CUBE).rows(), np.arange(len(points)))


# -- other libraries


def tool_of(surface):
    return {**SLAB, "contact": {"obstacles": [{"name": "tool", "surface": surface}]}}


def test_surfaces_come_from_arrays_and_from_what_others_call_them():
    points = np.array([0.03, 0.03, 0.0405]) + 0.01 * OCTAHEDRON
    as_pyvista = types.SimpleNamespace(points=points, faces=np.hstack([np.full((8, 1), 3), FACES]).ravel())
    forces = []
    for surface in (plica.Surface(points, FACES), types.SimpleNamespace(vertices=points, faces=FACES), as_pyvista):
        for given in (surface, {"file": surface}):
            sim = plica.Simulation(tool_of(given))
            forces.append(press(sim).tolist())
    assert min(forces[0]) < -1e-3 and all(other == forces[0] for other in forces)
    with pytest.raises(plica.InputError, match="expected triangles alone, as PolyData.triangulate"):
        plica.Scene(tool_of(types.SimpleNamespace(points=points, faces=np.array([4, 0, 1, 2, 3]))))
    with pytest.raises(plica.InputError, match="triangles: expected numbers of points from 0 to 5, got 0 to 6"):
        plica.Surface(points, FACES + (FACES == 5))


def test_an_embedded_surface_from_arrays():
    points = 0.05 + 0.03 * OCTAHEDRON
    scene = {**CUBE, "body": {**CUBE["body"], "surface": plica.Surface(points, FACES)}}
    sim = plica.Simulation(scene)
    assert np.allclose(sim.surface_positions(), points, atol=1e-12) and np.array_equal(sim.scene.surface_triangles(), FACES)


def test_to_meshio(tmp_path):
    meshio = pytest.importorskip("meshio")
    points, tets = block()
    mesh = plica.Mesh(points, tets, region=np.arange(len(tets)) % 2, vertex_sets={"base": [0, 1]})
    sim = plica.Simulation(duration=1, gravity=[0, 0, -9.81], body={"levels": [mesh], "element": "linear", "fixed": [{"group": "base"}]}).step(5)
    theirs = sim.to_meshio()
    assert isinstance(theirs, meshio.Mesh) and np.array_equal(theirs.points, sim.positions())
    assert np.array_equal(theirs.cell_data["von_mises"][0], sim.von_mises()) and np.array_equal(theirs.cell_data["region"][0], mesh.region)
    assert np.allclose(theirs.point_data["displacement"], sim.positions() - points, atol=1e-15)
    theirs.write(tmp_path / "cube.vtu")
    assert np.array_equal(meshio.read(tmp_path / "cube.vtu").points, sim.positions())


# -- the program and its words


def program(*words):
    return subprocess.run([os.environ["PLICA_EXECUTABLE"], *map(str, words)], check=True, capture_output=True, text=True).stdout


def test_check_and_explain_say_what_the_program_says():
    assert plica.explain(SMALLEST) == program("explain", SMALLEST)
    checked = plica.check(SMALLEST)
    assert checked["sound"] and checked == json.loads(program("check", SMALLEST, "--json"))
    with pytest.raises(plica.InputError, match="young_modulus"):
        plica.check(SMALLEST, body={"material": {"young_modulus": "-1 Pa"}})


def test_the_package_is_the_program_too():
    def run(*words):
        return subprocess.run([sys.executable, "-m", "plica", *map(str, words)], capture_output=True, text=True, timeout=120)

    sound = run("check", SMALLEST)
    assert sound.returncode == 0 and "sound" in sound.stdout, sound.stderr
    assert run("check", "nowhere.yaml").returncode == 2
    assert run("list", "materials").stdout == program("list", "materials")
    with pytest.raises(RuntimeError, match="Kokkos, which runs here already"):
        plica.info() and plica._plica.program(["plica", "--version"])


def test_functions_say_what_they_return():
    for name, one in inspect.getmembers(plica.Simulation, inspect.isfunction):
        if not name.startswith("_") and name not in ("to_pyvista", "to_meshio"):
            assert inspect.signature(one).return_annotation is not inspect.Signature.empty, name


def test_the_environment_of_the_examples():
    spec = importlib.util.spec_from_file_location("environment", SOURCES / "drivers/python/examples/environment.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    scene = {**module.SCENE, "body": {**module.SCENE["body"], "levels": [{"box": {"size": [0.12, 0.08, 0.04], "cells": [6, 4, 2]}}]}}
    task = module.Press(scene)

    def episode():
        seen = [task.reset(seed=5)[0]]
        for n in range(task.actions):
            observation, reward, terminated, truncated, _ = task.step([0, 0, -0.1 * (n < 20)])
            seen.append(observation)
            assert reward <= 0 and not terminated
        assert truncated
        return np.array(seen)

    first = episode()
    assert first.shape == (task.actions + 1, 9) and np.isfinite(first).all()
    assert np.array_equal(episode(), first)
