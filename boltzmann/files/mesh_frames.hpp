// Mesh frames: a time series of VTK ImageData that ParaView opens through an index file.
#pragma once

#include <boltzmann/schemes/mesh/mesh_field.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

/// Frames of a mesh: folder/mesh/000000100.vti for step 100, and the index folder/mesh.pvd, which is complete after
/// every frame.
class MeshFrames {
 public:
  /// Starts a new series and removes existing frames. Throws Error if the folder can't be written.
  explicit MeshFrames(std::string const& folder);
  /// Continues after `last_step`: later frames are removed, and the index lists the remaining ones. Throws Error
  /// if a frame can't be read.
  static MeshFrames append_to(std::string const& folder, std::int64_t last_step);
  /// Removes all frames and the index.
  static void remove(std::string const& folder);

  /// Throws Error if the frame or the index can't be written; the index is then unchanged.
  void write(std::int64_t step, double time, std::span<MeshField const* const> fields);

 private:
  struct Frame {
    std::int64_t step;
    double time;
  };
  MeshFrames(std::string folder, std::vector<Frame> frames);
  void write_index() const;

  std::string folder_;
  std::vector<Frame> frames_;
};

}  // namespace boltzmann
