// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/app/program.hpp>

int main(int argc, char** argv) { return plica::app::program(argc, argv); }
