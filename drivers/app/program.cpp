// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <plica/drivers/app/commands/commands.hpp>
#include <plica/drivers/app/failures.hpp>
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/output/study_choice.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/program.hpp>
#include <plica/drivers/app/reference/reference.hpp>
#include <plica/drivers/app/scene/key_list.hpp>
#include <plica/drivers/app/scene/reader.hpp>

namespace plica::app {
namespace {

// Command line and the arguments that it gives. CLI11 fills the members while it parses.
class CommandLine {
 public:
  CommandLine() {
    app_.require_subcommand(1);
    app_.set_version_flag("--version", version_text);
    app_.failure_message(fault_of_words);
    app_.footer(
        "--kokkos-* is handed to Kokkos. Results go to the standard output, messages to the "
        "standard error.\n"
        "Exit: 0 done, 1 failure, 2 bad input, 3 diverged, 4 no MPI for several processes, 130 "
        "interrupted.");
    add_run();
    add_explain();
    add_scene_command("check", "check the scene, run nothing",
                      [this] { return check(arguments_); });
    add_study();
    add_stability();
    add_verify();
    add_report();
    add_view();
    add_doctor();
    add_mesh();
    add_list();
    add_schema();
    add_completion();
  }

  /// Runs the command. Throws CLI::ParseError for bad words, --help and --version.
  ExitStatus execute(std::vector<std::string> words, Ranks* ranks) {
    arguments_.words = words;
    arguments_.ranks = ranks && ranks->count() > 1 ? ranks : nullptr;
    const auto is_kokkos = [](const std::string& word) { return word.starts_with("--kokkos-"); };
    std::copy_if(words.begin() + 1, words.end(), std::back_inserter(arguments_.kokkos.pass_through),
                 is_kokkos);
    std::erase_if(words, is_kokkos);
    if (words.size() > 1 && words[1] == "help") words[1] = "--help";
    check_command(words);
    // CLI11 takes the words in reverse order
    app_.parse(std::vector<std::string>(words.rbegin(), words.rend() - 1));
    for (const std::string& set : sets_) arguments_.overrides.push_back({set, "--set " + set});
    if (!duration_.empty())
      arguments_.overrides.push_back({"duration=" + duration_, "--duration " + duration_});
    if (app_.got_subcommand("run") && arguments_.scene.empty() && arguments_.resume.empty())
      throw CLI::RequiredError("SCENE, or --resume FOLDER,");
    if (arguments_.ranks && !app_.got_subcommand("run"))
      throw InputError(
          fmt::format("plica {} is one process, and {} were started; expected plica "
                      "run, or one process",
                      app_.get_subcommands().front()->get_name(), arguments_.ranks->count()));
    if (app_.got_subcommand("stability")) check_stability();
    if (!study_folder_.empty())
      for (const Override& chosen :
           settings_of_study(study_folder_, arguments_.scene, arguments_.overrides))
        arguments_.overrides.push_back(chosen);
    return with_ranks(action_, arguments_.ranks);
  }

  /// Prints help, the version, or what was wrong.
  ExitStatus explain_error(const CLI::ParseError& error) {
    return app_.exit(error, std::cout, std::cerr) == 0 ? ExitStatus::done : ExitStatus::bad_input;
  }

 private:
  CLI::App* add(const std::string& name, const std::string& help,
                std::function<ExitStatus()> action) {
    CLI::App* command = app_.add_subcommand(name, help);
    command->footer(manual_of(name));
    command->callback([this, action] { action_ = action; });
    return command;
  }

