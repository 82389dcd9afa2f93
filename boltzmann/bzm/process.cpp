// Starts programs with posix_spawn, and quotes words for a shell.
#include <boltzmann/bzm/process.hpp>
#include <boltzmann/core/error.hpp>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>

extern "C" char** environ;

namespace boltzmann::bzm {
namespace {

pid_t spawn(std::vector<std::string> const& words, posix_spawn_file_actions_t const* actions) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (auto const& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_t process = 0;
  if (int const error = posix_spawnp(&process, words[0].c_str(), actions, nullptr, arguments.data(), environ))
    throw Error("'" + words[0] + "' can't be started: " + std::strerror(error));
  return process;
}

int wait_for(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) continue;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Runs a program and calls `heard` with each piece that it writes to this descriptor. If that is standard output,
/// standard error is discarded.
template <class Heard>
int run_heard(std::vector<std::string> const& words, int descriptor, Heard const& heard) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw Error(std::string("no pipe: ") + std::strerror(errno));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], descriptor);
  if (descriptor == STDOUT_FILENO) posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t process = 0;
  try {
    process = spawn(words, &actions);
  } catch (Error const&) {
    posix_spawn_file_actions_destroy(&actions);
    close(ends[0]), close(ends[1]);
    throw;
  }
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  std::array<char, 4096> buffer{};
  for (ssize_t count = 0; (count = read(ends[0], buffer.data(), buffer.size())) != 0;) {
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) break;
    heard(std::string_view(buffer.data(), static_cast<std::size_t>(count)));
  }
  close(ends[0]);
  return wait_for(process);
}

}  // namespace

std::string find_program(std::string const& name) {
  if (name.find('/') != std::string::npos) return access(name.c_str(), X_OK) == 0 ? name : "";
  char const* list = std::getenv("PATH");
  std::string const path = list ? list : "/usr/bin:/bin";
  for (std::size_t at = 0; at <= path.size();) {
    std::size_t const end = std::min(path.find(':', at), path.size());
    auto const file = std::filesystem::path(path.substr(at, end - at)) / name;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0) return file.string();
    at = end + 1;
  }
  return "";
}

int run_program(std::vector<std::string> const& words) { return wait_for(spawn(words, nullptr)); }

int run_program(std::vector<std::string> const& words, std::string& errors) {
  return run_heard(words, STDERR_FILENO, [&](std::string_view piece) { errors += piece; });
}

std::string output_of(std::vector<std::string> const& words) {
  std::string text;
  try {
    return run_heard(words, STDOUT_FILENO, [&](std::string_view piece) { text += piece; }) == 0 ? text : "";
  } catch (Error const&) {
    return "";
  }
}

std::string shell_line(std::vector<std::string> const& words) {
  std::string line;
  for (auto const& word : words) {
    if (!line.empty()) line += ' ';
    bool const plain = !word.empty() && word.find_first_not_of(
                                            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                            "0123456789_-+=/.,:@%") == std::string::npos;
    if (plain) {
      line += word;
      continue;
    }
    line += '\'';
    for (char const c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

std::string own_path() {
  std::error_code error;
  auto const path = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? "" : path.string();
}

}  // namespace boltzmann::bzm
