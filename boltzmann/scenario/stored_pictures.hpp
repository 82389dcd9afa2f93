// Stored pictures: pictures of a stored run, frame by frame of its trajectory.
#pragma once

#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/pictures/canvas.hpp>
#include <boltzmann/pictures/figure.hpp>
#include <boltzmann/pictures/figure_layout.hpp>
#include <boltzmann/scenario/picture_words.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

class StoredPictures {
 public:
  /// Pictures of the run in the folder. `scenario` is that run (load_stored_run); its particles and box are those of
  /// the last drawn frame. Throws Error if the folder has no frames, or the words name something that can't be drawn of
  /// them.
  StoredPictures(ScenarioSimulation& scenario, std::string folder, PictureWords const& words,
                 PlainNumbers plain = PlainNumbers::base);

  std::int64_t count() const { return static_cast<std::int64_t>(reader_.frames()); }
  std::int64_t step(std::int64_t frame) const { return reader_.steps()[static_cast<std::size_t>(frame)]; }
  /// The index of a frame, from 0 on, or from the end, -1 being the last. Throws Error if there is none.
  std::int64_t frame(std::int64_t number) const;

  Canvas canvas(std::int64_t frame);
  /// Writes 000000.png, 000001.png, ... of all frames into an existing folder, with a common scale of colours and axes.
  /// `done` is called with the number written so far.
  void write_all(std::string const& folder, FigureOptions const& paper,
                 std::function<void(std::int64_t done)> const& done = {});

 private:
  void fix_scales();

  ScenarioSimulation& scenario_;
  std::string folder_, title_;
  TrajectoryReader reader_;
  Picture picture_;
  std::vector<Diagnosis const*> diagnoses_;       // their accumulated data are in files
  std::optional<std::array<AxisRange, 2>> axes_;  // of all frames
};

}  // namespace boltzmann