  /// Returns CLI11's error message. For an unknown option it names the nearest one instead, and for
  /// a missing command all commands.
  static std::string fault_of_words(const CLI::App* app, const CLI::Error& error) {
    const std::vector<std::string> extra = app->remaining(true);
    std::string text = error.what(), command = app->get_name();
    for (; !app->get_subcommands().empty(); command += " " + app->get_name())
      app = app->get_subcommands().front();
    const auto option =
        std::ranges::find_if(extra, [](const std::string& word) { return word.starts_with('-'); });
    const auto commands = app->get_subcommands([](const CLI::App*) { return true; });
    if (option != extra.end()) {
      std::vector<std::string> known;
      for (const CLI::Option* one : app->get_options())
        for (const std::string& name : one->get_lnames()) known.push_back("--" + name);
      const std::string asked = option->substr(0, option->find('='));
      text = std::ranges::find(known, asked) == known.end()
                 ? unknown_name("option", asked, known)
                 : "'" + asked + "' stands before the command; expected it behind: " + command +
                       " " + asked;
    } else if (!commands.empty()) {
      text = "expected a command: ";
      for (const CLI::App* one : commands)
        text += (one == commands.front() ? "" : ", ") + one->get_name();
    }
    return coloured("error: ", Colour::red) + text + "\nsee " + command + " --help\n";
  }

  void check_command(const std::vector<std::string>& words) const {
    const CLI::App* command = &app_;
    for (std::size_t i = 1; i < words.size() && !words[i].starts_with('-'); ++i) {
      std::vector<std::string> known;
      const CLI::App* next = nullptr;
      for (const CLI::App* one : command->get_subcommands([](const CLI::App*) { return true; })) {
        known.push_back(one->get_name());
        if (one->get_name() == words[i]) next = one;
      }
      if (known.empty()) return;
      if (next == nullptr) throw InputError(unknown_name("command", words[i], known));
      command = next;
    }
  }

  CLI::App* add_scene_command(const std::string& name, const std::string& help,
                              std::function<ExitStatus()> action) {
    CLI::App* command = add(name, help, std::move(action));
    command->add_option("SCENE", arguments_.scene, "the scene, a YAML file")
        ->required(name != "run" && name != "stability");
    command->add_option("--set", sets_, "instead of what the scene says; repeatable")
        ->type_name("KEY.PATH=VALUE")
        ->allow_extra_args(false)
        ->take_all();
    command->add_option("--duration", duration_, "simulated time [s], instead of the scene's")
        ->type_name("TIME");
    command->add_option("--precision", arguments_.precision, "float or double (double)")
        ->type_name("WORD")
        ->check(CLI::IsMember(names(precisions())));
    add_threads(command);
    if (name == "explain" || name == "check")
      command->add_flag("--json", arguments_.json, "print JSON");
    return command;
  }

  void add_threads(CLI::App* command) {
    command
        ->add_option("--threads", arguments_.kokkos.threads, "threads to use (all that there are)")
        ->type_name("N")
        ->check(CLI::Range(thread_count.min, thread_count.max));
  }

  void add_explain() {
    CLI::App* command = add_scene_command("explain", "say what a run of the scene would do",
                                          [this] { return explain(arguments_); });
    add_study_option(command);
    command
        ->add_option("--ranks", arguments_.ranks_planned,
                     "say also what each of N ranks would have and send")
        ->type_name("N")
        ->check(CLI::Range(1, 1 << 20));
  }

  void add_run() {
    CLI::App* command = add_scene_command("run", "simulate the scene and write its files",
                                          [this] { return run(arguments_); });
    CLI::Option* folder = add_output(command, "out/SCENE");
    command
        ->add_option("--checkpoint", arguments_.checkpoint,
                     "save a checkpoint to resume from, every N macro steps or every TIME [s] of "
                     "simulated time")
        ->type_name("every=N|TIME");
    CLI::Option* resume = command->add_option(
        "--resume", arguments_.resume, "go on with the run in this folder, from its checkpoint");
    takes_folder(resume)->excludes(folder)->excludes(add_study_option(command));
    command->add_flag("--force", arguments_.force, "replace the run that is in the folder")
        ->excludes(resume);
    command->add_flag("--quiet", arguments_.quiet, "say nothing unless something is wrong");
    command->add_flag("--time-stages", arguments_.time_stages,
                      "time each stage on a GPU too, which slows the run");
  }

