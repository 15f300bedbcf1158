// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/study/sample_gradients.hpp>

namespace plica::test {

const Lame<double> soft = lame_constants(20e3, 0.4);

}  // namespace plica::test
