// Frame writers: one class for each kind of export format. Private to this module.
#pragma once

#include <boltzmann/files/export.hpp>

#include <memory>
#include <string>

namespace boltzmann {

class FrameWriter {
 public:
  FrameWriter() = default;
  virtual ~FrameWriter() = default;
  FrameWriter(FrameWriter const&) = delete;
  FrameWriter& operator=(FrameWriter const&) = delete;
  virtual void write(ExportFrame const& frame) = 0;
  virtual void finish() = 0;
};

/// All frames in one text file.
std::unique_ptr<FrameWriter> text_writer(std::string const& path, std::string (*text)(ExportFrame const&));
/// A row per particle and frame, with the fields of all ensembles.
std::unique_ptr<FrameWriter> csv_writer(std::string const& path);
/// A frame of one ensemble.
std::unique_ptr<FrameWriter> vtp_writer(std::string const& path);
/// copper.pvd and copper/ions-000000100.vtp, ...
std::unique_ptr<FrameWriter> pvd_writer(std::string const& path);
/// H5MD with one group of all particles, in a form that MDAnalysis opens.
std::unique_ptr<FrameWriter> h5md_writer(std::string const& path);

}  // namespace boltzmann
