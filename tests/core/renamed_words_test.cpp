// Words of before: who writes one is told the word of now, where that is one of those allowed.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/renamed_words.hpp>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace boltzmann::renamed_words_test {
namespace {

TEST(RenamedWords, AreToldWhereTheyAreAllowed) {
  for (auto const& [before, now] : renamed_words) {
    std::vector<std::string> const allowed{"something", std::string(now)};
    EXPECT_EQ(did_you_mean(before, allowed), "; it is '" + std::string(now) + "' now");
    EXPECT_EQ(did_you_mean(before, std::vector<std::string>{"something-else-entirely"}), "");
  }
}

TEST(RenamedWords, ThoseOfOtherProgramsAreToldToo) {
  for (auto const& [elsewhere, here] : words_elsewhere)
    EXPECT_EQ(did_you_mean(elsewhere, std::vector<std::string>{std::string(here), "euler"}),
              "; it is called '" + std::string(here) + "' here");
}

}  // namespace
}  // namespace boltzmann::renamed_words_test
