// Numbered .vti files and the .pvd that lists them.
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/export.hpp>
#include <boltzmann/files/mesh_frames.hpp>
#include <boltzmann/files/text_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <utility>

namespace boltzmann {
namespace {

namespace fs = std::filesystem;

std::string frame_name(std::int64_t step) {
  return step < 0 ? fmt::format("mesh/-{:09d}.vti", -step) : fmt::format("mesh/{:09d}.vti", step);
}

/// Parses the step in a frame's name. Returns false for other files.
bool step_of(fs::path const& path, std::int64_t& step) {
  std::string const name = path.filename().string();
  auto const [end, error] = std::from_chars(name.data(), name.data() + name.size(), step);
  return error == std::errc() && std::string_view(end) == ".vti";
}

double time_of(std::string const& path) {
  std::string text(4096, '\0');  // TimeValue is near the beginning
  std::ifstream file(path, std::ios::binary);
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  std::size_t const at = text.find("TimeValue");
  std::size_t const begin = at == std::string::npos ? at : text.find('>', at);
  if (begin == std::string::npos)
    throw Error(fmt::format("'{}' is an incomplete mesh frame; remove it to continue without it", path));
  return std::strtod(text.c_str() + begin + 1, nullptr);
}

}  // namespace

MeshFrames::MeshFrames(std::string folder, std::vector<Frame> frames)
    : folder_(std::move(folder)), frames_(std::move(frames)) {
  std::error_code error;
  fs::create_directories(folder_ + "/mesh", error);
  if (error) throw Error("the folder '" + folder_ + "/mesh' can't be made: " + error.message());
  write_index();
}

MeshFrames::MeshFrames(std::string const& folder) : MeshFrames((remove(folder), folder), {}) {}

void MeshFrames::remove(std::string const& folder) {
  std::error_code ignored;
  std::int64_t step = 0;
  // Consider only this program's frames; the folder may contain other files.
  for (auto const& entry : fs::directory_iterator(folder + "/mesh", ignored))
    if (step_of(entry.path(), step)) fs::remove(entry.path(), ignored);
  fs::remove(folder + "/mesh", ignored);
  fs::remove(folder + "/mesh.pvd", ignored);
}

MeshFrames MeshFrames::append_to(std::string const& folder, std::int64_t last_step) {
  std::vector<Frame> frames;
  std::error_code error;
  std::int64_t step = 0;
  for (auto const& entry : fs::directory_iterator(folder + "/mesh", error)) {
    if (!step_of(entry.path(), step)) continue;
    if (step > last_step)
      fs::remove(entry.path(), error);
    else
      frames.push_back({step, time_of(entry.path().string())});
  }
  std::sort(frames.begin(), frames.end(), [](Frame const& a, Frame const& b) { return a.step < b.step; });
  return {folder, std::move(frames)};
}

void MeshFrames::write(std::int64_t step, double time, std::span<MeshField const* const> fields) {
  write_vti(folder_ + "/" + frame_name(step), time, fields);
  frames_.push_back({step, time});
  write_index();
}

void MeshFrames::write_index() const {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "<Collection>\n";
  for (auto const& frame : frames_) {
    text += "<DataSet timestep=\"";
    append_number(text, frame.time);
    text += fmt::format("\" file=\"{}\"/>\n", frame_name(frame.step));
  }
  text += "</Collection>\n</VTKFile>\n";
  write_whole(folder_ + "/mesh.pvd", text);
}

}  // namespace boltzmann
