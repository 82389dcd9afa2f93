// Makes a team of processes from the environment.
#include <boltzmann/core/team_functions.h>
#include <boltzmann/core/clock.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/core/launcher.hpp>
#include <boltzmann/core/memory_team.hpp>
#include <boltzmann/core/shared_processors.hpp>
#include <boltzmann/core/team.hpp>

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#if defined(__linux__)
#include <sched.h>
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace boltzmann {
namespace {

namespace fs = std::filesystem;

// Set in the environment of child processes of a rank, which are no ranks. A program that starts runs under a launcher
// sets it, too.
constexpr char const* marker = "BOLTZMANN_ALONE";

thread_local Team* acting = nullptr;
std::atomic<Team*> joined{nullptr};
std::string start_words;
int real_errors = STDERR_FILENO;  // the stream for the last message of a silent rank

std::string environment(char const* name) {
  char const* const value = std::getenv(name);
  return value ? value : "";
}

/// Ranks above 0 print nothing.
void silence() {
  int const nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC), kept = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
  if (nowhere < 0) return;
  std::fflush(nullptr);
  if (kept >= 0) real_errors = kept;
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  close(nowhere);
}

/// Names the processors that this process may use, and the machine.
std::string processors() {
  std::string text(256, '\0');
  if (gethostname(text.data(), text.size()) != 0) text.clear();
#if defined(__linux__)
  cpu_set_t mine;
  if (sched_getaffinity(0, sizeof mine, &mine) == 0) text.append(reinterpret_cast<char const*>(&mine), sizeof mine);
#endif
  return text;
}

double patience() {
  std::string const said = environment("BOLTZMANN_PATIENCE");
  double const seconds = said.empty() ? 600 : std::atof(said.c_str());
  if (!(seconds > 0))
    throw Error(fmt::format("BOLTZMANN_PATIENCE is a number of seconds above 0, not '{}'", boltzmann::quoted(said)));
  return seconds;
}

struct Opened {
  MpiPlugin plugin;
  BoltzmannTeamFunctions const* functions = nullptr;
};

Opened open_plugin() {
  Opened opened;
  opened.plugin.path = find_mpi_plugin();
  if (opened.plugin.path.empty()) return opened;
  // Open MPI's own plug-ins search its symbols in the global namespace.
  void* const library = dlopen(opened.plugin.path.c_str(), RTLD_NOW | RTLD_GLOBAL);
  if (!library) {
    opened.plugin.reason = dlerror();
    return opened;
  }
  auto const table = reinterpret_cast<BoltzmannMpi>(dlsym(library, "boltzmann_mpi"));
  opened.functions = table ? table() : nullptr;
  if (!opened.functions || opened.functions->version != boltzmann_team_version) {
    opened.plugin.reason = "it belongs to another version of Boltzmann";
    opened.functions = nullptr;
    return opened;
  }
  opened.plugin.library = opened.functions->library();
  return opened;
}

void leave_at_exit(int status, void*) {
  int const of_all = joined.load()->end(status);
  if (of_all == status) return;
  std::fflush(nullptr);
  _exit(of_all);
}

[[noreturn]] void refuse(Launched const& told, std::string const& line) {
  if (told.rank > 0) silence();
  throw Error(line);
}

/// Ends this process with a message if `call` exceeds its time limit. A blocking call of a library cannot be
/// interrupted in another way.
template <class Call>
void within(double seconds, std::string const& line, Call const& call) {
  std::mutex mutex;
  std::condition_variable changed;
  bool done = false;
  std::thread watch([&] {
    std::unique_lock lock(mutex);
    if (changed.wait_for(lock, clock_time(std::min(seconds, 1e9)), [&] { return done; })) return;
    tell_last_words(line);
    _exit(1);
  });
  call();
  {
    std::scoped_lock const lock(mutex);
    done = true;
  }
  changed.notify_all();
  watch.join();
}

struct Place {
  int error = 0, rank = 0, size = 1;
};

/// Joins the launched ranks.
Place join_launched(BoltzmannTeamFunctions const& functions, Launched const& told) {
  double const seconds = patience();
  Place place;
  within(
      seconds,
      fmt::format("rank {} has waited {:.3g} s for the other processes of this launch to join; every process must be "
                  "the same program (BOLTZMANN_PATIENCE sets how many seconds a rank waits)",
                  told.rank, seconds),
      [&] { place.error = functions.join(nullptr, &place.rank, &place.size); });
  return place;
}

std::string words_of_start(std::vector<std::string> const& words) {
  std::string text = words.empty() ? "" : fs::path(words[0]).filename().string();
  for (std::size_t k = 1; k < words.size(); ++k) text += " " + words[k];
  return text;
}

std::string different_starts(int rank, std::string const& own, std::string const& other, std::string const& words) {
  return fmt::format("rank {} was started with '{}', {} with '{}'; all ranks need the same command", rank, own, other,
                     words);
}

/// The words of a file in which each word ends with a zero byte.
std::vector<std::string> texts_of(std::string const& path) {
  std::ifstream file(path);
  std::vector<std::string> texts;
  for (std::string text; std::getline(file, text, '\0');) texts.push_back(text);
  return texts;
}

/// The words of other ranks that run this program and have the same parent.
std::vector<std::string> starts_beside() {
  std::error_code ignored;
  auto const program = fs::read_symlink("/proc/self/exe", ignored);
  std::vector<std::string> all;
  for (fs::directory_iterator task(fmt::format("/proc/{}/task", getppid()), ignored), end; task != end;
       task.increment(ignored)) {
    std::ifstream children(task->path() / "children");
    for (long process = 0; children >> process;) {
      std::string const place = fmt::format("/proc/{}", process);
      if (process == getpid() || fs::read_symlink(place + "/exe", ignored) != program) continue;
      auto const variables = texts_of(place + "/environ");
      bool const other_rank = std::any_of(variables.begin(), variables.end(), [](std::string const& variable) {
        auto const equals = variable.find('=');
        std::string const name = variable.substr(0, equals);
        return (name == "OMPI_COMM_WORLD_RANK" || name == "PMI_RANK" || name == "PMIX_RANK" ||
                name == "SLURM_PROCID") &&
               variable.substr(equals + 1) != environment(name.c_str());
      });
      if (auto const words = texts_of(place + "/cmdline"); other_rank && !words.empty())
        all.push_back(words_of_start(words));
    }
  }
  return all;
}

/// Describes how the commands of the ranks differ; empty if they are the same. For all ranks.
std::string different_start(Team& team) {
  auto const all = team.gather(start_words);
  for (std::size_t r = 1; r < all.size(); ++r)
    if (all[r] != all[0]) return different_starts(static_cast<int>(r), all[r], "rank 0", all[0]);
  return "";
}

/// Ranks of one machine exchange messages through shared memory instead of MPI.
void speak_by_memory(Team& team, BoltzmannTeamFunctions const& launched) {
  std::string const said = environment("BOLTZMANN_MESSAGES");
  team.agree([&] {
    if (!said.empty() && said != "memory" && said != "mpi")
      throw Error(fmt::format("BOLTZMANN_MESSAGES is 'memory' or 'mpi', not '{}'", boltzmann::quoted(said)));
  });
  auto memory = std::make_unique<MemoryTeam>(team.rank(), team.size(), launched, nullptr);
  std::array<std::int64_t, 1> open{memory->open(team.gather(said == "mpi" ? "" : memory->address())) ? 1 : 0};
  team.min(open);
  if (open[0] == 1) team.speak_by(MemoryTeam::functions(), memory.release());  // never freed, like the team
}

/// Checks what has to be equal on all ranks, and divides the processors among them.
void settle(Team& team) {
  std::string own;
  team.agree([&] { own = to_string(instruction_set()); });
  auto const sets = team.gather(own);
  for (std::size_t r = 1; r < sets.size(); ++r)
    if (sets[r] != sets[0])
      throw Error(fmt::format(
          "rank {} uses the instructions {}, rank 0 uses {}, which have other bits; set BOLTZMANN_INSTRUCTIONS "
          "to one that all have",
          r, sets[r], sets[0]));
  auto const all = team.gather(processors());
  share_processors(static_cast<int>(std::count(all.begin(), all.end(), all[static_cast<std::size_t>(team.rank())])));
}

Team* join() {
  if (Team* const team = joined) return team;
  Launched const told = launched();
  if (told.size == 1) return new Team;
  LocalRanks::report();
  std::string const several = told.size > 1 ? fmt::format("{} processes", told.size) : "processes";
  Opened const opened = open_plugin();
  if (opened.plugin.path.empty())
    refuse(told, fmt::format("a launcher has started {} of this program, but there is no libboltzmann_mpi.so that "
                             "makes them one run; {}",
                             several, how_to_make_mpi_plugin()));
  if (!opened.functions) refuse(told, fmt::format("'{}' can't be used: {}", opened.plugin.path, opened.plugin.reason));
  auto const [error, rank, size] = join_launched(*opened.functions, told);
  if (error != 0) refuse(told, fmt::format("MPI can't begin (its error {})", error));
  if (told.size > 1 && size != told.size)
    refuse(told, fmt::format("a launcher has started {} of this program, but MPI counts {}: '{}' was compiled with "
                             "another MPI ({}) than that of the launcher",
                             several, size, opened.plugin.path, opened.plugin.library));
  auto* const team = new Team(*opened.functions, nullptr, rank, size);  // never freed: its exit handler runs last
  team->patience(patience());
  if (std::string const line = different_start(*team); !line.empty()) {
    opened.functions->leave(nullptr);
    refuse(told, line);
  }
  joined = team;
  stay_alone();  // for child processes
  on_exit(leave_at_exit, nullptr);
  if (rank > 0) silence();
  speak_by_memory(*team, *opened.functions);
  settle(*team);
  return team;
}

}  // namespace

