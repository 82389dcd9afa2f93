// Diagnoses of a flow of vortices.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/system_diagnosis.hpp>
#include <boltzmann/diagnoses/vortex_measures.hpp>
#include <boltzmann/schemes/flow_classes.hpp>
#include <boltzmann/schemes/vortices/vortex_flow.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann::instruments {
namespace {

class VortexInvariants final : public SystemDiagnosis {
 public:
  explicit VortexInvariants(DiagnosisParameters const& parameters) : SystemDiagnosis(parameters) {
    auto const& all = parameters.available;
    for (auto const& name : parameters.ensembles)
      if (auto const& named = ensemble_named(all, name); !has_vorticity(named))
        throw Error(fmt::format("'{}' is of class {}, which has no vorticity", name, named.class_name()));
    if (std::none_of(all.begin(), all.end(), [](auto const* one) { return has_vorticity(*one); }))
      throw Error(fmt::format("no ensemble has vorticity; classes {} have", classes_with_vorticity));
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

}  // namespace

std::unique_ptr<Diagnosis> make_vortex_invariants(DiagnosisParameters const& parameters) {
  return std::make_unique<VortexInvariants>(parameters);
}
std::unique_ptr<Diagnosis> make_vortex_energy(DiagnosisParameters const& parameters) {
  return std::make_unique<VortexEnergy>(parameters);
}

}  // namespace boltzmann::instruments
