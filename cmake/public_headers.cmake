# SPDX-License-Identifier: BSD-3-Clause
# The public headers: what programs that use Plica may include, and what the reference documents. The others may change at any
# time. <plica/plica.hpp> includes those of plica::plica.
set(plica_public_headers
  core/backend.hpp core/cuts.hpp core/device_array.hpp core/error.hpp core/load.hpp core/mesh.hpp core/motion.hpp
  core/obstacles.hpp core/one_rank.hpp core/precision.hpp core/problem.hpp core/ranks.hpp core/reports.hpp core/selection.hpp core/transfer.hpp
  kernels/contact/shapes.hpp
  kernels/contact/shapes/block.hpp kernels/contact/shapes/bowl.hpp kernels/contact/shapes/capsule.hpp
  kernels/contact/shapes/cone.hpp kernels/contact/shapes/cylinder.hpp kernels/contact/shapes/plane.hpp
  kernels/contact/shapes/sampled_surface.hpp kernels/contact/shapes/sphere.hpp
  meshes/boundary_triangles.hpp meshes/compare_levels.hpp meshes/composite.hpp meshes/cut.hpp meshes/embedding.hpp
  meshes/generators.hpp meshes/jitter.hpp meshes/lattice.hpp meshes/mesh_quality.hpp meshes/organs.hpp meshes/refinement.hpp meshes/reordering.hpp
  meshes/repair_mesh.hpp
  drivers/loads/external_forces.hpp drivers/methods/methods.hpp drivers/run/compose_levels.hpp drivers/run/join_bodies.hpp
  drivers/run/material_points.hpp
  drivers/run/registry.hpp drivers/run/simulation.hpp drivers/run/validate.hpp drivers/run/wait_passively.hpp)
set(plica_public_headers_of_files meshes/files/mesh_files.hpp)
set(plica_public_headers_of_mpi drivers/mpi/mpi_ranks.hpp drivers/mpi/waiting.hpp)
set(plica_public_headers_of_study drivers/study/choose_cycle.hpp drivers/study/stability.hpp drivers/study/study.hpp
  drivers/study/truth.hpp drivers/study/verify.hpp)