  CLI::Option* add_study_option(CLI::App* command) {
    return takes_folder(command->add_option("--study", study_folder_,
                                            "as the study of the scene in this folder chose for "
                                            "integration.error_class, by error and time"));
  }

  CLI::Option* add_output(CLI::App* command, const std::string& otherwise) {
    return takes_folder(command->add_option("-o,--output", arguments_.folder,
                                            "folder for the files (" + otherwise + ")"));
  }

  /// Makes an option take a folder. Refuses an empty text, such as an unset variable of the shell.
  static CLI::Option* takes_folder(CLI::Option* option) {
    return option->type_name("FOLDER")->check([](const std::string& text) {
      return std::string(text.empty() ? "expected a folder, got ''" : "");
    });
  }

  void add_study() {
    CLI::App* command =
        add_scene_command("study", "measure methods' errors against their run times",
                          [this] { return study(arguments_, study_); });
    add_output(command, "out/SCENE");
    command
        ->add_option("--budget", study_.budget,
                     "wall time of all runs [s]; what does not fit is left out and listed, but for "
                     "the reference and "
                     "every level "
                     "alone")
        ->type_name("TIME");
    CLI::Option* space =
        command->add_flag("--space", study_.space,
                          "a second reference on a mesh twice as fine, for the error in space");
    command
        ->add_flag("--truth", study_.truth,
                   "errors against the limit of refined meshes, in space and in time")
        ->excludes(space);
    command->add_flag("--force", arguments_.force, "replace another study that is in the folder");
    command->add_flag("--growth", study_.growth,
                      "the growth of small motions by each cycle, linearised about rest");
    command->add_flag("--quiet", arguments_.quiet, "say nothing unless something is wrong");
  }

  void add_stability() {
    CLI::App* command =
        add_scene_command("stability", "search the largest stable macro step of each method",
                          [this] { return stability(arguments_, stability_); });
    command->add_flag(
        "--matrix", stability_.matrix,
        "no scene: all stiff and extreme cases, each with the outcome that it must have");
    add_output(command, "out/SCENE, out/stability");
    command
        ->add_option("--budget", stability_.budget,
                     "wall time of all runs [s]; what does not fit is left out and listed")
        ->type_name("TIME");
    command->add_flag("--quiet", arguments_.quiet, "say nothing unless something is wrong");
  }

  void check_stability() const {
    if (!stability_.matrix && arguments_.scene.empty())
      throw CLI::RequiredError("SCENE, or --matrix,");
    const bool of_scene =
        !arguments_.scene.empty() || !arguments_.overrides.empty() || !arguments_.precision.empty();
    if (stability_.matrix && of_scene)
      throw InputError(
          "--matrix has its own bodies, in double: leave SCENE, --set, --duration and --precision "
          "out");
  }

  void add_verify() {
    CLI::App* command = add("verify", "solve problems with known answers",
                            [this] { return verify(arguments_, verify_); });
    command->add_option("PROBLEM", verify_.problems, "only these (all)");
    add_output(command, "out/verify");
    command->add_flag("--small", verify_.small, "on coarser meshes, in seconds");
    add_threads(command);
    command->add_flag("--quiet", arguments_.quiet, "say nothing unless something is wrong");
  }

  void add_report() {
    CLI::App* command = add("report", "write a page that shows a run or a study",
                            [this] { return report(report_); });
    command->add_option("FOLDER", report_.folder, "the folder of the run or study")->required();
    command->add_option("--frames", report_.frames, "show at most so many frames, evenly (200)")
        ->type_name("N")
        ->check(CLI::Range(2, 100000));
    command->add_flag("--quiet", report_.quiet, "say nothing unless something is wrong");
  }

