// Checks what may be written where, before anything is written.
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/mesh_frames.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/recording/run_file.hpp>
#include <boltzmann/recording/run_folder.hpp>

#include <unistd.h>

#include <array>
#include <filesystem>

namespace boltzmann {
namespace {

namespace fs = std::filesystem;

std::array<char const*, 5> constexpr result_files{"scenario.toml", run_file, "diagnoses.csv", "trajectory.h5",
                                                  "checkpoint.h5"};

}  // namespace

RunFolder::RunFolder(std::string name, bool overwrite) : name_(std::move(name)), overwrite_(overwrite) {
  while (name_.size() > 1 && name_.back() == '/') name_.pop_back();
  if (name_.empty()) throw Error("the folder of the results has no name");
}

void RunFolder::check() const {
  std::error_code ignored;
  fs::path const place(name_);
  if (fs::exists(place, ignored)) {
    if (!fs::is_directory(place, ignored)) throw Error("the results can't go into '" + name_ + "', which is no folder");
    if (!overwrite_)
      for (auto const* file : result_files)
        if (fs::exists(place / file, ignored))
          throw Error("'" + name_ + "' already holds a run; choose another folder, or replace it with --force");
  }
  // The nearest existing folder must be writable.
  fs::path parent = fs::absolute(place);
  while (!fs::exists(parent, ignored) && parent.has_relative_path()) parent = parent.parent_path();
  if (!fs::is_directory(parent, ignored))
    throw Error("the results can't go into '" + name_ + "': '" + parent.string() + "' is no folder");
  if (access(parent.c_str(), W_OK | X_OK) != 0)
    throw Error("the results can't go into '" + name_ + "': " + reason(errno));
}

void RunFolder::begin(std::span<std::string const> others) {
  std::error_code error;
  made_ = !fs::is_directory(name_, error);
  fs::create_directories(name_, error);
  if (error) throw Error("the folder '" + name_ + "' can't be made: " + error.message());
  lock();
  check();  // another process may have written here since the first check
  remove_results();
  for (auto const& file : others) fs::remove(path(file), error);
}

void RunFolder::undo() {
  unlock();
  remove_results();
  std::error_code ignored;
  if (made_) fs::remove(name_, ignored);
}

void RunFolder::remove_results() const {
  std::error_code ignored;
  for (auto const* file : result_files) fs::remove(path(file), ignored);
  for (auto const* beside : {"checkpoint.h5.previous", "checkpoint.h5.part", "scenario.toml.part", "trajectory.h5.undo",
                             "trajectory.h5md", "trajectory.h5md.part"})
    fs::remove(path(beside), ignored);
  MeshFrames::remove(name_);
}

}  // namespace boltzmann
