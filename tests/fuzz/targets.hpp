// What is fuzzed: each target takes bytes as they come from outside, and lets Boltzmann read them. What it throws
// besides an Error, or says without a place, is a defect. fuzz_test.cpp tries many in every test run; fuzz_main.cpp is
// for libFuzzer (preset "fuzz").
#pragma once

#include <string>
#include <vector>

namespace boltzmann::fuzz {

struct Target {
  std::string name;
  /// Reads; throws std::logic_error for what should not have happened.
  void (*read)(std::string const& bytes);
  /// Right inputs to begin with.
  std::vector<std::string> (*seeds)();
  /// Words that inputs are made of.
  std::vector<std::string> words;
};

/// "scenario", "formula", "run_file", "message", "particles", "table", "checkpoint", "trajectory".
std::vector<Target> const& targets();
/// Error if there is none of that name.
Target const& target(std::string const& name);

}  // namespace boltzmann::fuzz
