// bzm render: pictures and movies of a finished (or running) run, from its trajectory.
#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/bzm/process.hpp>
#include <boltzmann/pictures/figure.hpp>
#include <boltzmann/recording/run_file.hpp>
#include <boltzmann/scenario/stored_pictures.hpp>
#include <boltzmann/scenario/stored_run.hpp>
#include <boltzmann/sweep/run_sweep.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

namespace boltzmann::bzm {
namespace {

namespace fs = std::filesystem;

enum class Output { picture, movie, numbered };

Output output_of(std::string const& out) {
  if (out.empty())
    throw Error("give the file of the picture: -o picture.png, movie.mp4, or a folder for numbered pictures: frames/");
  if (out.back() == '/') return Output::numbered;
  std::string const extension = fs::path(out).extension().string();
  if (ends_as_picture(out)) return Output::picture;
  if (extension == ".mp4" || extension == ".webm" || extension == ".gif") return Output::movie;
  throw Error("'" + out +
              "' ends in none of .png, .svg, .pdf (pictures), .mp4, .webm, .gif (movies) or / (numbered pictures)");
}

// A folder that is removed with its contents by the destructor.
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

/// Writes all frames; on a terminal, a line counts them.
void write_frames(StoredPictures& pictures, std::string const& folder, FigureOptions const& paper) {
  bool const terminal = isatty(STDERR_FILENO) == 1;
  pictures.write_all(folder, paper, [&](std::int64_t done) {
    if (terminal) fmt::print(stderr, "\rframe {} of {}", done, pictures.count());
  });
  if (terminal) fmt::print(stderr, "\r\033[K");
}

}  // namespace

int render(RenderOptions const& options) {
  Output const kind = output_of(options.out);
  if (!fs::is_directory(options.folder)) throw Error("there is no folder '" + options.folder + "' with a run to draw");
  if (holds_sweep(options.folder))
    throw Error("'" + options.folder + "' holds a sweep; draw one of its runs, whose folders begin with their numbers");
  if (!holds_run(options.folder))
    throw Error("'" + options.folder + "' contains no run that can be drawn: neither scenario.toml nor " + run_file);
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
                "' has no trajectory.h5 to draw: the run stored none; trajectory = 10 in [output], or --set "
                "output.trajectory=10, stores a frame every 10 steps");
  auto const scenario = load_stored_run(options.folder);
  StoredPictures pictures(*scenario, options.folder, options.picture, PlainNumbers::shown);
  FigureOptions paper;
  paper.scale = options.scale;
  paper.dark = options.dark;

  if (kind == Output::picture) {
    std::int64_t const frame = pictures.frame(options.frame.value_or(-1));
    write_picture(pictures.canvas(frame), options.out, paper);
    fmt::print("{}: frame {} (step {})\n", options.out, frame, pictures.step(frame));
    return 0;
  }
  if (kind == Output::numbered) {
    std::error_code error;
    fs::create_directories(options.out, error);
    if (error) throw Error("the folder '" + options.out + "' can't be made: " + error.message());
    write_frames(pictures, options.out.substr(0, options.out.size() - 1), paper);
    fmt::print("{}: {} pictures\n", options.out, pictures.count());
    return 0;
  }
  TemporaryFolder const folder;
  write_frames(pictures, folder.path(), paper);
  std::vector<std::string> words{ffmpeg,       "-y",
                                 "-loglevel",  "error",
                                 "-framerate", std::to_string(options.frames_per_second),
                                 "-i",         folder.path() + "/%06d.png"};
  std::string const extension = fs::path(options.out).extension().string();
  if (extension == ".mp4") words.insert(words.end(), {"-c:v", "libx264", "-pix_fmt", "yuv420p"});
  words.push_back(options.out);
  if (run_program(words) != 0) throw Error("ffmpeg could not write '" + options.out + "' (its message is above)");
  fmt::print("{}: {} frames\n", options.out, pictures.count());
  return 0;
}

}  // namespace boltzmann::bzm
