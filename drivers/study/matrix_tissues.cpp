// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <plica/core/text.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/stability_matrix.hpp>
#include <plica/drivers/study/study_case.hpp>

// Laws and tissues in the stability matrix. Explicit limits are tested from both sides. The laws
// whose stiffness changes most are tested at large strains too.
namespace plica {

namespace {

/// Beam of one law or tissue.
struct TissueBeam {
  std::string name;
  MaterialOptions material;
};

struct TissueRun {
  std::string method;
  double step;  ///< macro step over the critical step; 0: auto, 0.9
  long macro_steps;
};

const TissueRun explicit_run{"single/symplectic_euler", 0, 400},
    shorter{"single/symplectic_euler", 0.5, 400}, above_limit{"single/symplectic_euler", 1.05, 400},
    implicit_run{"single/implicit_euler", 10, 60}, him_run{"cycle/him", 8, 100},
    tled{"single/central_difference", 0, 400}, tled_above{"single/central_difference", 1.05, 400};

MaterialOptions nearly_incompressible(MaterialOptions m, double mu) {
  m.parameters["bulk_modulus"] = 149. / 3 * mu;  // nu = 0.49
  return m;
}

MaterialOptions softening() {  // softens in tension, like brain
  MaterialOptions m{"ogden"};
  m.convention = "two_mu_over_alpha2", m.terms = {{842, -4.7}};
  return nearly_incompressible(m, 842);
}

MaterialOptions along_fibres() {
  MaterialOptions m{"transversely_isotropic"};
  m.parameters = {{"mu", 1e3}, {"eta", 2e4}}, m.fibres = FibreOptions{};
  return nearly_incompressible(m, 1e3);
}

MaterialOptions viscous(MaterialOptions m) {
  m.prony = {{0.3, 0.02}, {0.4, 0.5}};
  return m;
}

/// Returns a beam of every tissue and every law of tissue, and two beams that relax.
std::vector<TissueBeam> tissue_beams() {
  std::vector<TissueBeam> all;
  for (const Choice& tissue : tissues()) {
    MaterialOptions m = tissue_material(tissue.name);
    if (find_material(m.model)->has_fibres) m.fibres = FibreOptions{{1, 0, 0}, Point::UnitY()};
    all.push_back({tissue.name, m});
  }
  for (const MaterialInfo& law : material_list())
    if (law.of_tissue) all.push_back({std::string(law.name), complete({std::string(law.name)})});
  all.push_back({"neo_hookean of nu 0.49 that relaxes", viscous({"neo_hookean", 3e3, 0.49, 1000})});
  all.push_back({"ogden that softens and relaxes", viscous(softening())});
  return all;
}

/// Stretches the body along x by a factor, at constant volume.
void stretch_along_x(MatrixBody& body, double factor) {
  const double across = 1 / std::sqrt(factor) - 1;
  for (const Point& p : body.problem.body.levels.front().vertices)
    body.displacement.push_back(
        {(factor - 1) * p.x(), across * (p.y() - 0.05), across * (p.z() - 0.05)});
}

MatrixCase tissue_case(const TissueBeam& beam, const std::string& element, const TissueRun& run,
                       double stretch, const Expected& expected) {
  MatrixBody body = clamped_beam();
  Problem& p = body.problem;
  p.body.element = {element}, p.body.material = beam.material;
  p.gravity = {0, 0, -1e-4 * stiffness_at_rest(beam.material) / (beam.material.density * 0.4)};
  p.integration.implicit.newton_iterations = 20;
  if (stretch != 1) stretch_along_x(body, stretch);
  const std::string what = stretch != 1                   ? " stretched by " + number(stretch)
                           : run.step == above_limit.step ? " above its limit"
                                                          : " under its weight";
  MatrixCase one{.name = beam.name + what + ", " + number(run.step > 0 ? run.step : 0.9) +
                         " x critical, " + element + " elements",
                 .method = run.method,
                 .problem = problem_of(p, study_case(p, {}, chosen_method(run.method))),
                 .step = run.step,
                 .macro_steps = run.macro_steps,
                 .displacement = body.displacement,
                 .expected = expected};
  one.problem.integration.allow_unstable = run.step == above_limit.step;
  // one sub-step: the macro step itself is tested
  if (run.method.rfind("single/", 0) == 0) one.problem.integration.substeps = {1};
  return one;
}

}  // namespace

std::vector<MatrixCase> tissue_cases() {
  const Expected completes{.complete = true}, stops{.stop = true};
  std::vector<MatrixCase> cases;
  const TissueBeam fibres{"fibres of nu 0.49", along_fibres()},
      softens{"ogden that softens", softening()},
      relaxes{"ogden that softens and relaxes", viscous(softening())};
  for (const char* element : {"linear", "nodal"}) {
    const auto add = [&](const TissueBeam& beam, const TissueRun& run, double stretch,
                         const Expected& expected) {
      cases.push_back(tissue_case(beam, element, run, stretch, expected));
    };
    // Small strains, small steps: the limit at rest holds from both sides
    for (const TissueBeam& beam : tissue_beams()) {
      for (const TissueRun& run : {explicit_run, implicit_run, him_run})
        add(beam, run, 1, completes);
      add(beam, above_limit, 1, stops);
    }
    for (const TissueBeam& beam : {softens, relaxes})
      add(beam, tled, 1, completes), add(beam, tled_above, 1, stops);
    // Fibres are 20 times as stiff as the matrix between them. Beyond a strain of 0.1 a step of 0.9
    // of the limit at rest is too long
    for (const double stretch : {0.9, 1.1}) {
      add(fibres, explicit_run, stretch, stops);
      for (const TissueRun& run : {shorter, implicit_run, him_run})
        add(fibres, run, stretch, completes);
    }
    for (const TissueBeam& beam : {softens, relaxes}) {
      for (const double stretch : {0.8, 1.25})
        for (const TissueRun& run : {explicit_run, implicit_run, him_run})
          add(beam, run, stretch, completes);
      for (const double stretch : {0.5, 2.0}) add(beam, explicit_run, stretch, stops);
    }
  }
  return cases;
}

}  // namespace plica
