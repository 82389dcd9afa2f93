// Whether two folders hold the same run, to the last bit.
#pragma once

#include "tests/bzm/command.hpp"

#include <boltzmann/core/error.hpp>
#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/files/trajectory.hpp>

#include <bit>
#include <cstring>

namespace boltzmann::test {

inline std::int64_t checkpoint_step(fs::path const& folder) {
  try {
    return read_checkpoint((folder / "checkpoint.h5").string()).step;
  } catch (Error const&) {
    return -1;  // not yet there
  }
}

inline bool same_bits(std::vector<double> const& a, std::vector<double> const& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

inline void expect_same_checkpoint(fs::path const& one, fs::path const& other) {
  auto const a = read_checkpoint((one / "checkpoint.h5").string());
  auto const b = read_checkpoint((other / "checkpoint.h5").string());
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a.time), std::bit_cast<std::uint64_t>(b.time));
  EXPECT_EQ(a.seed, b.seed);
  ASSERT_EQ(a.ensembles.size(), b.ensembles.size());
  for (std::size_t e = 0; e < a.ensembles.size(); ++e) {
    EXPECT_GT(a.ensembles[e].size, 0U);
    EXPECT_TRUE(same_bits(a.ensembles[e].rows, b.ensembles[e].rows)) << "rows of " << a.ensembles[e].name;
  }
  ASSERT_EQ(a.state.size(), b.state.size());
  for (auto const& [name, values] : a.state)
    if (name != "planned") {
      ASSERT_TRUE(b.state.contains(name));
      EXPECT_TRUE(same_bits(values, b.state.at(name))) << "state of " << name;
    }
}

inline void expect_same_trajectory(fs::path const& one, fs::path const& other) {
  TrajectoryReader const a((one / "trajectory.h5").string()), b((other / "trajectory.h5").string());
  ASSERT_GT(a.frames(), 1U);
  ASSERT_EQ(a.steps(), b.steps());
  ASSERT_TRUE(same_bits(a.times(), b.times()));
  for (auto const& ensemble : a.ensembles())
    for (auto const& field : ensemble.fields)
      for (std::size_t frame = 0; frame < a.frames(); ++frame)
        ASSERT_TRUE(same_bits(a.read(frame, ensemble.name, field.name), b.read(frame, ensemble.name, field.name)))
            << field.name << " of " << ensemble.name << " in frame " << frame;
}

inline void expect_same_mesh_frames(fs::path const& one, fs::path const& other) {
  EXPECT_EQ(text_of(one / "mesh.pvd"), text_of(other / "mesh.pvd"));
  std::size_t frames = 0;
  for (auto const& entry : fs::directory_iterator(one / "mesh")) {
    ++frames;
    EXPECT_EQ(text_of(entry.path()), text_of(other / "mesh" / entry.path().filename())) << entry.path();
  }
  EXPECT_GT(frames, 4U);
  EXPECT_EQ(frames, static_cast<std::size_t>(std::distance(fs::directory_iterator(other / "mesh"), {})));
}

}  // namespace boltzmann::test
