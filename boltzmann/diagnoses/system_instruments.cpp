// Numbers, momenta, temperatures, energies, pressures: each converts functions of measures.hpp to columns.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/entropy.hpp>
#include <boltzmann/diagnoses/system_diagnosis.hpp>
#include <boltzmann/diagnoses/unknown.hpp>

#include <fmt/format.h>

#include <utility>

namespace boltzmann::instruments {
namespace {

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
      : SystemDiagnosis(parameters), subtract_drift_(parameters.subtract_drift) {
    for (auto const& name : parameters.ensembles)
      if (AnyEnsemble const& ensemble = ensemble_named(parameters.available, name); !carries_momentum(ensemble))
        throw Error(fmt::format("ensemble '{}' of class {} has no temperature: it needs a mass and a velocity", name,
                                ensemble.class_name()));
  }
  bool sums() const override { return true; }
  bool needs_kept_momentum() const override { return !subtract_drift_; }
  std::vector<Column> columns_of_one() const override {
    std::vector<Column> columns{{"temperature", dimensions::temperature}};
    if (dimension() > 1)
      for (auto& column : along_axes("temperature", dimension(), dimensions::temperature))
        columns.push_back(std::move(column));
    return columns;
  }
  void measure_one(Ensembles of, Sample const& sample, std::vector<double>& values) override {
    Temperature const t = temperature(of, sample.boltzmann_constant,
                                      {.subtract_drift = subtract_drift_,
                                       .box = &sample.box,
                                       .threads = sample.threads,
                                       .system = sample.ensembles,
                                       .momentum_is_kept = sample.momentum_is_kept});
    values.push_back(t.total);
    if (dimension() > 1) values.insert(values.end(), t.component.begin(), t.component.begin() + dimension());
  }

 private:
  bool subtract_drift_;
};

/// Energies of the whole system; for named ensembles also the kinetic energy.
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

/// The viscosity of a flow that the images of a sheared box drive: minus the flux of its momentum up the gradient,
/// divided by the rate.
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

/// S / N k of an ideal gas (figure 3 of SPAM): of all ensembles with the necessary fields, or of each named one.
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

}  // namespace

std::unique_ptr<Diagnosis> make_number(DiagnosisParameters const& parameters) {
  return std::make_unique<Number>(parameters);
}
std::unique_ptr<Diagnosis> make_momentum(DiagnosisParameters const& parameters) {
  return std::make_unique<Momentum>(parameters);
}
std::unique_ptr<Diagnosis> make_angular_momentum(DiagnosisParameters const& parameters) {
  return std::make_unique<AngularMomentum>(parameters);
}
std::unique_ptr<Diagnosis> make_temperature(DiagnosisParameters const& parameters) {
  return std::make_unique<TemperatureDiagnosis>(parameters);
}
std::unique_ptr<Diagnosis> make_energies(DiagnosisParameters const& parameters) {
  return std::make_unique<Energies>(parameters);
}
std::unique_ptr<Diagnosis> make_pressure(DiagnosisParameters const& parameters) {
  return std::make_unique<Pressure>(parameters);
}
std::unique_ptr<Diagnosis> make_viscosity(DiagnosisParameters const& parameters) {
  return std::make_unique<Viscosity>(parameters);
}
std::unique_ptr<Diagnosis> make_entropy(DiagnosisParameters const& parameters) {
  return std::make_unique<EntropyDiagnosis>(parameters);
}

}  // namespace boltzmann::instruments
