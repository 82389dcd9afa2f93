// What is wrong with a formula, and where.
#pragma once

#include <boltzmann/core/error.hpp>

#include <cstddef>
#include <string>
#include <utility>

namespace boltzmann {

/// What is wrong with a formula, and at which of its characters (from 0).
struct FormulaError : Error {
  FormulaError(std::size_t at, std::string const& message) : Error(message), offset(at) {}
  std::size_t offset;
};

/// The same where several texts make one thing: a law with its parts and parameters, an equation of state.
struct FormulaPartError : FormulaError {
  FormulaPartError(std::string the_part, std::size_t at, std::string const& message)
      : FormulaError(at, message), part(std::move(the_part)) {}
  std::string part;  ///< which of them, by its name; empty: the law's own text
};

}  // namespace boltzmann
