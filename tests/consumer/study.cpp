// SPDX-License-Identifier: BSD-3-Clause
// A program outside Plica that links plica::study: the names of the problems with known answers.
#include <iostream>
#include <plica/drivers/study/verify.hpp>

int main() {
  for (const plica::Choice& problem : plica::verify_problems()) std::cout << problem.name << '\n';
}
