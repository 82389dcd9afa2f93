// The commands of bzm: their options, and the exit status that they return (0 done, 1 internal error, 2 wrong input, 3
// the physics failed, 4 out of time, 130 stopped by a signal). Mistakes are thrown as Error and PhysicsFailure.
#pragma once

#include <boltzmann/scenario/overrides.hpp>
#include <boltzmann/scenario/picture_words.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann::bzm {

/// A separate status: a batch script must distinguish a run that needs to be resumed from a finished one.
inline constexpr int out_of_time_status = 4;

/// Options of a run in a window.
struct WindowRun {
  bool open = false;       ///< in a window
  std::uint16_t port = 0;  ///< 0: any free port
  bool play = false;       ///< start immediately, and exit after the last step
};

struct RunOptions {
  std::string scenario;
  Overrides overrides;
  std::optional<double> hours;  ///< of wall time
  std::string out;              ///< empty: results/<name>
  bool quiet = false, force = false;
  WindowRun window;
};
int run(RunOptions const& options);

struct ResumeOptions {
  std::string folder;
  std::optional<std::int64_t> steps;
  std::optional<int> threads;
  std::optional<double> hours;  ///< of wall time
  bool quiet = false;
  WindowRun window;
};
int resume(ResumeOptions const& options);

struct RenderOptions {
  std::string folder, out;
  std::optional<std::int64_t> frame;  ///< counts from 0; negative: from the end
  PictureWords picture;               ///< options of the picture
  bool dark = false;
  int frames_per_second = 25;
  double scale = 1;
};
int render(RenderOptions const& options);

struct ExportRun {
  std::string folder, out;
  std::string frames;                          ///< "a:b:c"; empty: all
  std::vector<std::string> ensembles, fields;  ///< comma-separated or repeated; empty: all
  std::vector<std::string> species;            ///< "ensemble=Cu"
  std::string units;                           ///< empty: the default units of the format
};
int export_run(ExportRun const& options);
/// The list of formats below the options in the help.
std::string export_help();

/// Writes the page of a stored run to a file instead of opening a window.
struct PageFile {
  std::string out;                 ///< empty: open a window
  std::vector<std::string> views;  ///< empty: the views of the run
  std::size_t frames = 100;        ///< maximum
  double megabytes = 8;            ///< maximum
};

struct WindowCommand {
  std::string folder;  ///< of a stored run; empty: the gallery
  std::uint16_t port = 0;
  PageFile page;
};
int window(WindowCommand const& command);

/// `kind`: empty for all kinds of names, or one of listed_kinds() (scenario/catalogue_pages.hpp).
int list(std::string const& kind, bool names_only);
/// Throws Error if there is no such name, or, for the schema, if a name is given.
int show(std::string const& name);
int show_schema(std::string const& name);
int check(std::string const& scenario, Overrides const& overrides);
/// Content of a new scenario: a gas, a class of its own, or laws of its own.
enum class NewScenario { plain, of_class, of_law };
int new_scenario(std::string const& name, NewScenario kind);

struct AccuracyOptions {
  std::string scenario;
  Overrides overrides;
  std::string out;  ///< file of a picture; empty: none
};
/// The cost of a scenario's multipoles against tolerance, and the accuracy reached.
int accuracy(AccuracyOptions const& options);

struct BuildOptions {
  std::string program, out;
  bool dry = false;
};
int build(BuildOptions const& options);

int doctor(std::string const& folder);

struct BenchOptions {
  double seconds = 20;         ///< for all problems together
  std::optional<int> threads;  ///< the largest number to measure [all]
  std::string json;            ///< file for the results; empty: none
};
int bench(BenchOptions const& options);
int bench_on_ranks(BenchOptions const& options);

/// The completions of a command, taken from the parser.
struct CommandWords {
  struct Option {
    std::string name, doc;  ///< "--set"
    std::string value;      ///< "" if it takes none; "DIR", "FILE" or another word
  };
  std::string name, doc;
  std::vector<Option> options;
  std::string
      argument;  ///< kind of the positional argument: "scenario", "folder", "program", "name", ...; "" if there is none
};
/// Prints the completion script of a shell: bash, zsh or fish.
int completion(std::string const& shell, std::vector<CommandWords> const& commands);
std::vector<std::string> const& completion_shells();

/// The version with its commit, from `git describe`. The build generates it (cmake/describe.cmake).
extern char const* const described_version;

}  // namespace boltzmann::bzm
