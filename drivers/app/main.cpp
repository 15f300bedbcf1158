// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/app/launch.hpp>
#include <plica/drivers/run/wait_passively.hpp>

int main(int argc, char** argv) {
  plica::wait_passively(argv);
  return plica::app::launch(argc, argv);
}