  void add_view() {
    CLI::App* command =
        add_scene_command("view", "watch the scene live in a browser, and pull at the body",
                          [this] { return view(arguments_, view_); });
    command->add_option("--port", view_.port, "of the page's address (8642); 0: any free one")
        ->type_name("N")
        ->check(CLI::Range(0, 65535));
    command->add_flag("!--no-browser", view_.browser, "open none, only say the address");
  }

  void add_doctor() {
    CLI::App* command = add("doctor", "say what this machine can do, and check a short run",
                            [this] { return doctor(arguments_.json, arguments_.kokkos); });
    add_threads(command);
    command->add_flag("--json", arguments_.json, "print JSON, in SI units");
  }

  void add_mesh() {
    CLI::App* mesh =
        app_.add_subcommand("mesh", "look at mesh files, convert, repair and make them");
    mesh->require_subcommand(1);
    CLI::App* info = mesh->add_subcommand(
        "info", "what a mesh file holds and how well its tetrahedra are shaped");
    info->add_option("FILE", mesh_.file, "the mesh, or a surface")->required();
    info->add_flag("--json", mesh_.json, "print JSON, in SI units");
    info->add_option("--scale", mesh_.scale, "metres per unit of the file, such as 0.001");
    add_mesh_choices(info, mesh_.read);
    add_weld(info, mesh_.read);
    const auto add = [this, info](const std::string& option, const std::string& key,
                                  const std::string& type_text, const std::string& help) {
      info->add_option_function<std::string>(
          option, [this, key](const std::string& text) { mesh_.material[key] = text; },
          help + ": " + type_text);
    };
    MaterialOptions material;
    list_options(material, add);
    info->callback([this] {
      action_ = [this] {
        mesh_.kokkos = arguments_.kokkos;
        return mesh_info(mesh_);
      };
    });
    add_convert(mesh);
    add_mesh_choices(
        add_making(mesh, "repair", "merge duplicates, drop loose parts, shape slivers better",
                   "a mesh", mesh_repair),
        make_.read);
    CLI::App* fill = add_making(
        mesh, "fill", "make a mesh of a closed surface's inside, or of the labels of an image",
        "a closed surface; or an image of labels (.nrrd, .nii, .nii.gz, .mha, .vtk)", mesh_fill);
    fill->add_option("--size", make_.size, "its edges, such as 2mm")->required();
    add_weld(fill, make_.read);
    fill->add_option(
        "--leave-out", make_.read.leave_out,
        "labels of an image that are no body, beside 0: numbers or names, such as 3,5");
    fill->add_option("--with", make_.with,
                     "of a surface: gmsh fits it; lattice is of cubes over it; left out: Gmsh "
                     "where it is installed")
        ->check(CLI::IsMember({"gmsh", "lattice"}));
    fill->add_option("--time-limit", make_.time_limit, "stop Gmsh after this time (10 min)");
    CLI::App* coarsen = add_making(mesh, "coarsen", "make a coarser lattice mesh over a mesh",
                                   "a mesh", mesh_coarsen);
    coarsen->add_option("--vertices", make_.vertices, "it has at most, and about")->required();
    add_mesh_choices(coarsen, make_.read);
  }

  static void add_mesh_choices(CLI::App* command, ReadArguments& read) {
    command->add_option("--regions", read.regions,
                        "array of the file's cells that numbers the regions; none: no regions");
    command->add_option("--leave-out", read.leave_out,
                        "regions that are no body: names or numbers, such as 0,7");
    command->add_option("--order", read.order,
                        "of second-order tetrahedra: split, in eight; linear, by their corners");
  }

  static void add_weld(CLI::App* command, ReadArguments& read) {
    command->add_option("--weld", read.weld,
                        "points on open edges of a surface at most this part of its box's diagonal "
                        "apart become one (1e-6); 0: they stay");
  }

