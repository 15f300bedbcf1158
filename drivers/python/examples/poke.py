# SPDX-License-Identifier: BSD-3-Clause
"""A blunt instrument is drawn over a slab of tissue: three pictures of its stress, and the energies in time.

    python drivers/python/examples/poke.py [poke.png]     # needs plica, pyvista and matplotlib
"""
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import plica
import pyvista

SCENE = pathlib.Path(__file__).parents[2] / "scenes" / "poke.yaml"
MOMENTS = 0.2, 0.5, 0.8  # [s]


def picture(grid):
    plotter = pyvista.Plotter(off_screen=True, window_size=(900, 560))
    plotter.add_mesh(grid, scalars="von_mises", clim=(0, 4e3), cmap="viridis", show_scalar_bar=False)
    plotter.camera_position = [(0.06, -0.14, 0.17), (0.06, 0.045, 0.0), (0, 0, 1)]
    return plotter.screenshot(return_img=True)


sim = plica.Simulation(SCENE, set={"body.levels.0.box.cells": [24, 16, 8]})
pictures, times, energies = [], [], []
for frame in sim.run(every="10 ms"):
    times.append(frame.time)
    energies.append(frame.energies())
    if len(pictures) < len(MOMENTS) and frame.time >= MOMENTS[len(pictures)]:
        pictures.append((frame.time, picture(frame.to_pyvista())))

figure, axes = plt.subplot_mosaic([["0", "1", "2"], ["energies"] * 3], figsize=(11, 5), height_ratios=[2, 1.4], layout="constrained")
for i, (time, image) in enumerate(pictures):
    axes[str(i)].imshow(image)
    axes[str(i)].set_title(f"{time:.2f} s: von Mises stress, 0 to 4 kPa", fontsize=9)
    axes[str(i)].axis("off")
for name in ("elastic", "kinetic"):
    axes["energies"].plot(times, [1e3 * getattr(one, name) for one in energies], label=name)
axes["energies"].set(xlabel="time [s]", ylabel="energy [mJ]")
axes["energies"].legend()
file = sys.argv[1] if len(sys.argv) > 1 else "poke.png"
figure.savefig(file, dpi=110)
print(file)
