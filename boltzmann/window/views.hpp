// Views: all that a window can show of a simulation, by name: pictures of it and the user's own drawings. The live run
// and the stored one stand on it.
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
  /// The simulation and what else it reads must outlive the views. `folder` is where diagnoses.csv and trajectory.h5
  /// are, or empty.
  Views(Simulation& simulation, UnitSystem const& units, std::string title, std::string folder);

  /// A drawing of the user's own, which it replaces if there is one of that name.
  void install(std::string name, std::function<void(Canvas&)> draw);
  /// A picture under a name. Nothing happens if one of the name is there; if it can't be drawn of this simulation it is
  /// left out, or Error says why.
  enum class Unfit { left_out, throws };
  void add(std::string name, Picture picture, Unfit unfit = Unfit::left_out);
  /// What a recording measures and draws: its table, its diagnoses, and its pictures under the names of their files.
  void take(Recording const& recording);
  /// What every simulation can show as far as it can: particles, phase space, a histogram, a spectrum, a profile, a
  /// map, fields on a mesh.
  void add_usual();
  void title(std::string title) { title_ = std::move(title); }
  /// The colours of ensembles that have none of their own.
  void palette(std::vector<Colour> colours) { palette_ = std::move(colours); }
  /// The header of the table of measured quantities, "total energy (eV)": there is a diagnosis "Measured" then.
  void columns(std::vector<std::string> header);
  /// Diagnoses of the run, for pictures of what they have seen.
  void diagnoses(std::vector<Diagnosis const*> list) { instruments_ = std::move(list); }

  /// The fields of hello that a simulation decides.
  nlohmann::json describe() const;
  /// What a view shows at a step. Nothing if the page itself draws it, from the table.
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

/// The number of a field that may be left out or null; Error if it is something else.
double number_or(nlohmann::json const& object, char const* key, double otherwise);

}  // namespace boltzmann
