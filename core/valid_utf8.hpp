// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// The text with U+FFFD in place of every byte sequence that is not UTF-8 (RFC 3629), as the Unicode standard recommends it
/// (chapter 3.9, "U+FFFD substitution of maximal subparts"). Valid text stays as it is.
std::string valid_utf8(std::string_view text);

/// For names that must stay distinct: each name and its valid form. Where several would become the same, all but the first get
/// a number: "L?ber", "L?ber (2)", with U+FFFD for the question mark.
std::map<std::string, std::string> valid_names(const std::vector<std::string>& names);

}  // namespace plica
