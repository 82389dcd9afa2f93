// The commands of bzm: what each is told, and the exit status that it gives (0 done, 1 internal error, 2 wrong input,
// 3 the physics failed, 4 out of time, 130 stopped by a signal). Mistakes are thrown as Error and PhysicsFailure.
#pragma once

#include <boltzmann/scenario/overrides.hpp>
#include <boltzmann/scenario/picture_words.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann::bzm {

/// A status of its own: a script that has to submit the rest of a run must tell it from a run that is done.
inline constexpr int out_of_time_status = 4;

/// How a run is looked at.
struct WindowRun {
  bool open = false;       ///< in a window
  std::uint16_t port = 0;  ///< 0: a free one
  bool play = false;       ///< begins at once, and ends by itself
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
  PictureWords picture;               ///< what is said of it
  bool dark = false;
  int frames_per_second = 25;
  double scale = 1;
};
int render(RenderOptions const& options);

struct ExportRun {
  std::string folder, out;
  std::string frames;                          ///< "a:b:c"; empty: all
  std::vector<std::string> ensembles, fields;  ///< with commas or several; empty: all
  std::vector<std::string> species;            ///< "ensemble=Cu"
  std::string units;                           ///< empty: those of the format
};
int export_run(ExportRun const& options);
/// What stands below the options in its help: the formats.
std::string export_help();

/// The page of a stored run as a file, in place of a window.
struct PageFile {
  std::string out;                 ///< empty: none
  std::vector<std::string> views;  ///< empty: those of the run
  std::size_t frames = 100;        ///< at most
  double megabytes = 8;            ///< at most
};

struct WindowCommand {
  std::string folder;  ///< of a stored run; empty: the gallery
  std::uint16_t port = 0;
  PageFile page;
};
int window(WindowCommand const& command);

/// `kind` empty: all kinds of names; or one of listed_kinds() (scenario/catalogue_pages.hpp).
int list(std::string const& kind, bool names_only);
/// Error if there is no name, or, of the schema, if there is one.
int show(std::string const& name);
int show_schema(std::string const& name);
int check(std::string const& scenario, Overrides const& overrides);
/// What it shows: a gas, a class of its own, or laws of its own.
enum class NewScenario { plain, of_class, of_law };
int new_scenario(std::string const& name, NewScenario kind);

struct AccuracyOptions {
  std::string scenario;
  Overrides overrides;
  std::string out;  ///< a picture; empty: none
};
/// What the tolerances of a scenario's multipoles cost, and reach.
int accuracy(AccuracyOptions const& options);

struct BuildOptions {
  std::string program, out;
  bool dry = false;
};
int build(BuildOptions const& options);

int doctor(std::string const& folder);

struct BenchOptions {
  double seconds = 20;         ///< for all problems together
  std::optional<int> threads;  ///< the most that are tried [all]
  std::string json;            ///< a file for the figures; empty: none
};
int bench(BenchOptions const& options);
int bench_on_ranks(BenchOptions const& options);

/// What a shell completes of a command; from the parser.
struct CommandWords {
  struct Option {
    std::string name, doc;  ///< "--set"
    std::string value;      ///< "" if it takes none; "DIR", "FILE" or another word
  };
  std::string name, doc;
  std::vector<Option> options;
  std::string
      argument;  ///< what stands behind the command: "scenario", "folder", "program", "name", ...; "" if nothing
};
/// Prints the completion script of a shell: bash, zsh or fish.
int completion(std::string const& shell, std::vector<CommandWords> const& commands);
std::vector<std::string> const& completion_shells();

/// The version with its commit, as `git describe` says it; made by the build (cmake/describe.cmake).
extern char const* const described_version;

}  // namespace boltzmann::bzm
