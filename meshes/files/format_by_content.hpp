// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace plica {

/// Format of a file as its first bytes tell it.
struct KnownContent {
  std::string extension;    ///< extension of the format in the lists; empty: it cannot be read
  std::string description;  ///< name of the format, such as "VTK's XML format"
  std::string advice;       ///< way to a file that can be read, where this one cannot

  /// Returns whether a file of this extension is expected to have this content.
  bool names(const std::string& file_extension) const;
};

/// Returns what the first bytes of a file say; nothing where they fit several formats, or none.
std::optional<KnownContent> known_content(std::string_view bytes);

}  // namespace plica
