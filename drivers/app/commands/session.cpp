// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <Kokkos_Core.hpp>
#include <charconv>
#include <cstdlib>
#include <plica/drivers/app/commands/session.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/scene/describe.hpp>
#include <string_view>

namespace plica::app {

namespace {

constexpr std::chrono::seconds set_up_patience(2);
constexpr std::string_view ours = "plica: ";

SetUpProgress* listener = nullptr;                     // global, as Kokkos calls plain functions
Kokkos::Tools::Experimental::EventSet tools_of_users;  // callbacks of the user's profiling tool

}  // namespace

SetUpProgress::SetUpProgress(bool quiet) : quiet_(quiet) {
  if (!quiet_) thread_ = std::thread([this] { wait(); });
}

SetUpProgress::~SetUpProgress() { finish(); }

double SetUpProgress::finish() {
  const std::chrono::duration<double> since = Clock::now() - start_;
  if (listening_) Kokkos::Tools::Experimental::set_callbacks(tools_of_users), listener = nullptr;
  listening_ = false;
  if (!thread_.joinable()) return since.count();
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  changed_.notify_all();
  thread_.join();
  return since.count();
}

void SetUpProgress::phase(const std::string& name) { enter(name); }

void SetUpProgress::listen() {
  if (quiet_) return;
  listener = this, listening_ = true;
  tools_of_users = Kokkos::Tools::Experimental::get_callbacks();
  Kokkos::Tools::Experimental::set_push_region_callback(begin_region);
  Kokkos::Tools::Experimental::set_pop_region_callback(end_region);
}

void SetUpProgress::begin_region(const char* name) {
  if (tools_of_users.push_region != nullptr) tools_of_users.push_region(name);
  const std::string_view text = name;
  if (listener->depth_++ == 0 && text.starts_with(ours))
    listener->enter(std::string(text.substr(ours.size())));
}

void SetUpProgress::end_region() {
  --listener->depth_;
  if (tools_of_users.pop_region != nullptr) tools_of_users.pop_region();
}

void SetUpProgress::enter(const std::string& name) {
  const std::lock_guard lock(mutex_);
  current_ = name;
  if (late_) say();
}

void SetUpProgress::say() const {
  if (current_.empty()) return;
  const std::chrono::duration<double> since = Clock::now() - start_;
  message(fmt::format("set-up, {:.1f} s: {}", since.count(), current_));
}

void SetUpProgress::wait() {
  std::unique_lock lock(mutex_);
  if (changed_.wait_for(lock, set_up_patience, [this] { return over_; })) return;
  late_ = true;
  say();
}

namespace {

// Throws InputError for a number of threads that Kokkos would abort the process for
void check_thread_count(const std::string& name, const std::string& value) {
  int threads = 0;
  const char* const end = value.data() + value.size();
  const auto [rest, error] = std::from_chars(value.data(), end, threads);
  if (error != std::errc{} || rest != end || threads < 1 || threads > thread_count.max)
    throw InputError(fmt::format("{}: expected a whole number in [1, {}], got '{}'", name,
                                 thread_count.max, value));
}

}  // namespace

KokkosSession::KokkosSession(const KokkosArguments& arguments) {
  constexpr std::string_view option = "--kokkos-num-threads=";
  if (const char* const threads = std::getenv("KOKKOS_NUM_THREADS"))
    check_thread_count("KOKKOS_NUM_THREADS", threads);
  for (const std::string& word : arguments.pass_through)
    if (word.starts_with(option))
      check_thread_count("--kokkos-num-threads", word.substr(option.size()));
  // Prevents Kokkos' warning that OpenMP's threads are not bound. Binding is the user's choice, and
  // here it is too late for it.
  setenv("OMP_PROC_BIND", "false", 0);
  std::vector<std::string> words = {"plica"};
  words.insert(words.end(), arguments.pass_through.begin(), arguments.pass_through.end());
  if (arguments.threads > 0)
    words.push_back("--kokkos-num-threads=" + std::to_string(arguments.threads));
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  int count = static_cast<int>(words.size());
  Kokkos::initialize(count, pointers.data());
}

std::vector<LevelReport> in_input_numbers(std::vector<LevelReport> levels, const Scene& scene) {
  auto numbering = scene.numbering.begin();  // one entry per mesh; coarse spaces have none
  for (LevelReport& level : levels) {
    if (level.tets == 0) continue;
    for (StiffElement& e : level.stiffest) e.element = input_number(numbering->tet_ids, e.element);
    ++numbering;
  }
  return levels;
}

SubstepRefused in_input_numbers(const SubstepRefused& error, const Scene& scene) {
  std::optional<StiffElement> element = error.element;
  const auto& ids = scene.numbering[static_cast<std::size_t>(error.level)].tet_ids;
  if (element) element->element = input_number(ids, element->element);
  return {error.words, error.level, element};
}

Scene loaded(const SceneArguments& arguments, SetUpProgress& progress) {
  progress.phase("reading the scene and its meshes");
  Scene scene = load_scene(arguments.scene, arguments.overrides);
  warn(scene);
  return scene;
}

void warn(const Scene& scene) {
  for (const std::string& warning : scene.warnings)
    message(coloured("warning: ", Colour::yellow) + warning);
}

}  // namespace plica::app
