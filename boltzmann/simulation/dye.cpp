// The places of releases, and the number of tracers.
#include <boltzmann/core/error.hpp>
#include <boltzmann/simulation/dye.hpp>

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace boltzmann {

OptionTable const& dye_options() {
  static OptionTable const all = [] {
    using namespace option;
    OptionTable all;
    all.add_said("on", text("the name of an ensemble"), "ensemble of class Dye or Tracer that receives the particles");
    all.add_of<DyeOptions>(
        "from", [](DyeOptions& dye) -> OptionPlace { return std::span(dye.from); }, vector(dimensions::length),
        "point of release, or one end of a line");
    all.add("to", &DyeOptions::to, vector(dimensions::length), "the other end of the line", "one point");
    all.add("places", &DyeOptions::places, whole(1, 1e6), "points on the line, both ends included");
    all.add("every", &DyeOptions::every, whole(1, std::numeric_limits<double>::infinity()), "steps between releases");
    all.add("limit", &DyeOptions::limit, whole(1, 1e8),
            "largest number of particles in the ensemble; then the release stops");
    all.at("on").needed = "\"dye\"";
    all.at("from").needed = "[-2, 0]";
    return all;
  }();
  return all;
}

DyeSource::DyeSource(AnyEnsemble& ensemble, DyeOptions const& options) : ensemble_(&ensemble), options_(options) {
  auto const is_tracer = [&] {
    return static_cast<int>(ensemble.influence_size()) == ensemble.dimension() && !ensemble.find_field("vorticity") &&
           !ensemble.find_field("velocity") && !ensemble.find_field("mass");
  };
  if (!is_tracer())
    throw Error(fmt::format("dye: '{}' is of class {}; what is released is of class Dye or Tracer", ensemble.name(),
                            ensemble.class_name()));
  if (options.places < 1) throw Error("dye: there is one place at least, not 0");
  if (options.to ? options.places < 2 : options.places > 1)
    throw Error(fmt::format("dye: {} with {} place{}; a line has both ends, 'from' and 'to', and 2 places or more",
                            options.to ? "'to'" : "no 'to'", options.places, options.places == 1 ? "" : "s"));
  for (int a = 0; a < ensemble.dimension(); ++a)
    if (!std::isfinite(options.from[static_cast<std::size_t>(a)]) ||
        (options.to && !std::isfinite((*options.to)[static_cast<std::size_t>(a)])))
      throw Error("dye: a place is not finite");
}

void DyeSource::change() {
  ++changes_;
  std::size_t const before = ensemble_->size();
  if (before + options_.places > options_.limit) return;
  ensemble_->resize(before + options_.places);
  auto const dimension = static_cast<std::size_t>(ensemble_->dimension());
  Field const *const place = ensemble_->find_field("place"), *const release = ensemble_->find_field("release");
  for (std::size_t k = 0; k < options_.places; ++k) {
    double* const row = ensemble_->row(before + k);
    for (std::size_t a = 0; a < dimension; ++a) {
      double const from = options_.from[a], to = options_.to ? (*options_.to)[a] : from;
      double const part = k == 0 ? 0 : static_cast<double>(k) / static_cast<double>(options_.places - 1);
      row[a] = (1 - part) * from + part * to;
    }
    if (place && place->components == 1) row[place->offset] = static_cast<double>(options_.first_place + k);
    if (release && release->components == 1) row[release->offset] = static_cast<double>(changes_);
  }
  released_ += options_.places;
}

std::string DyeSource::report(UnitSystem const& /*units*/) const {
  bool const full = ensemble_->size() + options_.places > options_.limit;
  return fmt::format("'{}': {} released, {} now{}", ensemble_->name(), released_, ensemble_->size(),
                     full ? ", which is the limit" : "");
}

std::vector<double> DyeSource::state() const { return {static_cast<double>(released_), static_cast<double>(changes_)}; }

void DyeSource::restore(std::span<double const> state) {
  if (state.size() != 2) throw Error("the checkpoint does not fit this simulation: it has no dye");
  released_ = static_cast<std::size_t>(state[0]);
  changes_ = static_cast<std::size_t>(state[1]);
}

}  // namespace boltzmann
