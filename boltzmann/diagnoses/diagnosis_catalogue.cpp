// The instruments behind the catalogue: each turns the plain functions of measures.hpp into columns.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/average.hpp>
#include <boltzmann/diagnoses/body_forces.hpp>
#include <boltzmann/diagnoses/bond_order.hpp>
#include <boltzmann/diagnoses/box_measures.hpp>
#include <boltzmann/diagnoses/chains.hpp>
#include <boltzmann/diagnoses/derived.hpp>
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/diagnoses/diffusion.hpp>
#include <boltzmann/diagnoses/energy_balance.hpp>
#include <boltzmann/diagnoses/entropy.hpp>
#include <boltzmann/diagnoses/field_measures.hpp>
#include <boltzmann/diagnoses/formula_diagnosis.hpp>
#include <boltzmann/diagnoses/green_kubo.hpp>
#include <boltzmann/diagnoses/heat_flux.hpp>
#include <boltzmann/diagnoses/mean_profile.hpp>
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/diagnoses/radial_distribution.hpp>
#include <boltzmann/diagnoses/shock.hpp>
#include <boltzmann/diagnoses/slab.hpp>
#include <boltzmann/diagnoses/structure_factor.hpp>
#include <boltzmann/diagnoses/time_correlation.hpp>
#include <boltzmann/diagnoses/unknown.hpp>
#include <boltzmann/diagnoses/vortex_measures.hpp>
#include <boltzmann/diagnoses/wave_spectrum.hpp>
#include <boltzmann/schemes/molecules/molecule_scheme.hpp>
#include <boltzmann/schemes/vortices/vortex_flow.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace boltzmann {
namespace {

// ---- Looking up ----

std::vector<std::string> names_of(std::vector<AnyEnsemble const*> const& ensembles) {
  std::vector<std::string> names;
  names.reserve(ensembles.size());
  for (auto const* ensemble : ensembles) names.push_back(ensemble->name());
  return names;
}

AnyEnsemble const& ensemble_named(std::vector<AnyEnsemble const*> const& ensembles, std::string const& name) {
  for (auto const* ensemble : ensembles)
    if (ensemble->name() == name) return *ensemble;
  auto const names = names_of(ensembles);
  throw Error(fmt::format("there is no ensemble '{}'; there are {}{}", name, join(names), did_you_mean(name, names)));
}

std::size_t index_in(Sample const& sample, std::string const& name) {
  for (std::size_t e = 0; e < sample.ensembles.size(); ++e)
    if (sample.ensembles[e]->name() == name) return e;
  throw Error(fmt::format("a diagnosis looks for ensemble '{}', which is not in the simulation", name));
}

/// "momentum x", "momentum y", ...
std::vector<Column> along_axes(std::string const& what, int axes, Dimension dimension) {
  std::vector<Column> columns;
  columns.reserve(static_cast<std::size_t>(axes));
  for (int a = 0; a < axes; ++a) columns.push_back({what + " " + "xyz"[a], dimension});
  return columns;
}

std::string prefixed(std::string const& prefix, std::string const& what) {
  return prefix.empty() ? what : prefix + " " + what;
}

int dimension_of(DiagnosisParameters const& parameters) {
  if (parameters.available.empty()) throw Error("a diagnosis needs an ensemble to look at; the simulation has none");
  return parameters.available.front()->dimension();
}

// ---- Of the whole system, or of each ensemble that is named ----

/// One set of columns for the whole system, or one for each named ensemble.
class SystemDiagnosis : public Diagnosis {
 public:
  explicit SystemDiagnosis(DiagnosisParameters const& parameters)
      : dimension_(dimension_of(parameters)), names_(parameters.ensembles) {
    for (auto const& name : names_) ensemble_named(parameters.available, name);
  }

  std::vector<Column> columns() const final {
    std::vector<Column> columns;
    for (auto const& name : names_)
      for (auto const& column : columns_of_one()) columns.push_back({prefixed(name, column.name), column.dimension});
    if (names_.empty()) columns = columns_of_one();
    for (auto const& column : columns_of_all()) columns.push_back(column);
    return columns;
  }

  void measure(Sample const& sample, std::vector<double>& values) final {
    for (auto const& name : names_) measure_one(*sample.ensembles[index_in(sample, name)], sample, values);
    if (names_.empty()) measure_one(sample.ensembles, sample, values);
    measure_all(sample, values);
  }

 protected:
  int dimension() const { return dimension_; }
  virtual std::vector<Column> columns_of_one() const = 0;
  virtual void measure_one(Ensembles of, Sample const& sample, std::vector<double>& values) = 0;
  /// What belongs to the whole system only, after the others.
  virtual std::vector<Column> columns_of_all() const { return {}; }
  virtual void measure_all(Sample const&, std::vector<double>&) {}

