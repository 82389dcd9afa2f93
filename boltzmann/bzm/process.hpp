// Other programs: found on the PATH, run without a shell.
#pragma once

#include <string>
#include <vector>

namespace boltzmann::bzm {

/// The full path of a program on the PATH; "" if there is none.
std::string find_program(std::string const& name);

/// Runs a program and waits for it. Gives its exit status (128 + signal if one ended it). Error if it can't be started.
int run_program(std::vector<std::string> const& words);

/// The same; what it writes to standard error goes into `errors` alone.
int run_program(std::vector<std::string> const& words, std::string& errors);

/// The same; gives what it writes to standard output, or "" if it fails.
std::string output_of(std::vector<std::string> const& words);

/// The words as a line that a shell would read the same way.
std::string shell_line(std::vector<std::string> const& words);

/// The path of this very program.
std::string own_path();

}  // namespace boltzmann::bzm
