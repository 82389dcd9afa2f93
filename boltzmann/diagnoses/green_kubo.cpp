// Fluxes of the whole system for each row.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/diagnoses/chosen.hpp>
#include <boltzmann/diagnoses/green_kubo.hpp>
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/diagnoses/time_correlation.hpp>
#include <boltzmann/diagnoses/unknown.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace boltzmann {
namespace {

/// The symmetric traceless stress, times the volume: D x D numbers.
std::vector<double> shear_stress(Sample const& sample, int D) {
  Tensor3 stress = kinetic_stress(sample.ensembles);
  double trace = 0;
  for (int a = 0; a < D; ++a) {
    for (int b = 0; b < D; ++b) stress[a][b] += sample.measures->virial[a][b];
    trace += stress[a][a];
  }
  std::vector<double> flux;
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) flux.push_back(0.5 * (stress[a][b] + stress[b][a]) - (a == b ? trace / D : 0));
  return flux;
}

std::vector<double> charge_current(Sample const& sample, int D) {
  std::array<ExactSum, 3> current;
  for (auto const* ensemble : sample.ensembles) {
    Field const* charge = ensemble->find_field("charge");
    if (charge == nullptr || !has_velocities(*ensemble)) continue;
    Velocities const velocities = velocities_of(*ensemble);
    for (std::size_t i = 0; i < ensemble->size(); ++i)
      for (int a = 0; a < D; ++a) current[a] += ensemble->row(i)[charge->offset] * velocities[i][a];
  }
  std::vector<double> flux;
  for (int a = 0; a < D; ++a) flux.push_back(current[a].value());
  return flux;
}

std::vector<double> heat_current(Sample const& sample, int D) {
  auto const& measures = *sample.measures;
  Triple const drift = common_velocity(sample.ensembles);
  std::array<ExactSum, 3> current;
  for (std::size_t e = 0; e < sample.ensembles.size(); ++e) {
    AnyEnsemble const& ensemble = *sample.ensembles[e];
    if (!carries_momentum(ensemble)) continue;
    if (e >= measures.per_particle.size() || e >= measures.virial_per_particle.size() ||
        measures.per_particle[e].size() != ensemble.size() ||
        measures.virial_per_particle[e].size() != 9 * ensemble.size())
      throw Error(
          "heat-conductivity: energy and virial of each particle are known only where all influences are pairs");
    Velocities const velocities = velocities_of(ensemble);
    int const at_mass = ensemble.field("mass").offset;
    for (std::size_t i = 0; i < ensemble.size(); ++i) {
      if (!ensemble.mobility.moves(i)) continue;
      double v[3] = {0, 0, 0}, energy = measures.per_particle[e][i];
      for (int a = 0; a < D; ++a) {
        v[a] = velocities[i][a] - drift[a];
        energy += 0.5 * ensemble.row(i)[at_mass] * v[a] * v[a];
      }
      double const* virial = &measures.virial_per_particle[e][9 * i];
      for (int a = 0; a < D; ++a) {
        current[a] += energy * v[a];
        for (int b = 0; b < D; ++b) current[a] += virial[3 * a + b] * v[b];
      }
    }
  }
  std::vector<double> flux;
  for (int a = 0; a < D; ++a) flux.push_back(current[a].value());
  return flux;
}

}  // namespace

Words<Transport> const& transport_words() {
  static Words<Transport> const words{
      "transport coefficient",
      {{Transport::viscosity, "viscosity", "of shear"},
       {Transport::conductivity, "conductivity", "electrical"},
       {Transport::heat_conductivity, "heat-conductivity", "of one kind of particles"}}};
  return words;
}

GreenKubo::GreenKubo(std::vector<AnyEnsemble const*> const& available, Options const& options) : options_(options) {
  chosen_names(available, {});
  dimension_ = available.front()->dimension();
  if (options_.count < 1) throw Error("green-kubo: the longest lag is one row or more");
  sums_.assign(options_.count + 1, 0.0);
  numbers_.assign(options_.count + 1, 0.0);
  auto const number_of = [&](auto const& what) { return std::count_if(available.begin(), available.end(), what); };
  auto const carries = number_of([](auto const* one) { return carries_momentum(*one); });
  if (carries == 0) throw Error("green-kubo: no ensemble has a mass and a velocity, so that there is no temperature");
  if (options_.quantity == Transport::viscosity && dimension_ == 1)
    throw Error("green-kubo: there is no shear in 1D, and so no viscosity of shear");
  if (options_.quantity == Transport::conductivity &&
      number_of([](auto const* one) { return one->find_field("charge") != nullptr && has_velocities(*one); }) == 0)
    throw Error("green-kubo: no ensemble has a charge and a velocity, so that there is no current");
  if (options_.quantity == Transport::heat_conductivity && carries > 1)
    throw Error("green-kubo: heat-conductivity is of one ensemble; in a mixture particles carry enthalpy, too");
}