 private:
  int dimension_;
  std::vector<std::string> names_;
};

class Number final : public SystemDiagnosis {
 public:
  explicit Number(DiagnosisParameters const& parameters) : SystemDiagnosis(parameters) {}
  bool sums() const override { return true; }
  std::vector<Column> columns_of_one() const override {
    return {{"number", dimensions::none}, {"mass", dimensions::mass}};
  }
  void measure_one(Ensembles of, Sample const&, std::vector<double>& values) override {
    values.push_back(static_cast<double>(number_of_particles(of)));
    values.push_back(total_mass(of));
  }
};

class Momentum final : public SystemDiagnosis {
 public:
  explicit Momentum(DiagnosisParameters const& parameters) : SystemDiagnosis(parameters) {}
  bool sums() const override { return true; }
  std::vector<Column> columns_of_one() const override {
    return along_axes("momentum", dimension(), dimensions::momentum);
  }
  void measure_one(Ensembles of, Sample const& sample, std::vector<double>& values) override {
    Triple const p = momentum(of, sample.threads);
    values.insert(values.end(), p.begin(), p.begin() + dimension());
  }
};

class VortexInvariants final : public SystemDiagnosis {
 public:
  explicit VortexInvariants(DiagnosisParameters const& parameters) : SystemDiagnosis(parameters) {
    auto const& all = parameters.available;
    for (auto const& name : parameters.ensembles)
      if (auto const& named = ensemble_named(all, name); !has_vorticity(named))
        throw Error(fmt::format("'{}' is of class {}, which has no vorticity", name, named.class_name()));
    if (std::none_of(all.begin(), all.end(), [](auto const* one) { return has_vorticity(*one); }))
      throw Error("no ensemble has vorticity; classes Vortex, Inviscid, Viscous and Diffusive do");
  }
  std::vector<Column> columns_of_one() const override {
    using namespace dimensions;
    bool const plane = dimension() == 2;
    Dimension const of_line = circulation * length, of_impulse = of_line * (plane ? none : length);
    std::vector<Column> all;
    auto const add = [&](std::vector<Column> const& more) { all.insert(all.end(), more.begin(), more.end()); };
    add(plane ? std::vector<Column>{{"circulation", circulation}} : along_axes("total vorticity", 3, of_line));
    add(along_axes("impulse", dimension(), of_impulse));
    add(plane ? std::vector<Column>{{"angular impulse", of_impulse * length}}
              : along_axes("angular impulse", 3, of_impulse * length));
    if (!plane) add({{"helicity", of_line * velocity}});
    return all;
  }
  void measure_one(Ensembles of, Sample const&, std::vector<double>& values) override {
    auto const found = vortex_measures(of);
    int const numbers = dimension() == 2 ? 1 : 3;
    values.insert(values.end(), found.circulation.begin(), found.circulation.begin() + numbers);
    values.insert(values.end(), found.impulse.begin(), found.impulse.begin() + dimension());
    values.insert(values.end(), found.angular_impulse.begin(), found.angular_impulse.begin() + numbers);
    if (numbers == 3) values.push_back(found.helicity);
  }
};

class VortexEnergy final : public Diagnosis {
 public:
  explicit VortexEnergy(DiagnosisParameters const& parameters) {
    if (parameters.vortices.empty())
      throw Error("there are no vortices that make a flow: no law of Biot and Savart acts");
    for (auto const& source : parameters.vortices) {
      names_.push_back(source.ensemble->name());
      laws_.push_back(source.law);
    }
    dimension_ = dimension_of(parameters);
  }
  std::vector<Column> columns() const override {
    using namespace dimensions;
    Dimension const of_plane = circulation * circulation;
    bool const plane = dimension_ == 2;
    std::vector<Column> all{{"vortex energy", plane ? of_plane : of_plane * length},
                            {"enstrophy", plane ? circulation * frequency : circulation * velocity},
                            {"largest vorticity", frequency}};
    if (!plane) all.push_back({"vorticity divergence", none});
    return all;
  }
  void measure(Sample const& sample, std::vector<double>& values) override {
    std::vector<VortexSource> sources;
    for (std::size_t k = 0; k < names_.size(); ++k)
      sources.push_back({sample.ensembles[index_in(sample, names_[k])], laws_[k]});
    FlowMeasures const found = VortexFlow(sources, sample.box, sample.threads).measure();
    values.insert(values.end(), {found.energy, found.enstrophy, found.largest_vorticity});
    if (dimension_ == 3) values.push_back(found.divergence);
  }

 private:
  int dimension_;
  std::vector<std::string> names_;
  std::vector<VortexLaw> laws_;
};

class AngularMomentum final : public SystemDiagnosis {
 public:
  explicit AngularMomentum(DiagnosisParameters const& parameters)
      : SystemDiagnosis(parameters), about_centre_(parameters.about_centre_of_mass) {}
  bool sums() const override { return true; }
  std::vector<Column> columns_of_one() const override {
    if (dimension() < 3) return {{"angular momentum", dimensions::angular_momentum}};
    return along_axes("angular momentum", 3, dimensions::angular_momentum);
  }
  void measure_one(Ensembles of, Sample const&, std::vector<double>& values) override {
    Triple const l = angular_momentum(of, about_centre_ && total_mass(of) != 0 ? centre_of_mass(of) : Triple{});
    values.insert(values.end(), l.begin(), l.begin() + (dimension() < 3 ? 1 : 3));
  }

 private:
  bool about_centre_;
};

class TemperatureDiagnosis final : public SystemDiagnosis {
 public:
  explicit TemperatureDiagnosis(DiagnosisParameters const& parameters)
      : SystemDiagnosis(parameters), subtract_drift_(parameters.subtract_drift), rigid_bonds_(parameters.rigid_bonds) {
    for (auto const& name : parameters.ensembles)
      if (AnyEnsemble const& ensemble = ensemble_named(parameters.available, name); !carries_momentum(ensemble))
        throw Error(fmt::format("ensemble '{}' of class {} has no temperature: it needs a mass and a velocity", name,
                                ensemble.class_name()));
  }
  bool sums() const override { return true; }
  std::vector<Column> columns_of_one() const override {
    std::vector<Column> columns{{"temperature", dimensions::temperature}};
    if (dimension() > 1)
      for (auto& column : along_axes("temperature", dimension(), dimensions::temperature))
        columns.push_back(std::move(column));
    return columns;
  }
  void measure_one(Ensembles of, Sample const& sample, std::vector<double>& values) override {
    Temperature t = temperature(of, sample.boltzmann_constant,
                                {.subtract_drift = subtract_drift_, .box = &sample.box, .threads = sample.threads});
    double const lost = subtract_drift_ ? dimension() : 0;
    double const all = dimension() * static_cast<double>(number_of_particles(of)) - lost;
    // Each rigid bond takes a degree of freedom, alike of all axes.
    double kept = 0;
    for (auto const& [name, count] : rigid_bonds_)
      for (auto const* ensemble : of) kept += ensemble->name() == name ? static_cast<double>(count) : 0;
    if (kept > 0) {
      t.total *= all / (all - kept);
      for (double& component : t.component) component *= all / (all - kept);
    }
    values.push_back(t.total);
    if (dimension() > 1) values.insert(values.end(), t.component.begin(), t.component.begin() + dimension());
  }

