// Other programs: found on the PATH, run without a shell.
#pragma once

#include <string>
#include <vector>

namespace boltzmann::bzm {

/// The full path of a program on the PATH; "" if there is none.
std::string find_program(std::string const& name);

/// Runs a program and waits for it. Returns its exit status (128 + signal if a signal ended it). Throws Error if it
/// can't be started.
int run_program(std::vector<std::string> const& words);

/// The same; standard error is stored in `errors` and not printed.
int run_program(std::vector<std::string> const& words, std::string& errors);

/// Runs a program and returns its standard output, or "" if it fails.
std::string output_of(std::vector<std::string> const& words);

/// Joins the words to a line that a shell parses into the same words.
std::string shell_line(std::vector<std::string> const& words);

/// The path of the running executable.
std::string own_path();

}  // namespace boltzmann::bzm
