// Exact sums over ranks: they are integers, so the order does not matter.
#include <boltzmann/core/team.hpp>
#include <boltzmann/particles/share_sums.hpp>

#include <algorithm>
#include <vector>

namespace boltzmann {

void add_up(std::span<AnyEnsemble const* const> of, std::span<ExactSum> sums) {
  for (auto const* ensemble : of)
    if (ensemble->share() && ensemble->share()->sums) return add_up(*ensemble->share()->sums, sums);
}

void add_up(Team& team, std::span<ExactSum> sums) {
  team.meet(Team::Occasion::gathers);
  std::vector<std::int64_t> digits;
  for (auto& one : sums) {
    auto const own = one.digits();
    digits.insert(digits.end(), own.begin(), own.end());
  }
  team.sum(digits);
  auto at = digits.begin();
  for (auto& one : sums) {
    std::copy_n(at, ExactSum::words, one.digits().begin());
    at += ExactSum::words;
  }
}

}  // namespace boltzmann
