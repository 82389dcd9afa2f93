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

constexpr char const* exit_statuses =
    "Exit status: 0 done; 1 internal error, or a file could not be written during the run; 2 your input is wrong;\n"
    "3 the physics failed (the message names step, particle and the last good checkpoint); 4 out of time (--hours): "
    "bzm\n"
    "resume goes on; 130 stopped by Ctrl-C.";

constexpr char const* hours_doc =
    "of wall time: stops before they are over, as Ctrl-C does, with status 4; bzm resume goes on";

std::string hours_above_zero(std::string const& text) {
  return std::strtod(text.c_str(), nullptr) > 0 ? "" : "'" + text + "' is no time; hours are above 0, for example 3.5";
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
  throw Error("unknown command '" + word + "'" + choices_with(hint, names, "there are", "bzm --help"));
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
  return fmt::format("{} (bzm {}--help tells more)", text, command ? command->get_name() + " " : "");
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
    app_.set_version_flag("--version", std::string("bzm ") + described_version);
    app_.require_subcommand(0, 1);
    app_.footer(exit_statuses);
    app_.set_help_flag("-h,--help", help);
    add_run();
    add_resume();
    add_window();
    add_render();
    add_export();
    add_words();
    add_tools();
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
      throw Error("--ranks: a launcher has started several ranks of this already; leave one of them out");
    if (ranks_.count.value_or(1) > 1) return run_on_ranks(words_without_ranks(argc, argv), ranks_);
    instruction_set();  // report a wrong BOLTZMANN_INSTRUCTIONS once, not for each law of a scenario
    return action_();
  }

 private:
  static constexpr char const* help = "say what can be said, and stop";

  CLI::App* command(char const* name, char const* doc, std::function<int()> call) {
    auto* sub = app_.add_subcommand(name, doc);
    sub->set_help_flag("-h,--help", help);
    sub->callback([this, call = std::move(call)] { action_ = call; });
    return sub;
  }

  void ranks_options(CLI::App* sub) {
    auto* const count = sub->add_option("--ranks", ranks_.count, "so many processes do it together, by mpirun");
    count->check(CLI::Range(1, 1000000));
    sub->add_option("--hosts", ranks_.hosts, "with --ranks: a file that says on which machines")
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
    sub->add_flag("--window", window.open, "in a window: prints the address of a page to watch and steer it");
    sub->add_option("--port", window.port, "of the window's page [a free one]")->check(CLI::Range(0, 65535));
    sub->add_flag("--play", window.play, "with --window: begin at once, and end with the last step if nobody looks");
  }
  static void scenario_options(CLI::App* sub, Overrides& overrides) {
    sub->add_option("--set", overrides.set, "change the scenario: key.path=value (may be given again)")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    sub->add_option("--steps", overrides.steps, "number of steps")->transform(CLI::Validator(whole_number, "N"));
    sub->add_option_function<std::string>(
           "--time", [&overrides](std::string const& time) { overrides.set.push_back("run.time=" + time); },
           "instead of steps: how long, \"2 ps\"")
        ->type_name("TIME");
    sub->add_option("--seed", overrides.seed, "seed of all random numbers")
        ->transform(CLI::Validator(whole_number, "N"));
    sub->add_option("--threads", overrides.threads, "number of threads")->check(CLI::Range(1, 4096));
    sub->add_option("--vary", overrides.vary,
                    "one run for each value of a key; given again, another key goes along with it")
        ->type_name("KEY=[VALUES]")
        ->allow_extra_args(false);
    sub->add_option("--seeds", overrides.seeds, "one run for each of so many seeds, and means with their errors")
        ->check(CLI::Range(1, 10000));
    sub->add_flag("--no-sweep", overrides.no_sweep, "one run of a scenario that has a [sweep]");
  }

  void add_run() {
    CLI::App* sub = command("run", "run a scenario; results go into a folder", [this] { return run(run_options_); });
    sub->add_option("scenario", run_options_.scenario,
                    "a file, the name of a shipped scenario (bzm list), or -: standard input")
        ->required();
    scenario_options(sub, run_options_.overrides);
    sub->add_option("--hours", run_options_.hours, hours_doc)->check(hours_above_zero);
    sub->add_option("-o,--out", run_options_.out, "folder for the results [results/<name>]")->type_name("DIR");
    sub->add_flag("--quiet", run_options_.quiet, "no progress line and no table");
    sub->add_flag("--force", run_options_.force, "replace a run that is in the folder");
    window_options(sub, run_options_.window);
    ranks_options(sub);
  }

  void add_resume() {
    CLI::App* sub = command("resume", "go on with a run or a sweep from where it was stopped",
                            [this] { return resume(resume_options_); });
    sub->add_option("folder", resume_options_.folder, "the folder of the run or sweep")->required();
    sub->add_option("--steps", resume_options_.steps, "so many steps from the checkpoint on [to the planned end]")
        ->transform(CLI::Validator(whole_number, "N"));
    sub->add_option("--threads", resume_options_.threads, "number of threads")->check(CLI::Range(1, 4096));
    sub->add_option("--hours", resume_options_.hours, hours_doc)->check(hours_above_zero);
    sub->add_flag("--quiet", resume_options_.quiet, "no progress line and no table");
    window_options(sub, resume_options_.window);
    ranks_options(sub);
  }

  void add_window() {
    CLI::App* sub =
        command("window", "watch a stored run on a page; without a folder: choose a scenario, change it and run it",
                [this] { return window(window_command_); });
    sub->add_option("folder", window_command_.folder, "the folder of a run [none: the gallery of scenarios]");
    auto* const port = sub->add_option("--port", window_command_.port, "of the page [a free one]");
    port->check(CLI::Range(0, 65535));
    PageFile& page = window_command_.page;
    auto* const out =
        sub->add_option("-o,--out", page.out, "write the page with its frames into an .html file that plays anywhere")
            ->type_name("FILE")
            ->excludes(port);
    sub->add_option("--view", page.views, "in the file: a view or picture, by name (may be given again) [the run's]")
        ->type_name("NAME")
        ->allow_extra_args(false)
        ->needs(out);
    sub->add_option("--frames", page.frames, "in the file: so many at most, evenly chosen")
        ->transform(CLI::Validator(whole_number, "N"))
        ->capture_default_str()
        ->needs(out);
    sub->add_option("--megabytes", page.megabytes, "of the file at most: else fewer particles and frames")
        ->capture_default_str()
        ->needs(out);
  }

  void add_render() {
    CLI::App* sub = command("render", "draw a picture or a movie of a run", [this] { return render(render_options_); });
    sub->add_option("folder", render_options_.folder, "the folder of the run")->required();
    sub->add_option("-o,--out", render_options_.out,
                    "picture.png .svg .pdf; movie.mp4 .webm .gif (needs ffmpeg); frames/ for numbered pictures")
        ->required()
        ->type_name("FILE");
    sub->add_option("--frame", render_options_.frame, "number of the frame, from 0; negative: from the end [-1]");
    picture_words(sub, render_options_.picture);
    sub->add_option("--fps", render_options_.frames_per_second, "frames per second of a movie")->capture_default_str();
    sub->add_option("--scale", render_options_.scale, "1: 1200 x 900 pixels")->capture_default_str();
    sub->add_flag("--dark", render_options_.dark, "light on dark");
  }

  void add_export() {
    CLI::App* sub =
        command("export", "write a run's trajectory for OVITO, VMD, ParaView, ASE, MDAnalysis or a spreadsheet",
                [this] { return export_run(export_options_); });
    sub->footer(export_help());
    sub->add_option("folder", export_options_.folder, "the folder of the run, or a trajectory.h5")->required();
    sub->add_option("-o,--out", export_options_.out, "the file; its ending says what it is")
        ->required()
        ->type_name("FILE");
    sub->add_option("--frames", export_options_.frames,
                    "one, 7, or from:to:every, 10:100:5; from 0, negative: from the end")
        ->type_name("A:B:C");
    sub->add_option("--ensemble", export_options_.ensembles, "only these (may be given again, or with commas)")
        ->type_name("NAME")
        ->allow_extra_args(false);
    sub->add_option("--fields", export_options_.fields, "only these, beside the position: velocity,mass")
        ->type_name("NAMES")
        ->allow_extra_args(false);
    sub->add_option("--species", export_options_.species, "what stands for the particles of an ensemble: atoms=Cu")
        ->type_name("NAME=SYMBOL")
        ->allow_extra_args(false);
    sub->add_option("--units", export_options_.units,
                    "metal (angstrom, ps, amu, eV, K, e), real, si, cgs, micro, nano, or run: those of trajectory.h5 "
                    "[.xyz, .dump, .data: metal for atoms, si for larger things; else run]");
  }

  void add_words() {
    CLI::App* sub =
        command("list", "list the names there are, each with a line", [this] { return list(kind_, names_only_); });
    sub->add_option("kind", kind_, join(listed_kinds()) + " [all but units]");
    sub->add_flag("--names", names_only_, "only the names, one a line");

    sub = command("show", "explain a scenario, class, law, loader, integrator, diagnosis, table or unit",
                  [this] { return schema_ ? show_schema(name_) : show(name_); });
    sub->add_option("name", name_, "a word that bzm list shows, or a unit");
    sub->add_flag("--schema", schema_, "the JSON Schema of scenario files, for editors");
    sub = command("check", "find all mistakes of a scenario, and run nothing",
                  [this] { return check(name_, overrides_); });
    sub->add_option("scenario", name_, "a file, the name of a shipped scenario, or -: standard input")->required();
    scenario_options(sub, overrides_);
    sub = command("accuracy", "what each tolerance of multipoles costs, for the particles of a scenario",
                  [this] { return accuracy(accuracy_options_); });
    sub->add_option("scenario", accuracy_options_.scenario,
                    "a file, the name of a shipped scenario, or -: standard input")
        ->required();
    scenario_options(sub, accuracy_options_.overrides);
    sub->add_option("-o,--out", accuracy_options_.out, "draw seconds over errors: .png .svg .pdf")->type_name("FILE");
    sub = command("new", "write a commented scenario to start from", [this] {
      return new_scenario(name_, own_class_ ? NewScenario::of_class
                                 : own_law_ ? NewScenario::of_law
                                            : NewScenario::plain);
    });
    sub->add_option("name", name_, "the scenario's name; NAME.toml is written here")->required();
    auto* const of_class =
        sub->add_flag("--class", own_class_, "one that derives a class of its own, with fields and rates");
    sub->add_flag("--law", own_law_, "one whose laws are typed, between pairs and from outside")->excludes(of_class);
  }

  void add_tools() {
    CLI::App* sub = command("build", "compile a C++ program with the right compiler line, and show the line",
                            [this] { return build(build_options_); });
    sub->add_option("program", build_options_.program, "program.cpp")->required();
    sub->add_option("-o,--out", build_options_.out, "the program to write [without .cpp]")->type_name("FILE");
    sub->add_flag("--dry", build_options_.dry, "show the line only");

    sub = command("doctor", "look at this machine and compute a known answer", [this] { return doctor(folder_); });
    sub->add_option("folder", folder_, "where results will go [results]");

    sub = command("bench", "how fast are some standard problems on this machine?",
                  [this] { return bench(bench_options_); });
    sub->add_option("--seconds", bench_options_.seconds, "time for all of them together")
        ->check(CLI::Range(0.1, 86400.0))
        ->capture_default_str();
    sub->add_option("--threads", bench_options_.threads, "each runs on one thread and on so many [all]")
        ->check(CLI::Range(1, 4096));
    sub->add_option("--json", bench_options_.json, "write the figures into this file too")->type_name("FILE");
    ranks_options(sub);

    sub = command("completion", "print the completion script of a shell: eval \"$(bzm completion bash)\"",
                  [this] { return completion(shell_, command_words(app_)); });
    sub->add_option("shell", shell_, "bash, zsh or fish")->capture_default_str();
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
