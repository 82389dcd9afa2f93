// Pairs in bins of their distance: all pairs, or with cells if the distance is short.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/chosen.hpp>
#include <boltzmann/diagnoses/near_images.hpp>
#include <boltzmann/diagnoses/radial_distribution.hpp>
#include <boltzmann/diagnoses/unknown.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace boltzmann {
namespace {

using Counts = std::vector<std::uint64_t>;

/// Half of the shortest side, or the value of the options.
double reach_in(Box const& box, RadialDistributionOptions const& options) {
  if (!std::isnan(options.to)) return options.to;
  double shortest = box.length(0);
  for (int a = 1; a < box.dimension(); ++a) shortest = std::min(shortest, box.length(a));
  return 0.5 * shortest;
}

/// The probability that two uniformly distributed particles in the box are within r of each other: the fraction of the
/// box within r of a particle, averaged over its position. For the separation u an axis between walls contributes 1 -
/// |u_a| / L_a; <|n_a|>, <|n_a n_b|> and <|n_x n_y n_z|> are means over directions.
double ideal_within(Box const& box, double r) {
  using std::numbers::pi;
  int const D = box.dimension();
  double const surface = D == 1 ? 2 : D == 2 ? 2 * pi : 4 * pi;
  double const one = D == 1 ? 1 : D == 2 ? 2 / pi : 0.5, two = D == 2 ? 1 / pi : 2 / (3 * pi), three = 1 / (4 * pi);
  std::array<double, 4> sums{1, 0, 0, 0};  // of products of 0, 1, 2, 3 different 1/L
  for (int a = 0; a < D; ++a) {
    if (box.periodic(a)) continue;
    for (std::size_t k = 3; k > 0; --k) sums[k] += sums[k - 1] / box.length(a);
  }
  double const factor[4] = {1, -one, two, -three};
  double within = 0;
  for (int k = 0; k <= D; ++k) within += factor[k] * sums[static_cast<std::size_t>(k)] * std::pow(r, D + k) / (D + k);
  return surface * within / box.volume();
}

/// Wrapped into the box along periodic axes.
void add_positions(AnyEnsemble const& ensemble, std::size_t i, Box const& box, std::vector<double>& all) {
  for (int a = 0; a < box.dimension(); ++a)
    all.push_back(box.periodic(a) ? box.wrapped(ensemble.row(i)[a], a) : ensemble.row(i)[a]);
}

/// The positions of a group, or of all, contiguous.
std::vector<double> positions_of(AnyEnsemble const& ensemble, std::span<std::uint32_t const> which, Box const& box,
                                 std::vector<double> all = {}) {
  for (auto const i : members_of(ensemble, which)) add_positions(ensemble, i, box, all);
  return all;
}

template <int D>
class PairCounter {
 public:
  PairCounter(Box const& box, double reach, std::size_t bins) : reach2_(reach * reach), bins_(bins) {
    per_length_ = static_cast<double>(bins) / reach;
    for (int a = 0; a < D; ++a) {
      period_[a] = box.periodic(a) ? box.length(a) : 0;
      half_[a] = box.periodic(a) ? 0.5 * box.length(a) : std::numeric_limits<double>::infinity();
    }
  }
  /// By the nearest image.
  void add(double const* p, double const* q, std::uint64_t* counts) const {
    double r2 = 0;
    for (int a = 0; a < D; ++a) {
      double d = q[a] - p[a];
      d += d > half_[a] ? -period_[a] : d < -half_[a] ? period_[a] : 0.0;
      r2 += d * d;
    }
    count(r2, counts);
  }
  /// By the plain distance.
  void add_plain(double const* p, double const* q, std::uint64_t* counts) const {
    double r2 = 0;
    for (int a = 0; a < D; ++a) r2 += (q[a] - p[a]) * (q[a] - p[a]);
    count(r2, counts);
  }

 private:
  void count(double r2, std::uint64_t* counts) const {
    if (!(r2 < reach2_)) return;
    auto const bin = static_cast<std::size_t>(std::sqrt(r2) * per_length_);
    ++counts[bin < bins_ ? bin : bins_ - 1];
  }