 private:
  bool subtract_drift_;
  std::vector<std::pair<std::string, std::size_t>> rigid_bonds_;
};

/// Energies of the whole system; of named ensembles the kinetic energy besides.
class Energies final : public SystemDiagnosis {
 public:
  explicit Energies(DiagnosisParameters const& parameters)
      : SystemDiagnosis(parameters), whole_only_(parameters.ensembles.empty()) {}
  bool sums() const override { return true; }
  bool needs_energies() const override { return true; }
  std::vector<Column> columns_of_one() const override { return {{"kinetic energy", dimensions::energy}}; }
  void measure_one(Ensembles of, Sample const& sample, std::vector<double>& values) override {
    values.push_back(kinetic_energy(of, sample.threads));
  }
  std::vector<Column> columns_of_all() const override {
    std::vector<Column> columns;
    if (!whole_only_) columns.push_back({"kinetic energy", dimensions::energy});
    for (char const* name : {"potential energy", "external energy", "internal energy", "total energy"})
      columns.push_back({name, dimensions::energy});
    return columns;
  }
  void measure_all(Sample const& sample, std::vector<double>& values) override {
    double const kinetic = kinetic_energy(sample.ensembles, sample.threads);
    bool const known = sample.measures != nullptr && sample.measures->unknown.empty();
    double const potential = known ? sample.measures->potential : unknown;
    double const external = known ? sample.measures->external : unknown;
    double const internal = known ? sample.measures->internal : unknown;
    if (!whole_only_) values.push_back(kinetic);
    values.insert(values.end(), {potential, external, internal, kinetic + potential + external + internal});
  }

 private:
  bool whole_only_;
};

class Pressure final : public SystemDiagnosis {
 public:
  explicit Pressure(DiagnosisParameters const& parameters) : SystemDiagnosis(parameters) {}
  bool sums() const override { return true; }
  bool needs_virial() const override { return true; }
  std::vector<Column> columns_of_one() const override {
    Dimension const unit = dimensions::energy / pow(dimensions::length, dimension());
    std::vector<Column> columns{{"pressure", unit}};
    for (int a = 0; dimension() > 1 && a < dimension(); ++a)
      for (int b = 0; b < dimension(); ++b) columns.push_back({fmt::format("pressure {}{}", "xyz"[a], "xyz"[b]), unit});
    return columns;
  }
  void measure_one(Ensembles of, Sample const& sample, std::vector<double>& values) override {
    Tensor3 tensor;
    for (auto& row : tensor) row.fill(unknown);
    if (sample.measures != nullptr) tensor = pressure_tensor(of, *sample.measures, sample.box, sample.threads);
    values.push_back(sample.measures != nullptr ? pressure(of, *sample.measures, sample.box, sample.threads) : unknown);
    for (int a = 0; dimension() > 1 && a < dimension(); ++a)
      values.insert(values.end(), tensor[a].begin(), tensor[a].begin() + dimension());
  }
};

/// Of a flow that the images of a sheared box drive: minus the momentum along it that goes up its gradient, over its rate.
class Viscosity final : public Diagnosis {
 public:
  explicit Viscosity(DiagnosisParameters const& parameters)
      : dimension_(parameters.available.empty() ? 3 : parameters.available.front()->dimension()) {}
  bool sums() const override { return true; }
  bool needs_virial() const override { return true; }
  void check(Box const& box) const override {
    if (!box.sheared())
      throw Error("viscosity: the box is not sheared ('shear' in [box]); in equilibrium green-kubo gives a viscosity");
  }
  std::vector<Column> columns() const override {
    Dimension const stress = dimensions::energy / pow(dimensions::length, dimension_);
    return {{"viscosity", stress * dimensions::time}, {"shear stress", stress}};
  }
  void measure(Sample const& sample, std::vector<double>& values) override {
    check(sample.box);
    Shear const& shear = sample.box.shear();
    double stress = unknown;
    if (sample.measures != nullptr)
      stress =
          -pressure_tensor(sample.ensembles, *sample.measures, sample.box, sample.threads)[shear.gradient][shear.flow];
    values.insert(values.end(), {stress / shear.rate, stress});
  }

 private:
  int dimension_;
};

/// S / N k of an ideal gas (figure 3 of SPAM): of all ensembles that have what it needs, or of each named one.
class EntropyDiagnosis final : public SystemDiagnosis {
 public:
  explicit EntropyDiagnosis(DiagnosisParameters const& parameters)
      : SystemDiagnosis(parameters), options_{{parameters.weight, parameters.range}, parameters.gamma, {}} {
    std::vector<AnyEnsemble const*> chosen;
    for (auto const& name : parameters.ensembles) chosen.push_back(&ensemble_named(parameters.available, name));
    if (chosen.empty()) chosen = suitable(parameters.available);
    if (chosen.empty()) chosen = parameters.available;
    for (auto const* ensemble : chosen) {
      if (!has_entropy(*ensemble))
        throw Error(fmt::format("ensemble '{}' of class {} has no entropy: it needs mass, velocity and specific_energy",
                                ensemble->name(), ensemble->class_name()));
      if (!(parameters.range >= 0))
        throw Error(fmt::format("the range of an entropy must be above 0, it is {}", parameters.range));
      if (parameters.range == 0 && ensemble->find_field("range") == nullptr)
        throw Error(fmt::format("ensemble '{}' of class {} has no range of its own: an entropy of it needs 'range'",
                                ensemble->name(), ensemble->class_name()));
    }
    if (parameters.gamma != 0 && !(parameters.gamma > 1))
      throw Error(fmt::format("an entropy needs a gamma above 1, it is {}", parameters.gamma));
  }
  std::vector<Column> columns_of_one() const override {
    std::vector<Column> columns;
    for (char const* heat : {"", " without fluctuations", " with all motion"})
      for (char const* way : {"sum", "integral"})
        columns.push_back({fmt::format("entropy {}{}", way, heat), dimensions::none});
    return columns;
  }
  void measure_one(Ensembles of, Sample const& sample, std::vector<double>& values) override {
    SmoothEntropy const s = smooth_entropy(suitable(of), sample.box, options_);
    for (Entropy const& one : {s.with_fluctuations, s.without_fluctuations, s.with_all_motion})
      values.insert(values.end(), {one.sum, one.integral});
  }

