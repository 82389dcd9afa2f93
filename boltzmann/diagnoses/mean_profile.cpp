// Sums of bins, accumulated from sample to sample.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/chosen.hpp>
#include <boltzmann/diagnoses/mean_profile.hpp>
#include <boltzmann/diagnoses/unknown.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace boltzmann {

MeanProfile::MeanProfile(std::vector<AnyEnsemble const*> const& available, Options options)
    : options_(std::move(options)) {
  auto const names = chosen_names(available, options_.ensembles);
  dimension_ = available.front()->dimension();
  if (options_.axis < 0 || options_.axis >= dimension_)
    throw Error(
        fmt::format("mean-profile: in {}D there is no axis {}", dimension_, "xyz"[std::clamp(options_.axis, 0, 2)]));
  if (options_.count < 1) throw Error("mean-profile: it needs a bin");
  if (options_.from >= options_.to)
    throw Error(fmt::format("mean-profile: it goes from a lower to a higher place, not from {} to {}", options_.from,
                            options_.to));
  bool carries = false;
  for (auto const* ensemble : available) {
    bool const named = std::find(names.begin(), names.end(), ensemble->name()) != names.end();
    carries = carries || (named && carries_momentum(*ensemble));
    if (named && !options_.ensembles.empty() && !carries_momentum(*ensemble))
      throw Error(fmt::format("mean-profile: ensemble '{}' of class {} has no mass and velocity", ensemble->name(),
                              ensemble->class_name()));
  }
  if (!carries) throw Error("mean-profile: no ensemble has a mass and a velocity");
  for (auto const& name : split_names(options_.quantities)) quantities_.push_back(profile_quantity(dimension_, name));
  if (quantities_.empty()) throw Error("mean-profile: it needs a quantity");
}

std::vector<Column> MeanProfile::columns() const {
  std::vector<Column> columns;
  for (auto const& quantity : quantities_)
    for (char const* end : {"lowest", "highest"})
      columns.push_back({labelled(options_.label, std::string(end) + " " + quantity.label), quantity.dimension});
  return columns;
}

void MeanProfile::check(Box const& box) const {
  if (box.boundary(options_.axis) == Boundary::open && (std::isnan(options_.from) || std::isnan(options_.to)))
    throw Error(
        fmt::format("mean-profile: axis {} is open, so the ends of its bins are not known; write 'from' and 'to', the "
                    "lowest and the highest {} of the bins",
                    "xyz"[options_.axis], "xyz"[options_.axis]));
}

bool MeanProfile::needs_energies() const {
  return std::any_of(quantities_.begin(), quantities_.end(), [](auto const& quantity) {
    return quantity.name == "potential-energy" || quantity.name == "specific-energy";
  });
}

bool MeanProfile::needs_virial() const {
  return std::any_of(quantities_.begin(), quantities_.end(),
                     [](auto const& quantity) { return quantity.name.starts_with("pressure"); });
}

void MeanProfile::begin(double low, double high) {
  low_ = low;
  high_ = high;
  sums_.emplace(dimension_, options_.axis, low, high, options_.count);
}

void MeanProfile::measure(Sample const& sample, std::vector<double>& values) {
  if (sample.time >= options_.since) {
    check(sample.box);
    if (!sums_)
      begin(std::isnan(options_.from) ? sample.box.low(options_.axis) : options_.from,
            std::isnan(options_.to) ? sample.box.high(options_.axis) : options_.to);
    if (needs_virial() && (sample.measures == nullptr || sample.measures->virial_per_particle.empty()))
      throw Error(
          "mean-profile: the virial of each particle, for pressures, is known only where all influences are pairs");
    sums_->add(MassiveParticles(sample, sample.measures, options_.ensembles), sample.box);
    constant_ = sample.boltzmann_constant;
    looks_ += 1;
  }
  auto const now = profile();
  for (auto const& quantity : quantities_) {
    double low = unknown, high = unknown;
    if (now)
      for (double const value : values_of(*now, quantity)) {
        low = std::fmin(low, value);
        high = std::fmax(high, value);
      }
    values.insert(values.end(), {low, high});
  }
}

std::optional<Profile> MeanProfile::profile() const {
  if (!sums_) return std::nullopt;
  return sums_->profile(constant_);
}

std::vector<double> MeanProfile::values_of(Profile const& profile, ProfileQuantity const& quantity) const {
  auto values = profile.values(quantity.name);
  if (quantity.name == "number")
    for (double& number : values) number /= looks_;
  return values;
}

std::vector<GatheredTable> MeanProfile::tables() const {
  GatheredTable table{file_name("mean-profile", options_.label),
                      {{std::string(1, "xyz"[options_.axis]), dimensions::length}}};
  for (auto const& quantity : quantities_) table.columns.push_back({quantity.label, quantity.dimension});
  if (auto const now = profile()) {
    table.values.push_back(now->position);
    for (auto const& quantity : quantities_) table.values.push_back(values_of(*now, quantity));
  }
  return {table};
}

std::vector<double> MeanProfile::state() const {
  if (!sums_) return {};
  std::vector<double> state{looks_, low_, high_, constant_};
  auto const sums = sums_->state();
  state.insert(state.end(), sums.begin(), sums.end());
  return state;
}

void MeanProfile::restore(std::span<double const> state) {
  sums_.reset();
  looks_ = 0;
  if (state.empty()) return;
  StateReader reader(state);
  looks_ = reader.next();
  double const low = reader.next(), high = reader.next();
  constant_ = reader.next();
  begin(low, high);
  sums_->restore(state.subspan(4));
}

}  // namespace boltzmann