  double reach2_, per_length_;
  std::size_t bins_;
  double period_[D], half_[D];
};

/// The pairs to count: all pairs of `first`, or those between `first` and `second`.
struct PairSets {
  std::vector<double> const &first, &second;
  bool same;
  Box const& box;
  double reach;
  std::size_t bins;
  int threads;
};

/// Integers, whose sum does not depend on the order: the same for any threads.
template <int D>
Counts counts_of(PairSets const& sets) {
  std::size_t const size = sets.first.size() / D, others = sets.second.size() / D;
  std::size_t const grain = size / 64 + 1, ranges = (size + grain - 1) / grain;
  std::vector<Counts> parts(std::max<std::size_t>(ranges, 1), Counts(sets.bins));
  PairCounter<D> const counter(sets.box, sets.reach, sets.bins);
  // Cells pay if few of the others are near. Images of a particle may be near, too, so that at half a side all are.
  double sphere = 1, space = 1;
  for (int a = 0; a < D; ++a) sphere *= 3 * sets.reach, space *= sets.box.length(a);
  bool const by_cells = others > 200 && sphere < space / 4;
  Cells cells;
  if (by_cells) cells = Cells(D, sets.second.data(), D, others, sets.reach, sets.threads);
  double const pairs = static_cast<double>(size) * (by_cells ? 100 : static_cast<double>(others));
  for_ranges(size, grain, threads_for(static_cast<std::size_t>(pairs), 1.0 / 8, sets.threads),
             [&](std::size_t begin, std::size_t end) {
               for (std::size_t from = begin; from < end; from += grain) {
                 std::uint64_t* const counts = parts[from / grain].data();
                 for (std::size_t i = from; i < std::min(from + grain, end); ++i) {
                   double const* const p = &sets.first[D * i];
                   if (by_cells)
                     each_near<D>(cells, p, sets.box, sets.reach, [&](std::size_t j, double const* image) {
                       if (!sets.same || j > i) counter.add_plain(image, &sets.second[D * j], counts);
                     });
                   else
                     for (std::size_t j = sets.same ? i + 1 : 0; j < others; ++j)
                       counter.add(p, &sets.second[D * j], counts);
                 }
               }
             });
  for (std::size_t k = 1; k < parts.size(); ++k)
    for (std::size_t bin = 0; bin < sets.bins; ++bin) parts[0][bin] += parts[k][bin];
  return std::move(parts[0]);
}

}  // namespace

RadialDistribution::RadialDistribution(std::vector<AnyEnsemble const*> const& available, Options options)
    : options_(std::move(options)), label_(options_.label) {
  auto const& names = options_.ensembles;
  chosen_names(available, names);
  if (names.size() > 2)
    throw Error(fmt::format("a radial distribution is of one ensemble or between two, not of {}", join(names)));
  if (options_.every < 1) throw Error("the sampling interval of a radial distribution must be 1 step or more");
  if (options_.count < 1) throw Error("a radial distribution needs a bin");
  if (options_.to <= 0) throw Error(fmt::format("a radial distribution needs a distance above 0, not {}", options_.to));
  if (label_.empty())
    for (auto const& name : names) label_ += (label_.empty() ? "" : " ") + name;
  check_chosen(available, names, options_.particles, options_.partners);
  if (!options_.particles.empty() && names.empty()) options_.ensembles = {available.front()->name()};
  bool const within = options_.partners.empty() && (names.size() < 2 || names[0] == names[1]);
  partners_each_ = within ? 2 : 1;
}

void RadialDistribution::check(Box const& box) const {
  refuse_shear(box, "radial-distribution");
  if (!box.regions().empty())
    throw Error("radial-distribution: the box has regions that particles can't be in, so that no density is known");
  double const reach = reach_in(box, options_);
  for (int a = 0; a < box.dimension(); ++a) {
    bool const closed = box.periodic(a) || (box.walled(a, Box::End::low) && box.walled(a, Box::End::high));
    if (!closed)
      throw Error(
          fmt::format("radial-distribution: axis {} is open, so that there is no density to compare with; "
                      "periodic axes and those between walls have one",
                      "xyz"[a]));
    double const most = box.periodic(a) ? 0.5 * box.length(a) : box.length(a);
    if (reach > most * (1 + 1e-12))
      throw Error(
          fmt::format("radial-distribution: pairs are counted up to {}, and along axis {} of the box only up "
                      "to {}{}",
                      box.spoken_units().text(reach, dimensions::length, 6), "xyz"[a],
                      box.spoken_units().text(most, dimensions::length, 6),
                      box.periodic(a) ? ", half of it, is an image the nearest" : ""));
  }
}

std::vector<Column> RadialDistribution::columns() const {
  return {{labelled(label_, "g peak"), dimensions::none}, {labelled(label_, "g peak distance"), dimensions::length}};
}