 private:
  static std::vector<AnyEnsemble const*> suitable(Ensembles of) {
    std::vector<AnyEnsemble const*> all;
    for (auto const* ensemble : of)
      if (has_entropy(*ensemble)) all.push_back(ensemble);
    return all;
  }

  EntropyOptions options_;
};

std::unique_ptr<Diagnosis> make_heat_flux(DiagnosisParameters const& parameters) {
  int const axis = parameters.axis.empty() ? dimension_of(parameters) - 1 : parameters.axis[0] - 'x';
  return std::make_unique<HeatFlux>(parameters.available,
                                    HeatFluxOptions{axis, parameters.conductivity, parameters.since});
}

/// The first axis where none is named.
int axis_of(DiagnosisParameters const& parameters) { return parameters.axis.empty() ? 0 : parameters.axis[0] - 'x'; }

std::unique_ptr<Diagnosis> make_slab(DiagnosisParameters const& parameters) {
  for (auto const& name : parameters.ensembles) ensemble_named(parameters.available, name);
  return std::make_unique<Slab>(
      parameters.available,
      SlabOptions{axis_of(parameters), parameters.from, parameters.to, std::max<std::size_t>(parameters.count, 1),
                  parameters.ensembles, parameters.label.empty() ? "slab" : parameters.label});
}

std::unique_ptr<Diagnosis> make_shock(DiagnosisParameters const& parameters) {
  for (auto const& name : parameters.ensembles) ensemble_named(parameters.available, name);
  ShockOptions options;
  options.axis = axis_of(parameters);
  if (!parameters.end.empty() && parameters.end != "low" && parameters.end != "high")
    throw Error(fmt::format("a shock comes from the end 'low' or 'high' of its axis, not '{}'", parameters.end));
  if (!parameters.end.empty()) options.end = parameters.end == "low" ? Box::End::low : Box::End::high;
  if (!parameters.quantity.empty()) options.quantity = parameters.quantity;
  options.count = parameters.count;
  options.since = parameters.since;
  options.margin = parameters.margin;
  options.near = parameters.near;
  options.far = parameters.far;
  options.ensembles = parameters.ensembles;
  return std::make_unique<Shock>(parameters.available, std::move(options));
}

// ---- Of a group of particles ----

/// A group in each of the chosen ensembles: all, by number, or those of similar velocity at the first look.
class GroupDiagnosis : public Diagnosis {
 public:
  explicit GroupDiagnosis(DiagnosisParameters const& parameters)
      : dimension_(dimension_of(parameters)),
        names_(parameters.ensembles.empty() ? names_of(parameters.available) : parameters.ensembles),
        label_(parameters.label),
        particles_(parameters.particles),
        similar_(parameters.similar_velocity),
        tolerance_(parameters.tolerance) {
    if (!particles_.empty() && similar_)
      throw Error("a group is given by particle numbers or by a velocity, not by both");
    if ((!particles_.empty() || !label_.empty()) && names_.size() != 1)
      throw Error(fmt::format("a group of chosen particles belongs to one ensemble; say which of {}", join(names_)));
    if (!(tolerance_ >= 0))
      throw Error(fmt::format("the tolerance of a group must not be negative, it is {}", tolerance_));
    for (auto const& name : names_) {
      AnyEnsemble const& ensemble = ensemble_named(parameters.available, name);
      for (std::uint32_t const i : particles_)
        if (i >= ensemble.size())
          throw Error(fmt::format("ensemble '{}' has {} particles, numbered from 0; there is no particle {}", name,
                                  ensemble.size(), i));
      prefixes_.push_back(label_.empty() ? name : label_);
    }
  }

  std::vector<Column> columns() const final {
    std::vector<Column> columns;
    for (std::size_t g = 0; g < prefixes_.size(); ++g)
      for (auto const& column : columns_of_group(g))
        columns.push_back({prefixed(prefixes_[g], column.name), column.dimension});
    return columns;
  }

  void measure(Sample const& sample, std::vector<double>& values) final {
    if (similar_ && groups_.empty()) choose_similar(sample);
    for (std::size_t g = 0; g < names_.size(); ++g) {
      std::size_t const e = index_in(sample, names_[g]);
      AnyEnsemble const& ensemble = *sample.ensembles[e];
      auto const group = similar_ ? groups_[g] : particles_.empty() ? all_particles(ensemble) : particles_;
      for (std::uint32_t const i : group)
        if (i >= ensemble.size())
          throw Error(fmt::format("a group has particle {} of '{}', which has {} now", i, names_[g], ensemble.size()));
      measure_group(g, ensemble, group, energies_of(sample, e), values);
    }
  }

  bool by_number() const final { return similar_ || !particles_.empty(); }

  /// Nothing before the first look; then, for each ensemble, the size of its group and the numbers of its particles.
  std::vector<double> state() const final {
    std::vector<double> state;
    for (auto const& group : groups_) {
      state.push_back(static_cast<double>(group.size()));
      state.insert(state.end(), group.begin(), group.end());
    }
    return state;
  }
  void restore(std::span<double const> state) final {
    groups_.clear();
    if (state.empty()) return;
    std::size_t at = 0;
    for (std::size_t g = 0; similar_ && g < names_.size(); ++g) {
      auto const left = static_cast<double>(state.size() - at);
      double const count = at < state.size() ? state[at++] : -1;
      if (!(count >= 0 && count < left)) break;
      auto const begin = state.begin() + static_cast<std::ptrdiff_t>(at);
      auto& group = groups_.emplace_back();
      std::transform(begin, begin + static_cast<std::ptrdiff_t>(count), std::back_inserter(group),
                     [](double i) { return static_cast<std::uint32_t>(i); });
      at += group.size();
    }
    if (groups_.size() != names_.size() || at != state.size())
      throw Error("the checkpoint does not fit this diagnosis: its groups are others");
  }

 protected:
  int dimension() const { return dimension_; }
  virtual std::vector<Column> columns_of_group(std::size_t group) const = 0;
  virtual void measure_group(std::size_t group, AnyEnsemble const& ensemble,
                             std::vector<std::uint32_t> const& particles, std::span<double const> energies,
                             std::vector<double>& values) = 0;

