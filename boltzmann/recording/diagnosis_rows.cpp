// One table for all diagnoses of a run.
#include <boltzmann/core/units.hpp>
#include <boltzmann/recording/diagnosis_rows.hpp>
#include <boltzmann/recording/saved_state.hpp>
#include <boltzmann/simulation/keeps_numbers.hpp>
#include <boltzmann/simulation/refusals.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace boltzmann {

void DiagnosisRows::add(std::int64_t interval, std::unique_ptr<Diagnosis> diagnosis) {
  if (every != 0 && every != interval)
    throw Error(fmt::format("all diagnoses share one table and so one interval: every {} steps, not also every {}",
                            every, interval));
  every = interval;
  list_.push_back(std::move(diagnosis));
}

void DiagnosisRows::check() const {
  std::set<std::string> names;
  for (auto const& column : columns())
    if (!names.insert(column.name).second) throw Error("two diagnoses give a column called '" + column.name + "'");
  std::set<std::string> files{"diagnoses.csv"};
  for (auto const& file : gathered_files())
    if (!files.insert(file).second) throw Error("two diagnoses write the file '" + file + "'; give one another label");
  for (auto const& diagnosis : list_) diagnosis->check(simulation_.schemes().front()->box());
  for (auto const& diagnosis : list_)
    if (numbers_change(simulation_.adaptations()) && diagnosis->by_number())
      throw Error(
          fmt::format("the diagnosis of '{}' follows particles by their numbers, which change where particles "
                      "come and go between steps",
                      diagnosis->columns().front().name));
  for (auto const& line : refusals(simulation_, list_))
    if (!line.empty()) throw Error(line);
  if (end.condition && every == 0) throw Error("a run can't be ended by a condition on its diagnoses: there are none");
}

std::vector<Diagnosis const*> DiagnosisRows::instruments() const {
  std::vector<Diagnosis const*> all;
  for (auto const& diagnosis : list_) all.push_back(diagnosis.get());
  return all;
}

std::vector<Column> DiagnosisRows::columns() const {
  std::vector<Column> all;
  for (auto const& diagnosis : list_)
    for (auto& column : diagnosis->columns()) all.push_back(std::move(column));
  return all;
}

std::vector<std::string> DiagnosisRows::header() const {
  std::vector<std::string> header{"step"};
  auto const add = [&](std::string const& name, Dimension dimension) {
    auto const unit = units_.display(dimension).unit;
    header.push_back(unit.empty() ? name : name + " (" + unit + ")");
  };
  add("time", dimensions::time);
  for (auto const& column : columns()) add(column.name, column.dimension);
  return header;
}

bool DiagnosisRows::follow_steps() const {
  return std::any_of(list_.begin(), list_.end(), [](auto const& diagnosis) { return diagnosis->follows(); });
}

std::vector<std::string> DiagnosisRows::gathered_files() const {
  std::vector<std::string> files;
  for (auto const& diagnosis : list_)
    for (auto const& table : diagnosis->tables()) files.push_back(table.name + ".csv");
  return files;
}

void DiagnosisRows::write_gathered(std::string const& folder) const {
  for (auto const& diagnosis : list_)
    for (auto& gathered : diagnosis->tables()) {
      CsvTable table{{}, std::move(gathered.values)};
      table.columns.resize(gathered.columns.size());
      for (std::size_t c = 0; c < gathered.columns.size(); ++c) {
        auto const [unit, factor] = units_.display(gathered.columns[c].dimension);
        table.header.push_back(gathered.columns[c].name + (unit.empty() ? "" : " (" + unit + ")"));
        for (double& value : table.columns[c]) value *= factor;
      }
      write_csv(folder + "/" + gathered.name + ".csv", table);
    }
}

void DiagnosisRows::begin(std::string const& path) {
  if (every > 0) csv_.emplace(path, header());
}

void DiagnosisRows::go_on(std::string const& path, Checkpoint const& saved) {
  if (every == 0) return;
  std::optional<std::uint64_t> checksum;
  if (auto const rows = saved.state.find("diagnoses.csv"); rows != saved.state.end()) checksum = whole(rows->second);
  csv_.emplace(CsvFile::append_to(path, header(), saved.step, checksum));
}

Sample DiagnosisRows::sample(std::span<AnyEnsemble* const> ensembles) const {
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

void DiagnosisRows::follow() {
  auto const ensembles = supervised_by(simulation_.schemes());
  for (auto const& diagnosis : list_)
    if (diagnosis->follows()) diagnosis->follow(sample(ensembles));
}

bool DiagnosisRows::write() {
  bool energies = false, mesh = false;
  for (auto const& diagnosis : list_) {
    energies = energies || diagnosis->needs_energies() || diagnosis->needs_virial();
    mesh = mesh || diagnosis->needs_mesh();
  }
  EnergyAndVirial measures;
  if (energies) measures = simulation_.measure();
  auto const ensembles = supervised_by(simulation_.schemes());
  auto const on_nodes = mesh ? mesh_fields_of(simulation_.schemes()) : std::vector<MeshField const*>{};
  Sample seen = sample(ensembles);
  if (energies) seen.measures = &measures;
  seen.mesh_fields = on_nodes;
  std::vector<double> values{simulation_.time()};
  for (auto const& diagnosis : list_) diagnosis->measure(seen, values);
  bool const ends = end.condition && end.condition(simulation_.step(), values);
  if (ends) {
    end.met = end.met_now = simulation_.step();
    end.met_by = end.what;
    end.condition = {};
    simulation_.pause();
  }
  if (factors_.empty()) {
    factors_.push_back(units_.display(dimensions::time).factor);
    for (auto const& column : columns()) factors_.push_back(units_.display(column.dimension).factor);
  }
  for (std::size_t c = 0; c < values.size(); ++c) values[c] *= factors_[c];
  csv_->write(simulation_.step(), values);
  for (auto const& listener : listeners_) listener(simulation_.step(), values);
  return ends;
}

void DiagnosisRows::save(Checkpoint& checkpoint) {
  if (end.met) checkpoint.state["stopped"] = {static_cast<double>(*end.met)};
  for (std::size_t d = 0; d < list_.size(); ++d) checkpoint.state[fmt::format("diagnosis {}", d)] = list_[d]->state();
  if (!csv_) return;
  csv_->sync();
  checkpoint.state["diagnoses.csv"] = halves(csv_->checksum());
}

void DiagnosisRows::restore(Checkpoint const& saved, std::string const& path) {
  for (std::size_t d = 0; d < list_.size(); ++d)
    list_[d]->restore(saved_part(saved, fmt::format("diagnosis {}", d), path));
  if (!saved.state.contains("stopped")) return;
  end.met = static_cast<std::int64_t>(saved_part(saved, "stopped", path).at(0));
  end.condition = {};
}

}  // namespace boltzmann
