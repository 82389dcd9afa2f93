// The report and the state of a rezoner.
#include <boltzmann/simulation/rezoner.hpp>

#include <fmt/format.h>

namespace boltzmann {
namespace {

std::string count(std::size_t number, char const* one) {
  return fmt::format("{} {}{}", number, one, number == 1 ? "" : "s");
}

}  // namespace

Rezoner::Rezoner(AnyEnsemble& ensemble, Box const& box, Rezoning const& rezoning)
    : ensemble_(&ensemble), box_(&box), rezoning_(rezoning) {
  check(ensemble, box, rezoning);
}

void Rezoner::change() {
  Rezoned const now = rezone(*ensemble_, *box_, rezoning_);
  done_.splits += now.splits;
  done_.merges += now.merges;
  done_.angular_momentum_lost += now.angular_momentum_lost;
}

std::string Rezoner::report(UnitSystem const& units) const {
  auto const& lost = done_.angular_momentum_lost;
  int const dimension = ensemble_->dimension();
  std::string line = fmt::format("'{}': {}, {}, {} now", ensemble_->name(), count(done_.splits, "split"),
                                 count(done_.merges, "merge"), count(ensemble_->size(), "particle"));
  if (dimension > 1 && done_.merges > 0)
    line += fmt::format("; angular momentum lost: {}",
                        units.text(dimension == 2 ? lost[2] : magnitude(lost), dimensions::angular_momentum));
  return line;
}

std::vector<double> Rezoner::state() const {
  auto const& lost = done_.angular_momentum_lost;
  return {static_cast<double>(done_.splits), static_cast<double>(done_.merges), lost[0], lost[1], lost[2]};
}

void Rezoner::restore(std::span<double const> state) {
  if (state.size() != 5) throw Error("the checkpoint does not fit this simulation: it has no rezoning");
  done_ = {static_cast<std::size_t>(state[0]), static_cast<std::size_t>(state[1]), {state[2], state[3], state[4]}};
}

}  // namespace boltzmann