 private:
  void choose_similar(Sample const& sample) {
    std::size_t found = 0;
    for (auto const& name : names_) {
      groups_.push_back(similar_particles(*sample.ensembles[index_in(sample, name)], *similar_, tolerance_));
      found += groups_.back().size();
    }
    if (found > 0) return;
    groups_.clear();
    throw Error(fmt::format("no particle of {} starts within {} of the velocity ({})", join(names_), tolerance_,
                            fmt::join(std::span(*similar_).first(static_cast<std::size_t>(dimension_)), ", ")));
  }
  static std::span<double const> energies_of(Sample const& sample, std::size_t e) {
    if (sample.measures == nullptr || !sample.measures->unknown.empty()) return {};
    if (e >= sample.measures->per_particle.size()) return {};
    return sample.measures->per_particle[e];
  }

  int dimension_;
  std::vector<std::string> names_, prefixes_;
  std::string label_;
  std::vector<std::uint32_t> particles_;
  std::optional<Triple> similar_;
  double tolerance_;
  std::vector<std::vector<std::uint32_t>> groups_;
};

class MeanVelocity final : public GroupDiagnosis {
 public:
  explicit MeanVelocity(DiagnosisParameters const& parameters) : GroupDiagnosis(parameters) {}
  std::vector<Column> columns_of_group(std::size_t) const override {
    return along_axes("mean velocity", dimension(), dimensions::velocity);
  }
  void measure_group(std::size_t, AnyEnsemble const& ensemble, std::vector<std::uint32_t> const& particles,
                     std::span<double const>, std::vector<double>& values) override {
    Triple const mean = mean_velocity(ensemble, particles);
    values.insert(values.end(), mean.begin(), mean.begin() + dimension());
  }
};

class VelocityDiffusion final : public GroupDiagnosis {
 public:
  explicit VelocityDiffusion(DiagnosisParameters const& parameters) : GroupDiagnosis(parameters) {}
  std::vector<Column> columns_of_group(std::size_t) const override {
    return {{"velocity spread", dimensions::velocity * dimensions::velocity}};
  }
  void measure_group(std::size_t, AnyEnsemble const& ensemble, std::vector<std::uint32_t> const& particles,
                     std::span<double const>, std::vector<double>& values) override {
    values.push_back(velocity_spread(ensemble, particles));
  }
};

class ExtremesDiagnosis final : public GroupDiagnosis {
 public:
  explicit ExtremesDiagnosis(DiagnosisParameters const& parameters)
      : GroupDiagnosis(parameters), units_(parameters.units) {
    auto const names = parameters.ensembles.empty() ? names_of(parameters.available) : parameters.ensembles;
    for (auto const& name : names)
      meanings_.push_back(quantity_meaning(ensemble_named(parameters.available, name), parameters.quantity, &units_));
  }
  bool needs_energies() const override {
    std::string const& name = meanings_.front().name;
    return name == "potential-energy" || name.find("potential_energy") != std::string::npos;
  }
  std::vector<Column> columns_of_group(std::size_t group) const override {
    auto const& meaning = meanings_[group];
    std::vector<Column> columns;
    for (char const* which : {"minimum", "maximum", "mean"})
      columns.push_back({fmt::format("{} {}", meaning.label, which), meaning.dimension});
    return columns;
  }
  void measure_group(std::size_t group, AnyEnsemble const& ensemble, std::vector<std::uint32_t> const& particles,
                     std::span<double const> energies, std::vector<double>& values) override {
    auto const all = quantity(ensemble, meanings_[group].name, energies, &units_);
    std::vector<double> chosen;
    chosen.reserve(particles.size());
    for (std::uint32_t const i : particles) {
      if (i >= all.size()) throw Error(fmt::format("ensemble '{}' has no particle {} any more", ensemble.name(), i));
      chosen.push_back(all[i]);
    }
    Extremes const found = extremes(chosen);
    values.insert(values.end(), {found.minimum, found.maximum, found.mean});
  }

 private:
  UnitSystem units_;
  std::vector<QuantityMeaning> meanings_;
};

// ---- Of a mesh ----

class FieldEnergy final : public Diagnosis {
 public:
  explicit FieldEnergy(DiagnosisParameters const& parameters) { field_energy(parameters.mesh_fields); }
  bool sums() const override { return true; }
  bool needs_mesh() const override { return true; }
  std::vector<Column> columns() const override { return {{"field energy", dimensions::energy}}; }
  void measure(Sample const& sample, std::vector<double>& values) override {
    values.push_back(field_energy(sample.mesh_fields));
  }
};

/// "field.x" where nothing is said.
std::string mesh_quantity_name(DiagnosisParameters const& parameters) {
  return parameters.quantity.empty() ? "field.x" : parameters.quantity;
}

class FieldMode final : public Diagnosis {
 public:
  explicit FieldMode(DiagnosisParameters const& parameters) : quantity_(mesh_quantity_name(parameters)) {
    MeshQuantity const quantity = mesh_quantity(parameters.mesh_fields, quantity_);
    if (parameters.mode.size() != static_cast<std::size_t>(quantity.grid().dimension))
      throw Error(
          fmt::format("field-mode: 'mode' has {} number{}, the mesh {} ax{}; give the periods in the box along "
                      "each axis",
                      parameters.mode.size(), parameters.mode.size() == 1 ? "" : "s", quantity.grid().dimension,
                      quantity.grid().dimension == 1 ? "is" : "es"));
    std::copy(parameters.mode.begin(), parameters.mode.end(), mode_.begin());
    field_mode(quantity, mode_);
    label_ = fmt::format("{} mode {}", quantity.label, fmt::join(parameters.mode, " "));
    dimension_ = quantity.dimension();
  }
  bool sums() const override { return true; }
  bool needs_mesh() const override { return true; }
  std::vector<Column> columns() const override {
    return {{label_ + " amplitude", dimension_}, {label_ + " real", dimension_}, {label_ + " imaginary", dimension_}};
  }
  void measure(Sample const& sample, std::vector<double>& values) override {
    auto const c = field_mode(mesh_quantity(sample.mesh_fields, quantity_), mode_);
    values.insert(values.end(), {std::abs(c), c.real(), c.imag()});
  }

