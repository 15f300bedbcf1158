// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The program's benchmarks, each family in its file.
namespace plica::bench {

void register_limits();   ///< limit/...: bandwidth and arithmetic of the machine
void register_kernels();  ///< force/, tangent/<material>/<precision>/<tets>
/// explicit_step/, implicit_step/, assembly/, block_product/, cg_iteration/<material>/...
void register_steps();
void register_levels();   ///< transfer/, contact/, cycle/, set_up/
void register_growth();   ///< growth/<element>/<tets>: an explicit step, in double
void register_ranks();    ///< ranks/<element>/<tets>/<ranks>: plans of large bodies
void register_scale();    ///< scale/<steps>/<precision>/<tets>: macro steps, larger on a device
void register_layouts();  ///< layout/<layout>/<material>/<precision>/<tets>: in plica_bench_layouts

}  // namespace plica::bench
