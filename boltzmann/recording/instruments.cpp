// All diagnoses of a sample share the quantities that must be computed for it: energies, fields of a mesh.
#include <boltzmann/core/units.hpp>
#include <boltzmann/recording/instruments.hpp>
#include <boltzmann/simulation/conserved.hpp>
#include <boltzmann/simulation/refusals.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace boltzmann {

void Instruments::add(std::unique_ptr<Diagnosis> diagnosis) {
  if (factors_.empty()) factors_.push_back(units_.display(dimensions::time).factor);
  for (auto const& column : diagnosis->columns()) factors_.push_back(units_.display(column.dimension).factor);
  list_.push_back(std::move(diagnosis));
}

std::vector<Diagnosis const*> Instruments::list() const {
  std::vector<Diagnosis const*> all;
  for (auto const& diagnosis : list_) all.push_back(diagnosis.get());
  return all;
}

void Instruments::check() const {
  std::set<std::string> names;
  for (auto const& column : columns())
    if (!names.insert(column.name).second) throw Error("two diagnoses give a column called '" + column.name + "'");
  for (auto const& diagnosis : list_) diagnosis->check(simulation_.schemes().front()->box());
  for (auto const& line : refusals(simulation_, list_))
    if (!line.empty()) throw Error(line);
}

std::vector<Column> Instruments::columns() const {
  std::vector<Column> all;
  for (auto const& diagnosis : list_)
    for (auto& column : diagnosis->columns()) all.push_back(std::move(column));
  return all;
}

std::vector<std::string> Instruments::header() const {
  std::vector<std::string> header{"step"};
  auto const add = [&](std::string const& name, Dimension dimension) {
    auto const unit = units_.display(dimension).unit;
    header.push_back(unit.empty() ? name : name + " (" + unit + ")");
  };
  add("time", dimensions::time);
  for (auto const& column : columns()) add(column.name, column.dimension);
  return header;
}

bool Instruments::sums_suffice() const {
  return std::all_of(list_.begin(), list_.end(), [](auto const& diagnosis) { return diagnosis->sums(); });
}

bool Instruments::follow_steps() const {
  return std::any_of(list_.begin(), list_.end(), [](auto const& diagnosis) { return diagnosis->follows(); });
}

std::vector<std::pair<std::string, CsvTable>> Instruments::gathered() const {
  std::vector<std::pair<std::string, CsvTable>> all;
  for (auto const& diagnosis : list_)
    for (auto& gathered : diagnosis->tables()) {
      CsvTable table{{}, std::move(gathered.values)};
      table.columns.resize(gathered.columns.size());
      for (std::size_t c = 0; c < gathered.columns.size(); ++c) {
        auto const [unit, factor] = units_.display(gathered.columns[c].dimension);
        table.header.push_back(gathered.columns[c].name + (unit.empty() ? "" : " (" + unit + ")"));
        for (double& value : table.columns[c]) value *= factor;
      }
      all.emplace_back(gathered.name, std::move(table));
    }
  return all;
}

Sample Instruments::sample(std::span<AnyEnsemble* const> ensembles) const {
  FlowImpulse taken;
  for (auto const* adaptation : simulation_.adaptations()) taken += adaptation->taken();
  return {ensembles,
          simulation_.schemes().front()->box(),
          nullptr,
          units_.is_reduced() ? 1.0 : units_(constants::boltzmann),
          simulation_.time(),
          simulation_.step(),
          {},
          simulation_.schemes().front()->threads(),
          taken};
}

void Instruments::follow() const {
  auto const ensembles = supervised_by(simulation_.schemes());
  for (auto const& diagnosis : list_)
    if (diagnosis->follows()) diagnosis->follow(sample(ensembles));
}

std::vector<double> Instruments::measure() const {
  bool energies = false, mesh = false, kept = false;
  for (auto const& diagnosis : list_) {
    energies = energies || diagnosis->needs_energies() || diagnosis->needs_virial();
    mesh = mesh || diagnosis->needs_mesh();
    kept = kept || diagnosis->needs_kept_momentum();
  }
  EnergyAndVirial measures;
  if (energies) {
    measures = simulation_.measure();
    need_finite(simulation_, measures);
  }
  auto const ensembles = supervised_by(simulation_.schemes());
  auto const on_nodes = mesh ? mesh_fields_of(simulation_.schemes()) : std::vector<MeshField const*>{};
  Sample seen = sample(ensembles);
  if (energies) seen.measures = &measures;
  seen.mesh_fields = on_nodes;
  if (kept) seen.momentum_is_kept = simulation_.momentum_is_kept();
  std::vector<double> values{simulation_.time()};
  for (auto const& diagnosis : list_) diagnosis->measure(seen, values);
  return values;
}

void Instruments::show(std::span<double> row) const {
  for (std::size_t c = 0; c < row.size() && c < factors_.size(); ++c) row[c] *= factors_[c];
}

}  // namespace boltzmann