 private:
  std::string quantity_, label_;
  std::array<int, 3> mode_{0, 0, 0};
  Dimension dimension_;
};

std::unique_ptr<Diagnosis> make_wave_spectrum(DiagnosisParameters const& parameters) {
  std::string const name = mesh_quantity_name(parameters);
  MeshQuantity const quantity = mesh_quantity(parameters.mesh_fields, name);
  MeshGrid const& grid = quantity.grid();
  int const axis = parameters.axis.empty() ? 0 : parameters.axis[0] - 'x';
  if (parameters.axis.size() > 1 || axis < 0 || axis >= grid.dimension)
    throw Error(fmt::format("wave-spectrum: the mesh has no axis '{}'; it has {}", parameters.axis,
                            grid.dimension == 1   ? "x"
                            : grid.dimension == 2 ? "x, y"
                                                  : "x, y, z"));
  if (!grid.periodic[axis])
    throw Error(fmt::format("wave-spectrum: the axis {} is not periodic, so that no waves belong to it", "xyz"[axis]));
  return std::make_unique<WaveSpectrum>(name, axis, parameters.modes);
}

std::unique_ptr<Diagnosis> make_body_forces(DiagnosisParameters const& parameters) {
  return std::make_unique<BodyForces>(parameters.available, parameters.stream, parameters.length);
}

// ---- Structure and transport ----

/// Where nothing is said, what its options begin with.
std::size_t or_usual(std::size_t said, std::size_t usual) { return said > 0 ? said : usual; }

std::unique_ptr<Diagnosis> make_radial_distribution(DiagnosisParameters const& parameters) {
  RadialDistributionOptions options{parameters.ensembles, parameters.label, parameters.to};
  options.count = or_usual(parameters.count, options.count);
  options.since = parameters.since;
  options.every = parameters.every;
  options.particles = parameters.particles;
  options.partners = parameters.partners;
  return std::make_unique<RadialDistribution>(parameters.available, std::move(options));
}

std::unique_ptr<Diagnosis> make_structure_factor(DiagnosisParameters const& parameters) {
  StructureFactorOptions options{parameters.ensembles, parameters.label};
  options.modes = or_usual(parameters.modes, options.modes);
  if (!parameters.by.empty()) options.by = wave_sums_words().named(parameters.by);
  options.since = parameters.since;
  options.every = parameters.every;
  options.particles = parameters.particles;
  options.partners = parameters.partners;
  return std::make_unique<StructureFactor>(parameters.available, std::move(options));
}

std::unique_ptr<Diagnosis> make_bond_order(DiagnosisParameters const& parameters) {
  return std::make_unique<BondOrder>(parameters.available, BondOrderOptions{parameters.ensembles, parameters.label,
                                                                            parameters.range, parameters.order});
}

template <class Kind>
std::unique_ptr<Diagnosis> make_time_correlation(DiagnosisParameters const& parameters) {
  TimeCorrelationOptions options{parameters.ensembles, parameters.since, parameters.every};
  options.count = or_usual(parameters.count, options.count);
  options.origins = parameters.origins;
  options.subtract_drift = parameters.subtract_drift;
  options.label = parameters.label;
  options.particles = parameters.particles;
  return std::make_unique<Kind>(parameters.available, options);
}

std::unique_ptr<Diagnosis> make_green_kubo(DiagnosisParameters const& parameters) {
  GreenKuboOptions options;
  options.quantity = transport_words().named(parameters.quantity);
  options.count = or_usual(parameters.count, options.count);
  options.since = parameters.since;
  return std::make_unique<GreenKubo>(parameters.available, options);
}

std::unique_ptr<Diagnosis> make_mean_profile(DiagnosisParameters const& parameters) {
  MeanProfileOptions options;
  if (!parameters.quantity.empty()) options.quantities = parameters.quantity;
  options.ensembles = parameters.ensembles;
  options.label = parameters.label;
  options.axis = axis_of(parameters);
  options.from = parameters.from;
  options.to = parameters.to;
  options.count = or_usual(parameters.count, options.count);
  options.since = parameters.since;
  return std::make_unique<MeanProfile>(parameters.available, std::move(options));
}

std::unique_ptr<Diagnosis> make_average(DiagnosisParameters const& parameters) {
  return std::make_unique<Average>(parameters.columns_before,
                                   AverageOptions{parameters.columns, parameters.label, parameters.since});
}

// ---- The table ----

using Maker = std::unique_ptr<Diagnosis> (*)(DiagnosisParameters const&);

template <class Kind>
std::unique_ptr<Diagnosis> make(DiagnosisParameters const& parameters) {
  return std::make_unique<Kind>(parameters);
}

struct Entry {
  DiagnosisKind kind;
  Maker make;
};

OptionTable told(std::vector<OptionKey> const& keys) { return diagnosis_options().only(keys); }

std::vector<Entry> const& table() {  // long: a table, an entry for each diagnosis
  static std::vector<Entry> const entries = [] {
    OptionKey const each{"ensembles", "one set of columns for each of them", "of each ensemble there is"};
    std::vector<OptionKey> const group{each, {"label"}, {"particles"}, {"similar_velocity"}, {"tolerance"}};
    std::vector<OptionKey> group_and_quantity = group;
    group_and_quantity.push_back({"quantity", "a field, `\"speed\"`, `\"kinetic-energy\"`, ...", "", "\"speed\""});
    OptionKey const on_mesh{"quantity", "`\"field.x\"`, `\"potential\"` or `\"density\"`", "`\"field.x\"`"};
    OptionKey const pairs_of{"ensembles", "of one: pairs within it; of two: between them", "of all particles"};
    OptionKey const first_look{"since", "the time of the first look", "the start"};
    OptionKey const rows{"every", "only rows whose steps are multiples of it count"};
    OptionKey const lags{"count", "the longest lag, in looks", "`200`"};
    OptionKey const group_label{"label", "of columns and files", "by the ensemble"};
    OptionKey const moving{"subtract_drift", "relative to the mean of the ensemble"};
    OptionKey const some{"ensembles", "only of these", "all of the matter"};
    return std::vector<Entry>{
        {{"energies", "kinetic, potential, external, internal and total energy",
          told({{"ensembles", "the kinetic energy of each of them, too", "of none"}})},
         make<Energies>},
        {{"momentum", "total momentum: the sum of m v", told({{"ensembles"}})}, make<Momentum>},
        {{"angular-momentum", "the sum of m r x v about the origin or the centre of mass; conserved in open space only",
          told({{"ensembles"}, {"about_centre_of_mass"}})},
         make<AngularMomentum>},
        {{"vortex-invariants",
          "circulation, linear and angular impulse of vortices, in 3D helicity: what a flow without viscosity "
          "conserves "
          "in open space",
          told({{"ensembles"}})},
         make<VortexInvariants>},
        {{"vortex-energy",
          "of the flow of vortices in open space: energy (2D: Hamilton's function) and enstrophy over the density of "
          "the "
          "fluid, the largest vorticity at an element, in 3D how much of the vorticity has a divergence; sums over all "
          "pairs",
          {},
          false,
          true},
         make<VortexEnergy>},
        {{"body-forces",
          "what a flow does to the bodies in it, over its density and in the mean since the row before: on all of them "
          "by "
          "the change of the flow's impulse, with drag and lift coefficients, and on each by pressure",
          told({{"stream"}, {"length"}})},
         make_body_forces},
        {{"temperature", "m <v^2> / k along each axis and their mean", told({{"ensembles"}, {"subtract_drift"}})},
         make<TemperatureDiagnosis>},
        {{"pressure", "the pressure tensor (sum of m v v + virial) / volume and the mean of its diagonal", {}},
         make<Pressure>},
        {{"viscosity",
          "of a sheared box: shear stress over rate, with friction between pairs; the mean is that of `average`",
          {}},
         make<Viscosity>},
        {{"number", "number of particles and their mass", told({{"ensembles"}})}, make<Number>},
        {{"entropy",
          "entropy S / N k of an ideal gas of smooth particles, as a sum over them and as an integral, with and "
          "without the fluctuations of their velocities",
          told({{"ensembles"}, {"weight"}, {"range"}, {"gamma"}})},
         make<EntropyDiagnosis>},
        {{"heat-flux",
          "of smooth particles between two walls with temperatures: heat conducted, heat carried by the flow, and "
          "Nusselt's number with its mean and spread",
          told({{"axis", "from wall to wall", "the last"}, {"conductivity", "", "", "0.1"}, {"since"}})},
         make_heat_flux},
        {{"slab",
          "kinetic (about the mean velocity) and internal temperature, density, velocity and place of the particles "
          "that were between two places at the start",
          told({some,
                {"label", "of the columns", "`\"slab\"`"},
                {"axis", "across the slab", "`\"x\"`"},
                {"from"},
                {"to"},
                {"count", "equal slabs side by side", "`1`"}})},
         make_slab},
        {{"shock",
          "place and speed of a plane shock front, the matter behind and ahead of it in windows that move with it, and "
          "by how much Rankine's and Hugoniot's three conditions fail",
          told({some,
                {"axis", "along which the shock runs", "`\"x\"`"},
                {"end"},
                {"quantity", "the front is where it is half way between ahead and behind", "`\"velocity\"`", "",
                 option::word({"velocity", "density"})},
                {"count", "bins of the profile that shows the front", "as they fit"},
                {"since"},
                {"margin"},
                {"near"},
                {"far"}})},
         make_shock},
        {{"mean-velocity", "of a group of particles: its change is the drag", told(group)}, make<MeanVelocity>},
        {{"velocity-diffusion", "mean square spread of the velocities of a group of particles", told(group)},
         make<VelocityDiffusion>},
        {{"diffusion",
          "mean square displacement of particles, relative to their mean and followed through periodic axes, and the "
          "diffusion coefficient by a straight line through it",
          told({each, {"since"}})},
         [](DiagnosisParameters const& parameters) -> std::unique_ptr<Diagnosis> {
           return std::make_unique<Diffusion>(parameters.available, parameters.ensembles, parameters.since);
         }},
        {{"radial-distribution",
          "height and place of the highest peak of g(r), over the looks so far; g(r) and the running coordination "
          "number in radial-distribution.csv",
          told({pairs_of,
                {"label", "of columns and file", "the ensembles"},
                {"particles"},
                {"partners"},
                {"to", "the largest distance", "half of the box's shortest side"},
                {"count", "bins", "`200`"},
                rows,
                first_look})},
         make_radial_distribution},
        {{"structure-factor",
          "height and place of the highest value of S(k), over the wave vectors of a periodic box; S(k) in "
          "structure-factor.csv",
          told({pairs_of,
                {"label", "of columns and file", "the ensembles"},
                {"particles"},
                {"partners"},
                {"modes", "the shortest wave: so many periods in the longest side", "`12`"},
                {"by"},
                rows,
                first_look})},
         make_structure_factor},
        {{"bond-order",
          "how far the directions to neighbours are those of a crystal: in 3D Steinhardt's q6 (fcc 0.575, bcc 0.629), "
          "in 2D psi6 (triangles 1), in the mean over particles and of the whole, and the mean number of neighbours",
          told({{"ensembles", "among the particles of one", "among all"},
                {"label", "of the columns", "the ensemble"},
                {"range", "neighbours are within it", "", "1.5"},
                {"order", "4 sees squares and cubes, 6 triangles and close packing", "`6`"}})},
         make_bond_order},
        {{"velocity-autocorrelation",
          "the diffusion coefficient of Green and Kubo, from many time origins; <v(0).v(t)> in "
          "velocity-autocorrelation.csv, its spectrum in velocity-spectrum.csv",
          told({each, group_label, {"particles"}, first_look, {"every"}, lags, {"origins"}, moving})},
         make_time_correlation<VelocityAutocorrelation>},
        {{"mean-square-displacement",
          "the diffusion coefficient of Einstein, by the later half of the mean square displacement from many time "
          "origins, followed through periodic axes; that in mean-square-displacement.csv",
          told({each, group_label, {"particles"}, first_look, {"every"}, lags, {"origins"}, moving})},
         make_time_correlation<MeanSquareDisplacement>},
        {{"green-kubo",
          "a transport coefficient by the autocorrelation of the system's flux in equilibrium, from row to row; that "
          "in "
          "green-kubo-viscosity.csv and the like",
          told({{"quantity", "the coefficient", "", "\"viscosity\"", option::word(transport_words().names())},
                {"count", "the longest lag, in rows", "`200`"},
                first_look})},
         make_green_kubo},
        {{"mean-profile",
          "the lowest and the highest density, temperature, ... of bins along an axis, over the looks so far; the "
          "profiles in mean-profile.csv",
          told({some,
                {"label", "of columns and file", "none"},
                {"quantity", "with commas, what the drawing `profile` has: `\"density, pressure.xx\"`",
                 "`\"density, kinetic-temperature\"`"},
                {"axis", "across the bins", "`\"x\"`"},
                {"from", "where the bins begin"},
                {"to", "where they end"},
                {"count", "bins", "`50`"},
                first_look})},
         make_mean_profile},
        {{"average",
          "of columns of the diagnoses above: the mean over the rows so far, its error by blocks of rows, and their "
          "ratio; the run's last lines tell them, average.csv has the error by the length of blocks",
          told({{"columns"}, {"label", "of the file", "none"}, first_look})},
         make_average},
        {{"chains",
          "of chains of particles, one behind the other: mean squares of the distance from end to end and of the "
          "radius "
          "of gyration, and the root of the mean square bond",
          told({each, {"count", "particles of a chain", "", "20"}})},
         [](DiagnosisParameters const& parameters) -> std::unique_ptr<Diagnosis> {
           return std::make_unique<Chains>(parameters.available, parameters.ensembles, parameters.count);
         }},
        {{"extremes", "minimum, maximum and mean of a quantity over a group of particles", told(group_and_quantity)},
         make<ExtremesDiagnosis>},
        {{"formula",
          "what a formula makes of the particles of an ensemble, with mean(...), sum(...), min(...) and max(...) over "
          "them",
          told({each,
                {"label", "of the column", "", "\"order\""},
                {"formula", "", "", "\"norm(mean(velocity))/mean(speed)\""},
                {"parameters"},
                {"where"},
                {"particles"}})},
         formula_diagnosis},
        {{"histogram", "which part of the particles of an ensemble has values of a formula in each of some bins",
          told({each,
                {"label", "of the columns", "", "\"speeds\""},
                {"formula", "of one particle", "", "\"speed\""},
                {"from", "the lower end of the first bin", "", "0", option::number(option::of_what_is_shown)},
                {"to", "the upper end of the last bin", "", "10", option::number(option::of_what_is_shown)},
                {"count", "bins", "`20`"},
                {"parameters"},
                {"where"},
                {"particles"}})},
         histogram_diagnosis},
        {{"field-energy", "of a mesh: half the integral of density times potential, the energy of its field", {}, true},
         make<FieldEnergy>},
        {{"field-mode",
          "of a mesh: amplitude, real and imaginary part of c in Re(c exp(i k x)), the wave with so many periods in "
          "the box along each axis",
          told({{"mode", "", "", "[3]"}, on_mesh}), true},
         make<FieldMode>},
        {{"wave-spectrum", "of a mesh: no columns; records a quantity for the drawing wave-spectrum",
          told({on_mesh, {"axis", "along which waves run", "`\"x\"`"}, {"modes"}}), true},
         make_wave_spectrum},
        {{"box", "volume and lengths of the box, and the mass of all particles over the volume", {}},
         [](DiagnosisParameters const& parameters) -> std::unique_ptr<Diagnosis> {
           return std::make_unique<BoxMeasures>(dimension_of(parameters));
         }},
        {{"energy-balance", "energy, work of moving walls, heat of baths, and what is left: the first less these", {}},
         [](DiagnosisParameters const&) -> std::unique_ptr<Diagnosis> { return std::make_unique<EnergyBalance>(); }},
    };
  }();
  return entries;
}

void refuse_unused(DiagnosisKind const& kind, DiagnosisParameters parameters) {
  DiagnosisParameters plain;
  for (auto const& option : diagnosis_options())
    if (!kind.options.find(option.key) && toml_value(option, &parameters) != toml_value(option, &plain))
      throw Error(fmt::format("diagnosis {} has no option {}; it has {}", kind.name, option.key,
                              kind.options.empty() ? "none" : join(kind.options.keys())));
}

}  // namespace

