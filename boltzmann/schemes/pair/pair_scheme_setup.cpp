// Adds laws to a pair scheme, and checks that they are compatible with its box.
#include <boltzmann/schemes/pair/pair_scheme_laws.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

/// True if the law is a flow of vortices between these ensembles.
bool is_flow(AnyEnsemble const& target, AnyEnsemble const& source) {
  Field const* vorticity = source.find_field("vorticity");
  return vorticity && is_vorticity(*vorticity, source.dimension()) && !target.find_field("velocity");
}

/// A filter of these pairs, for this number of particles.
PairFilter filter_of(std::vector<BondMembers> const& pairs, std::size_t size, bool only) {
  std::vector<std::vector<std::uint32_t>> partners(size);
  for (auto const& [i, j] : pairs) {
    partners[i].push_back(j);
    partners[j].push_back(i);
  }
  PairFilter filter{only, {0}, {}};
  for (auto& mine : partners) {
    std::sort(mine.begin(), mine.end());
    filter.index.insert(filter.index.end(), mine.begin(), mine.end());
    filter.start.push_back(filter.index.size());
  }
  return filter;
}

/// No second image of a bonded particle may be in range, because it would be treated as the first.
void check_images_of_bonded(Box const& box, double cutoff) {
  for (int a = 0; a < box.dimension(); ++a)
    if (box.periodic(a) && box.length(a) < 2 * cutoff)
      throw Error(
          fmt::format("bonded pairs are left out or scaled where a second image is not near: the periodic axis {} must "
                      "be twice the cut-off {} or longer, not {}",
                      "xyz"[a], cutoff, box.length(a)));
}

}  // namespace

void pairs::check_walls(Box const& box, AnyEnsemble const& target, AnyEnsemble const& source, double cutoff) {
  if (!box.any_wall()) return;
  for (int a = 0; a < box.dimension(); ++a) {
    if (box.boundary(a) != Boundary::mirror) continue;
    if (!is_flow(target, source))
      throw Error(fmt::format(
          "axis {} is a mirror: particles that interact by pairs need a reflecting, periodic or open axis there "
          "(mirrors are for smooth particles and vortices)",
          "xyz"[a]));
    if (std::isfinite(cutoff))
      throw Error(
          fmt::format("axis {} is a mirror: a flow is made by all vortices and all of their images; leave out "
                      "the cut-off",
                      "xyz"[a]));
    if (box.walled(a, Box::End::low) && box.walled(a, Box::End::high))
      throw Error(
          fmt::format("axis {} has walls at both ends, between which vortices have images without end: let "
                      "multipoles do it ([multipole], MultipoleScheme), or open one end",
                      "xyz"[a]));
  }
  check_walls_of_flow(box, "pairs");
}

PairScheme::PairScheme(Box box, double cutoff)
    : Scheme(std::move(box)), cutoff_(cutoff), neighbourhood_(this->box(), cutoff) {
  if (!(cutoff > 0)) throw Error(fmt::format("the cut-off is a positive length, not {}", cutoff));
}

PairScheme::~PairScheme() = default;

void PairScheme::bonded_factors(AnyEnsemble& ensemble, std::vector<BondMembers> const& bonds,
                                std::vector<double> const& factors) {
  std::erase_if(bonded_, [&](auto const& one) { return one->ensemble == &ensemble; });
  for (auto const& bond : bonds)
    for (auto const i : bond)
      if (i >= ensemble.size())
        throw Error(fmt::format("a bond names particle {}, but '{}' has {}", i, ensemble.name(), ensemble.size()));
  std::vector<BondMembers> apart;
  BondedPairs all{&ensemble, {}, {}};
  for (std::size_t k = 0; k < factors.size(); ++k) {
    if (!std::isfinite(factors[k]))
      throw Error(fmt::format("the factor of pairs {} bonds apart is a number, not {}", k + 1, factors[k]));
    if (factors[k] == 1) continue;
    auto const pairs = pairs_apart(bonds, k + 1);
    apart.insert(apart.end(), pairs.begin(), pairs.end());
    if (factors[k] != 0 && !pairs.empty())
      all.factors.emplace_back(factors[k], filter_of(pairs, ensemble.size(), true));
  }
  if (apart.empty()) return;
  all.apart = filter_of(apart, ensemble.size(), false);
  bonded_.push_back(std::make_unique<BondedPairs>(std::move(all)));
}

