// Formulas, evaluated for the particles of each ensemble: means and sums, and histograms.
#include <boltzmann/diagnoses/formula_diagnosis.hpp>

#include <boltzmann/particles/particle_formula.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace boltzmann {
namespace {

/// The names in a diagnosis' formula: fields, time, parameters, parts.
ParticleNames names_for(AnyEnsemble const& ensemble, DiagnosisParameters const& parameters) {
  ParticleNames names(ensemble.fields(), ensemble.dimension(), parameters.units);
  names.add_time();
  auto const need_new = [&](std::string const& name) {
    if (names.inputs.has(name))
      throw FormulaPartError(name, 0, fmt::format("'{}' means something else in a formula already", name));
  };
  for (auto const& [name, value, dimension] : parameters.formula_parameters) {
    need_new(name);
    names.inputs.define(name, value, dimension);
  }
  for (auto const& [name, text] : parameters.formula_parts) {
    need_new(name);
    try {
      names.inputs.define(name, text);
    } catch (FormulaError const& error) {
      throw FormulaPartError(name, error.offset, error.what());
    }
  }
  return names;
}

/// Base of diagnoses of the rows of each chosen ensemble, or of chosen particles of one.
class OfEnsembles : public Diagnosis {
 public:
  explicit OfEnsembles(DiagnosisParameters const& parameters)
      : label_(parameters.label), particles_(parameters.particles) {
    if (parameters.formula.empty()) throw Error("a formula is needed, e.g. formula = \"mean(speed)\"");
    for (auto const* ensemble : parameters.available)
      if (parameters.ensembles.empty()) ensembles_.push_back(ensemble->name());
    for (auto const& name : parameters.ensembles) ensembles_.push_back(name);
    if (ensembles_.empty()) throw Error("a diagnosis needs an ensemble; the simulation has none");
    if (!particles_.empty() && ensembles_.size() > 1)
      throw Error(fmt::format("a group of chosen particles belongs to one ensemble; name one of {}", join(ensembles_)));
    for (auto const& name : ensembles_) {
      AnyEnsemble const& ensemble = named(parameters.available, name);
      for (auto const i : particles_)
        if (i >= ensemble.size())
          throw Error(fmt::format("ensemble '{}' has {} particles, numbered from 0; there is no particle {}", name,
                                  ensemble.size(), i));
    }
  }

  void measure(Sample const& sample, std::vector<double>& values) final {
    for (std::size_t e = 0; e < ensembles_.size(); ++e) {
      AnyEnsemble const& ensemble = named(sample.ensembles, ensembles_[e]);
      for (auto const i : particles_)
        if (i >= ensemble.size())
          throw Error(
              fmt::format("a group has particle {} of '{}', which has {} now", i, ensembles_[e], ensemble.size()));
      measure_one(e, ensemble, sample.time, values);
    }
  }
  bool by_number() const final { return !particles_.empty(); }

 protected:
  virtual void measure_one(std::size_t e, AnyEnsemble const& ensemble, double time, std::vector<double>& values) = 0;

  template <class All>
  static AnyEnsemble const& named(All const& all, std::string const& name) {
    std::vector<std::string> names;
    for (auto const* one : all) {
      if (one->name() == name) return *one;
      names.push_back(one->name());
    }
    throw Error(fmt::format("there is no ensemble '{}'{}", name, choices(name, names)));
  }
  std::size_t count(AnyEnsemble const& ensemble) const {
    return particles_.empty() ? ensemble.size() : particles_.size();
  }
  double const* row(AnyEnsemble const& ensemble, std::size_t k) const {
    return ensemble.row(particles_.empty() ? k : particles_[k]);
  }
  /// The name of its columns.
  std::string title(std::size_t e) const { return ensembles_.size() == 1 ? label_ : ensembles_[e] + " " + label_; }
  std::vector<std::string> const& ensembles() const { return ensembles_; }

