// Words of before: who writes one is told the word of now, where that is one of those allowed.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/renamed_words.hpp>

#include <gtest/gtest.h>

#include <sstream>
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
  for (auto const& [here, elsewhere] : words_elsewhere) {
    std::istringstream words{std::string(elsewhere)};
    for (std::string word; words >> word;)
      EXPECT_EQ(did_you_mean(word, std::vector<std::string>{std::string(here), "euler"}),
                "; it is called '" + std::string(here) + "' here");
  }
  EXPECT_EQ(did_you_mean("NVT", std::vector<std::string>{"nose-hoover"}), "; it is called 'nose-hoover' here");
}

TEST(NearWords, HaveHalfOfTheirLettersInCommonOrBeginAlike) {
  std::vector<std::string> const words{"temperature", "temper", "low", "n", "r", "steps", "Radius"};
  EXPECT_EQ(nearest("temprature", words), "temperature");
  EXPECT_EQ(nearest("tem", words), "temper");  // the shortest
  EXPECT_EQ(nearest("R", words), "r");
  EXPECT_EQ(nearest("rad", words), "Radius");
  EXPECT_EQ(nearest("spets", words), "steps");
  for (char const* far : {"lj", "nvt", "e", "k", "box", "fix"}) EXPECT_EQ(nearest(far, words), "") << far;
}

}  // namespace
}  // namespace boltzmann::renamed_words_test