Team& team() {
  if (acting) return *acting;
  static Team* const of_process = join();
  return *of_process;
}

ActingTeam::ActingTeam(Team& team) : before_(acting) { acting = &team; }
ActingTeam::~ActingTeam() { acting = before_; }

void tell_failure(std::string const& line) {
  Team* const here = acting ? acting : joined.load();
  if (!here || here->tell(line)) fmt::print(stderr, "{}\n", line);
}

void tell_last_words(std::string const& line) { dprintf(real_errors, "%s\n", line.c_str()); }

void Team::give_up(std::string const& line) {
  tell_last_words(line);
  functions_->abort(of_, 1);
  throw TeamFailure(line, 1);
}

Launched launched() {
  if (auto const said = environment(marker); !said.empty() && said != "0") return {};
  for (auto const& [size, rank] : {std::pair("OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"),
                                   {"PMI_SIZE", "PMI_RANK"},
                                   {"SLURM_STEP_NUM_TASKS", "SLURM_PROCID"}})
    if (!environment(size).empty() && !environment(rank).empty())
      return {std::atoi(environment(rank).c_str()), std::max(1, std::atoi(environment(size).c_str()))};
  if (auto const rank = environment("PMIX_RANK"); !rank.empty()) return {std::atoi(rank.c_str()), 0};
  return {};
}

