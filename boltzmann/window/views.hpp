// Views: everything that a window can show of a simulation, by name: pictures and the user's own drawings. Used by the
// live run and the stored one.
#pragma once

#include <boltzmann/pictures/picture.hpp>
#include <boltzmann/window/source.hpp>

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace boltzmann {

class Recording;

class Views {
 public:
  /// The simulation and the other arguments must outlive the views. `folder` contains diagnoses.csv and trajectory.h5,
  /// or is empty.
  Views(Simulation& simulation, UnitSystem const& units, std::string title, std::string folder);

  /// Adds a drawing of the user, which replaces one of the same name.
  void install(std::string name, std::function<void(Canvas&)> draw);
  /// Adds a picture under a name, unless the name exists. If it can't be drawn of this simulation, it is omitted, or
  /// Error gives the reason.
  enum class Unfit { left_out, throws };
  void add(std::string name, Picture picture, Unfit unfit = Unfit::left_out);
  /// Adds the views of a recording: its table, its diagnoses, and its pictures under the names of their files.
  void take(Recording const& recording);
  /// Adds the usual views that the simulation supports: particles, phase space, a histogram, a spectrum, a profile, a
  /// map, fields on a mesh.
  void add_usual();
  void title(std::string title) { title_ = std::move(title); }
  /// The colours of ensembles without one of their own.
  void palette(std::vector<Colour> colours) { palette_ = std::move(colours); }
  /// The header of the table of measured quantities, "total energy (eV)". It adds a diagnosis "Measured".
  void columns(std::vector<std::string> header);
  /// Diagnoses of the run, for pictures of their accumulated data.
  void diagnoses(std::vector<Diagnosis const*> list) { instruments_ = std::move(list); }

  /// The members of hello that depend on the simulation.
  nlohmann::json describe() const;
  /// The drawing of a view at a step; null if the page draws it itself, from the table.
  std::shared_ptr<Canvas const> draw(nlohmann::json const& view, std::int64_t step, double time) const;
  PictureFile picture(nlohmann::json const& request, std::int64_t step, double time) const;
  nlohmann::json particle(std::string const& ensemble, std::size_t number) const;
  std::string quantity(double number, Dimension dimension) const;

  Simulation& simulation() const { return simulation_; }
  UnitSystem const& units() const { return units_; }
  std::string const& title() const { return title_; }
  std::string const& folder() const { return folder_; }

 private:
  void describe_box(nlohmann::json& result) const;
  void describe_ensembles(nlohmann::json& result) const;
  void describe_pictures(nlohmann::json& result) const;

  struct Entry {
    std::string name;
    Picture picture;
    std::function<void(Canvas&)> installed;
    bool table = false;
  };
  Entry const& entry(std::string const& name) const;
  Canvas canvas(Entry const& entry, nlohmann::json const& view, std::int64_t step, double time) const;
  std::vector<AnyEnsemble*> ensembles() const;
  std::vector<std::string> column_names() const;
  PictureSources sources(Picture const& picture) const;

  Simulation& simulation_;
  UnitSystem units_;
  std::string title_, folder_;
  std::vector<Entry> entries_;
  std::vector<Colour> palette_;
  std::vector<std::string> header_;
  std::vector<Diagnosis const*> instruments_;
  std::shared_ptr<CloudMemory> memory_ = std::make_shared<CloudMemory>();
};

/// The number of an optional member that may be null. Throws Error if it is something else.
double number_or(nlohmann::json const& object, char const* key, double otherwise);

}  // namespace boltzmann
