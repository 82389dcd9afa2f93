// bzm render: pictures and movies of a finished (or running) run, from its trajectory.
#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/bzm/process.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/pictures/figure.hpp>
#include <boltzmann/pictures/figure_layout.hpp>
#include <boltzmann/recording/run_file.hpp>
#include <boltzmann/scenario/stored_run.hpp>
#include <boltzmann/sweep/run_sweep.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <optional>

namespace boltzmann::bzm {
namespace {

namespace fs = std::filesystem;

enum class Output { picture, movie, numbered };

Output output_of(std::string const& out) {
  if (out.empty())
    throw Error("say where the picture goes: -o picture.png, movie.mp4, or a folder for numbered pictures: frames/");
  if (out.back() == '/') return Output::numbered;
  std::string const extension = fs::path(out).extension().string();
  if (ends_as_picture(out)) return Output::picture;
  if (extension == ".mp4" || extension == ".webm" || extension == ".gif") return Output::movie;
  throw Error("'" + out +
              "' ends in none of .png, .svg, .pdf (pictures), .mp4, .webm, .gif (movies) or / (numbered pictures)");
}

// A folder that goes away with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "bzm-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw Error("no temporary folder can be made in " + fs::temp_directory_path().string());
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(TemporaryFolder const&) = delete;
  TemporaryFolder& operator=(TemporaryFolder const&) = delete;
  std::string const& path() const { return path_; }

 private:
  std::string path_;
};

class Frames {
 public:
  Frames(RenderOptions const& options, ScenarioSimulation& scenario)
      : scenario_(scenario),
        folder_(options.folder),
        title_(!scenario.title.empty() ? scenario.title
                                       : fs::absolute(options.folder + "/").parent_path().filename().string()),
        reader_(options.folder + "/trajectory.h5") {
    if (reader_.frames() == 0) throw Error("'" + folder_ + "/trajectory.h5' has no frames");
    picture_ = picture_by_words(scenario, options.picture);
    if (picture_.drawing == "wave-spectrum")
      throw Error(
          "a wave spectrum can't be drawn from a trajectory: it is drawn when the run ends, from what its diagnosis "
          "has recorded; --drawing chooses another picture");
    for (auto const& diagnosis : scenario.diagnoses) diagnoses_.push_back(diagnosis.get());
    paper_.scale = options.scale;
    paper_.dark = options.dark;
  }

  std::int64_t count() const { return static_cast<std::int64_t>(reader_.frames()); }
  std::int64_t step(std::int64_t frame) const { return reader_.steps()[static_cast<std::size_t>(frame)]; }

  Canvas canvas(std::int64_t number) {
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
  void write(std::int64_t frame, std::string const& path) { write_picture(canvas(frame), path, paper_); }

  /// One scale of colours and of axes for all frames of a movie.
  void fix_scales() {
    double const infinity = std::numeric_limits<double>::infinity();
    double low = infinity, high = -infinity;
    Canvas all;  // the corners of what each frame shows
    std::array<Axis, 2> axes;
    // What shows the past has most to show at the end.
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
      for (std::size_t a = 0; a < 2; ++a) {  // those of the drawing itself, NaN if it leaves them open
        axes[a].low = std::isnan(now[a].low) ? now[a].low : std::min(axes[a].low, now[a].low);
        axes[a].high = std::isnan(now[a].high) ? now[a].high : std::max(axes[a].high, now[a].high);
      }
    }
    if (low <= high && !std::isfinite(picture_.low)) picture_.low = low;
    if (low <= high && !std::isfinite(picture_.high)) picture_.high = high;
    all.axes(axes[0], axes[1]);
    if (with_axes && !all.points().empty()) axes_ = axis_ranges(all, 4.0 / 3);
  }

  /// Pictures 000000.png, 000001.png, ... of all frames.
  void write_all(std::string const& folder) {
    fix_scales();
    bool const terminal = isatty(STDERR_FILENO) == 1;
    for (std::int64_t frame = 0; frame < count(); ++frame) {
      write(frame, fmt::format("{}/{:06d}.png", folder, frame));
      if (terminal) fmt::print(stderr, "\rframe {} of {}", frame + 1, count());
    }
    if (terminal) fmt::print(stderr, "\r\033[K");
  }

 private:
  ScenarioSimulation& scenario_;
  std::string folder_, title_;
  TrajectoryReader reader_;
  Picture picture_;
  std::vector<Diagnosis const*> diagnoses_;  // what they have gathered is in files
  FigureOptions paper_;
  std::optional<std::array<AxisRange, 2>> axes_;  // of a movie
};

}  // namespace

int render(RenderOptions const& options) {
  Output const kind = output_of(options.out);
  if (!fs::is_directory(options.folder)) throw Error("there is no folder '" + options.folder + "' with a run to draw");
  if (holds_sweep(options.folder))
    throw Error("'" + options.folder + "' holds a sweep; draw one of its runs, whose folders begin with their numbers");
  if (!holds_run(options.folder))
    throw Error("'" + options.folder + "' holds no run that could be drawn: neither scenario.toml nor " + run_file);
  std::string const ffmpeg = find_program("ffmpeg");
  if (kind == Output::movie && ffmpeg.empty())
    throw Error(
        "a movie needs ffmpeg, which is not installed (Debian: apt install ffmpeg); `-o frames/` writes numbered "
        "pictures");
  if (kind != Output::picture && options.frame) throw Error("--frame chooses one picture; a movie has all frames");
  if (options.frames_per_second < 1 || options.frames_per_second > 240)
    throw Error(fmt::format("a movie has 1 to 240 frames per second, not {}", options.frames_per_second));
  if (!fs::exists(options.folder + "/trajectory.h5"))
    throw Error("'" + options.folder +
                "' has no trajectory.h5 to draw: the run was not asked for one; trajectory = 10 in [output], or --set "
                "output.trajectory=10, stores a frame every 10 steps");
  auto const scenario = load_stored_run(options.folder);
  Frames frames(options, *scenario);

  if (kind == Output::picture) {
    std::int64_t const chosen = options.frame.value_or(-1);
    std::int64_t const frame = chosen < 0 ? chosen + frames.count() : chosen;
    if (frame < 0 || frame >= frames.count())
      throw Error(fmt::format("there is no frame {}; the trajectory has frames 0 to {} (or -1 to -{} from the end)",
                              chosen, frames.count() - 1, frames.count()));
    frames.write(frame, options.out);
    fmt::print("{}: frame {} (step {})\n", options.out, frame, frames.step(frame));
    return 0;
  }
  if (kind == Output::numbered) {
    std::error_code error;
    fs::create_directories(options.out, error);
    if (error) throw Error("the folder '" + options.out + "' can't be made: " + error.message());
    frames.write_all(options.out.substr(0, options.out.size() - 1));
    fmt::print("{}: {} pictures\n", options.out, frames.count());
    return 0;
  }
  TemporaryFolder const folder;
  frames.write_all(folder.path());
  std::vector<std::string> words{ffmpeg,       "-y",
                                 "-loglevel",  "error",
                                 "-framerate", std::to_string(options.frames_per_second),
                                 "-i",         folder.path() + "/%06d.png"};
  std::string const extension = fs::path(options.out).extension().string();
  if (extension == ".mp4") words.insert(words.end(), {"-c:v", "libx264", "-pix_fmt", "yuv420p"});
  words.push_back(options.out);
  if (run_program(words) != 0) throw Error("ffmpeg could not write '" + options.out + "' (its message is above)");
  fmt::print("{}: {} frames\n", options.out, frames.count());
  return 0;
}

}  // namespace boltzmann::bzm
