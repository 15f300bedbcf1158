# SPDX-License-Identifier: BSD-3-Clause
"""Runs a scene by two programs and says how far apart the bodies are at the end, over how far they moved; exit status 1 above the bound.

    parity.py PLICA OTHER_PLICA SCENE double|float
"""
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "drivers" / "plots"))
import numpy  # noqa: E402
from frames import read_vtu  # noqa: E402

BOUND = {"double": 1e-9, "float": 1e-3}  # rounding in another order, grown over some ten milliseconds


def ends(program, scene, precision, folder):
    command = [program, "run", scene, "-o", folder, "--force", "--quiet", "--precision", precision, "--duration", "10 ms",
               "--set", "output.volume=true", "--set", "output.every=5 ms"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"parity: {' '.join(map(str, command))}: {done.stderr.strip()}")
    frames = sorted(Path(folder).glob("frames/volume_*.vtu"))
    return [read_vtu(frame)["Points"] for frame in (frames[0], frames[-1])]


def main(one, other, scene, precision):
    with tempfile.TemporaryDirectory() as folder:
        (start, mine), (_, theirs) = (ends(program, scene, precision, Path(folder) / str(i)) for i, program in enumerate((one, other)))
    error = numpy.abs(mine - theirs).max() / numpy.abs(mine - start).max()
    print(f"{scene}, {precision}: {error:.2g} of the motion; bound {BOUND[precision]:g}")
    return int(error > BOUND[precision])


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
