// One table for all diagnoses of a run.
#include <boltzmann/recording/diagnosis_rows.hpp>
#include <boltzmann/recording/saved_state.hpp>

#include <fmt/format.h>

#include <set>

namespace boltzmann {

void DiagnosisRows::add(std::int64_t interval, std::unique_ptr<Diagnosis> diagnosis) {
  if (every != 0 && every != interval)
    throw Error(fmt::format("all diagnoses share one table and so one interval: every {} steps, not also every {}",
                            every, interval));
  every = interval;
  instruments_.add(std::move(diagnosis));
}

void DiagnosisRows::check() const {
  instruments_.check();
  std::set<std::string> files{"diagnoses.csv"};
  for (auto const& file : gathered_files())
    if (!files.insert(file).second) throw Error("two diagnoses write the file '" + file + "'; give one another label");
  if (end.condition && every == 0) throw Error("a run can't be ended by a condition on its diagnoses: there are none");
}

std::vector<std::string> DiagnosisRows::gathered_files() const {
  std::vector<std::string> files;
  for (auto const& diagnosis : instruments_.all())
    for (auto const& table : diagnosis->tables()) files.push_back(table.name + ".csv");
  return files;
}

void DiagnosisRows::write_gathered(std::string const& folder) const {
  for (auto const& [name, table] : instruments_.gathered()) write_csv(folder + "/" + name + ".csv", table);
}

void DiagnosisRows::begin(std::string const& path) {
  if (every > 0) csv_.emplace(path, instruments_.header());
}

void DiagnosisRows::go_on(std::string const& path, Checkpoint const& saved) {
  if (every == 0) return;
  std::optional<std::uint64_t> checksum;
  if (auto const rows = saved.state.find("diagnoses.csv"); rows != saved.state.end()) checksum = whole(rows->second);
  csv_.emplace(CsvFile::append_to(path, instruments_.header(), saved.step, checksum));
}

bool DiagnosisRows::write() {
  auto values = instruments_.measure();
  bool const ends = end.condition && end.condition(simulation_.step(), values);
  if (ends) {
    end.met = end.met_now = simulation_.step();
    end.met_by = end.what;
    end.condition = {};
    simulation_.pause();
  }
  instruments_.show(values);
  if (csv_) csv_->write(simulation_.step(), values);
  for (auto const& listener : listeners_) listener(simulation_.step(), values);
  return ends;
}

void DiagnosisRows::save(Checkpoint& checkpoint) {
  if (end.met) checkpoint.state["stopped"] = {static_cast<double>(*end.met)};
  for (std::size_t d = 0; auto const& diagnosis : instruments_.all())
    checkpoint.state[fmt::format("diagnosis {}", d++)] = diagnosis->state();
  if (!csv_) return;
  csv_->sync();
  checkpoint.state["diagnoses.csv"] = halves(csv_->checksum());
}

void DiagnosisRows::restore(Checkpoint const& saved, std::string const& path) {
  for (std::size_t d = 0; auto const& diagnosis : instruments_.all())
    diagnosis->restore(saved_part(saved, fmt::format("diagnosis {}", d++), path));
  if (!saved.state.contains("stopped")) return;
  end.met = static_cast<std::int64_t>(saved_part(saved, "stopped", path).at(0));
  end.condition = {};
}

}  // namespace boltzmann