void started_with(int argc, char const* const* argv) { start_words = words_of_start({argv, argv + argc}); }

void compare_start_of_ranks() {
  Launched const told = launched();
  if (told.size == 1) return;
  for (int looks = 0; looks < 10; ++looks) {
    auto const others = starts_beside();
    for (auto const& other : others)
      if (other != start_words) throw Error(different_starts(told.rank, start_words, "another rank", other));
    if (!others.empty()) return;
    std::this_thread::sleep_for(clock_time(0.05));
  }
}

void stay_alone() { setenv(marker, "1", 1); }

std::string find_mpi_plugin() {
  constexpr char const* name = "libboltzmann_mpi.so";
  std::error_code ignored;
  if (std::string const told = environment("BOLTZMANN_MPI"); !told.empty())
    return fs::exists(told, ignored) ? told : "";
  std::vector<fs::path> programs{fs::read_symlink("/proc/self/exe", ignored)}, folders;
  std::string const path = environment("PATH");
  for (std::size_t at = 0; at < path.size();) {
    std::size_t const end = std::min(path.find(':', at), path.size());
    if (auto const bzm = fs::path(path.substr(at, end - at)) / "bzm"; fs::exists(bzm, ignored)) {
      programs.push_back(fs::canonical(bzm, ignored));
      break;
    }
    at = end + 1;
  }
  for (auto const& program : programs) {
    folders.push_back(program.parent_path());
    folders.push_back(program.parent_path().parent_path() / "lib/boltzmann");
  }
  if (std::string const home = environment("HOME"); !home.empty()) folders.emplace_back(home + "/.local/lib/boltzmann");
  folders.emplace_back("/usr/local/lib/boltzmann");
  folders.emplace_back("/usr/lib/boltzmann");
  for (auto const& folder : folders)
    if (fs::exists(folder / name, ignored)) return (folder / name).string();
  return "";
}

MpiPlugin open_mpi_plugin() { return open_plugin().plugin; }

std::string how_to_make_mpi_plugin() {
  return "where mpicc is (Debian: apt install libopenmpi-dev), `make` builds it beside bzm, and so does, with the "
         "files "
         "of share/boltzmann/mpi: mkdir -p ~/.local/lib/boltzmann && mpicc -O2 -shared -fPIC mpi_plugin.c -o "
         "~/.local/lib/boltzmann/libboltzmann_mpi.so";
}

}  // namespace boltzmann
