# SPDX-License-Identifier: BSD-3-Clause
"""A task to learn: press a ball onto tissue until it feels a given force. The class has reset() and step() as gymnasium's have.

    python drivers/python/examples/environment.py     # needs plica; runs an episode with a simple controller
"""
import time

import numpy as np
import plica

SCENE = {
    "duration": 1,
    "body": {
        "levels": [{"box": {"size": [0.12, 0.08, 0.04], "cells": [18, 12, 6]}}],
        "material": {"model": "neo_hookean", "young_modulus": "10 kPa", "poisson_ratio": 0.4},
        "fixed": [{"half_space": {"normal": [0, 0, 1]}}],
        "damping": {"mass": 20},
    },
    "contact": {"obstacles": [{"name": "ball", "sphere": {"centre": [0.06, 0.04, 0.051], "radius": 0.01}, "friction": 0.2}]},
}


class Press:
    """An episode is 100 actions.

    action: [3] velocity of the ball, as a part of the greatest, from -1 to 1.
    observation: [9] displacement [cm], force that it feels and force that is asked for [0.1 N].
    """

    most = 0.05  # m/s
    actions, steps = 100, 10  # of an episode; macro steps of an action

    def __init__(self, scene=SCENE):
        self.simulation = plica.Simulation(scene)
        self.random = np.random.default_rng()

    def reset(self, *, seed=None, options=None):
        if seed is not None:
            self.random = np.random.default_rng(seed)
        self.simulation.reset()
        self.place, self.done = np.zeros(3), 0
        self.asked = np.array([0, 0, self.random.uniform(0.05, 0.2)])  # N
        return self._observation(), {}

    def step(self, action):
        velocity = self.most * np.clip(np.asarray(action, float), -1, 1)
        for _ in range(self.steps):
            self.place += self.simulation.macro_step * velocity
            self.simulation.move_obstacle("ball", self.place)
            self.simulation.step()
        self.done += 1
        observation = self._observation()
        reward = -float(np.abs(observation[3:6] - observation[6:]).sum())
        return observation, reward, False, self.done >= self.actions, {}  # terminated, truncated

    def _observation(self):
        force = -self.simulation.wrenches()["ball"].force
        return np.concatenate([100 * self.place, 10 * force, 10 * self.asked])


if __name__ == "__main__":
    task = Press()
    observation, _ = task.reset(seed=1)
    start, total, over = time.perf_counter(), 0.0, False
    while not over:
        missing = observation[8] - observation[5]  # lower where the force is too small
        observation, reward, _, over, _ = task.step([0, 0, -0.3 * missing])
        total += reward
    seconds = time.perf_counter() - start
    print(f"asked for {task.asked[2]:.3f} N, feels {observation[5] / 10:.3f} N, rewards {total:.1f}; "
          f"{task.actions * task.steps / seconds:.0f} macro steps a second")
