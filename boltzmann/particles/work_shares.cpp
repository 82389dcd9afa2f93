// Cuts from measured work, and the messages that gather the results of ranks.
#include <boltzmann/particles/work_shares.hpp>

#include <algorithm>
#include <utility>

namespace boltzmann {

WorkShares::Cuts WorkShares::even(std::size_t items, std::size_t multiple) const {
  Cuts cuts;
  std::size_t const parts = (items + multiple - 1) / multiple;
  for (std::size_t r = 0; r <= ranks(); ++r) cuts.push_back(std::min(items, parts * r / ranks() * multiple));
  return cuts;
}

WorkShares::Cuts WorkShares::balanced(std::size_t items) const {
  if (cuts_.size() != ranks() + 1) return even(items);
  Cuts cuts;
  for (double const cut : cuts_)
    cuts.push_back(std::min(static_cast<std::size_t>(cut * static_cast<double>(items)), items));
  cuts.back() = items;
  return cuts;
}

/// The cuts for equal work, if the work of each part is uniform inside it.
void WorkShares::took(Cuts const& cuts, std::vector<Work> const& work) {
  double all = 0;
  for (Work const& of_rank : work)
    for (auto const part : of_rank) all += static_cast<double>(part);
  if (!(all > 0)) return;
  auto const items = static_cast<double>(cuts.back());
  std::vector<double> next{0};
  double before = 0;
  for (std::size_t r = 0; r < work.size(); ++r) {
    double const begin = static_cast<double>(cuts[r]) / items, end = static_cast<double>(cuts[r + 1]) / items;
    for (std::size_t k = 0; k < parts; ++k) {
      auto const of_part = static_cast<double>(work[r][k]);
      while (next.size() < work.size()) {
        double const wanted = all * static_cast<double>(next.size()) / static_cast<double>(work.size());
        if (wanted > before + of_part) break;
        double const part = static_cast<double>(k) + (of_part > 0 ? (wanted - before) / of_part : 0);
        next.push_back(begin + (end - begin) * part / parts);
      }
      before += of_part;
    }
  }
  next.push_back(1);
  cuts_ = std::move(next);
}

void WorkShares::bring(std::vector<Found> const& arrays) const {
  std::vector<Team::Message> messages;
  auto const part = [](Found const& array, std::size_t r) {
    std::size_t const begin = (*array.cuts)[r], end = (*array.cuts)[r + 1];
    return std::pair(static_cast<char*>(array.first) + begin * array.bytes, (end - begin) * array.bytes);
  };
  for (std::size_t r = 0; r < ranks(); ++r) {
    if (r == rank()) continue;
    for (Found const& array : arrays) {
      auto const [theirs, their_size] = part(array, r);
      auto const [mine, my_size] = part(array, rank());
      messages.push_back({static_cast<int>(r), true, theirs, their_size});
      messages.push_back({static_cast<int>(r), false, mine, my_size});
    }
  }
  team_->meet(Team::Occasion::exchanges);
  team_->exchange(messages);
}

}  // namespace boltzmann
