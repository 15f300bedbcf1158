# SPDX-License-Identifier: BSD-3-Clause
"""What the Python package says of obstacles, writes into folders and shows on pages."""
import json
import os
import signal
import socket
import subprocess
import sys
import textwrap
import urllib.request
from pathlib import Path

import numpy as np
import plica
import pytest

sys.path.insert(0, str(Path(os.environ["PLICA_SOURCE_DIR"]) / "drivers" / "plots"))

PRESS = {
    "duration": "40 ms",
    "body": {
        "levels": [{"box": {"size": [0.1, 0.1, 0.04], "cells": [4, 4, 2]}}],
        "fixed": [{"half_space": {"normal": [0, 0, 1]}}],
        "surface": {"boundary": True},
    },
    "contact": {"obstacles": [{"name": "finger", "sphere": {"centre": [0.05, 0.05, 0.058], "radius": 0.02}}]},
}


def test_wrenches_are_named_and_push_the_body_away():
    sim = plica.Simulation(PRESS)
    assert list(sim.wrenches()) == ["finger"]
    fingers = [sim.step().wrenches()["finger"] for _ in range(10)]
    assert all(one.force.shape == one.torque.shape == (3,) and one.force.dtype == np.float64 for one in fingers)
    force = min((one.force for one in fingers), key=lambda force: force[2])
    assert force[2] < -1e-3 and np.abs(force[:2]).max() < 0.2 * -force[2]
    with plica.Simulation({key: value for key, value in PRESS.items() if key != "contact"}) as alone:
        assert alone.wrenches() == {}


def test_obstacles_are_moved_by_the_caller():
    sim = plica.Simulation(PRESS)
    for n in range(10):
        sim.move_obstacle("finger", [0, 0, 0.05])
        sim.step()
    assert np.linalg.norm(sim.wrenches()["finger"].force) == 0
    with pytest.raises(plica.InputError, match="unknown obstacle 'thumb' .choices: finger"):
        sim.move_obstacle("thumb", [0, 0, 0])
    with pytest.raises(plica.InputError, match=r"displacement: expected an array \[3\] of .*, got \[2\]"):
        sim.move_obstacle("finger", [0, 0])
    with pytest.raises(plica.InputError, match="finite"):
        sim.move_obstacle("finger", [0, 0, np.nan])
    assert sim.tools() == {}


def test_obstacles_are_turned_by_the_caller():
    lever = {"name": "lever", "capsule": {"from": [0.05, 0.05, 0.07], "to": [0.25, 0.05, 0.07], "radius": 0.01}}
    turn = {"about": [0.25, 0.05, 0.07], "axis": [0, 1, 0]}
    sim = plica.Simulation(PRESS | {"contact": {"obstacles": [lever | {"rotate": turn}]}})
    for n in range(1, 41):
        sim.move_obstacle("lever", [0, 0, 0], [0, -0.004 * n, 0])
        sim.step()
    # its end has come down by 0.16 * 0.2 m
    assert sim.wrenches()["lever"].force[2] < -1e-3
    with pytest.raises(plica.InputError, match=r"rotation: expected an array \[3\] of .*, got \[2\]"):
        sim.move_obstacle("lever", [0, 0, 0], [0, 0])
    heavy = plica.Simulation(PRESS | {"contact": {"obstacles": [lever | {"mass": "50 g"}]}})
    with pytest.raises(plica.InputError, match="lever has mass, and does not turn"):
        heavy.move_obstacle("lever", [0, 0, 0], [0, 0, 1])


def test_pictures_have_obstacles_where_their_turn_has_them():
    from obstacles import motion

    turn = {"axis": [0, 0, 1], "about": [0.1, 0, 0], "rotation": [np.pi / 2, 0, 0], "sine": {"amplitude": np.pi / 2, "frequency": 1, "phase": 0}}
    places = motion({"velocity": [1, 0, 0], "turn": turn})
    # (0.2, 0, -1) is 0.1 beside the axis and comes to (0.2, 1, 0), then a quarter turn about it to (-0.9, 0.1, 0), and on by 0.25 m
    assert np.allclose(places(np.array([[0.2, 0, -1]]), 0.25), [[-0.65, 0.1, 0]])


def test_tools_follow_where_the_caller_leads_them():
    finger = {**PRESS["contact"]["obstacles"][0], "mass": "50 g", "coupling": {"stiffness": "100 N/m"}}
    sim = plica.Simulation({**PRESS, "duration": "0.3 s", "contact": {"obstacles": [finger]}})
    assert np.array_equal(sim.tools()["finger"].displacement, np.zeros(3))
    sim.move_obstacle("finger", [0, 0, 0.02])
    sim.step()
    tool = sim.tools()["finger"]
    assert tool.displacement.shape == tool.velocity.shape == (3,) and tool.displacement.dtype == np.float64
    assert tool.displacement[2] < 0.01 and tool.velocity[2] > 0, "it is on its way"
    sim.run()
    assert np.allclose(sim.tools()["finger"].displacement, [0, 0, 0.02], atol=1e-4)


