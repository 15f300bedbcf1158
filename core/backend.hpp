// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Kokkos_Core.hpp>
#include <plica/core/like_device.hpp>

#ifndef PLICA_VECTOR_BYTES
#define PLICA_VECTOR_BYTES 8
#endif

namespace plica {

/// Precision and execution space of the device side. All code that touches the device has this one
/// template parameter.
template <class RealType, class ExecType>
struct Backend {
  using Real = RealType;                       ///< float or double
  using Exec = ExecType;                       ///< a Kokkos execution space
  using Memory = typename Exec::memory_space;  ///< memory space of its fields
  /// True where the host can read `Memory`.
  static constexpr bool on_host = Kokkos::SpaceAccessibility<Kokkos::HostSpace, Memory>::accessible;
  /// True where kernels are shaped for a CPU, on which one thread fills vector registers. On a GPU,
  /// many threads work as a team.
  static constexpr bool for_cpu = on_host && !like_device::on;
  /// Elements per pass of a kernel: a vector register's worth on a CPU, one on a GPU.
  static constexpr int lanes = for_cpu && PLICA_VECTOR_BYTES > static_cast<int>(sizeof(Real))
                                   ? PLICA_VECTOR_BYTES / static_cast<int>(sizeof(Real))
                                   : 1;
};

// The backends that simulations run in. Tests and the program walk this list; another one is one
// more line. PLICA_WITHOUT_FLOAT and PLICA_WITHOUT_SERIAL leave some out: see PLICA_BACKENDS in
// CMakeLists.txt.
#ifdef PLICA_WITHOUT_FLOAT
#define PLICA_IN_PRECISIONS(DO, Exec) DO(double, Exec)
#else
#define PLICA_IN_PRECISIONS(DO, Exec) DO(float, Exec) DO(double, Exec)
#endif
#define PLICA_IN_BOTH(DO, Exec) DO(float, Exec) DO(double, Exec)
#if defined(KOKKOS_ENABLE_SERIAL) && !defined(PLICA_LIKE_DEVICE) && !defined(PLICA_WITHOUT_SERIAL)
#define PLICA_ON_SERIAL(DO) DO(Kokkos::Serial)
#define PLICA_FOR_SERIAL(IN, DO) IN(DO, Kokkos::Serial)
#else
#define PLICA_ON_SERIAL(DO)
#define PLICA_FOR_SERIAL(IN, DO)
#endif
#if defined(KOKKOS_ENABLE_OPENMP)
#define PLICA_ON_OPENMP(DO) DO(Kokkos::OpenMP)
#define PLICA_FOR_OPENMP(IN, DO) IN(DO, Kokkos::OpenMP)
#else
#define PLICA_ON_OPENMP(DO)
#define PLICA_FOR_OPENMP(IN, DO)
#endif
#if defined(KOKKOS_ENABLE_CUDA)
#define PLICA_ON_CUDA(DO) DO(Kokkos::Cuda)
#define PLICA_FOR_CUDA(IN, DO) IN(DO, Kokkos::Cuda)
#else
#define PLICA_ON_CUDA(DO)
#define PLICA_FOR_CUDA(IN, DO)
#endif
#define PLICA_FOR_ALL_SPACES(IN, DO) \
  PLICA_FOR_SERIAL(IN, DO) PLICA_FOR_OPENMP(IN, DO) PLICA_FOR_CUDA(IN, DO)
#define PLICA_FOR_EACH_BACKEND(DO) PLICA_FOR_ALL_SPACES(PLICA_IN_PRECISIONS, DO)
/// List of these, and of float beside each in double: preconditioners of runs in double use float.
#define PLICA_FOR_EACH_PRECISION(DO) PLICA_FOR_ALL_SPACES(PLICA_IN_BOTH, DO)

/// True where simulations run in that precision.
template <class Real>
inline constexpr bool is_built = true;
#ifdef PLICA_WITHOUT_FLOAT
template <>
inline constexpr bool is_built<float> = false;
#endif

/// List of the execution spaces that are built.
#define PLICA_FOR_EACH_SPACE(DO) PLICA_ON_SERIAL(DO) PLICA_ON_OPENMP(DO) PLICA_ON_CUDA(DO)
/// List of the memory spaces in which fields of these execution spaces live, each once.
#if defined(KOKKOS_ENABLE_CUDA)
#define PLICA_FOR_EACH_MEMORY(DO) DO(Kokkos::HostSpace) DO(Kokkos::CudaSpace)
#else
#define PLICA_FOR_EACH_MEMORY(DO) DO(Kokkos::HostSpace)
#endif

/// Rows per slice of a matrix that is stored slice by slice. On a CPU they fill a vector register;
/// on a GPU 32 rows let a warp read whole lines.
template <class B>
inline constexpr int slice_height = B::for_cpu ? B::lanes : 32;

/// Number of vertices of a block. Rows of a block's vertices are sorted among themselves, and block
/// sums do not reach over its ends.
template <class B>
inline constexpr int vertex_block = B::for_cpu ? 512 : 1024;

/// Returns the number of threads of a team. It is one on a CPU, where teams run side by side, and
/// `on_device` on a GPU.
template <class B>
constexpr int team_size(int on_device) {
  return B::for_cpu ? 1 : like_device::team_size<typename B::Exec>(on_device);
}

/// Returns the number of a team in its league.
template <class Member>
KOKKOS_INLINE_FUNCTION int league_rank(const Member& team) {
  return like_device::place(team.league_rank(), team.league_size());
}

/// Returns team scratch memory for `count` numbers, at a level of Kokkos's scratch memory.
template <class Real, class Member>
KOKKOS_INLINE_FUNCTION Real* team_scratch(const Member& team, int level, std::size_t count) {
  Real* const memory =
      static_cast<Real*>(team.team_scratch(level).get_shmem_aligned(count * sizeof(Real), 64));
  like_device::poison(team, memory, count);
  return memory;
}

/// One value per vertex or point.
template <class B>
using Scalars = Kokkos::View<typename B::Real*, Kokkos::LayoutRight, typename B::Memory>;
/// One vector per vertex or point. Vectors lie interleaved (x y z) on every backend.
template <class B>
using Vectors = Kokkos::View<typename B::Real* [3], Kokkos::LayoutRight, typename B::Memory>;
/// Indices of vertices, elements or other items.
template <class B>
using Indices = Kokkos::View<int*, Kokkos::LayoutRight, typename B::Memory>;
/// Numbers that are double in either precision, such as sums.
template <class B>
using Doubles = Kokkos::View<double*, Kokkos::LayoutRight, typename B::Memory>;

}  // namespace plica
