// bzm: the command line. Parses it, calls a command, and turns every failure into its message and exit status.
#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/bzm/launch.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/core/launcher.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/files/hdf5_file.hpp>
#include <boltzmann/files/standard_streams.hpp>
#include <boltzmann/pictures/picture_options.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/scenario/catalogue_pages.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>

namespace {

using namespace boltzmann;
using namespace boltzmann::bzm;

/// The group of a command in `bzm --help`, and the examples in its own help.
struct CommandHelp {
  char const* name;
  char const* group;
  char const* examples;
};
constexpr CommandHelp command_help[] = {
    {"new", "Start here",
     "  bzm new gas              writes gas.toml, a commented scenario\n"
     "  bzm new dust --law       the same with laws written as formulas"},
    {"check", "Start here",
     "  bzm check gas.toml       lists every mistake with its line\n"
     "  bzm check gas.toml --set run.step=\"2 fs\""},
    {"run", "Start here",
     "  bzm run copper           a shipped scenario; results go to results/copper\n"
     "  bzm run gas.toml --steps 1e4 --set run.step=\"2 fs\"\n"
     "  bzm run gas.toml --vary 'ensembles.0.temperature=[\"80 K\", \"120 K\"]'\n"
     "  bzm run gas.toml --window\n"
     "  bzm run dam-break --ranks 8"},
    {"window", "Start here",
     "  bzm window               the gallery: choose a scenario, change it and run it\n"
     "  bzm window results/copper\n"
     "  bzm window results/copper -o copper.html"},
    {"resume", "Results of runs",
     "  bzm resume results/copper\n"
     "  bzm resume results/copper --steps 5000"},
    {"render", "Results of runs",
     "  bzm render results/copper -o copper.png\n"
     "  bzm render results/copper -o copper.mp4 --fps 30"},
    {"export", "Results of runs",
     "  bzm export results/copper -o copper.xyz\n"
     "  bzm export results/copper -o copper.vtp --frames 10:100:5"},
    {"list", "Reference",
     "  bzm list scenarios\n"
     "  bzm list laws"},
    {"show", "Reference",
     "  bzm show lennard-jones\n"
     "  bzm show influences      the keys of a table"},
    {"accuracy", "Tools", "  bzm accuracy galaxies -o accuracy.png"},
    {"build", "Tools", "  bzm build program.cpp && ./program"},
    {"doctor", "Tools", "  bzm doctor"},
    {"bench", "Tools", "  bzm bench --seconds 20"},
    {"completion", "Tools", "  eval \"$(bzm completion bash)\""}};

constexpr char const* first_steps =
    "First run: bzm run copper. Own scenario: bzm new gas, bzm check gas.toml, bzm run gas.toml.\n"
    "Help of a command with examples: bzm COMMAND --help";

constexpr char const* exit_statuses =
    "Exit status: 0 success; 1 internal error, or a file could not be written during the run; 2 wrong input;\n3 the "
    "physics failed (the message names step, particle and last good checkpoint); 4 wall-clock limit reached\n(--hours; "
    "continue with bzm resume); 130 stopped by Ctrl-C.";

constexpr char const* hours_doc =
    "Wall-clock limit in hours: stop before it, as Ctrl-C does, with status 4 (continue with bzm resume)";

std::string hours_above_zero(std::string const& text) {
  return std::strtod(text.c_str(), nullptr) > 0
             ? ""
             : "'" + text + "' is not a time; hours must be above 0, for example 3.5";
}

std::vector<std::string> command_names(CLI::App const& app) {
  std::vector<std::string> names;
  for (auto const* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(CLI::App const& app) {
  std::vector<std::string> names;
  for (auto const* option : app.get_options())
    for (auto const& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

// Adds an option for each property of a picture.
void picture_words(CLI::App* command, PictureWords& words) {
  for (auto const& option : picture_options()) {
    if (option.key == "file") continue;
    std::string const& key = option.key;
    std::string const names = "--" + key + (key == "colour" ? ",--color" : key == "logarithmic" ? ",--log" : "");
    std::string const doc = plain_text(option.doc);
    if (option.kind.form == OptionKind::Form::flag)
      command->add_flag_callback(
          names, [&words, key] { words.emplace_back(key, "true"); }, doc);
    else
      command->add_option_function<std::string>(
          names, [&words, key](std::string const& text) { words.emplace_back(key, text); }, doc);
  }
}

// The commands and options for shell completion.
std::vector<CommandWords> command_words(CLI::App const& app) {
  std::vector<CommandWords> all;
  for (auto const* command : app.get_subcommands({})) {
    CommandWords words{command->get_name(), command->get_description(), {}, ""};
    for (auto const* option : command->get_options()) {
      if (option->get_positional()) words.argument = option->get_name(true);
      std::string const value = option->get_type_size() == 0 ? "" : option->get_type_name();
      for (auto const& name : option->get_lnames())
        words.options.push_back({"--" + name, option->get_description(), value});
    }
    all.push_back(std::move(words));
  }
  return all;
}

// Checks that the first word is a command. CLI11 would only report an unexpected argument.
void check_command(CLI::App const& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::string const word = argv[1];
  auto const names = command_names(app);
  if (std::find(names.begin(), names.end(), word) != names.end()) return;
  std::string hint = did_you_mean(word, names);
  std::error_code ignored;
  if (std::filesystem::is_regular_file(word, ignored) && word.ends_with(".toml"))
    hint = "; did you mean 'bzm run " + word + "'?";
  else if (word == "help")
    hint = "; did you mean 'bzm --help'?";
  throw Error("unknown command '" + word + "'" + choices_with(hint, names, "bzm has the commands", "bzm --help"));
}

// Explains an unknown option by the most similar known one.
std::string explain(CLI::App const& app, CLI::ParseError const& error, int argc, char** argv) {
  CLI::App const* command = nullptr;
  for (auto const* each : app.get_subcommands({}))
    if (argc > 1 && each->get_name() == argv[1]) command = each;
  auto const known = option_names(command ? *command : app);
  for (int i = 1; i < argc; ++i) {
    std::string const word = argv[i];
    std::string const name = word.substr(0, word.find('='));
    if (name.starts_with("--") && name.size() > 2 && std::find(known.begin(), known.end(), name) == known.end())
      return fmt::format("unknown option '{}'{}{}", name, command ? " of bzm " + command->get_name() : "",
                         choices(name, known, command ? "it has" : "bzm has",
                                 command ? "bzm " + command->get_name() + " --help" : std::string("bzm --help")));
  }
  std::string text = error.what();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return fmt::format("{} (see bzm {}--help)", text, command ? command->get_name() + " " : "");
}

/// Accepts 1e5 as a number of steps, too.
std::string whole_number(std::string& text) {
  double number = 0;
  auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  bool const digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  if (error != std::errc() || end != text.data() + text.size() || !(number >= 0) || number != std::floor(number) ||
      (!digits && number > 9e15) || number > 9.2e18)
    return fmt::format("a whole number, zero or more, is needed (100000 or 1e5), not '{}'", text);
  if (!digits) text = fmt::format("{:.0f}", number);
  return "";
}

/// The commands with their options, and the action of each.
class CommandLine {
 public:
  CommandLine() {
    app_.set_version_flag("--version", std::string("bzm ") + described_version, "Show the version");
    app_.require_subcommand(0, 1);
    app_.footer(exit_statuses);  // commands inherit it
    app_.set_help_flag("-h,--help", help);
    add_new();
    add_check();
    add_run();
    add_window();
    add_resume();
    add_render();
    add_export();
    add_words();
    add_tools();
    app_.footer(std::string(first_steps) + "\n\n" + exit_statuses);
    for (auto const& one : command_help) {
      auto* const sub = app_.get_subcommand(one.name);
      sub->group(one.group);
      sub->footer(std::string("Examples:\n") + one.examples +
                  (sub->get_footer().empty() ? "" : "\n\n" + sub->get_footer()));
    }
  }

  int perform(int argc, char** argv) {
    check_command(app_, argc, argv);
    try {
      app_.parse(argc, argv);
    } catch (CLI::ParseError const& error) {
      if (error.get_exit_code() == 0) return app_.exit(error);
      throw Error(explain(app_, error, argc, argv));
    }
    if (!action_) {
      fmt::print("{}", app_.help());
      return 0;
    }
    if (ranks_.count && !team().alone())
      throw Error("--ranks: a launcher has already started several ranks of this program; leave one of them out");
    if (ranks_.count.value_or(1) > 1) return run_on_ranks(words_without_ranks(argc, argv), ranks_);
    instruction_set();  // report a wrong BOLTZMANN_INSTRUCTIONS once, not for each law of a scenario
    return action_();
  }

 private:
  static constexpr char const* help = "Show this help";

  CLI::App* command(char const* name, char const* doc, std::function<int()> call) {
    auto* sub = app_.add_subcommand(name, doc);
    sub->set_help_flag("-h,--help", help);
    sub->callback([this, call = std::move(call)] { action_ = call; });
    return sub;
  }

  void ranks_options(CLI::App* sub) {
    auto* const count = sub->add_option("--ranks", ranks_.count, "Run on N MPI processes, started by mpirun");
    count->check(CLI::Range(1, 1000000).description(""))->type_name("N");
    sub->add_option("--hosts", ranks_.hosts, "With --ranks: a file with the names of the machines")
        ->type_name("FILE")
        ->needs(count);
  }

  /// The command line for the ranks themselves.
  static std::vector<std::string> words_without_ranks(int argc, char** argv) {
    std::vector<std::string> words;
    for (int i = 1; i < argc; ++i) {
      std::string const word = argv[i];
      if (word == "--ranks" || word == "--hosts")
        ++i;
      else if (!word.starts_with("--ranks=") && !word.starts_with("--hosts="))
        words.push_back(word);
    }
    return words;
  }

  static void window_options(CLI::App* sub, WindowRun& window) {
    sub->add_flag("--window", window.open, "Show the run in a browser page, whose address is printed");
    sub->add_option("--port", window.port, "Port for the web page (default: any free port)")
        ->check(CLI::Range(0, 65535).description(""))
        ->type_name("N");
    sub->add_flag("--play", window.play,
                  "With --window: start immediately; exit after the last step if no browser is connected");
  }
  static void scenario_options(CLI::App* sub, Overrides& overrides) {
    sub->add_option("--set", overrides.set,
                    "Change a value of the scenario, for example --set run.step=\"1 fs\" (repeatable)")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    sub->add_option("--steps", overrides.steps, "Number of steps")
        ->transform(CLI::Validator(whole_number, ""))
        ->type_name("N");
    sub->add_option_function<std::string>(
           "--time", [&overrides](std::string const& time) { overrides.set.push_back("run.time=" + time); },
           "Length of the run instead of a number of steps, for example \"2 ps\"")
        ->type_name("TIME");
    sub->add_option("--seed", overrides.seed, "Seed of all random numbers")
        ->transform(CLI::Validator(whole_number, ""))
        ->type_name("N");
    sub->add_option("--threads", overrides.threads, "Number of threads (default: that of the scenario, or all cores)")
        ->check(CLI::Range(1, 4096).description(""))
        ->type_name("N");
    sub->add_option("--vary", overrides.vary, "One run for each value of a key; if repeated, the keys vary in step")
        ->type_name("KEY=[VALUES]")
        ->allow_extra_args(false);
    sub->add_option("--seeds", overrides.seeds, "One run for each of N seeds; reports means with errors")
        ->check(CLI::Range(1, 10000).description(""))
        ->type_name("N");
    sub->add_flag("--no-sweep", overrides.no_sweep, "Do a single run of a scenario that has a [sweep]");
  }

  void add_new() {
    CLI::App* sub = command("new", "Write a commented scenario to start from", [this] {
      return new_scenario(name_, own_class_ ? NewScenario::of_class
                                 : own_law_ ? NewScenario::of_law
                                            : NewScenario::plain);
    });
    sub->add_option("name", name_, "Name of the scenario; writes NAME.toml in the current folder")->required();
    auto* const of_class = sub->add_flag(
        "--class", own_class_, "Start from a scenario with its own class of particles, with fields and rates");
    sub->add_flag("--law", own_law_, "Start from a scenario with laws written as formulas, between pairs and external")
        ->excludes(of_class);
  }

  void add_check() {
    CLI::App* sub = command("check", "Find all mistakes in a scenario without running it",
                            [this] { return check(name_, overrides_); });
    sub->add_option("scenario", name_, "A file, the name of a shipped scenario, or - for standard input")->required();
    scenario_options(sub, overrides_);
  }

  void add_run() {
    CLI::App* sub = command("run", "Run a scenario; write results to a folder", [this] { return run(run_options_); });
    sub->add_option("scenario", run_options_.scenario,
                    "A file, the name of a shipped scenario (see bzm list), or - for standard input")
        ->required();
    scenario_options(sub, run_options_.overrides);
    sub->add_option("--hours", run_options_.hours, hours_doc)->check(hours_above_zero)->type_name("HOURS");
    sub->add_option("-o,--out", run_options_.out, "Folder for the results (default: results/NAME)")->type_name("DIR");
    sub->add_flag("--quiet", run_options_.quiet, "Print no progress line and no table");
    sub->add_flag("--force", run_options_.force, "Replace an earlier run in the folder");
    window_options(sub, run_options_.window);
    ranks_options(sub);
  }

  void add_resume() {
    CLI::App* sub = command("resume", "Continue a stopped run or sweep from its checkpoint",
                            [this] { return resume(resume_options_); });
    sub->add_option("folder", resume_options_.folder, "Folder of the run or sweep")->required();
    sub->add_option("--steps", resume_options_.steps,
                    "Number of steps from the checkpoint on (default: to the planned end)")
        ->transform(CLI::Validator(whole_number, ""))
        ->type_name("N");
    sub->add_option("--threads", resume_options_.threads,
                    "Number of threads (default: that of the scenario, or all cores)")
        ->check(CLI::Range(1, 4096).description(""))
        ->type_name("N");
    sub->add_option("--hours", resume_options_.hours, hours_doc)->check(hours_above_zero)->type_name("HOURS");
    sub->add_flag("--quiet", resume_options_.quiet, "Print no progress line and no table");
    window_options(sub, resume_options_.window);
    ranks_options(sub);
  }

  void add_window() {
    CLI::App* sub = command("window", "Open the gallery of scenarios in the browser, or replay a stored run",
                            [this] { return window(window_command_); });
    sub->add_option("folder", window_command_.folder, "Folder of a run to replay (default: the gallery of scenarios)");
    auto* const port =
        sub->add_option("--port", window_command_.port, "Port for the web page (default: any free port)");
    port->check(CLI::Range(0, 65535).description(""))->type_name("N");
    PageFile& page = window_command_.page;
    auto* const out = sub->add_option("-o,--out", page.out,
                                      "Write the page with its frames to one .html file that plays without Boltzmann")
                          ->type_name("FILE")
                          ->excludes(port);
    sub->add_option("--view", page.views,
                    "With --out: a view or picture to include, by name (repeatable; default: those of the run)")
        ->type_name("NAME")
        ->allow_extra_args(false)
        ->needs(out);
    sub->add_option("--frames", page.frames, "With --out: largest number of frames, evenly chosen")
        ->transform(CLI::Validator(whole_number, ""))
        ->type_name("N")
        ->capture_default_str()
        ->needs(out);
    sub->add_option("--megabytes", page.megabytes,
                    "With --out: largest size of the file; fewer particles and frames are stored to keep to it")
        ->capture_default_str()
        ->needs(out);
  }

  void add_render() {
    CLI::App* sub = command("render", "Draw a picture or a movie of a run", [this] { return render(render_options_); });
    sub->add_option("folder", render_options_.folder, "Folder of the run")->required();
    sub->add_option("-o,--out", render_options_.out,
                    "picture.png .svg .pdf; movie.mp4 .webm .gif (needs ffmpeg); or frames/ for numbered pictures")
        ->required()
        ->type_name("FILE");
    sub->add_option("--frame", render_options_.frame,
                    "Number of the frame, from 0; negative counts from the end (default: -1, the last)");
    picture_words(sub, render_options_.picture);
    sub->add_option("--fps", render_options_.frames_per_second, "Frames per second of a movie")->capture_default_str();
    sub->add_option("--scale", render_options_.scale, "Size of the picture; 1 is 1200 x 900 pixels")
        ->capture_default_str();
    sub->add_flag("--dark", render_options_.dark, "Draw on a dark background");
  }

  void add_export() {
    CLI::App* sub = command("export", "Write a trajectory for OVITO, VMD, ParaView, ASE, MDAnalysis or a spreadsheet",
                            [this] { return export_run(export_options_); });
    sub->footer(export_help());
    sub->add_option("folder", export_options_.folder, "Folder of the run, or a trajectory.h5")->required();
    sub->add_option("-o,--out", export_options_.out, "File to write; its extension chooses the format")
        ->required()
        ->type_name("FILE");
    sub->add_option("--frames", export_options_.frames,
                    "One frame (7) or from:to:every (10:100:5); from 0, negative counts from the end")
        ->type_name("A:B:C");
    sub->add_option("--ensemble", export_options_.ensembles,
                    "Only these ensembles (repeatable, or separated by commas)")
        ->type_name("NAME")
        ->allow_extra_args(false);
    sub->add_option("--fields", export_options_.fields,
                    "Only these fields besides the position, for example velocity,mass")
        ->type_name("NAMES")
        ->allow_extra_args(false);
    sub->add_option("--species", export_options_.species, "Chemical symbol of an ensemble, for example atoms=Cu")
        ->type_name("NAME=SYMBOL")
        ->allow_extra_args(false);
    sub->add_option(
        "--units", export_options_.units,
        "Units: metal (angstrom, ps, amu, eV, K, e), real, si, cgs, micro, nano, or run for those of trajectory.h5 "
        "(default for .xyz, .dump and .data: metal for atoms, si for larger particles; else run)");
  }

  void add_words() {
    CLI::App* sub =
        command("list", "List scenarios, classes, laws, integrators and other names, each with a description",
                [this] { return list(kind_, names_only_); });
    sub->add_option("kind", kind_, join(listed_kinds()) + " (default: all but units)");
    sub->add_flag("--names", names_only_, "Print only the names, one per line");

    sub = command("show", "Explain a scenario, class, law, loader, integrator, diagnosis, table, key or unit",
                  [this] { return schema_ ? show_schema(name_) : show(name_); });
    sub->add_option("name", name_, "A name that bzm list shows, a key, or a unit");
    sub->add_flag("--schema", schema_, "Print the JSON Schema of scenario files, for editors");
    sub = command("accuracy", "Measure the cost of each multipole tolerance for the particles of a scenario",
                  [this] { return accuracy(accuracy_options_); });
    sub->add_option("scenario", accuracy_options_.scenario,
                    "A file, the name of a shipped scenario, or - for standard input")
        ->required();
    scenario_options(sub, accuracy_options_.overrides);
    sub->add_option("-o,--out", accuracy_options_.out, "Also plot time against error: .png .svg .pdf")
        ->type_name("FILE");
  }

  void add_tools() {
    CLI::App* sub = command("build", "Compile a C++ program that uses Boltzmann, and print the compiler command",
                            [this] { return build(build_options_); });
    sub->add_option("program", build_options_.program, "program.cpp")->required();
    sub->add_option("-o,--out", build_options_.out, "Program to write (default: the source name without .cpp)")
        ->type_name("FILE");
    sub->add_flag("--dry", build_options_.dry, "Print the compiler command without running it");

    sub = command("doctor", "Check the installation: compiler, MPI, disk, and a known result",
                  [this] { return doctor(folder_); });
    sub->add_option("folder", folder_, "Folder for results, whose disk is tested (default: results)");

    sub = command("bench", "Measure the speed of standard problems on this machine",
                  [this] { return bench(bench_options_); });
    sub->add_option("--seconds", bench_options_.seconds, "Total time for all problems")
        ->check(CLI::Range(0.1, 86400.0).description(""))
        ->type_name("SECONDS")
        ->capture_default_str();
    sub->add_option("--threads", bench_options_.threads,
                    "Measure with one thread and with N threads (default: all cores)")
        ->check(CLI::Range(1, 4096).description(""))
        ->type_name("N");
    sub->add_option("--json", bench_options_.json, "Also write the figures to this file")->type_name("FILE");
    ranks_options(sub);

    sub = command("completion", "Print the completion script of a shell, for eval \"$(bzm completion bash)\"",
                  [this] { return completion(shell_, command_words(app_)); });
    sub->add_option("shell", shell_, "Shell: bash, zsh or fish")->capture_default_str();
  }

  CLI::App app_{"Boltzmann: particle simulations from a scenario file or a C++ program.", "bzm"};
  std::function<int()> action_;
  RunOptions run_options_;
  Ranks ranks_;
  ResumeOptions resume_options_;
  WindowCommand window_command_;
  RenderOptions render_options_;
  ExportRun export_options_;
  std::string kind_;
  bool names_only_ = false;
  std::string name_;
  Overrides overrides_;
  bool schema_ = false, own_class_ = false, own_law_ = false;
  AccuracyOptions accuracy_options_;
  BuildOptions build_options_;
  std::string folder_;
  BenchOptions bench_options_;
  std::string shell_ = "bash";
};

}  // namespace

int main(int argc, char** argv) {
  open_standard_streams();
  hdf5::leave_without_words();
  std::signal(SIGXFSZ, SIG_IGN);  // turn a file size limit into an error that can be reported, like a full disk
  std::string const command = argc > 1 ? argv[1] : "";
  bool const by_all = command == "run" || command == "resume" || command == "bench";
  try {
    started_with(argc, argv);
    if (!by_all) {  // these commands run on rank 0 only
      compare_start_of_ranks();
      if (launched().rank > 0) return 0;
      stay_alone();
    }
    team();  // initialises MPI; from here on, ranks above 0 print nothing
    return CommandLine().perform(argc, argv);
  } catch (ScenarioErrors const& errors) {
    tell_failure(join(errors.lines, "\n"));
    return 2;
  } catch (Error const& error) {
    return report(error);
  } catch (PhysicsFailure const& failure) {
    return report(failure);
  } catch (RecordingFailure const& failure) {
    return report(failure);
  } catch (TeamFailure const& failure) {
    return report(failure);
  } catch (std::bad_alloc const&) {
    tell_failure("there is not enough memory for this simulation");
    return 1;
  } catch (std::filesystem::filesystem_error const& error) {  // for example a folder without permission
    tell_failure(fmt::format("'{}': {}", error.path1().string(), error.code().message()));
    return 2;
  } catch (std::exception const& error) {
    tell_failure(fmt::format("internal error: {}", error.what()));
    return 1;
  }
}