std::vector<DiagnosisKind> const& diagnosis_kinds() {
  static std::vector<DiagnosisKind> const kinds = [] {
    std::vector<DiagnosisKind> all;
    for (auto const& entry : table()) all.push_back(entry.kind);
    return all;
  }();
  return kinds;
}

void find_vortices(DiagnosisParameters& parameters, std::vector<Scheme*> const& schemes) {
  parameters.vortices = vortex_sources(schemes);
  if (!schemes.empty()) VortexFlow::refuse_images(schemes.front()->box());
}

void find_rigid_bonds(DiagnosisParameters& parameters, std::vector<Scheme*> const& schemes) {
  for (auto const* scheme : schemes)
    if (auto const* molecules = dynamic_cast<MoleculeScheme const*>(scheme))
      for (auto const& bonds : molecules->rigid_bonds())
        parameters.rigid_bonds.emplace_back(bonds->ensemble().name(), bonds->size());
}

std::unique_ptr<Diagnosis> make_diagnosis(std::string_view kind, DiagnosisParameters const& parameters) {
  std::vector<std::string> names;
  for (auto const& entry : table()) {
    if (entry.kind.name == kind) {
      refuse_unused(entry.kind, parameters);
      return entry.make(parameters);
    }
    names.push_back(entry.kind.name);
  }
  throw Error(fmt::format("there is no diagnosis '{}'; there are {}{}", kind, join(names), did_you_mean(kind, names)));
}

}  // namespace boltzmann