void RadialDistribution::count_pairs(Sample const& sample) {
  Box const& box = sample.box;
  check(box);
  if (looks_ == 0) {
    reach_ = reach_in(box, options_);
    counted_.assign(options_.count, 0.0);
    expected_.assign(options_.count, 0.0);
  }
  for (int a = 0; a < box.dimension(); ++a)  // a box may shrink
    if (reach_ > (box.periodic(a) ? 0.5 : 1.0) * box.length(a) * (1 + 1e-12))
      throw Error(fmt::format(
          "radial-distribution: the box is now too short along axis {} for pairs up to {}; set a smaller 'to'",
          "xyz"[a], box.spoken_units().text(reach_, dimensions::length, 6)));
  auto const& names = options_.ensembles;
  bool const within = partners_each_ == 2;
  std::vector<double> first, second;
  if (names.empty())
    for (auto const* ensemble : sample.ensembles) first = positions_of(*ensemble, {}, box, std::move(first));
  else
    first = positions_of(ensemble_of(sample, names[0]), options_.particles, box);
  if (!within) second = positions_of(ensemble_of(sample, names.back()), options_.partners, box);
  PairSets const sets{first, within ? first : second, within, box, reach_, counted_.size(), sample.threads};
  auto const counts = box.dimension() == 1   ? counts_of<1>(sets)
                      : box.dimension() == 2 ? counts_of<2>(sets)
                                             : counts_of<3>(sets);
  auto const D = static_cast<double>(box.dimension());
  double const size = static_cast<double>(first.size()) / D;
  double const pairs = within ? size * (size - 1) / 2 : size * static_cast<double>(second.size()) / D;
  double before = 0;
  for (std::size_t bin = 0; bin < counts.size(); ++bin) {
    double const within_end =
        ideal_within(box, reach_ * static_cast<double>(bin + 1) / static_cast<double>(counts.size()));
    counted_[bin] += static_cast<double>(counts[bin]);
    expected_[bin] += pairs * (within_end - before);
    before = within_end;
  }
  centres_ += size;
  ++looks_;
}

void RadialDistribution::measure(Sample const& sample, std::vector<double>& values) {
  if (sample.time >= options_.since && sample.step % static_cast<std::int64_t>(options_.every) == 0)
    count_pairs(sample);
  auto const all = g();
  auto const highest = std::max_element(all.begin(), all.end());
  if (looks_ == 0 || highest == all.end() || std::isnan(*highest)) {
    values.insert(values.end(), {unknown, unknown});
    return;
  }
  // The parabola through the bin and its two neighbours.
  auto const at = static_cast<std::size_t>(highest - all.begin());
  double const width = reach_ / static_cast<double>(all.size());
  double height = *highest, place = static_cast<double>(at) + 0.5;
  if (at > 0 && at + 1 < all.size()) {
    double const slope = 0.5 * (all[at + 1] - all[at - 1]), bend = all[at + 1] - 2 * all[at] + all[at - 1];
    if (bend < 0) {
      place -= slope / bend;
      height -= 0.5 * slope * slope / bend;
    }
  }
  values.insert(values.end(), {height, place * width});
}

std::vector<double> RadialDistribution::distances() const {
  std::vector<double> middles;
  for (std::size_t bin = 0; bin < counted_.size(); ++bin)
    middles.push_back(reach_ * (static_cast<double>(bin) + 0.5) / static_cast<double>(counted_.size()));
  return middles;
}

std::vector<double> RadialDistribution::g() const {
  std::vector<double> g;
  for (std::size_t bin = 0; bin < counted_.size(); ++bin)
    g.push_back(expected_[bin] > 0 ? counted_[bin] / expected_[bin] : unknown);
  return g;
}

std::vector<double> RadialDistribution::coordination() const {
  std::vector<double> partners;
  double before = 0;
  for (double const pairs : counted_) {
    partners.push_back(centres_ > 0 ? partners_each_ * (before + 0.5 * pairs) / centres_ : unknown);
    before += pairs;
  }
  return partners;
}

std::vector<GatheredTable> RadialDistribution::tables() const {
  return {{file_name("radial-distribution", label_),
           {{"distance", dimensions::length}, {"g", dimensions::none}, {"coordination number", dimensions::none}},
           {distances(), g(), coordination()}}};
}

std::vector<double> RadialDistribution::state() const {
  std::vector<double> state{static_cast<double>(looks_), reach_, centres_};
  add_list(state, counted_);
  add_list(state, expected_);
  return state;
}

void RadialDistribution::restore(std::span<double const> state) {
  StateReader reader(state);
  looks_ = static_cast<std::size_t>(reader.next());
  reach_ = reader.next();
  centres_ = reader.next();
  counted_ = reader.list();
  expected_ = reader.list();
  reader.finish();
  if (counted_.size() != expected_.size() || (looks_ > 0 && counted_.size() != options_.count))
    throw Error("the checkpoint does not fit this diagnosis: its radial distribution has other bins");
}

}  // namespace boltzmann
