# SPDX-License-Identifier: BSD-3-Clause
"""What a wheel has is enough, without the folders it was built in; what it leaves to others is named."""
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import plica
import pytest

EVERYWHERE = re.compile(r"(lib(c|m|dl|rt|pthread|stdc\+\+|gcc_s|z)\.so|ld-).*")

BLOCK = {"duration": "10 ms", "body": {"levels": [{"box": {"size": [0.1, 0.1, 0.1], "cells": [2, 2, 2]}}]}}
USE = f"""
import plica
plica.Simulation({BLOCK}).run()
print(plica.__file__, *{{line.split()[-1] for line in open("/proc/self/maps") if ".so" in line}}, sep="\\n")
"""


def needed(library):
    said = subprocess.run(["readelf", "-d", library], check=True, capture_output=True, text=True).stdout
    return set(re.findall(r"NEEDED.*\[(.*)\]", said))


def test_a_wheel_needs_nothing_else(tmp_path):
    build = Path(plica.__file__).parents[2]
    if not (build / "cmake_install.cmake").exists() or not shutil.which("readelf"):
        pytest.skip("needs a build tree and readelf")
    subprocess.run(["cmake", "--install", build, "--component", "python", "--prefix", tmp_path], check=True, capture_output=True)
    package = tmp_path / "plica"
    carried = {file.name for file in (package / "lib").iterdir()}
    for library in [*package.glob("_plica*.so"), *(package / "lib").iterdir()]:
        assert not {name for name in needed(library) - carried if not EVERYWHERE.fullmatch(name)}

    for file in Path(plica.__file__).parent.glob("*.py"):
        shutil.copy(file, package)
    environment = {name: value for name, value in os.environ.items() if name != "LD_LIBRARY_PATH"} | {"PYTHONPATH": str(tmp_path)}
    child = subprocess.run([sys.executable, "-c", USE], cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert child.returncode == 0, child.stderr
    module, *libraries = map(Path, child.stdout.split("\n")[:-1])
    assert module.parent == package
    assert carried <= {library.name for library in libraries if library.parent == package / "lib"}


def test_what_is_left_out_of_an_installation_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)  # as if it were not installed
    with pytest.raises(ImportError, match="plica.study needs pandas: pip install pandas"):
        plica.study(duration=1)
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(ImportError, match="to_pyvista needs pyvista"):
        plica.Simulation(BLOCK).to_pyvista()


def test_stubs_are_there():
    package = Path(plica._plica.__file__).parent
    assert (package / "py.typed").exists()
    assert "class Diagnosis" in (package / "_plica.pyi").read_text()
