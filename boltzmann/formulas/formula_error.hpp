// The error in a formula, and its place.
#pragma once

#include <boltzmann/core/error.hpp>

#include <cstddef>
#include <string>
#include <utility>

namespace boltzmann {

/// The error in a formula, and the index of the character (from 0).
struct FormulaError : Error {
  FormulaError(std::size_t at, std::string const& message) : Error(message), offset(at) {}
  std::size_t offset;
};

/// The same for objects with several texts: a law with its parts and parameters, an equation of state.
struct FormulaPartError : FormulaError {
  FormulaPartError(std::string the_part, std::size_t at, std::string const& message)
      : FormulaError(at, message), part(std::move(the_part)) {}
  std::string part;  ///< the name of the text; empty: the law's own text
};

}  // namespace boltzmann
