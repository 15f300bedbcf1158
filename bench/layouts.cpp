// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>
#include <iomanip>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/kernels/materials/list.hpp>
#include <sstream>

#include "case.hpp"
#include "counted.hpp"
#include "layouts/element_forces.hpp"
#include "layouts/patched.hpp"
#include "layouts/per_vertex.hpp"
#include "measure.hpp"
#include "suites.hpp"

// How to store elements and bring their forces to the vertices: the experiment behind
// kernels/patch_kernel.hpp. All ways use the same pointwise materials on the same mesh, and must
// agree before they are timed.
namespace plica::bench {

namespace {

std::vector<double> constants_of(const std::string& material) {
  const MaterialInfo& info = *find_material(material);
  return info.kernel_constants(parameter_values(info, {material, 1e5, 0.45}, {}));
}

/// A bent beam, and what its forces are.
template <class B, class Material>
struct LayoutProblem {
  TetMesh mesh;
  std::vector<double> constants = constants_of(Material::name);
  Vectors<B> u, f;
  std::vector<typename B::Real> expected;

  explicit LayoutProblem(const Cells& cells) : mesh(beam_mesh(cells)) {
    u = to_field<B>(bent(mesh, 0.1 / cells[0]));
    f = Vectors<B>("bench::f", mesh.vertices.size());
    Patched<B, Material>(mesh, constants)({}, u, f);
    expected = forces();
  }
  std::vector<typename B::Real> forces() const {
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), f);
    return {host.data(), host.data() + host.span()};
  }
  /// The largest difference from the library's forces, relative to their largest.
  double difference() const {
    const auto now = forces();
    double off = 0, size = 0;
    for (std::size_t i = 0; i < now.size(); ++i) {
      off = std::max(off, std::abs(static_cast<double>(now[i]) - static_cast<double>(expected[i])));
      size = std::max(size, std::abs(static_cast<double>(expected[i])));
    }
    return off / size;
  }
  /// FNV-1a over all bits of the forces: equal for equal bits.
  std::string fingerprint() const {
    const auto now = forces();
    std::uint64_t hash = 14695981039346656037ULL;
    std::vector<unsigned char> bytes(now.size() * sizeof(now[0]));
    std::memcpy(bytes.data(), now.data(), bytes.size());
    for (unsigned char b : bytes) hash = (hash ^ b) * 1099511628211ULL;
    std::ostringstream text;
    text << "bits " << std::hex << std::setw(16) << std::setfill('0') << hash;
    return text.str();
  }
};

template <class B, class Material, template <class, class> class Layout>
void run_layout(benchmark::State& state, const Case& c) {
  using Real = typename B::Real;
  struct Fixture {
    LayoutProblem<B, Material> problem;
    Layout<B, Material> layout;
    explicit Fixture(const Cells& cells)
        : problem(cells), layout(problem.mesh, problem.constants) {}
  };
  const std::string name = std::string(Layout<B, Material>::name) + " " + c.name;
  auto& now = fixture<Fixture>(name, [&] { return std::make_shared<Fixture>(c.cells); });
  const auto& p = now.problem;
  const typename B::Exec exec;
  now.layout(exec, p.u, p.f);
  exec.fence();
  // round-off of sums in another order
  if (const double off = p.difference(), most = sizeof(Real) == 8 ? 1e-12 : 1e-5; !(off < most)) {
    state.SkipWithError(("differs from the library by " + std::to_string(off)).c_str());
    return;
  }
  state.SetLabel(p.fingerprint());
  const double tets = static_cast<double>(p.mesh.tets.size()),
               vertices = static_cast<double>(p.mesh.vertices.size());
  const double compulsory = tets * (8 + 10 * sizeof(Real)) + vertices * 6 * sizeof(Real);
  measure<Real>(state, exec, {tets, compulsory, tets * flops_per_tet<Material>(1)},
                [&] { now.layout(exec, p.u, p.f); });
  // what this layout moves
  state.counters["bytes_per_tet"] = now.layout.bytes_per_tet(vertices / tets);
}

template <template <class, class> class Layout, class B, class Material>
void add(const Case& c) {
  benchmark::RegisterBenchmark(
      (std::string("layout/") + Layout<B, Material>::name + "/" + c.name).c_str(),
      run_layout<B, Material, Layout>, c);
}

}  // namespace

void register_layouts() {
  for_each_case<TypeList<StVenantKirchhoff, NeoHookean>>(
      []<class B, class Material>(const Case& c) {
        add<Buffered, B, Material>(c);
        add<Coloured, B, Material>(c);
        add<PerVertex, B, Material>(c);
        add<Patched, B, Material>(c);
        add<Atomic, B, Material>(c);
      },
      {small_beam, medium_beam, large_beam});
}

}  // namespace plica::bench
