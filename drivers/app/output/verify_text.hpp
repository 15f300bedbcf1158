// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/output/verify_json.hpp>

namespace plica::app {

/// verify.md: one table with all there is to say, and what it was made on.
std::string verify_markdown(const VerifyHead& head, const VerifyResult& result);

/// The same in short, for a terminal; `folder` has the rest.
std::string verify_text(const VerifyResult& result, const std::string& folder);

}  // namespace plica::app
