// Running the real bzm as a user would: a process with its own folder, whose output and exit status are seen.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

namespace boltzmann::test {

namespace fs = std::filesystem;

inline std::string text_of(fs::path const& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_text(fs::path const& path, std::string const& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
}

/// A folder that goes away with all that is in it.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "bzm-test-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(Folder const&) = delete;
  Folder& operator=(Folder const&) = delete;
  fs::path operator/(std::string const& name) const { return path_ / name; }
  std::string string() const { return path_.string(); }

 private:
  fs::path path_;
};

struct Outcome {
  int status;  ///< the exit status, or 128 + signal
  std::string out, err;
};

/// A started program.
class Process {
 public:
  /// `words[0]` is the path of the program; it runs in `folder`.
  Process(std::vector<std::string> const& words, std::string const& folder) {
    out_ = folder + "/.stdout-" + std::to_string(count_);
    err_ = folder + "/.stderr-" + std::to_string(count_++);
    std::fflush(nullptr);  // or the child would write it again
    process_ = fork();
    if (process_ != 0) return;
    if (chdir(folder.c_str()) != 0 || !std::freopen(out_.c_str(), "w", stdout) ||
        !std::freopen(err_.c_str(), "w", stderr))
      _exit(126);
    std::vector<char*> arguments;
    for (auto const& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  ~Process() {
    if (!waited_) kill(process_, SIGKILL), wait();
  }
  Process(Process const&) = delete;
  Process& operator=(Process const&) = delete;

  void signal(int number) const { kill(process_, number); }
  bool running() {
    if (waited_) return false;
    if (waitpid(process_, &status_, WNOHANG) == process_) waited_ = true;
    return !waited_;
  }
  /// Waits until `done` says true; false after a minute, or if the program has ended before.
  bool wait_until(std::function<bool()> const& done) {
    for (int i = 0; i < 6000; ++i) {
      if (done()) return true;
      if (!running()) return done();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  Outcome wait() {
    if (!waited_) waitpid(process_, &status_, 0);
    waited_ = true;
    return {WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_), text_of(out_), text_of(err_)};
  }

 private:
  inline static int count_ = 0;
  std::string out_, err_;
  pid_t process_ = 0;
  int status_ = 0;
  bool waited_ = false;
};

inline std::vector<std::string> bzm_words(std::vector<std::string> words) {
  words.insert(words.begin(), std::string(BOLTZMANN_BUILD) + "/bzm");
  return words;
}

inline Outcome bzm(std::vector<std::string> const& words, std::string const& folder) {
  return Process(bzm_words(words), folder).wait();
}

inline std::size_t lines_in(std::string const& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

inline bool has(std::string const& text, std::string const& part) { return text.find(part) != std::string::npos; }

/// Has the scenario that `bzm new gas` writes.
struct GasFolder : Folder {
  GasFolder() { EXPECT_EQ(bzm({"new", "gas"}, string()).status, 0); }
  Outcome run(std::vector<std::string> more) const {
    more.insert(more.begin(), {"run", "gas.toml"});
    return bzm(more, string());
  }
  Outcome shell(std::string const& line) const {
    return Process({"/bin/sh", "-c", "PATH=" BOLTZMANN_BUILD ":$PATH; " + line}, string()).wait();
  }
};

}  // namespace boltzmann::test
