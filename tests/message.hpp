// The line that a call throws, for tests of errors.
#pragma once

#include <boltzmann/core/error.hpp>

#include <string>

namespace boltzmann {

/// What the Thrown that comes out of call() says; "no error" if there is none.
template <class Thrown = Error>
std::string message(auto const& call) {
  try {
    call();
  } catch (Thrown const& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace boltzmann
