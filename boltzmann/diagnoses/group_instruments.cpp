// For a group of particles: all of an ensemble, by number, or by velocity.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/derived.hpp>
#include <boltzmann/diagnoses/instruments.hpp>
#include <boltzmann/diagnoses/measures.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann::instruments {
namespace {

/// A group in each of the chosen ensembles: all, by number, or those of similar velocity at the first sample.
class GroupDiagnosis : public Diagnosis {
 public:
  explicit GroupDiagnosis(DiagnosisParameters const& parameters)
      : dimension_(dimension_of(parameters)),
        names_(chosen_names(parameters.available, parameters.ensembles)),
        label_(parameters.label),
        particles_(parameters.particles),
        similar_(parameters.similar_velocity),
        tolerance_(parameters.tolerance) {
    if (!particles_.empty() && similar_)
      throw Error("a group is given by particle numbers or by a velocity, not by both");
    check_chosen(parameters.available, names_, particles_);
    if (!label_.empty() && names_.size() != 1)
      throw Error(fmt::format("a group of chosen particles belongs to one ensemble; name one of {}", join(names_)));
    if (!(tolerance_ >= 0))
      throw Error(fmt::format("the tolerance of a group must not be negative, it is {}", tolerance_));
    for (auto const& name : names_) prefixes_.push_back(label_.empty() ? name : label_);
  }

  std::vector<Column> columns() const final {
    std::vector<Column> columns;
    for (std::size_t g = 0; g < prefixes_.size(); ++g)
      for (auto const& column : columns_of_group(g))
        columns.push_back({labelled(prefixes_[g], column.name), column.dimension});
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

  /// Empty before the first sample; then, for each ensemble, the size of its group and the numbers of its particles.
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
      groups_.push_back(similar_particles(ensemble_of(sample, name), *similar_, tolerance_));
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
    auto const names = chosen_names(parameters.available, parameters.ensembles);
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

}  // namespace

std::unique_ptr<Diagnosis> make_mean_velocity(DiagnosisParameters const& parameters) {
  return std::make_unique<MeanVelocity>(parameters);
}
std::unique_ptr<Diagnosis> make_velocity_diffusion(DiagnosisParameters const& parameters) {
  return std::make_unique<VelocityDiffusion>(parameters);
}
std::unique_ptr<Diagnosis> make_extremes(DiagnosisParameters const& parameters) {
  return std::make_unique<ExtremesDiagnosis>(parameters);
}

}  // namespace boltzmann::instruments