  CLI::App* add_making(CLI::App* mesh, const std::string& name, const std::string& help,
                       const std::string& in, ExitStatus (*make)(const MakeMeshArguments&)) {
    CLI::App* command = mesh->add_subcommand(name, help);
    command->add_option("FILE", make_.in, in)->required();
    command
        ->add_option("-o,--output", make_.out,
                     "the mesh file to write, in the format of its extension")
        ->required();
    command->add_option("--scale", make_.scale, "metres per unit of FILE, such as 0.001");
    command->callback([this, make] { action_ = [this, make] { return make(make_); }; });
    return command;
  }

  void add_convert(CLI::App* mesh) {
    CLI::App* convert =
        mesh->add_subcommand("convert", "write a mesh or surface in another format");
    convert->add_option("IN", convert_.in, "the file to read")->required();
    convert->add_option("OUT", convert_.out, "the file to write, in the format of its extension")
        ->required();
    convert->add_option("--format", convert_.format, "which one, where the extension has several");
    convert->add_flag("--binary", convert_.binary, "its binary form");
    convert->add_option("--scale", convert_.scale, "all lengths times this, such as 0.001");
    add_mesh_choices(convert, convert_.read);
    add_weld(convert, convert_.read);
    convert->add_option("--merge-duplicates", convert_.merge_duplicates,
                        "a distance, such as 1um, after scaling: vertices this close become one");
    convert->footer("Written are\n" + written_formats_text() +
                    "Of a mesh written as a surface only the boundary is kept.");
    convert->callback([this] { action_ = [this] { return mesh_convert(convert_); }; });
  }

  void add_list() {
    CLI::App* command = add("list", "list what scenes can choose from", [this] {
      if (family_.empty()) return list_families(arguments_.json);
      if (family_ != "reference") return list(family_, arguments_.json);
      return write_reference(app_, arguments_);
    });
    command->add_option("FAMILY", family_, "what to list");
    add_output(command, "out/reference");
    command->add_flag("--json", arguments_.json, "print JSON");
  }

  void add_schema() {
    add("schema", "print the JSON Schema of scenes, for editors", [] {
      std::cout << scene_schema().dump(2) << "\n";
      return ExitStatus::done;
    });
  }

  void add_completion() {
    CLI::App* command = add("completion", "print a script that completes command lines", [this] {
      std::cout << completion_script(app_, shell_);
      return ExitStatus::done;
    });
    command->add_option("SHELL", shell_, "bash or zsh")->required();
  }

  CLI::App app_{
      "Plica: soft-tissue simulation with nonlinear tetrahedral finite elements, contact and "
      "surgical tools",
      "plica"};
  RunArguments arguments_;
  StudyArguments study_;
  StabilityArguments stability_;
  VerifyArguments verify_;
  ReportArguments report_;
  ViewArguments view_;
  std::vector<std::string> sets_;
  std::string duration_, family_, shell_;
  std::filesystem::path study_folder_;  // empty: none
  MeshInfoArguments mesh_;
  ConvertArguments convert_;
  MakeMeshArguments make_;
  std::function<ExitStatus()> action_;
};

ExitStatus execute(const std::vector<std::string>& words, Ranks* ranks) {
  const bool speaks = !ranks || ranks->own() == 0;
  CommandLine command_line;
  const auto command = [&] {
    try {
      return command_line.execute(words, ranks);
    } catch (const CLI::ParseError& error) {
      return speaks ? command_line.explain_error(error) : ExitStatus::bad_input;
    }
  };
  return guarded(command, speaks);
}

}  // namespace

int program(int argc, char** argv, Ranks* ranks) {
  std::signal(SIGXFSZ, SIG_IGN);  // a write beyond the file size limit then fails with an error
  ExitStatus status = execute({argv, argv + argc}, ranks);
  if (!std::cout.flush() && status == ExitStatus::done)
    status = failed("cannot write the standard output", ExitStatus::failed);
  return static_cast<int>(status);
}

}  // namespace plica::app
