// Starts mpirun and stays its parent. mpirun alone would end ranks a second after Ctrl-C, and with another exit status.
#include <boltzmann/bzm/launch.hpp>
#include <boltzmann/bzm/process.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/launcher.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <thread>

namespace boltzmann::bzm {
namespace {

std::string find_launcher() {
  for (auto const* name : {"mpirun", "mpiexec"})
    if (auto const path = find_program(name); !path.empty()) return path;
  return "";
}

std::string first_line_of_version(std::string const& launcher) {
  std::string const text = output_of({launcher, "--version"});
  return text.substr(0, text.find('\n'));
}

/// Converts a wait status to an exit status, as a shell does.
int status_of(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

/// In the child process: it gets its own process group, so that only bzm receives Ctrl-C of the terminal.
[[noreturn]] void become(std::vector<std::string> const& words, sigset_t const& signals) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  sigprocmask(SIG_SETMASK, &signals, nullptr);
  if (isatty(STDIN_FILENO) == 1) {  // only the group of bzm may read from the terminal
    int const nothing = open("/dev/null", O_RDONLY);
    dup2(nothing, STDIN_FILENO);
  }
  std::vector<char*> arguments;
  for (auto const& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execv(arguments[0], arguments.data());
  std::string const line = words[0] + " can't be started: " + std::strerror(errno) + "\n";
  [[maybe_unused]] auto const written = write(STDERR_FILENO, line.data(), line.size());
  _exit(2);
}

/// True if the process is still a rank, and not another process with a reused number.
bool is_rank(int process) {
  std::error_code gone;
  return std::filesystem::read_symlink(fmt::format("/proc/{}/exe", process), gone) == own_path() && !gone;
}

/// A launcher with its ranks. bzm sends signals to the ranks directly: launchers do not forward them reliably, and some
/// end ranks a second later.
struct Launch {
  pid_t launcher;
  bool open_mpi;
  LocalRanks& ranks;
  int signalled = 0;  // number of signals sent

  static void send(std::vector<int> const& to, int number) {
    for (int const rank : to)
      if (is_rank(rank)) kill(rank, number);
  }

  /// The first signal stops the run after its step, the second ends all ranks.
  void pass_on() {
    auto const found = ranks.read_new();
    ++signalled;
    if (signalled > 2) {
      send(ranks.all(), SIGKILL);
      kill(launcher, SIGKILL);
    } else if (signalled == 2) {
      send(ranks.all(), SIGUSR1);
      send(found, SIGKILL);  // a single SIGTERM would not end them
      kill(launcher, SIGTERM);
    } else if (!ranks.all().empty()) {
      send(ranks.all(), SIGUSR1);  // each of them forwards it to ranks on other machines
    } else {
      // Open MPI may forward SIGUSR1. A launcher that receives SIGTERM ends all ranks.
      kill(launcher, open_mpi ? SIGUSR1 : SIGTERM);
    }
  }

  /// Sends the signal also to ranks that have started after it.
  void welcome() {
    auto const found = ranks.read_new();
    if (signalled > 0) send(found, signalled > 1 ? SIGKILL : SIGUSR1);
  }

  int status(int of_launcher) const {
    int const of_all = status_of(of_launcher);
    if (signalled == 0 && of_all > 128)
      fmt::print(stderr, "a rank was ended by signal {} ({}), and the others with it; the last checkpoint is whole\n",
                 of_all - 128, strsignal(of_all - 128));
    return signalled > 1 || (signalled == 1 && of_all > 128) ? 130 : of_all;
  }
};

/// The signals that stop a run. SIGHUP is not among them if nohup ignores it.
sigset_t watched_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (int const number : {SIGINT, SIGTERM, SIGHUP, SIGCHLD}) sigaddset(&signals, number);
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler == SIG_IGN) sigdelset(&signals, SIGHUP);
  return signals;
}

/// Starts the launcher, forwards signals, and returns the exit status.
int start_and_wait(std::vector<std::string> const& line, bool open_mpi) {
  LocalRanks ranks;
  sigset_t const signals = watched_signals();
  sigset_t before;
  sigprocmask(SIG_BLOCK, &signals, &before);
  int const caught = signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
  pid_t const child = caught < 0 ? -1 : fork();
  if (child < 0) throw Error(fmt::format("'{}' can't be started: {}", line[0], std::strerror(errno)));
  if (child == 0) become(line, before);
  Launch launch{child, open_mpi, ranks};
  for (;;) {
    if (int status = 0; waitpid(child, &status, WNOHANG) == child) {
      close(caught);
      sigprocmask(SIG_SETMASK, &before, nullptr);
      return launch.status(status);
    }
    std::array<pollfd, 2> waiting{pollfd{caught, POLLIN, 0}, pollfd{ranks.descriptor(), POLLIN, 0}};
    if (poll(waiting.data(), waiting.size(), -1) < 0 && errno != EINTR) throw Error("no signals can be waited for");
    for (signalfd_siginfo signal; read(caught, &signal, sizeof signal) == sizeof signal;)
      if (signal.ssi_signo != SIGCHLD) launch.pass_on();
    launch.welcome();
  }
}

}  // namespace

std::string launcher_version() {
  auto const launcher = find_launcher();
  return launcher.empty() ? "" : fmt::format("{}: {}", launcher, first_line_of_version(launcher));
}

int run_on_ranks(std::vector<std::string> const& words, Ranks const& ranks) {
  std::string const launcher = find_launcher();
  if (launcher.empty())
    throw Error("--ranks: there is neither mpirun nor mpiexec on the PATH (Debian: apt install openmpi-bin)");
  auto const plugin = open_mpi_plugin();
  if (plugin.path.empty())
    throw Error("--ranks: there is no libboltzmann_mpi.so, by which processes do one run; " + how_to_make_mpi_plugin());
  if (plugin.library.empty()) throw Error(fmt::format("--ranks: '{}' can't be used: {}", plugin.path, plugin.reason));
  if (!ranks.hosts.empty() && !std::filesystem::exists(ranks.hosts))
    throw Error("--hosts: there is no file '" + ranks.hosts + "'");
  std::string const version = first_line_of_version(launcher);
  bool const open_mpi = version.find("Open MPI") != std::string::npos || version.find("OpenRTE") != std::string::npos;
  if (open_mpi && geteuid() == 0 && !std::getenv("OMPI_ALLOW_RUN_AS_ROOT"))
    throw Error(
        "--ranks: Open MPI starts nothing for root unless OMPI_ALLOW_RUN_AS_ROOT=1 and "
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
        "are in the environment");
  setenv("BOLTZMANN_MPI", std::filesystem::absolute(plugin.path).c_str(), 1);
  std::vector<std::string> line{launcher};
  if (open_mpi) {
    // If each rank has a processor of its own, a waiting rank (Team) may keep it busy.
    bool const enough = ranks.hosts.empty() && *ranks.count <= static_cast<int>(std::thread::hardware_concurrency());
    setenv("OMPI_MCA_mpi_yield_when_idle", enough ? "0" : "1", 0);
    // Allow more ranks than processors. Suppress the launcher's reports of exit statuses, because the ranks report
    // them.
    line.insert(line.end(), {"--oversubscribe", "--quiet", "-x", "BOLTZMANN_MPI"});
  }
  if (!ranks.hosts.empty()) line.insert(line.end(), {open_mpi ? "--hostfile" : "-f", ranks.hosts});
  line.insert(line.end(), {"-n", std::to_string(*ranks.count), own_path()});
  line.insert(line.end(), words.begin(), words.end());

  return start_and_wait(line, open_mpi);
}

}  // namespace boltzmann::bzm