void PairScheme::add_pairs(AnyEnsemble& target, AnyEnsemble& source, PairKernels kernels, LawPointer law,
                           LawTraits traits, double cutoff) {
  if (!(cutoff > 0)) throw Error(fmt::format("the cut-off is a positive length, not {}", cutoff));
  pairs::check_walls(box(), target, source, cutoff);
  for (int a = 0; a < box().dimension(); ++a) {
    if (!box().periodic(a)) continue;
    if (!std::isfinite(cutoff))
      throw Error(
          fmt::format("axis {} is periodic: a pair law needs a cut-off there (at most the axis' length {}), or the sum "
                      "over images has no end",
                      "xyz"[a], box().length(a)));
    if (cutoff > box().length(a))
      throw Error(fmt::format("the cut-off {} is longer than the periodic axis {}, which allows at most {}", cutoff,
                              "xyz"[a], box().length(a)));
  }
  add(target);
  add(source);
  auto const bonded = std::find_if(bonded_.begin(), bonded_.end(),
                                   [&](auto const& one) { return &target == &source && one->ensemble == &target; });
  if (bonded == bonded_.end())
    return add_near(target, source, kernels, std::move(law), std::move(traits), cutoff, {}, 1);
  if (!std::isfinite(cutoff))
    throw Error(fmt::format("bonded pairs of '{}' are left out of a law or scaled in it where it has a cut-off",
                            target.name()));
  check_images_of_bonded(box(), cutoff);
  add_near(target, source, kernels, law, traits, cutoff, (*bonded)->apart, 1);
  for (auto const& [factor, pairs] : (*bonded)->factors)
    add_near(target, source, kernels, law, traits, cutoff, pairs, factor);
}

void PairScheme::add_near(AnyEnsemble& target, AnyEnsemble& source, PairKernels kernels, LawPointer law,
                          LawTraits traits, double cutoff, PairFilter filter, double factor) {
  auto near = std::make_unique<Near>();
  near->target = &target;
  near->source = &source;
  near->kernels = kernels;
  near->law = std::move(law);
  near->traits = traits;
  near->cutoff = cutoff;
  near->task.same = &target == &source;
  near->task.cutoff2 = cutoff * cutoff;
  near->factor = factor;
  near->filtered = !filter.start.empty();
  if (!near->all_pairs())
    near->list = neighbourhood_.add(target, source, cutoff, std::move(filter), traits.positions_alone);
  near_.push_back(std::move(near));
  changed();
}

void PairScheme::add_connections(AnyEnsemble& ensemble, std::vector<Connection> const& connections, PairKernels kernels,
                                 LawPointer law, LawTraits traits) {
  add(ensemble);
  auto connected = std::make_unique<Connected>();
  connected->ensemble = &ensemble;
  connected->kernels = kernels;
  connected->law = std::move(law);
  connected->traits = traits;
  connected->list = connected_pairs(connections, ensemble.size());
  connected_.push_back(std::move(connected));
  changed();
}

void PairScheme::add_external(AnyEnsemble& ensemble, ExternalKernels kernels, LawPointer law, LawTraits traits,
                              std::vector<std::uint32_t> const* only) {
  add(ensemble);
  auto external = std::make_unique<External>();
  external->ensemble = &ensemble;
  external->kernels = kernels;
  external->law = std::move(law);
  external->traits = traits;
  external->everyone = only == nullptr;
  if (only) external->only = *only;
  std::sort(external->only.begin(), external->only.end());
  for (auto const i : external->only) {
    external->last = std::max<std::size_t>(external->last, i);
    if (i >= ensemble.size())
      throw Error(
          fmt::format("external influence on particle {} of '{}', which has {}", i, ensemble.name(), ensemble.size()));
  }
  external_.push_back(std::move(external));
  changed();
}

void PairScheme::replace_external(std::size_t number, LawPointer law, LawTraits traits) {
  external_.at(number)->law = std::move(law);
  external_.at(number)->traits = traits;
  changed();
}

}  // namespace boltzmann
