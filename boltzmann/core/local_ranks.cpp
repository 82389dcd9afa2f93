// A pipe of the starting process, which ranks open by its path in /proc.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/launcher.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace boltzmann {
namespace {

constexpr char const* address_variable = "BOLTZMANN_LAUNCHED_BY";

std::atomic<int> early_signals{0};
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void on_early_signal(int) {
  if (early_signals.fetch_add(1) > 0) _exit(130);
}

}  // namespace

std::string where_processes_are_numbered() {
  std::error_code ignored;
  std::string machine;
  std::getline(std::ifstream("/proc/sys/kernel/random/boot_id"), machine);
  return machine + " " + std::filesystem::read_symlink("/proc/self/ns/pid", ignored).string();
}

LocalRanks::LocalRanks() {
  if (pipe(ends_) != 0) throw Error(fmt::format("there is no pipe for the ranks: {}", std::strerror(errno)));
  for (int const end : ends_) {
    fcntl(end, F_SETFD, FD_CLOEXEC);
    fcntl(end, F_SETFL, O_NONBLOCK);
  }
  setenv(address_variable, fmt::format("{} {} {}", getpid(), ends_[1], where_processes_are_numbered()).c_str(), 1);
}

LocalRanks::~LocalRanks() {
  unsetenv(address_variable);
  for (int const end : ends_) close(end);
}

std::vector<int> LocalRanks::read_new() {
  char buffer[4096];
  for (;;) {
    ssize_t const count = read(ends_[0], buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    unfinished_.append(buffer, static_cast<std::size_t>(count));
  }
  std::vector<int> found;
  for (std::size_t end = 0; (end = unfinished_.find('\n')) != std::string::npos; unfinished_.erase(0, end + 1))
    if (int const process = std::atoi(unfinished_.c_str()); process > 1) found.push_back(process);
  all_.insert(all_.end(), found.begin(), found.end());
  return found;
}

void LocalRanks::report() {
  char const* const address = std::getenv(address_variable);
  long process = 0;
  int end = -1;
  if (!address || std::sscanf(address, "%ld %d", &process, &end) != 2 ||
      !std::string_view(address).ends_with(where_processes_are_numbered()))
    return;
  // A signal may come before the run watches signals. By default it would kill the process, or be lost.
  struct sigaction action {};
  action.sa_handler = on_early_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGUSR1, &action, nullptr);
  int const pipe = open(fmt::format("/proc/{}/fd/{}", process, end).c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK);
  if (pipe < 0) return;
  std::string const line = fmt::format("{}\n", getpid());
  [[maybe_unused]] auto const written = write(pipe, line.data(), line.size());  // one write, so that lines do not mix
  close(pipe);
}

int LocalRanks::take_early_signals() { return early_signals.exchange(0); }

}  // namespace boltzmann
