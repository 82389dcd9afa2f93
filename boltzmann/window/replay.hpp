// Replay: shows a stored run frame by frame, forwards and backwards, even while it is still being written.
#pragma once

#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/window/source.hpp>
#include <boltzmann/window/views.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace boltzmann {

class Clients;

class Replay final : public Source {
 public:
  /// Shows the frames of folder/trajectory.h5 in the ensembles of the views, and the table of folder/diagnoses.csv.
  /// Throws Error if there are no frames.
  Replay(Views& views, std::string name, std::string description);
  Replay(Replay const&) = delete;
  Replay& operator=(Replay const&) = delete;

  /// Executes the clients' requests until one of them quits, or a signal arrives (then it returns true).
  bool run(Clients& clients);

  nlohmann::json hello() const override;
  nlohmann::json status() const override;
  std::uint64_t scene() const override { return scene_; }
  std::uint64_t notice() const override { return notice_; }
  nlohmann::json perform(nlohmann::json const& request) override;
  std::shared_ptr<Canvas const> draw(nlohmann::json const& view) override;
  PictureFile picture(nlohmann::json const& request) override;
  nlohmann::json particle(std::string const& ensemble, std::size_t number) const override;
  ShownTable const* table() const override { return &table_; }

 private:
  std::int64_t frames() const { return static_cast<std::int64_t>(steps_.size()); }
  std::int64_t step() const { return steps_[static_cast<std::size_t>(frame_)]; }
  double time() const { return times_[static_cast<std::size_t>(frame_)]; }
  void take(std::unique_ptr<TrajectoryReader> reader);
  void go_to(std::int64_t frame);
  void read_table();
  void look_for_more();

  Views& views_;
  std::string name_, description_, path_;
  std::unique_ptr<TrajectoryReader> reader_;  // null while the file can't be read
  std::vector<std::int64_t> steps_;
  std::vector<double> times_;
  std::filesystem::file_time_type written_{};  // of the file, before it was opened
  std::int64_t frame_ = 0;
  std::string message_;  // reason why it does not continue
  int direction_ = 0;    // 1: forwards, -1: backwards
  double frames_per_second_ = 25;
  bool quit_ = false;
  std::uint64_t scene_ = 1, notice_ = 1;
  ShownTable table_;
};

}  // namespace boltzmann
