# SPDX-License-Identifier: BSD-3-Clause
"""A clamped body of neo-Hookean tetrahedra in Newton's semi-implicit solver on the CPU: float, one thread."""
import time

import newton
import warp as wp

VERSION = f"{newton.__version__} with Warp {wp.__version__}"


class Body:
    """Clamped at the lower end of an axis, under gravity along z. Its k_mu and k_lambda are Lame's constants, as its users give them."""

    def __init__(self, mesh, young, poisson, density, step, gravity, axis):
        wp.config.quiet = True
        builder = newton.ModelBuilder(gravity=(0.0, 0.0, gravity))
        builder.add_soft_mesh(pos=wp.vec3(), rot=wp.quat_identity(), scale=1.0, vel=wp.vec3(), density=density, k_damp=0.0,
                              vertices=[wp.vec3(*x) for x in mesh.vertices], indices=[a for tet in mesh.tets for a in tet],
                              k_mu=young / (2 * (1 + poisson)), k_lambda=young * poisson / ((1 + poisson) * (1 - 2 * poisson)))
        for a in mesh.clamped(axis):
            builder.particle_mass[a] = 0.0
        with wp.ScopedDevice("cpu"):
            self.model = builder.finalize(device="cpu")
            self.now, self.next = self.model.state(), self.model.state()
            self.solver, self.control, self.step = newton.solvers.SolverSemiImplicit(self.model), self.model.control(), step

    def run(self, steps):
        """Processor seconds of so many steps."""
        start = time.process_time()
        for _ in range(steps):
            self.now.clear_forces()
            self.solver.step(self.now, self.next, self.control, None, self.step)
            self.now, self.next = self.next, self.now
        return time.process_time() - start
