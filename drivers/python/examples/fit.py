# SPDX-License-Identifier: BSD-3-Clause
"""Two parameters of a law from a measured force curve: a ball is pressed into a slab of tissue.

    python drivers/python/examples/fit.py [measured.csv]     # needs plica and numpy

measured.csv has the columns depth [m] and force [N]. Without it a curve with noise is made up from parameters that are known.
"""
import csv
import sys

import numpy as np
import plica

SPEED = 0.01  # of the ball [m/s]
SCENE = {
    "body": {
        "levels": [{"box": {"size": ["6 cm", "6 cm", "3 cm"], "cells": [10, 10, 5], "origin": ["-3 cm", "-3 cm", "-3 cm"]}}],
        "fixed": [{"half_space": {"point": [0, 0, "-3 cm"], "normal": [0, 0, 1]}}],
        "damping": {"mass": "20 1/s"},
        "surface": {"boundary": True},
    },
    "contact": {"obstacles": [{"name": "ball", "sphere": {"centre": [0, 0, "10 mm"], "radius": "10 mm"}}]},
    "integration": {"macro_step": "5 ms", "safety": 0.5},  # the law stiffens beyond its limit at rest
}
TRUTH = np.array([2e3, 3.0])  # of the curve that is made up
START = np.array([5e3, 1.0])


def law(mu, c2):
    """The material with a shear modulus at rest [Pa] and an exponent: the larger c2, the more it stiffens."""
    return {"model": "veronda_westmann", "c1": mu / c2, "c2": c2, "bulk_modulus": 10 * mu, "density": 1060}


def forces(depth, parameters):
    """Forces [N] on the ball at ascending depths [m]."""
    depth = np.asarray(depth)
    duration = depth[-1] / SPEED
    path = [{"time": 0, "displacement": [0, 0, 0]}, {"time": duration, "displacement": [0, 0, -depth[-1]]}]
    scene = SCENE | {"duration": duration, "body": SCENE["body"] | {"material": law(*parameters)}}
    scene["contact"] = {"obstacles": [SCENE["contact"]["obstacles"][0] | {"curve": path}]}
    curve = [(0.0, 0.0)]
    with plica.Simulation(scene) as simulation:
        for frame in simulation.run(every="20 ms"):
            curve.append((SPEED * frame.time, -frame.wrenches()["ball"].force[2]))
    return np.interp(depth, *np.transpose(curve))


def fit(model, start, measured, iterations=12):
    """Least squares by Levenberg's and Marquardt's method, in the logarithms of the parameters: they stay above 0.

    model(parameters) returns what is measured. Returns the parameters and their relative standard errors, as the scatter of the
    measured values has them.
    """
    x = np.log(start)
    misfit = model(np.exp(x)) - measured
    damping, difference = 1e-2, 0.02
    for _ in range(iterations):
        slopes = np.column_stack([(model(np.exp(x + step)) - measured - misfit) / difference for step in difference * np.eye(len(x))])
        square = slopes.T @ slopes
        while True:
            change = -np.linalg.solve(square + damping * np.diag(np.diag(square)), slopes.T @ misfit)
            change *= min(1, 1 / np.abs(change).max())  # at most by a factor e at once
            tried = model(np.exp(x + change)) - measured
            better = tried @ tried < misfit @ misfit
            if better or np.abs(change).max() < 1e-3:
                break
            damping *= 10
        if better:
            x, misfit, damping = x + change, tried, damping / 10
        if np.abs(change).max() < 1e-3:
            break
    variance = misfit @ misfit / (len(measured) - len(x))
    return np.exp(x), np.sqrt(variance * np.diag(np.linalg.inv(square)))


def made_up(depth, noise=0.01, seed=1):
    """Forces [N] of TRUTH with a scatter, as a part of the largest force."""
    exact = forces(depth, TRUTH)
    return exact + noise * exact[-1] * np.random.default_rng(seed).standard_normal(len(depth))


def main(file=None):
    if file is None:
        depth = np.linspace(0.5e-3, 10e-3, 20)
        force = made_up(depth)
        print(f"made up: mu = {TRUTH[0]:.0f} Pa, c2 = {TRUTH[1]:.2f}, scatter 1 % of the largest force")
    else:
        with open(file) as lines:
            rows = list(csv.DictReader(lines))
        depth, force = (np.array([float(row[name]) for row in rows]) for name in ("depth", "force"))
    (mu, c2), error = fit(lambda parameters: forces(depth, parameters), START, force)
    rest = forces(depth, (mu, c2)) - force
    print(f"found:   mu = {mu:.0f} Pa +- {100 * error[0]:.1f} %, c2 = {c2:.2f} +- {100 * error[1]:.1f} % (standard errors)")
    print(f"left:    {100 * np.sqrt(np.mean(rest**2)) / force.max():.1f} % of the largest force (root mean square)")


if __name__ == "__main__":
    main(*sys.argv[1:2])
