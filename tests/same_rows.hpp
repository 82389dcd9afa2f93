// Whether two ensembles hold the same particles, to the last bit of all fields.
#pragma once

#include <boltzmann/particles/ensemble.hpp>

#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace boltzmann {

inline void expect_same_rows(AnyEnsemble const& a, AnyEnsemble const& b, std::string const& what = "") {
  ASSERT_EQ(a.size(), b.size()) << what;
  ASSERT_EQ(a.doubles(), b.doubles()) << what;
  for (std::size_t i = 0; i < a.size(); ++i)
    ASSERT_EQ(std::memcmp(a.row(i), b.row(i), a.doubles() * sizeof(double)), 0)
        << what << ", row " << i << " of '" << a.name() << "'";
}

}  // namespace boltzmann
