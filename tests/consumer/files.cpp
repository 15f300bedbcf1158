// SPDX-License-Identifier: BSD-3-Clause
#include <plica/meshes/files/mesh_files.hpp>

int main() {
  const plica::FileBytes file{"m.vtu", ""};
  try {
    plica::read_mesh(file);
  } catch (const plica::InputError&) {
    return 0;
  }
  return 1;
}
