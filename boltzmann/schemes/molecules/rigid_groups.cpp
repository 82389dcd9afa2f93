// Stores each group as a tree of bonds, so that it can be assembled across the ends of a periodic box.
#include <boltzmann/schemes/molecules/rigid_groups.hpp>

namespace boltzmann {

RigidGroups::RigidGroups(AnyEnsemble& ensemble, std::span<BondMembers const> bonds)
    : ensemble_(ensemble), mass_(ensemble.field("mass").offset), velocity_(ensemble.field("velocity").offset) {
  std::vector<std::size_t> first(ensemble.size() + 1, 0);
  for (auto const& bond : bonds)
    for (auto const i : bond) ++first[i + 1];
  for (std::size_t i = 0; i < ensemble.size(); ++i) first[i + 1] += first[i];
  std::vector<std::uint32_t> mates(first.back());
  auto next = first;
  for (auto const& [i, j] : bonds) mates[next[i]++] = j, mates[next[j]++] = i;
  std::vector<bool> found(ensemble.size(), false);
  member_.reserve(ensemble.size());
  anchor_.reserve(ensemble.size());
  auto const take = [&](std::uint32_t i, std::uint32_t anchor) {
    found[i] = true;
    member_.push_back(i);
    anchor_.push_back(anchor);
  };
  for (std::uint32_t i = 0; i < ensemble.size(); ++i) {
    if (found[i]) continue;
    std::size_t const begin = member_.size();
    take(i, 0);
    for (std::size_t k = begin; k < member_.size(); ++k)
      for (std::size_t b = first[member_[k]]; b < first[member_[k] + 1]; ++b)
        if (!found[mates[b]]) take(mates[b], static_cast<std::uint32_t>(k - begin));
    start_.push_back(member_.size());
  }
}

RigidGroups::Body RigidGroups::body(std::size_t group, Box const& box, std::vector<Vector<3>>& arms) const {
  auto const members = this->members(group);
  std::uint32_t const* const anchor = anchor_.data() + start_[group];
  int const D = box.dimension();
  arms.assign(members.size(), Vector<3>{0, 0, 0});
  Body body;
  for (std::size_t k = 0; k < members.size(); ++k) {
    double const* const row = ensemble_.row(members[k]);
    if (k > 0) {  // arms are relative to the first member for now
      double const* const before = ensemble_.row(members[anchor[k]]);
      for (int a = 0; a < D; ++a) arms[k][a] = row[a] - before[a];
      box.nearest_image(arms[k].component);
      arms[k] += arms[anchor[k]];
    }
    double const mass = row[mass_];
    body.mass += mass;
    body.centre += arms[k] * mass;
    for (int a = 0; a < D; ++a) body.velocity[a] += row[velocity_ + a] * mass;
  }
  Vector<3> const to_centre = body.centre * (1 / body.mass);
  body.velocity = body.velocity * (1 / body.mass);
  for (auto& arm : arms) arm -= to_centre;
  for (int a = 0; a < D; ++a) body.centre[a] = ensemble_.row(members[0])[a] + to_centre[a];
  return body;
}

}  // namespace boltzmann