std::string GreenKubo::name() const {
  return options_.quantity == Transport::viscosity      ? "viscosity"
         : options_.quantity == Transport::conductivity ? "conductivity"
                                                        : "heat conductivity";
}

Dimension GreenKubo::flux_dimension() const {
  using namespace dimensions;
  return options_.quantity == Transport::viscosity      ? energy
         : options_.quantity == Transport::conductivity ? charge * velocity
                                                        : energy * velocity;
}

Dimension GreenKubo::coefficient_dimension() const {
  using namespace dimensions;
  Dimension const plain = flux_dimension() * flux_dimension() * dimensions::time / (energy * pow(length, dimension_));
  return options_.quantity == Transport::heat_conductivity ? plain / dimensions::temperature : plain;
}

std::vector<Column> GreenKubo::columns() const { return {{name(), coefficient_dimension()}}; }

std::vector<double> GreenKubo::flux(Sample const& sample) const {
  if (options_.quantity == Transport::conductivity) return charge_current(sample, dimension_);
  if (sample.measures == nullptr) throw Error("green-kubo: the virial is not known here");
  return options_.quantity == Transport::viscosity ? shear_stress(sample, dimension_)
                                                   : heat_current(sample, dimension_);
}

void GreenKubo::measure(Sample const& sample, std::vector<double>& values) {
  if (sample.time >= options_.since) {
    if (rows_ == 1) interval_ = sample.time - first_time_;
    if (rows_ > 1 && std::abs(sample.time - last_time_ - interval_) > 1e-6 * std::abs(interval_))
      throw Error(fmt::format("green-kubo: rows must be at equal times; {} follows {}, before that the interval was {}",
                              sample.time, last_time_, interval_));
    if (rows_ == 0) first_time_ = sample.time;
    last_time_ = sample.time;
    rows_ += 1;
    constant_ = sample.boltzmann_constant;
    volume_ += (sample.box.volume() - volume_) / rows_;
    temperature_ +=
        (temperature(sample.ensembles, sample.boltzmann_constant, {.subtract_drift = true}).total - temperature_) /
        rows_;
    fluxes_.push_front(flux(sample));
    if (fluxes_.size() > options_.count + 1) fluxes_.pop_back();
    for (std::size_t lag = 0; lag < fluxes_.size(); ++lag) {
      for (std::size_t c = 0; c < fluxes_[lag].size(); ++c) sums_[lag] += fluxes_[lag][c] * fluxes_[0][c];
      numbers_[lag] += 1;
    }
  }
  values.push_back(numbers_.back() > 0 ? coefficient().back() : unknown);
}

std::vector<double> GreenKubo::autocorrelation() const {
  std::vector<double> c;
  for (std::size_t lag = 0; lag < sums_.size() && numbers_[lag] > 0; ++lag) c.push_back(sums_[lag] / numbers_[lag]);
  return c;
}

std::vector<double> GreenKubo::coefficient() const {
  auto integral = running_integral(autocorrelation(), std::abs(interval_));
  int const D = dimension_;
  double divisor = volume_ * constant_ * temperature_;
  if (options_.quantity == Transport::viscosity) divisor *= (D - 1) * (D + 2);
  if (options_.quantity == Transport::conductivity) divisor *= D;
  if (options_.quantity == Transport::heat_conductivity) divisor *= D * temperature_;
  for (double& x : integral) x /= divisor;
  return integral;
}

std::vector<GatheredTable> GreenKubo::tables() const {
  auto const c = autocorrelation();
  std::vector<double> lags, normalised;
  for (std::size_t k = 0; k < c.size(); ++k) {
    lags.push_back(static_cast<double>(k) * std::abs(interval_));
    normalised.push_back(c[k] / c[0]);
  }
  return {{file_name("green-kubo", transport_words().name(options_.quantity)),
           {{"lag", dimensions::time},
            {"autocorrelation of the flux", flux_dimension() * flux_dimension()},
            {"normalised", dimensions::none},
            {name(), coefficient_dimension()}},
           {lags, c, normalised, coefficient()}}};
}

std::vector<double> GreenKubo::state() const {
  std::vector<double> state{rows_, first_time_, last_time_, interval_, temperature_, volume_, constant_};
  add_list(state, sums_);
  add_list(state, numbers_);
  for (auto const& flux : fluxes_) add_list(state, flux);
  return state;
}

void GreenKubo::restore(std::span<double const> state) {
  StateReader reader(state);
  for (double* number : {&rows_, &first_time_, &last_time_, &interval_, &temperature_, &volume_, &constant_})
    *number = reader.next();
  sums_ = reader.list();
  numbers_ = reader.list();
  if (sums_.size() != options_.count + 1 || numbers_.size() != sums_.size())
    throw Error("the checkpoint does not fit this diagnosis: it has other lags");
  fluxes_.clear();
  auto const kept = static_cast<std::size_t>(std::clamp(rows_, 0.0, static_cast<double>(options_.count + 1)));
  for (std::size_t k = 0; k < kept; ++k) fluxes_.push_back(reader.list());
  reader.finish();
}

}  // namespace boltzmann
