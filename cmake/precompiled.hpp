// SPDX-License-Identifier: BSD-3-Clause
// What most sources include, compiled once per target: the parsing of Kokkos and Eigen was most of
// a build's time. No source relies on it: every header is also compiled alone, without it
// (compile.headers).
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Kokkos_Core.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <variant>
#include <vector>
