// What is wrong with a formula, and where.
#pragma once

#include <boltzmann/core/error.hpp>

#include <cstddef>
#include <string>

namespace boltzmann {

/// What is wrong with a formula, and at which of its characters (from 0).
struct FormulaError : Error {
  FormulaError(std::size_t at, std::string const& message) : Error(message), offset(at) {}
  std::size_t offset;
};

}  // namespace boltzmann
