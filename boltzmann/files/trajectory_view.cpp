// The view satisfies MDAnalysis' readers. coordinates/H5MD.py needs: the first group of `particles`; box/dimension 3;
// position and velocity with a known `unit` at their values; `time` with one; box/edges/value of each frame;
// observables whose `value` has one number per frame, of which `dt` is the time step. parse_n_atoms and
// topology/MinimalParser.py make a universe from one file if it has a group called `trajectory` and its name ends with
// .h5md.
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/hdf5_file.hpp>
#include <boltzmann/files/trajectory_view.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <utility>

namespace boltzmann {
namespace {

using hdf5::Extents;
using hdf5::File;
using hdf5::Number;
using hdf5::Piece;

constexpr std::array known_lengths{"Angstrom", "nm", "pm", "fm"};
constexpr std::array known_times{"ps", "fs", "ns", "s"};
// "Angstrom fs-1" is left out, because MDAnalysis reads it as 1e-3 Angstrom/ps, wrong by a factor of a million.
constexpr std::array known_velocities{"Angstrom ps-1", "nm ps-1", "nm ns-1", "pm ps-1", "m s-1"};
constexpr std::array known_forces{"N", "J m-1"};

template <std::size_t N>
bool is_one_of(std::string_view word, std::array<char const*, N> const& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// The unit of time in ps.
double picoseconds(std::string const& unit) {
  return unit == "fs" ? 1e-3 : unit == "ns" ? 1e3 : unit == "s" ? 1e12 : 1;
}

std::string const view_group = "/particles/trajectory";

class View {
 public:
  View(std::string const& path, std::string const& of, TrajectoryOptions const& options,
       std::span<AnyEnsemble const* const> ensembles, BoxEdges const& box)
      : of_(of), options_(options), ensembles_(ensembles), box_(box), file_(File::create_plain(path)) {
    for (auto const* ensemble : ensembles_) size_ += ensemble->size();
    for (auto const& [element, dimension] :
         {std::pair{"time", dimensions::time}, std::pair{"position", dimensions::length},
          std::pair{"velocity", dimensions::velocity}})
      readable_ = readable_ && mdanalysis_reads(element, h5md_unit(unit(dimension)));
  }

  void write(std::span<double const> times, bool finished) {
    for (char const* name :
         {"/h5md", "/h5md/author", "/h5md/creator", "/h5md/modules", "/h5md/modules/units", "/particles"})
      file_->create_group(name);
    file_->create_group(view_group);
    file_->set("/h5md", "version", std::vector<std::int64_t>{1, 1});
    file_->set("/h5md/author", "name", options_.author);
    file_->set("/h5md/creator", "name", std::string("boltzmann"));
    file_->set("/h5md/creator", "version", options_.version);
    file_->set("/h5md/modules/units", "version", std::vector<std::int64_t>{1, 0});
    auto const frames = static_cast<std::uint64_t>(times.size());
    add_vectors("position", dimensions::length, frames);
    for (auto const& [name, number] : {std::pair{"step", Number::integer}, std::pair{"time", Number::real}})
      file_->create_view(view_group + "/position/" + name, number, {frames}, of_,
                         {{first() + "/position/" + name, {frames}, {0}, {0}, {0}, {0}}});
    write_unit(view_group + "/position/time", "ps", dimensions::time);
    if (all_have("velocity")) {
      add_vectors("velocity", dimensions::velocity, frames);
      link_times("velocity");
    }
    add_box(frames);
    add_species();
    for (char const* name : {"mass", "charge"}) add_constant(name);
    add_intervals(times, finished);
    file_->close();
  }

 private:
  std::string unit(Dimension dimension) const { return options_.unit_name ? options_.unit_name(dimension) : ""; }
  std::string first() const { return "/particles/" + ensembles_[0]->name(); }
  bool all_have(char const* field) const {
    return std::all_of(ensembles_.begin(), ensembles_.end(),
                       [&](auto const* ensemble) { return ensemble->find_field(field) != nullptr; });
  }
  void link_times(std::string const& element) {
    for (char const* name : {"/step", "/time"})
      file_->link(view_group + "/position" + name, view_group + "/" + element + name);
  }
  void write_unit(std::string const& dataset, std::string const& otherwise, Dimension dimension) {
    std::string const own = unit(dimension);
    file_->set(dataset, "unit", readable_ ? h5md_unit(own) : otherwise);
    if (!own.empty()) file_->set_fixed(dataset, "boltzmann_unit", own);
  }

  /// Concatenates all ensembles: calls where(ensemble, index of its first particle in the view).
  template <class Where>
  std::vector<Piece> pieces(Where const& where) const {
    std::vector<Piece> all;
    std::uint64_t at = 0;
    for (auto const* ensemble : ensembles_) {
      if (ensemble->size() > 0) all.push_back(where(*ensemble, at));
      at += ensemble->size();
    }
    return all;
  }

  void add_vectors(std::string const& name, Dimension dimension, std::uint64_t frames) {
    std::string const values = view_group + "/" + name + "/value";
    file_->create_group(view_group + "/" + name);
    file_->create_view(values, Number::real, {frames, size_, 3}, of_,
                       pieces([&](auto const& ensemble, std::uint64_t at) {
                         std::uint64_t const size = ensemble.size();
                         return Piece{"/particles/" + ensemble.name() + "/" + name + "/value",
                                      {frames, size, 3},
                                      {0, 0, 0},
                                      {0, size, 3},
                                      {0, at, 0},
                                      {0, size, 3}};
                       }));
    write_unit(values, name == "position" ? "Angstrom" : "Angstrom ps-1", dimension);
  }

  void add_box(std::uint64_t frames) {
    std::vector<std::string> boundary;
    for (int a = 0; a < 3; ++a) boundary.emplace_back(a < box_.dimension && box_.periodic[a] ? "periodic" : "none");
    file_->create_group(view_group + "/box");
    file_->set(view_group + "/box", "dimension", std::int64_t{3});
    file_->set(view_group + "/box", "boundary", boundary);
    if (std::find(boundary.begin(), boundary.end(), "periodic") == boundary.end()) return;
    file_->create_group(view_group + "/box/edges");
    file_->create_view(view_group + "/box/edges/value", Number::real, {frames, 3, 3}, of_,
                       {{first() + "/box/edges/value", {frames, 3, 3}, {0, 0, 0}, {0, 3, 3}, {0, 0, 0}, {0, 3, 3}}});
    write_unit(view_group + "/box/edges/value", "Angstrom", dimensions::length);
    link_times("box/edges");
  }

  void add_species() {
    std::vector<std::string> names;
    for (auto const* ensemble : ensembles_) names.push_back(ensemble->name());
    file_->create_view(view_group + "/species", Number::integer, {size_}, of_,
                       pieces([&](auto const& ensemble, std::uint64_t at) {
                         std::uint64_t const size = ensemble.size();
                         return Piece{"/particles/" + ensemble.name() + "/species", {size}, {0}, {size}, {at}, {size}};
                       }));
    file_->set(view_group + "/species", "names", names);
  }

  /// Repeats the value of the first frame; 0 for ensembles without this field.
  void add_constant(std::string const& name) {
    auto const& declared = options_.constant_fields;
    bool const constant = std::find(declared.begin(), declared.end(), name) != declared.end();
    std::vector<Piece> all;
    std::uint64_t at = 0;
    Dimension dimension;
    for (auto const* ensemble : ensembles_) {
      std::uint64_t const size = ensemble->size();
      if (Field const* field = ensemble->find_field(name); field && field->components == 1 && size > 0) {
        dimension = field->dimension;
        std::string const element = "/particles/" + ensemble->name() + "/" + name;
        all.push_back(constant ? Piece{element, {size}, {0}, {size}, {at}, {size}}
                               : Piece{element + "/value", {1, size}, {0, 0}, {1, size}, {at}, {size}});
      }
      at += size;
    }
    if (all.empty()) return;
    file_->create_view(view_group + "/" + name, Number::real, {size_}, of_, all);
    std::string const own = unit(dimension);
    if (own.empty()) return;
    file_->set_fixed(view_group + "/" + name, "boltzmann_unit", own);
    if (std::string const h5md = h5md_unit(own); !h5md.empty()) file_->set(view_group + "/" + name, "unit", h5md);
  }

  /// Times between successive frames. Future frames are assumed to have the last interval.
  void add_intervals(std::span<double const> times, bool finished) {
    if (times.size() < 2) return;
    double const factor = readable_ ? picoseconds(h5md_unit(unit(dimensions::time))) : 1;
    std::vector<double> intervals;
    for (std::size_t k = 1; k < times.size(); ++k) intervals.push_back(factor * (times[k] - times[k - 1]));
    intervals.push_back(intervals.back());
    std::uint64_t const frames = times.size();
    file_->create_group("/observables");
    file_->create_group("/observables/dt");
    file_->link(view_group + "/position/step", "/observables/dt/step");
    file_->link(view_group + "/position/time", "/observables/dt/time");
    file_->create_same("/observables/dt/value", finished ? frames : 2 * frames, intervals.back());
    file_->dataset("/observables/dt/value").write(intervals.data(), {0}, {frames});
    file_->set("/observables/dt/value", "unit", std::string("ps"));
  }

  std::string of_;
  TrajectoryOptions const& options_;
  std::span<AnyEnsemble const* const> ensembles_;
  BoxEdges const& box_;
  std::unique_ptr<File> file_;
  std::uint64_t size_ = 0;
  bool readable_ = true;  // true if MDAnalysis reads all units; otherwise units are only labels
};

}  // namespace

bool mdanalysis_reads(std::string_view element, std::string_view unit) {
  if (element == "time") return is_one_of(unit, known_times);
  if (element == "position" || element == "edges") return is_one_of(unit, known_lengths);
  if (element == "velocity") return is_one_of(unit, known_velocities);
  if (element == "force") return is_one_of(unit, known_forces);
  return true;
}

void write_trajectory_view(std::string const& path, std::string const& trajectory, TrajectoryOptions const& options,
                           std::span<AnyEnsemble const* const> ensembles, BoxEdges const& box,
                           std::span<double const> times, bool finished) {
  std::error_code error;
  try {
    if (ensembles.empty() || times.empty()) throw Error(path + ": there is no frame to show");
    View(path + ".part", trajectory, options, ensembles, box).write(times, finished);
    std::filesystem::rename(path + ".part", path, error);
    if (error) throw Error(fmt::format("{}: can't be written: {}", path, error.message()));
  } catch (Error const&) {
    for (auto const& file : {path + ".part", path}) std::filesystem::remove(file, error);
    throw;
  }
}

}  // namespace boltzmann
