// SPDX-License-Identifier: BSD-3-Clause
// The pages of the reference are those that the program writes.
#include <gtest/gtest.h>

#include <plica/drivers/app/scene/key_list.hpp>

#include "unit/app/child.hpp"

namespace plica::app::test {
namespace {

constexpr const char* pages[] = {"keys.md", "commands.md", "errors.md", "material_parameters.md",
                                 "support.md"};

TEST(Reference, IsWhatTheProgramWrites) {
  const TemporaryFolder folder;
  const Child child =
      run_child({PLICA_EXECUTABLE, "list", "reference", "-o", folder.path()}, folder);
  ASSERT_EQ(child.status, 0) << child.errors;
  for (const char* page : pages)
    EXPECT_TRUE(content_of(folder / page) ==
                content_of(std::filesystem::path(PLICA_SOURCE_DIR "/cmake/docs/reference") / page))
        << "cmake/docs/reference/" << page
        << " is not what the program writes; write it anew:\n"
           "  build/bin/plica list reference -o cmake/docs/reference";
}

TEST(Reference, HasEveryKey) {
  const std::string page = content_of(PLICA_SOURCE_DIR "/cmake/docs/reference/keys.md");
  for (const KeyInfo& key : scene_keys())
    EXPECT_NE(page.find("| `" + key.path.substr(key.path.rfind('.') + 1) + "` |"),
              std::string::npos)
        << key.path;
}

}  // namespace
}  // namespace plica::app::test
