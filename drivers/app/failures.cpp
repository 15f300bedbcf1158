// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <new>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/app/failures.hpp>
#include <plica/drivers/app/output/peak_memory.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/output/write_file.hpp>

namespace plica::app {

ExitStatus failed(const std::string& text, ExitStatus status) {
  message(coloured("error: ", Colour::red) + text);
  return status;
}

ExitStatus guarded(const std::function<ExitStatus()>& work, bool speaks) {
  const auto end = [&](const std::string& text, ExitStatus status) {
    return speaks ? failed(text, status) : status;
  };
  try {
    return work();
  } catch (const LostRank&) {
    throw;
  } catch (const InputError& error) {
    return end(error.what(), ExitStatus::bad_input);
  } catch (const FolderError& error) {
    return end(error.what(), ExitStatus::bad_input);
  } catch (const std::filesystem::filesystem_error& error) {
    return end(error.path1().string() + ": " + error.code().message() +
                   "; expected a place that can be read",
               ExitStatus::bad_input);
  } catch (const std::bad_alloc&) {
    return end("memory ran out, of which the process had " + in_bytes(peak_memory()) +
                   "; expected coarser meshes, or a machine with more",
               ExitStatus::failed);
  } catch (const std::exception& error) {
    return end(error.what(), ExitStatus::failed);
  }
}

ExitStatus with_ranks(const std::function<ExitStatus()>& work, const Ranks* ranks) {
  if (ranks == nullptr) return work();
  const auto lost = [&](const std::exception& error) {
    return LostRank(text("rank ", ranks->own(), ": ", error.what()));
  };
  try {
    return work();
  } catch (const ThrownByAll&) {
    throw;
  } catch (const UnheardFailure& error) {
    throw lost(error);
  } catch (const std::exception& error) {
    if (ranks->own() == 0) throw;
    throw lost(error);
  }
}

}  // namespace plica::app