 private:
  std::string label_;
  std::vector<std::uint32_t> particles_;
  std::vector<std::string> ensembles_;
};

class FormulaDiagnosis final : public OfEnsembles {
 public:
  explicit FormulaDiagnosis(DiagnosisParameters const& parameters) : OfEnsembles(parameters) {
    for (auto const& name : ensembles()) {
      AnyEnsemble const& ensemble = named(parameters.available, name);
      formulas_.emplace_back(parameters.formula, names_for(ensemble, parameters));
    }
  }
  std::vector<Column> columns() const override {
    std::vector<Column> columns;
    for (std::size_t e = 0; e < formulas_.size(); ++e)
      for (std::size_t c = 0; c < formulas_[e].components(); ++c) {
        std::string const component = formulas_[e].components() > 1 ? fmt::format(" {}", "xyz"[c]) : "";
        columns.push_back({title(e) + component, formulas_[e].dimension()});
      }
    return columns;
  }

 private:
  void measure_one(std::size_t e, AnyEnsemble const& ensemble, double time, std::vector<double>& values) override {
    formulas_[e].run(
        count(ensemble), [&](std::size_t k) { return row(ensemble, k); }, time);
    for (std::size_t c = 0; c < formulas_[e].components(); ++c) values.push_back(formulas_[e].component(c));
  }

  std::vector<ParticlesFormula> formulas_;
};

class HistogramDiagnosis final : public OfEnsembles {
 public:
  explicit HistogramDiagnosis(DiagnosisParameters const& parameters)
      : OfEnsembles(parameters),
        low_(parameters.from),
        high_(parameters.to),
        bins_(parameters.count == 0 ? 20 : parameters.count),
        units_(parameters.units) {
    if (!(low_ < high_))
      throw Error(
          fmt::format("a histogram needs 'from' and 'to', the ends of its bins, 'to' above 'from'; they are {} "
                      "and {}",
                      low_, high_));
    for (auto const& name : ensembles()) {
      formulas_.emplace_back(parameters.formula, names_for(named(parameters.available, name), parameters));
      if (formulas_.back().components() > 1) throw FormulaError(0, "a number is needed, not a vector");
    }
  }
  std::vector<Column> columns() const override {
    std::vector<Column> columns;
    auto const at = [&](std::size_t e, std::size_t k) {
      double const x = low_ + (high_ - low_) * static_cast<double>(k) / static_cast<double>(bins_);
      return units_.text(x, formulas_[e].formula().dimension());
    };
    for (std::size_t e = 0; e < formulas_.size(); ++e)
      for (std::size_t k = 0; k < bins_; ++k)
        columns.push_back({fmt::format("{} {} to {}", title(e), at(e, k), at(e, k + 1)), dimensions::none});
    return columns;
  }

 private:
  void measure_one(std::size_t e, AnyEnsemble const& ensemble, double time, std::vector<double>& values) override {
    std::vector<std::size_t> found(bins_, 0);
    std::size_t const all = count(ensemble);
    for (std::size_t k = 0; k < all; ++k) {
      double const part = (formulas_[e](row(ensemble, k), time) - low_) / (high_ - low_);
      if (part >= 0 && part < 1) ++found[static_cast<std::size_t>(part * static_cast<double>(bins_))];
    }
    for (auto const n : found) values.push_back(static_cast<double>(n) / static_cast<double>(all));
  }

  double low_, high_;
  std::size_t bins_;
  UnitSystem units_;
  std::vector<ParticleFormula> formulas_;
};

}  // namespace

std::unique_ptr<Diagnosis> formula_diagnosis(DiagnosisParameters const& parameters) {
  return std::make_unique<FormulaDiagnosis>(parameters);
}
Dimension dimension_of_formula(DiagnosisParameters const& parameters) {
  for (auto const* ensemble : parameters.available)
    if (parameters.ensembles.empty() || parameters.ensembles.front() == ensemble->name())
      return ParticleFormula(parameters.formula, names_for(*ensemble, parameters)).formula().dimension();
  return {};
}
std::unique_ptr<Diagnosis> histogram_diagnosis(DiagnosisParameters const& parameters) {
  return std::make_unique<HistogramDiagnosis>(parameters);
}

}  // namespace boltzmann
