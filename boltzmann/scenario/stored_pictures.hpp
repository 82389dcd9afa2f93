// Stored pictures: what a stored run looked like, frame by frame of its trajectory.
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
  /// Pictures of the run in the folder; of `scenario`, which is that run (load_stored_run), particles and box are those
  /// of the frame that was drawn last. Error if the folder has no frames, or words ask for what can't be drawn of them.
  StoredPictures(ScenarioSimulation& scenario, std::string folder, PictureWords const& words,
                 PlainNumbers plain = PlainNumbers::base);

  std::int64_t count() const { return static_cast<std::int64_t>(reader_.frames()); }
  std::int64_t step(std::int64_t frame) const { return reader_.steps()[static_cast<std::size_t>(frame)]; }
  /// A frame by its number from 0 on, or from the end, -1 being the last. Error if there is none.
  std::int64_t frame(std::int64_t number) const;

  Canvas canvas(std::int64_t frame);
  /// 000000.png, 000001.png, ... of all frames in a folder that is there, with one scale of colours and axes. `done` is
  /// told how many are written.
  void write_all(std::string const& folder, FigureOptions const& paper,
                 std::function<void(std::int64_t done)> const& done = {});

 private:
  void fix_scales();

  ScenarioSimulation& scenario_;
  std::string folder_, title_;
  TrajectoryReader reader_;
  Picture picture_;
  std::vector<Diagnosis const*> diagnoses_;       // what they have gathered is in files
  std::optional<std::array<AxisRange, 2>> axes_;  // of all frames
};

}  // namespace boltzmann
