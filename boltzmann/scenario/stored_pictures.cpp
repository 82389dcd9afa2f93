// Loads a frame into the particles and the box of a stored run, and draws it like a live run.
#include <boltzmann/scenario/stored_pictures.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

namespace boltzmann {

namespace fs = std::filesystem;

StoredPictures::StoredPictures(ScenarioSimulation& scenario, std::string folder, PictureWords const& words,
                               PlainNumbers plain)
    : scenario_(scenario),
      folder_(std::move(folder)),
      title_(!scenario.title.empty() ? scenario.title : fs::absolute(folder_ + "/").parent_path().filename().string()),
      reader_(folder_ + "/trajectory.h5") {
  if (reader_.frames() == 0) throw Error("'" + folder_ + "/trajectory.h5' has no frames");
  picture_ = picture_by_words(scenario, words, plain);
  if (picture_.drawing == "wave-spectrum")
    throw Error(
        "a wave spectrum can't be drawn from a trajectory: it is drawn when the run ends, from what its diagnosis "
        "has recorded; --drawing chooses another picture");
  for (auto const& diagnosis : scenario.diagnoses) diagnoses_.push_back(diagnosis.get());
}

std::int64_t StoredPictures::frame(std::int64_t number) const {
  std::int64_t const frame = number < 0 ? number + count() : number;
  if (frame < 0 || frame >= count())
    throw Error(fmt::format("there is no frame {}; the trajectory has frames 0 to {} (or -1 to -{} from the end)",
                            number, count() - 1, count()));
  return frame;
}

Canvas StoredPictures::canvas(std::int64_t number) {
  auto const frame = static_cast<std::size_t>(number);
  for (auto& ensemble : scenario_.ensembles) reader_.load(frame, *ensemble);
  for (auto& scheme : scenario_.schemes) reader_.load(frame, scheme->box());
  Canvas drawn = draw(picture_, {*scenario_.simulation, scenario_.units, title_, reader_.steps()[frame],
                                 reader_.times()[frame], folder_, diagnoses_});
  if (!axes_) return drawn;
  Axis x = drawn.x_axis(), y = drawn.y_axis();
  x.low = (*axes_)[0].low, x.high = (*axes_)[0].high;
  y.low = (*axes_)[1].low, y.high = (*axes_)[1].high;
  drawn.axes(x, y);
  return drawn;
}

/// Computes a common scale of colours and of axes for all frames.
void StoredPictures::fix_scales() {
  double const infinity = std::numeric_limits<double>::infinity();
  double low = infinity, high = -infinity;
  Canvas all;  // the corners of all frames
  std::array<Axis, 2> axes;
  // Drawings of a history have the largest range at the end.
  bool const past = picture_.drawing == "time-series" || (picture_.drawing == "spectrum" && picture_.x == "time");
  bool first = true, with_axes = true;
  for (std::int64_t frame = past ? count() - 1 : 0; frame < count(); ++frame) {
    Canvas const drawn = canvas(frame);
    for (auto const& bar : drawn.colour_bars()) low = std::min(low, bar.low), high = std::max(high, bar.high);
    with_axes = with_axes && drawn.frame();
    if (auto const corners = content_corners(drawn))
      for (auto const& [x, y] : *corners) all.point(x, y, ink);
    std::array<Axis, 2> const now{drawn.x_axis(), drawn.y_axis()};
    if (first) axes = now;
    first = false;
    for (std::size_t a = 0; a < 2; ++a) {  // those of the drawing itself; NaN: automatic
      axes[a].low = std::isnan(now[a].low) ? now[a].low : std::min(axes[a].low, now[a].low);
      axes[a].high = std::isnan(now[a].high) ? now[a].high : std::max(axes[a].high, now[a].high);
    }
  }
  if (low <= high && !std::isfinite(picture_.low)) picture_.low = low;
  if (low <= high && !std::isfinite(picture_.high)) picture_.high = high;
  all.axes(axes[0], axes[1]);
  if (with_axes && !all.points().empty()) axes_ = axis_ranges(all, 4.0 / 3);
}

void StoredPictures::write_all(std::string const& folder, FigureOptions const& paper,
                               std::function<void(std::int64_t)> const& done) {
  fix_scales();
  for (std::int64_t frame = 0; frame < count(); ++frame) {
    write_picture(canvas(frame), fmt::format("{}/{:06d}.png", folder, frame), paper);
    if (done) done(frame + 1);
  }
}

}  // namespace boltzmann
