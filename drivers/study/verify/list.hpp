// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/drivers/study/verify.hpp>

namespace plica {

/// Exception that ends verify() where the caller stops it.
struct VerifyStopped {};

/// Settings under which a problem is solved.
struct VerifyContext {
  bool small = false;           ///< true: coarser meshes
  std::function<bool()> go_on;  ///< false ends verify()

  /// Throws VerifyStopped where the caller stops; call it before each piece of work.
  void proceed() const {
    if (go_on && !go_on()) throw VerifyStopped{};
  }
  /// Returns three numbers of cells, each twice the one before. The first is `coarsest`, which must
  /// be even; in the small version it is half of that.
  std::vector<int> refined(int coarsest) const {
    const int first = small ? coarsest / 2 : coarsest;
    return {first, 2 * first, 4 * first};
  }
};

/// Returns the name of a mesh by its cells, "40x2x2".
inline std::string cells_text(int x, int y, int z) {
  return std::to_string(x) + "x" + std::to_string(y) + "x" + std::to_string(z);
}

using VerifyRows = std::vector<VerifyRow>;

VerifyRows affine_patch(const VerifyContext&);
VerifyRows rigid_motion(const VerifyContext&);
VerifyRows derivatives(const VerifyContext&);
VerifyRows conservation(const VerifyContext&);
VerifyRows critical_steps(const VerifyContext&);
VerifyRows hanging_bar(const VerifyContext&);
VerifyRows uniaxial_tension(const VerifyContext&);
VerifyRows stretched_block(const VerifyContext&);
VerifyRows axial_bar(const VerifyContext&);
VerifyRows bending(const VerifyContext&);
VerifyRows cook_incompressible(const VerifyContext&);
VerifyRows punch(const VerifyContext&);
VerifyRows cantilever(const VerifyContext&);
VerifyRows stopped_bar(const VerifyContext&);
VerifyRows cook_membrane(const VerifyContext&);
VerifyRows free_cube(const VerifyContext&);
VerifyRows tapered_membrane(const VerifyContext&);
VerifyRows laws_of_tissue(const VerifyContext&);
VerifyRows relaxation(const VerifyContext&);
VerifyRows bending_heart_muscle(const VerifyContext&);
VerifyRows artery(const VerifyContext&);
VerifyRows thick_sphere(const VerifyContext&);
VerifyRows turned_cylinder(const VerifyContext&);
VerifyRows forces_of_supports(const VerifyContext&);
VerifyRows twisting_column(const VerifyContext&);
VerifyRows free_spin(const VerifyContext&);
VerifyRows squash(const VerifyContext&);
VerifyRows manufactured_solution(const VerifyContext&);
VerifyRows time_order(const VerifyContext&);
VerifyRows friction_on_a_slope(const VerifyContext&);
VerifyRows sticking_and_slipping(const VerifyContext&);
VerifyRows grip_and_lift(const VerifyContext&);
VerifyRows stuck_on_a_turntable(const VerifyContext&);
VerifyRows impact_on_a_plate(const VerifyContext&);
VerifyRows thrown_cube(const VerifyContext&);
VerifyRows reactions(const VerifyContext&);
VerifyRows pressed_ball(const VerifyContext&);
VerifyRows ridges(const VerifyContext&);
VerifyRows hertz_contact(const VerifyContext&);
VerifyRows collision(const VerifyContext&);

/// A problem with a known solution.
struct VerifyProblem {
  const char* name;
  const char* summary;
  VerifyRows (*rows)(const VerifyContext&);
};

/// All problems. A new problem needs a file in this folder, a function above, and a line here.
inline constexpr VerifyProblem verify_list[] = {
    {"affine_patch", "an irregular mesh takes an affine deformation exactly, in every material",
     affine_patch},
    {"rigid_motion",
     "a turned and moved body feels no force; small-strain `linear` feels a known one",
     rigid_motion},
    {"derivatives", "energy, force and tangent are each other's derivatives, in every material",
     derivatives},
    {"conservation", "momentum and energy of a free body, by every integrator and cycle",
     conservation},
    {"critical_step", "2/w_max against dense eigenvalues and against runs", critical_steps},
    {"hanging_bar", "a bar under its own weight", hanging_bar},
    {"uniaxial_tension", "a bar under traction at both ends", uniaxial_tension},
    {"stretched_block", "energies of stretched blocks, and the forces of walls and rollers on them",
     stretched_block},
    {"axial_bar", "axial frequencies of a bar fixed at one end", axial_bar},
    {"cantilever", "deflection and first frequency of a slender beam", cantilever},
    {"stopped_bar", "velocity pulses in a bar that is stopped at one end", stopped_bar},
    {"cook_membrane", "Cook's membrane at finite strain", cook_membrane},
    {"bending",
     "slender and stubby clamped beams, nu from 0.3 to 0.4999, of linear and of nodal elements",
     bending},
    {"cook_incompressible", "Cook's membrane at nu 0.4999, flat and thick, of both elements",
     cook_incompressible},
    {"punch", "a punched block, nearly incompressible, squeezed to a third, of nodal elements",
     punch},
    {"free_cube",
     "frequencies of a nearly incompressible free cube: linear elements lock, nodal ones have the "
     "first 20 modes",
     free_cube},
    {"tapered_membrane", "in-plane frequencies of a tapered membrane (NAFEMS FV32)",
     tapered_membrane},
    {"laws_of_tissue",
     "stretched and sheared boxes of every law of tissue, in closed form, of both elements",
     laws_of_tissue},
    {"relaxation", "steps, ramps and sines of viscous materials, in closed form, of both elements",
     relaxation},
    {"bending_heart_muscle",
     "a beam bent by a pressure that follows it (Land et al. 2015, problem 1), of nodal elements",
     bending_heart_muscle},
    {"artery", "tubes under a pressure that follows them, neo-Hookean and with fibres", artery},
    {"thick_sphere", "a thick hollow ball under a pressure that follows it", thick_sphere},
    {"torsion", "a cylinder turned by half a turn: torque and the force along it", turned_cylinder},
    {"supports", "forces and moments of rollers, walls and turned ends, in runs of cycle rest",
     forces_of_supports},
    {"twisting_column",
     "a twisting column against its own finest mesh, and its energy, of both elements",
     twisting_column},
    {"free_spin",
     "energy and angular momentum of a spinning cube over 28 000 steps, of nodal elements",
     free_spin},
    {"squash", "how far a cube can be squashed between lubricated plates, of both elements",
     squash},
    {"manufactured_solution",
     "a chosen motion and the body force that it takes: order in space of both elements",
     manufactured_solution},
    {"time_order", "the order in time of every integrator on a nonlinear problem", time_order},
    {"friction_on_a_slope", "the slope on which a block begins to slip", friction_on_a_slope},
    {"incline", "a block on an incline about its friction angle, by explicit and implicit steps",
     sticking_and_slipping},
    {"grip_and_lift", "a cube that jaws lift by friction and hold", grip_and_lift},
    {"turntable", "a cube that sticks on a table that turns by 90 degrees", stuck_on_a_turntable},
    {"impact_on_a_plate", "a soft block that falls on a stiff plate: peak force, impulse, energy",
     impact_on_a_plate},
    {"thrown_cube", "a cube thrown at a floor gains no energy, by explicit and implicit steps",
     thrown_cube},
    {"reactions", "forces of obstacles against the change of momentum, in every integrator",
     reactions},
    {"pressed_ball", "force of a ball at rest by explicit and implicit steps", pressed_ball},
    {"ridges", "tips and ridges that fall on each other, exactly aligned", ridges},
    {"hertz", "force against approach of a sphere on a plane and on its like, of nodal elements",
     hertz_contact},
    {"collision", "momenta of two equal balls that collide askew", collision}};

}  // namespace plica
