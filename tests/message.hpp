// The line that a call throws, for tests of errors.
#pragma once

#include <boltzmann/core/error.hpp>

#include <string>

namespace boltzmann {

/// What the Error thrown by call() says; "no error" if there is none.
std::string message(auto const& call) {
  try {
    call();
  } catch (Error const& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace boltzmann
