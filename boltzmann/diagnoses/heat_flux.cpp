// Heat flux: one pass for the mean enthalpy, one for the convection relative to it.
#include <boltzmann/diagnoses/heat_flux.hpp>
#include <boltzmann/diagnoses/unknown.hpp>

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>

#include <fmt/format.h>

#include <cmath>

namespace boltzmann {
namespace {

/// Calls f(mass, velocity, enthalpy per mass) for every particle.
template <class Function>
void for_each_enthalpy(std::span<AnyEnsemble* const> ensembles, int axis, Function const& f) {
  for (AnyEnsemble const* ensemble : ensembles) {
    auto const at = [&](char const* field) { return static_cast<std::size_t>(ensemble->field(field).offset); };
    std::size_t const mass = at("mass"), velocity = at("velocity") + static_cast<std::size_t>(axis),
                      energy = at("specific_energy"), pressure = at("pressure"), density = at("density");
    for (std::size_t i = 0; i < ensemble->size(); ++i) {
      double const* p = ensemble->row(i);
      f(p[mass], p[velocity], p[energy] + p[pressure] / p[density]);
    }
  }
}

}  // namespace

double temperature_difference(Box const& box, int axis) {
  auto const temperature = [&](Box::End end) {
    return box.walled(axis, end) ? box.wall(axis, end).temperature : unknown;
  };
  double const difference = temperature(Box::End::low) - temperature(Box::End::high);
  if (!(difference != 0) || std::isnan(difference))
    throw Error(fmt::format("a heat flux along {} needs walls of different temperatures at both ends of this axis",
                            "xyz"[axis]));
  return difference;
}

HeatFlux::HeatFlux(std::vector<AnyEnsemble const*> const& ensembles, HeatFluxOptions const& options)
    : options_(options), dimension_(ensembles.empty() ? 0 : ensembles.front()->dimension()) {
  if (ensembles.empty()) throw Error("a heat flux needs smooth particles; the simulation has none");
  if (!(options.conductivity > 0) || !std::isfinite(options.conductivity))
    throw Error(
        fmt::format("a heat flux needs the conductivity of the material, above 0; it is {}", options.conductivity));
  if (options.axis < 0 || options.axis >= dimension_)
    throw Error(fmt::format("a heat flux along axis {}: the space has {} axes", "xyz"[options.axis % 3], dimension_));
  for (AnyEnsemble const* ensemble : ensembles)
    for (char const* field : {"mass", "velocity", "specific_energy", "pressure", "density"})
      if (!ensemble->find_field(field))
        throw Error(fmt::format("ensemble '{}' of class {} carries no heat: it has no {}", ensemble->name(),
                                ensemble->class_name(), field));
}

std::vector<Column> HeatFlux::columns() const {
  Dimension const flux = dimensions::energy / dimensions::time / pow(dimensions::length, dimension_ - 1);
  return {{"conductive heat flux", flux},
          {"convective heat flux", flux},
          {"nusselt number", dimensions::none},
          {"nusselt number mean", dimensions::none},
          {"nusselt number spread", dimensions::none}};
}

void HeatFlux::measure(Sample const& sample, std::vector<double>& values) {
  int const axis = options_.axis;
  double const difference = temperature_difference(sample.box, axis);
  double const conductive = options_.conductivity * difference / sample.box.length(axis);

  ExactSum mass, enthalpy, carried;
  for_each_enthalpy(sample.ensembles, axis, [&](double m, double, double h) {
    mass += m;
    enthalpy += m * h;
  });
  double const mean = mass.value() > 0 ? enthalpy.value() / mass.value() : 0;
  for_each_enthalpy(sample.ensembles, axis, [&](double m, double v, double h) { carried += m * v * (h - mean); });
  double const convective = carried.value() / sample.box.volume(), nusselt = 1 + convective / conductive;

  if (sample.time >= options_.since) {  // Welford's running mean and sum of squares
    ++count_;
    double const off = nusselt - mean_;
    mean_ += off / count_;
    squares_ += off * (nusselt - mean_);
  }
  values.insert(values.end(), {conductive, convective, nusselt, this->mean(), spread()});
}

double HeatFlux::mean() const { return count_ > 0 ? mean_ : unknown; }
double HeatFlux::spread() const { return count_ > 0 ? std::sqrt(squares_ / count_) : unknown; }

void HeatFlux::restore(std::span<double const> state) {
  if (state.size() != 3) throw Error("the checkpoint does not fit this diagnosis: a heat flux remembers three numbers");
  count_ = state[0];
  mean_ = state[1];
  squares_ = state[2];
}

}  // namespace boltzmann
