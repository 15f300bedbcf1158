# SPDX-License-Identifier: BSD-3-Clause
"""Runs a scene by two programs and says how far apart the bodies are at the end, over how far they moved; exit status 1 above the bound.

    parity.py PLICA OTHER_PLICA SCENE double|float

PLICA may also be a folder of frames that such a program wrote before, see references() in on_gpu/prepare.py.
"""
import array
import base64
import subprocess
import sys
import tempfile
import xml.etree.ElementTree
from pathlib import Path

BOUND = {"double": 1e-9, "float": 1e-3}  # rounding in another order, grown over some ten milliseconds


def points(frame):
    """Positions of a .vtu file of plica, three numbers a vertex; without NumPy, which a machine with a GPU may lack."""
    root = xml.etree.ElementTree.parse(frame).getroot()
    tag = root.find(".//DataArray[@Name='Points']")
    text, at = root.find("AppendedData").text.strip()[1:], int(tag.get("offset"))
    order = "little" if root.get("byte_order") == "LittleEndian" else "big"
    size = int.from_bytes(base64.b64decode(text[at:at + 12])[:8], order)
    content = base64.b64decode(text[at:at + (8 + size + 2) // 3 * 4])[8:8 + size]
    numbers = array.array({"Float64": "d", "Float32": "f"}[tag.get("type")], content)
    if order != sys.byteorder:
        numbers.byteswap()
    return numbers


def ends(program, scene, precision, folder):
    if Path(program).is_dir():
        kept = Path(program) / f"{Path(scene).stem}-{precision}"
        return [points(kept / name) for name in ("start.vtu", "end.vtu")]
    command = [program, "run", scene, "-o", folder, "--force", "--quiet", "--precision", precision, "--duration", "10 ms",
               "--set", "output.volume=true", "--set", "output.every=5 ms"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"parity: {' '.join(map(str, command))}: {done.stderr.strip()}")
    frames = sorted(Path(folder).glob("frames/volume_*.vtu"))
    return [points(frame) for frame in (frames[0], frames[-1])]


def main(one, other, scene, precision):
    with tempfile.TemporaryDirectory() as folder:
        (start, mine), (_, theirs) = (ends(program, scene, precision, Path(folder) / str(i)) for i, program in enumerate((one, other)))
    if len(mine) != len(theirs):
        sys.exit(f"parity: {len(mine) // 3} vertices beside {len(theirs) // 3}")
    # a comparison with NaN is false: what is not a number is no parity
    error = max(map(abs, (a - b for a, b in zip(mine, theirs)))) / max(map(abs, (a - b for a, b in zip(mine, start))))
    good = error <= BOUND[precision] and all(x == x for x in theirs)
    print(f"{scene}, {precision}: {error:.2g} of the motion; bound {BOUND[precision]:g}")
    return int(not good)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