def test_obstacles_take_hold_and_let_go():
    finger = dict(PRESS["contact"]["obstacles"][0], grasp={"reach": "12 mm"})
    sim = plica.Simulation(PRESS | {"contact": {"obstacles": [finger]}})
    assert len(sim.held()["finger"]) == 0
    sim.grasp("finger")
    held = sim.held()["finger"]
    assert len(held) > 0
    before = sim.surface_positions()[held].copy()
    for _ in range(20):
        sim.move_obstacle("finger", [0, 0, 0.002])
        sim.step()
    assert np.abs(sim.surface_positions()[held] - before - [0, 0, 0.002]).max() < 0.001
    sim.release("finger")
    assert len(sim.held()["finger"]) == 0
    with pytest.raises(plica.InputError, match="unknown obstacle 'thumb' .choices: finger"):
        sim.grasp("thumb")
    with plica.Simulation(PRESS) as bare, pytest.raises(plica.InputError, match="finger cannot hold anything"):
        bare.grasp("finger")


def test_cavities_say_volume_and_pressure():
    tube = {"tube": {"length": 0.1, "radius": 0.01, "wall": 0.01, "bend": 0, "around": 12, "across": 2, "along": 6}}
    ends = [{"group": "inlet"}, {"group": "outlet"}]
    fluid = {"ratio": 1.1, "bulk_modulus": "20 kPa"}
    loads = [{"group": "lumen", "enclosed_volume": fluid, "ramp": "50 ms"}]
    sim = plica.Simulation(duration="50 ms", body={"levels": [tube], "fixed": ends, "loads": loads})
    rest = sim.cavities()[0]
    assert rest.pressure == pytest.approx(0, abs=1e-9) and rest.volume == pytest.approx(0.1 * np.pi * 0.01**2, rel=0.1)
    sim.run()
    now = sim.cavities()[0]
    assert now.pressure == pytest.approx(20e3 * (1.1 - now.volume / rest.volume)) and now.volume > 1.02 * rest.volume


def test_frames_are_written_as_by_the_program(tmp_path):
    from frames import read_vtu

    sim = plica.Simulation(PRESS)
    times = [frame.time for frame in sim.run(every="10 ms", folder=tmp_path / "run")]
    assert len(times) == 4
    files = sorted((tmp_path / "run/frames").glob("surface_*.vtu"))
    assert len(files) == 5
    assert len(read_vtu(files[-1])["Points"]) == len(sim.surface_positions())
    page = sim.report()
    assert page == tmp_path / "run/report.html" and "finger" in page.read_text()
    assert plica.report(tmp_path / "run", frames=2) == page
    with pytest.raises(plica.InputError, match="holds a run already"):
        sim.run("10 ms", every="5 ms", folder=tmp_path / "run")
    assert len(list(sim.run("10 ms", every="5 ms", folder=tmp_path / "run", force=True))) == 2


def test_a_port_that_cannot_be_had_is_refused_before_the_scene_is_read():
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        with pytest.raises(plica.InputError, match=f"port {port} is in use.*choose another port"):
            plica.view("no such scene.yaml", port=port, browser=False)
    for port, expected in ((65536, "0 to 65535"), (-1, "a whole number >= 0"), ("http", "a whole number >= 0")):
        with pytest.raises(plica.InputError, match=f"port: expected {expected}, got {port!r}"):
            plica.view("no such scene.yaml", port=port, browser=False)


def test_a_view_is_served_and_ctrl_c_ends_it():
    code = textwrap.dedent(f"""
        import plica
        sim = plica.view({PRESS!r}, port=0, browser=False)
        print("ended", sim.time)
    """)
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    address = child.stdout.readline().split()[0]
    with urllib.request.urlopen(address + "/") as page:
        assert b"live" in page.read()
    with urllib.request.urlopen(address + "/frames") as frames:  # while somebody looks, it runs
        seen = [json.loads(line[6:])["time"] for line, _ in zip((line for line in frames if line.startswith(b"data: ")), range(5))]
    assert seen == sorted(seen) and seen[-1] > seen[0]
    child.send_signal(signal.SIGINT)
    output, errors = child.communicate(timeout=20)
    assert child.returncode == 0 and output.startswith("ended") and float(output.split()[1]) >= seen[-1], errors
