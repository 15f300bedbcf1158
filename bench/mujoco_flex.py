# SPDX-License-Identifier: BSD-3-Clause
"""A clamped body of StVK tetrahedra in MuJoCo (flex), made of a Gmsh file as its users make one."""
import time

import mujoco

SCENE = """<mujoco><option timestep="{step!r}" gravity="0 0 {gravity!r}" integrator="{integrator}"/><size memory="4G"/>
<worldbody><flexcomp name="body" type="gmsh" file="{file}" dim="3" mass="{mass!r}" radius="1e-5">
<contact selfcollide="none" contype="0" conaffinity="0"/><elasticity young="{young!r}" poisson="{poisson!r}" damping="0"/>
<pin id="{pins}"/></flexcomp></worldbody></mujoco>"""
VERSION = mujoco.__version__
WARNINGS = []  # what it has said since they were cleared
mujoco.set_mju_user_warning(WARNINGS.append)


class Flex:
    """One thread, double; clamped at the lower end of an axis. `damping` [1/s] is proportional to the mass; `forces` [N] act along z."""

    def __init__(self, mesh, file, young, poisson, density, step, integrator="Euler", gravity=0.0, damping=0.0, forces=None, axis=0):
        self.model = mujoco.MjModel.from_xml_string(SCENE.format(
            step=step, gravity=gravity, integrator=integrator, file=file, mass=density * mesh.volume, young=young, poisson=poisson,
            pins=" ".join(map(str, mesh.clamped(axis)))))
        self.data, self.rest = mujoco.MjData(self.model), mesh.vertices
        mujoco.mj_forward(self.model, self.data)
        bodies = self.model.flex_vertbodyid
        self.dofs = [self.model.body_dofadr[b] if self.model.body_dofnum[b] == 3 else -1 for b in bodies]
        for a, dof in enumerate(self.dofs):
            if dof >= 0:
                self.model.dof_damping[dof:dof + 3] = damping * self.model.body_mass[bodies[a]]
        for a, force in (forces or {}).items():
            self.data.qfrc_applied[self.dofs[a] + 2] = force

    def run(self, steps):
        """Processor seconds that so many steps take, None where it blew up: it starts anew then, and goes on."""
        until = self.data.time + (steps - 0.5) * self.model.opt.timestep
        start = time.process_time()
        for _ in range(steps):
            mujoco.mj_step(self.model, self.data)
        spent = time.process_time() - start
        return spent if self.data.time > until else None

    def deflection(self, shares):
        """Mean displacement along z over vertices with these weights [m]."""
        return sum(share * (self.data.flexvert_xpos[a][2] - self.rest[a][2]) for a, share in shares.items())
