// Field reports: inputs that once gave a wrong number, or none, without a word. Each test runs its file with bzm.
#pragma once

#include "tests/bzm/command.hpp"

#include <boltzmann/files/csv.hpp>

namespace boltzmann::test {

/// A scenario of tests/cases/files (or one written by the test) in a folder of its own, beside copies of all data files.
struct Case : Folder {
  /// Uses tests/cases/files/NAME.toml, or `text` if it is not empty.
  explicit Case(std::string const& name, std::string const& text = "") : name_(name + ".toml") {
    fs::path const files = fs::path(BOLTZMANN_SOURCE) / "tests/cases/files";
    for (auto const& file : fs::directory_iterator(files))
      if (file.path().extension() != ".toml") fs::copy(file.path(), *this / file.path().filename().string());
    write_text(*this / name_, text.empty() ? text_of(files / name_) : text);
  }
  /// Runs it on one thread, into the folder "run". `more` are further words of the command line.
  Outcome run(std::vector<std::string> const& more = {}) const {
    std::vector<std::string> words{"run", name_, "--threads", "1", "--out", "run", "--force"};
    words.insert(words.end(), more.begin(), more.end());
    return bzm(words, string());
  }
  /// "bzm check".
  Outcome check() const { return bzm({"check", name_}, string()); }
  /// A column of run/diagnoses.csv.
  std::vector<double> column(std::string const& name) const {
    return read_csv((*this / "run/diagnoses.csv").string()).column(name);
  }

 private:
  std::string name_;
};

}  // namespace boltzmann::test
