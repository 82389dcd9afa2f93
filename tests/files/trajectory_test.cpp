// Trajectories: what is written comes back; a resumed file equals one without a stop; the layout is H5MD's.
#include <gtest/gtest.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/hdf5_file.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <tests/hdf5_leaks.hpp>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "temporary_folder.hpp"

namespace boltzmann::trajectory_test {
namespace {

std::vector<std::uint64_t> bits(std::vector<double> const& values) {
  std::vector<std::uint64_t> result;
  for (double const value : values) result.push_back(std::bit_cast<std::uint64_t>(value));
  return result;
}

// A state that depends on the step alone, with bit patterns of all kinds (NaNs with payloads, denormals) in the
// velocities.
template <class E>
void set_state(E& ensemble, std::int64_t step) {
  std::mt19937_64 random(test_seed(static_cast<std::uint64_t>(step) * 1000 + ensemble.size()));
  for (std::size_t i = 0; i < ensemble.size(); ++i)
    for (int k = 0; k < ensemble[i].position.dimension; ++k) {
      ensemble[i].position[k] = static_cast<double>(step) + 0.001 * static_cast<double>(i) + 0.1 * k;
      ensemble[i].velocity[k] = std::bit_cast<double>(random());
    }
}

BoxEdges moving_box(int dimension, std::int64_t step) {
  BoxEdges box;
  box.dimension = dimension;
  for (int axis = 0; axis < dimension; ++axis)
    box.low[axis] = -axis, box.high[axis] = 10 + 0.5 * static_cast<double>(step);
  box.periodic[0] = true;
  return box;
}

void expect_state(TrajectoryReader const& reader, std::size_t frame, AnyEnsemble const& expected) {
  ASSERT_EQ(reader.size(frame, expected.name()), expected.size());
  for (auto const& field : expected.fields()) {
    auto const values = reader.read(frame, expected.name(), field.name);
    auto const components = static_cast<std::size_t>(field.components);
    ASSERT_EQ(values.size(), expected.size() * components);
    for (std::size_t i = 0; i < expected.size(); ++i)
      for (std::size_t k = 0; k < components; ++k)
        ASSERT_EQ(std::bit_cast<std::uint64_t>(values[i * components + k]),
                  std::bit_cast<std::uint64_t>(expected.row(i)[static_cast<std::size_t>(field.offset) + k]))
            << field.name << " of particle " << i << " in frame " << frame;
  }
}

template <class P>
void round_trip(bool three_columns, std::size_t size) {
  TemporaryFolder const folder;
  int const d = P::dimension;
  Ensemble<P> ions("ions", size), other("the others", 3);
  TrajectoryOptions options;
  options.three_columns = three_columns;
  options.constant_fields = {"mass"};
  {
    Trajectory file(folder / "t.h5", options);
    for (std::int64_t step = 0; step < 50; step += 5) {
      set_state(ions, step);
      set_state(other, step);
      AnyEnsemble const* const list[] = {&ions, &other};
      file.write(step, 0.1 * static_cast<double>(step), list, moving_box(d, step));
    }
    EXPECT_EQ(file.frames(), 10U);
  }
  TrajectoryReader const reader(folder / "t.h5");
  ASSERT_EQ(reader.frames(), 10U);
  ASSERT_EQ(reader.ensembles().size(), 2U);
  EXPECT_EQ(reader.ensembles()[0].name, "ions");
  EXPECT_EQ(reader.ensembles()[0].class_name, P::class_name);
  EXPECT_EQ(reader.ensembles()[1].dimension, d);
  ASSERT_EQ(reader.ensembles()[0].fields.size(), ions.fields().size());
  for (std::size_t k = 0; k < ions.fields().size(); ++k) {
    EXPECT_EQ(reader.ensembles()[0].fields[k].name, ions.fields()[k].name);
    EXPECT_EQ(reader.ensembles()[0].fields[k].components, ions.fields()[k].components);
    EXPECT_EQ(reader.ensembles()[0].fields[k].constant, ions.fields()[k].name == "mass");
  }
  for (std::size_t frame = 0; frame < 10; ++frame) {
    auto const step = static_cast<std::int64_t>(5 * frame);
    EXPECT_EQ(reader.steps()[frame], step);
    EXPECT_EQ(reader.times()[frame], 0.1 * static_cast<double>(step));
    set_state(ions, step);
    set_state(other, step);
    expect_state(reader, frame, ions);
    expect_state(reader, frame, other);
    Ensemble<P> loaded("ions", 77);
    reader.load(frame, loaded);
    expect_state(reader, frame, loaded);
    BoxEdges const box = reader.box(frame), expected = moving_box(d, step);
    EXPECT_EQ(box.dimension, d);
    for (int axis = 0; axis < d; ++axis) {
      EXPECT_EQ(box.low[axis], expected.low[axis]);
      EXPECT_EQ(box.high[axis], expected.high[axis]);
      EXPECT_EQ(box.periodic[axis], axis == 0);
    }
  }
}

TEST(Trajectory, ComesBackBitForBitInEveryDimension) {
  for (bool const three_columns : {true, false})
    for (std::size_t const size : {0, 1, 2, 100}) {
      round_trip<Newton<1>>(three_columns, size);
      round_trip<Newton<2>>(three_columns, size);
      round_trip<Coulomb<3>>(three_columns, size);
    }
}

TEST(Trajectory, ManyParticlesInSeveralChunksComeBack) { round_trip<Newton<3>>(true, 70000); }

TEST(Trajectory, FollowsTheH5mdSpecification) {
  TemporaryFolder const folder;
  Ensemble<Coulomb<2>> ions("ions", 4);
  AnyEnsemble const* const list[] = {&ions};
  TrajectoryOptions options;
  options.author = "A. Nonymous";
  options.version = "0.1.0";
  options.constant_fields = {"mass"};
  options.unit_name = [](Dimension d) -> std::string {
    if (d == dimensions::length) return "angstrom";
    if (d == dimensions::time) return "ps";
    if (d == dimensions::velocity) return "angstrom/ps";
    if (d == dimensions::mass) return "amu";
    return "2.5 e";
  };
  {
    Trajectory file(folder / "t.h5", options);
    for (int frame = 0; frame < 3; ++frame) file.write(10 * frame, frame, list, moving_box(2, 0));
  }
  auto const file = hdf5::File::open(folder / "t.h5");
  EXPECT_EQ(file->text("/h5md/author", "name"), "A. Nonymous");
  EXPECT_EQ(file->text("/h5md/creator", "name"), "boltzmann");
  EXPECT_EQ(file->text("/h5md/creator", "version"), "0.1.0");
  EXPECT_TRUE(file->has("/h5md/modules/units"));
  using hdf5::Extents;
  EXPECT_EQ(file->dataset("/particles/ions/position/value").extents(), (Extents{3, 4, 3}));
  EXPECT_EQ(file->dataset("/particles/ions/velocity/value").extents(), (Extents{3, 4, 3}));
  EXPECT_EQ(file->dataset("/particles/ions/charge/value").extents(), (Extents{3, 4}));
  EXPECT_EQ(file->dataset("/particles/ions/mass").extents(), (Extents{4}));
  EXPECT_EQ(file->dataset("/particles/ions/id").integers(), (std::vector<std::int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(file->dataset("/particles/ions/species").integers(), (std::vector<std::int64_t>{0, 0, 0, 0}));
  EXPECT_EQ(file->dataset("/particles/ions/velocity/step").integers(), (std::vector<std::int64_t>{0, 10, 20}));
  EXPECT_EQ(file->dataset("/particles/ions/box/edges/time").reals(), (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(file->integer("/particles/ions/box", "dimension"), 3);
  EXPECT_EQ(file->texts("/particles/ions/box", "boundary"), (std::vector<std::string>{"periodic", "none", "none"}));
  auto const edges = file->dataset("/particles/ions/box/edges/value");
  EXPECT_EQ(edges.extents(), (Extents{3, 3, 3}));
  std::vector<double> matrix(9);
  edges.read(matrix.data(), {2, 0, 0}, {1, 3, 3});
  EXPECT_EQ(matrix, (std::vector<double>{10, 0, 0, 0, 11, 0, 0, 0, 1}));
  EXPECT_EQ(file->text("/particles/ions/position/value", "unit"), "Angstrom");
  EXPECT_EQ(file->text("/particles/ions/position/value", "boltzmann_unit"), "angstrom");
  EXPECT_EQ(file->text("/particles/ions/velocity/value", "unit"), "Angstrom ps-1");
  EXPECT_EQ(file->text("/particles/ions/position/time", "unit"), "ps");
  EXPECT_EQ(file->text("/particles/ions/mass", "unit"), "amu");
  EXPECT_FALSE(file->has("/particles/ions/charge/value", "unit"));
  EXPECT_EQ(file->text("/particles/ions/charge/value", "boltzmann_unit"), "2.5 e");
  TrajectoryReader const reader(folder / "t.h5");
  EXPECT_EQ(reader.time_unit(), "ps");
  EXPECT_EQ(reader.ensembles()[0].fields[2].unit, "angstrom/ps");
}

// An ensemble that begins with 4 particles and has 30000 after 50 frames, as wakes do: the file is hardly larger than what
// is in it, and reads back.
TEST(Trajectory, OfAnEnsembleThatGrowsIsAsLargeAsItsNumbers) {
  TemporaryFolder const folder;
  Ensemble<Vortex<2>> wake("wake", 4);
  AnyEnsemble const* const list[] = {&wake};
  TrajectoryOptions options;
  options.sizes_change = true;
  options.three_columns = false;
  int const frames = 50;
  std::size_t most = 0;
  {
    Trajectory file(folder / "t.h5", options);
    for (int frame = 0; frame < frames; ++frame) {
      wake.resize(4 + 600 * static_cast<std::size_t>(frame));
      for (std::size_t i = 0; i < wake.size(); ++i)
        wake[i].position = {static_cast<double>(frame), static_cast<double>(i)};
      file.write(frame, 0.1 * frame, list, moving_box(2, frame));
    }
  }
  std::size_t numbers = 0;
  for (int frame = 0; frame < frames; ++frame) {
    most = 4 + 600 * static_cast<std::size_t>(frame);
    for (auto const& field : wake.fields()) numbers += most * static_cast<std::size_t>(field.components);
  }
  EXPECT_LT(static_cast<double>(read_text(folder / "t.h5").size()), 1.2 * 8 * static_cast<double>(numbers) + 1e6);
  TrajectoryReader const reader(folder / "t.h5");
  ASSERT_EQ(reader.frames(), static_cast<std::size_t>(frames));
  for (std::size_t const frame : {0, 1, 25, 49}) {
    auto const places = reader.read(frame, "wake", "position");
    ASSERT_EQ(places.size(), 2 * (4 + 600 * frame));
    EXPECT_EQ(places[places.size() - 2], static_cast<double>(frame));
    EXPECT_EQ(places.back(), static_cast<double>(places.size() / 2 - 1));
  }
}

TEST(Trajectory, UnitsThatMdanalysisRefusesAreKeptAside) {
  TemporaryFolder const folder;
  Ensemble<Newton<3>> ions("ions", 1);
  AnyEnsemble const* const list[] = {&ions};
  TrajectoryOptions options;
  options.unit_name = [](Dimension d) { return d == dimensions::length ? "cm" : "cm/s"; };
  Trajectory(folder / "t.h5", options).write(0, 0, list, {});
  auto const file = hdf5::File::open(folder / "t.h5");
  for (char const* name : {"position/value", "position/time", "velocity/value"}) {
    EXPECT_FALSE(file->has(std::string("/particles/ions/") + name, "unit"));
    EXPECT_TRUE(file->has(std::string("/particles/ions/") + name, "boltzmann_unit"));
  }
}

TEST(Trajectory, UnitsInTheNotationOfH5md) {
  EXPECT_EQ(h5md_unit("angstrom"), "Angstrom");
  EXPECT_EQ(h5md_unit("angstrom/ps"), "Angstrom ps-1");
  EXPECT_EQ(h5md_unit("amu angstrom^2/ps^2"), "amu Angstrom+2 ps-2");
  EXPECT_EQ(h5md_unit("J/(kg K)"), "J kg-1 K-1");
  EXPECT_EQ(h5md_unit("1/s"), "s-1");
  EXPECT_EQ(h5md_unit("1.804 angstrom"), "");
  EXPECT_EQ(h5md_unit(""), "");
}

TEST(Trajectory, NumbersOfParticlesMayChange) {
  TemporaryFolder const folder;
  Ensemble<Newton<2>> ions("ions", 0);
  AnyEnsemble const* const list[] = {&ions};
  std::vector<std::size_t> const sizes{0, 3, 1, 200, 0, 5};
  auto const write = [&](Trajectory& file, std::size_t from, std::size_t to) {
    for (std::size_t frame = from; frame < to; ++frame) {
      ions.resize(sizes[frame]);
      set_state(ions, static_cast<std::int64_t>(frame));
      file.write(static_cast<std::int64_t>(frame), 0, list, {.dimension = 2});
    }
  };
  {
    Trajectory file(folder / "t.h5");
    write(file, 0, sizes.size());
  }
  for (int pass = 0; pass < 2; ++pass) {
    TrajectoryReader const reader(folder / "t.h5");
    ASSERT_EQ(reader.frames(), sizes.size());
    for (std::size_t frame = 0; frame < sizes.size(); ++frame) {
      ions.resize(sizes[frame]);
      set_state(ions, static_cast<std::int64_t>(frame));
      expect_state(reader, frame, ions);
    }
    auto file = Trajectory::append_to(folder / "t.h5", 2);  // cuts off the large frame
    EXPECT_EQ(TrajectoryReader(folder / "t.h5").frames(), 3U);
    EXPECT_EQ(hdf5::File::open(folder / "t.h5")->dataset("/particles/ions/position/value").extents()[1], 3U);
    write(file, 3, sizes.size());
  }
}

// All numbers of a trajectory, one after the other.
std::vector<std::uint64_t> content(std::string const& path) {
  auto const file = hdf5::File::open(path);
  std::vector<std::uint64_t> all;
  auto const add = [&](auto const& self, std::string const& group) -> void {
    for (auto const& child : file->children(group)) {
      std::string const object = group + "/" + child;
      if (!file->is_dataset(object)) {
        self(self, object);
        continue;
      }
      auto const data = file->dataset(object);
      for (auto const extent : data.extents()) all.push_back(extent);
      for (auto const value : bits(data.reals())) all.push_back(value);
    }
  };
  add(add, "/particles");
  return all;
}

TEST(Trajectory, ResumedRunLeavesTheFileOfARunWithoutAStop) {
  TemporaryFolder const folder;
  Ensemble<Newton<2>> ions("ions", 3), dust("dust", 1);
  AnyEnsemble const* const list[] = {&ions, &dust};
  TrajectoryOptions options;
  options.constant_fields = {"mass"};
  auto const write = [&](Trajectory& file, std::int64_t from, std::int64_t to) {
    for (std::int64_t step = from; step < to; step += 10) {
      set_state(ions, step);
      set_state(dust, step);
      file.write(step, 0.1 * static_cast<double>(step), list, moving_box(2, step));
    }
  };
  {
    Trajectory whole(folder / "whole.h5", options);
    write(whole, 0, 1000);
  }
  auto const expected = content(folder / "whole.h5");
  for (std::int64_t const last : {-1, 0, 5, 10, 499, 500, 690, 700, 5000}) {
    {
      Trajectory file(folder / "t.h5", options);
      write(file, 0, 700);
    }
    auto resumed = Trajectory::append_to(folder / "t.h5", last, options);
    std::int64_t const next = last < 0 ? 0 : std::min<std::int64_t>(last / 10 * 10 + 10, 700);
    EXPECT_EQ(resumed.frames(), static_cast<std::size_t>(next / 10));
    write(resumed, next, 1000);
    resumed.close();
    EXPECT_EQ(content(folder / "t.h5"), expected) << "resumed after step " << last;
  }
}

// What two ensembles, of which one grows, leave in a trajectory.
struct Story {
  Ensemble<Newton<2>> ions{"ions", 3}, dust{"dust", 1};

  void tell(Trajectory& file, std::int64_t from, std::int64_t to) {
    AnyEnsemble const* const list[] = {&ions, &dust};
    for (std::int64_t step = from; step < to; step += 10) {
      dust.resize(static_cast<std::size_t>(1 + step / 400));
      set_state(ions, step);
      set_state(dust, step);
      file.write(step, 0.1 * static_cast<double>(step), list, moving_box(2, step));
    }
  }
  void tell_all(std::string const& path, std::int64_t last) {
    Trajectory file(path);
    tell(file, 0, last);
    file.close();
  }
};

TEST(Trajectory, AMarkedFileIsTakenBackToTheByte) {
  TemporaryFolder const folder;
  std::string const path = folder / "t.h5", log = path + ".undo";
  Story story;
  story.tell_all(folder / "whole.h5", 1500);
  std::string const whole = read_text(folder / "whole.h5");
  // The index of a dataset's chunks gets new blocks now and then: at marks or behind them. Groups of small frames share
  // a chunk.
  for (std::int64_t const mark : {10, 50, 170, 680})
    for (std::int64_t const beyond : {10, 300}) {
      SCOPED_TRACE(testing::Message() << "marked at " << mark << ", " << beyond << " steps beyond");
      std::string then;
      {
        Trajectory file(path);
        story.tell(file, 0, mark);
        file.mark();
        then = read_text(path);
        story.tell(file, mark, mark + beyond);
      }
      EXPECT_NE(read_text(path), then);
      auto resumed = Trajectory::append_to(path, mark - 10);
      EXPECT_EQ(resumed.frames(), static_cast<std::size_t>(mark / 10));
      EXPECT_FALSE(std::filesystem::exists(log));
      story.tell(resumed, mark, 1500);
      resumed.close();
      EXPECT_TRUE(read_text(path) == whole);
    }
}

TEST(Trajectory, AMarkThatDoesNotFitIsNoHindrance) {
  TemporaryFolder const folder;
  std::string const path = folder / "t.h5", log = path + ".undo";
  Story story;
  story.tell_all(folder / "whole.h5", 1000);
  auto const expected = content(folder / "whole.h5");
  auto const begin = [&] {
    Trajectory file(path);
    story.tell(file, 0, 400);
    file.mark();
    story.tell(file, 400, 500);
  };
  auto const goes_on_after = [&](std::int64_t last) {
    auto resumed = Trajectory::append_to(path, last);
    story.tell(resumed, last + 10, 1000);
    resumed.close();
    return content(path) == expected;
  };
  begin();
  EXPECT_TRUE(goes_on_after(450)) << "frames beyond the mark stay";
  begin();
  EXPECT_TRUE(goes_on_after(100)) << "frames before the mark go";
  // A log that was torn, or has been changed: the numbers are right all the same.
  std::mt19937 random(test_seed(8));
  for (int trial = 0; trial < 24; ++trial) {
    begin();
    std::string text = read_text(log);
    if (trial % 2 == 0)
      text.resize(random() % text.size());
    else
      text[random() % text.size()] ^= static_cast<char>(1U << random() % 8);
    std::ofstream(log, std::ios::binary) << text;
    ASSERT_TRUE(goes_on_after(390)) << "trial " << trial;
  }
  // Where there can be no log.
  std::filesystem::remove(log);
  std::filesystem::create_directory(log);
  begin();
  EXPECT_TRUE(goes_on_after(390));
}

// A disk that fails, or a power that is lost, may leave the last frames half written: they say so, those before them
// are read, and the run goes on from there.
TEST(Trajectory, AHalfWrittenFrameLeavesThoseBeforeIt) {
  TemporaryFolder const folder;
  Ensemble<Newton<2>> ions("ions", 7);
  AnyEnsemble const* const list[] = {&ions};
  std::int64_t const every = 1'000'003;  // stands nowhere else in the file
  auto const write = [&](Trajectory& file, std::int64_t step) {
    set_state(ions, step);
    file.write(step, std::sqrt(2.0 + static_cast<double>(step)), list, moving_box(2, step));
  };
  {
    Trajectory file(folder / "t.h5");
    for (std::int64_t k = 0; k < 5; ++k) write(file, k * every);
  }
  for (double const time_or_step :
       {std::sqrt(2.0 + static_cast<double>(4 * every)), std::bit_cast<double>(4 * every)}) {
    std::string bytes = read_text(folder / "t.h5"), number(8, '\0');
    std::memcpy(number.data(), &time_or_step, 8);
    auto const at = bytes.find(number);
    ASSERT_NE(at, std::string::npos);
    TextFile(folder / "torn.h5", TextFile::Mode::replace).write(bytes.replace(at, 8, 8, '\0'));
    {
      TrajectoryReader const torn(folder / "torn.h5");
      ASSERT_EQ(torn.frames(), 5U);
      for (std::size_t frame = 0; frame < 4; ++frame) {
        set_state(ions, every * static_cast<std::int64_t>(frame));
        expect_state(torn, frame, ions);
      }
      for (auto const& line :
           {message([&] { torn.size(4, "ions"); }), message([&] { torn.read(4, "ions", "velocity"); }),
            message([&] { torn.box(4); }), message([&] { torn.load(4, ions); })})
        EXPECT_NE(line.find("its frame 4 is damaged"), std::string::npos) << line;
      EXPECT_EQ(torn.frames_until(4 * every - 1), 4U);
    }
    {
      Trajectory again = Trajectory::append_to(folder / "torn.h5", 4 * every - 1);
      EXPECT_EQ(again.frames(), 4U);
      write(again, 4 * every);
    }
    TrajectoryReader const mended(folder / "torn.h5"), whole(folder / "t.h5");
    EXPECT_EQ(mended.steps(), whole.steps());
    EXPECT_EQ(mended.checksum(5), whole.checksum(5));
    set_state(ions, 4 * every);
    expect_state(mended, 4, ions);
  }
}

TEST(Trajectory, EveryTruncationIsOneError) {
  TemporaryFolder const folder;
  Ensemble<Newton<3>> ions("ions", 2);
  AnyEnsemble const* const list[] = {&ions};
  {
    Trajectory file(folder / "t.h5");
    for (int frame = 0; frame < 5; ++frame) file.write(frame, 0, list, {});
  }
  std::string const bytes = read_text(folder / "t.h5");
  for (std::size_t size = 0; size < bytes.size(); size += size < 100 ? 1 : 97) {
    std::ofstream(folder / "cut.h5", std::ios::binary) << bytes.substr(0, size);
    for (int use = 0; use < 2; ++use) {
      std::string const text = message([&] {
        use == 0 ? (void)TrajectoryReader(folder / "cut.h5") : (void)Trajectory::append_to(folder / "cut.h5", 99);
      });
      EXPECT_TRUE(text.starts_with(folder / "cut.h5" + ": ") && text.find('\n') == std::string::npos) << size << text;
    }
  }
  std::ofstream(folder / "cut.h5", std::ios::binary) << bytes.substr(0, bytes.size() - 1);
  EXPECT_NE(message([&] { TrajectoryReader(folder / "cut.h5"); }).find("truncated"), std::string::npos);
}

// Reads all that there is; the first thing that is wrong, or nothing.
std::string all_read(std::string const& path, Ensemble<Newton<3>>& into) {
  DamagedHdf5 const uncounted;
  return message([&] {
    TrajectoryReader const reader(path);
    for (std::size_t frame = 0; frame < reader.frames(); ++frame) {
      reader.box(frame);
      reader.load(frame, into);
    }
  });
}

TEST(Trajectory, EveryChangedByteIsOneErrorOrChangesNothing) {
  TemporaryFolder const folder;
  Ensemble<Newton<3>> ions("ions", 5);
  AnyEnsemble const* const list[] = {&ions};
  {
    TrajectoryOptions options;
    options.constant_fields = {"mass"};
    Trajectory file(folder / "t.h5", options);
    for (int frame = 0; frame < 5; ++frame) {
      set_state(ions, frame);
      file.write(frame, 0.1 * frame, list, moving_box(3, frame));
    }
  }
  std::string const bytes = read_text(folder / "t.h5");
  std::size_t told = 0;
  for (std::size_t at = 0; at < bytes.size(); at += 499) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 0x55);
    std::ofstream(folder / "changed.h5", std::ios::binary) << changed;
    Ensemble<Newton<3>> read("ions", 0);
    if (auto const text = all_read(folder / "changed.h5", read); text != "no error") {
      ++told;
      EXPECT_TRUE(text.starts_with(folder / "changed.h5" + ": ") && text.find('\n') == std::string::npos) << text;
      continue;
    }
    TrajectoryReader const reader(folder / "changed.h5");  // a byte that says nothing
    ASSERT_EQ(reader.frames(), 5U) << "byte " << at;
    for (int frame = 0; frame < 5; ++frame) {
      set_state(ions, frame);
      EXPECT_EQ(reader.steps()[static_cast<std::size_t>(frame)], frame) << "byte " << at;
      EXPECT_EQ(reader.times()[static_cast<std::size_t>(frame)], 0.1 * frame) << "byte " << at;
      ASSERT_NO_FATAL_FAILURE(expect_state(reader, static_cast<std::size_t>(frame), ions)) << "byte " << at;
      for (int a = 0; a < 3; ++a) {
        EXPECT_EQ(reader.box(static_cast<std::size_t>(frame)).periodic[a], a == 0) << "byte " << at;
        EXPECT_EQ(reader.box(static_cast<std::size_t>(frame)).high[a], 10 + 0.5 * frame) << "byte " << at;
      }
    }
  }
  EXPECT_GT(told, bytes.size() / 499 / 40);
  // A number of each kind, where it stands.
  ions[3].velocity = {1.25e77, 0, 0};
  {
    Trajectory file(folder / "u.h5");
    BoxEdges box = moving_box(3, 1);
    box.low[2] = -2.3456789;
    file.write(19088743, 0.375123456789, list, box);
  }
  std::string const good = read_text(folder / "u.h5");
  auto const bytes_of = [](auto number) { return std::string(reinterpret_cast<char const*>(&number), sizeof(number)); };
  for (auto const& [number, words] :
       {std::pair{bytes_of(1.25e77), "velocity is not what was written"},
        {bytes_of(std::int64_t{19088743}), "its step, time, size or box is not what was written"},
        {bytes_of(0.375123456789), "its step, time, size or box is not what was written"},
        {bytes_of(-2.3456789), "its step, time, size or box is not what was written"}}) {
    std::size_t const at = good.rfind(number);  // headers stand before
    ASSERT_NE(at, std::string::npos) << words;
    std::string changed = good;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    std::ofstream(folder / "u.h5", std::ios::binary) << changed;
    Ensemble<Newton<3>> read("ions", 0);
    EXPECT_NE(all_read(folder / "u.h5", read).find(words), std::string::npos) << all_read(folder / "u.h5", read);
  }
}

TEST(Trajectory, ErrorsAreOneLine) {
  TemporaryFolder const folder;
  std::string const path = folder / "t.h5";
  EXPECT_EQ(message([&] { TrajectoryReader reader(path); }), path + ": can't open it: No such file or directory");
  EXPECT_EQ(message([&] { Trajectory::append_to(path, 0); }), path + ": can't open it: No such file or directory");
  EXPECT_EQ(message([&] { Trajectory(folder / "no/t.h5"); }),
            folder / "no/t.h5" + ": can't open it for writing: No such file or directory");
  EXPECT_EQ(message([&] { Trajectory file("/dev/full"); }), "/dev/full: is not a regular file");
  std::ofstream(path) << "step,time\n";
  EXPECT_EQ(message([&] { TrajectoryReader reader(path); }), path + ": is not an HDF5 file");

  Ensemble<Newton<3>> ions("ions", 2), dust("dust", 1), slash("a/b", 1);
  Ensemble<Coulomb<3>> charged("ions", 2);
  AnyEnsemble const *const list[] = {&ions}, *const other[] = {&dust}, *const twice[] = {&ions, &ions},
                           *const bad[] = {&slash}, *const changed[] = {&charged};
  EXPECT_NE(message([&] { Trajectory(path).write(0, 0, twice, {}); }).find("two ensembles are called 'ions'"),
            std::string::npos);
  EXPECT_NE(message([&] { Trajectory(path).write(0, 0, bad, {}); }).find("can't be called 'a/b'"), std::string::npos);
  TrajectoryOptions options;
  options.constant_fields = {"mass"};
  {
    Trajectory file(path, options);
    EXPECT_EQ(message([&] { Trajectory second(path); }), path + ": another run is writing this file");
    file.write(0, 0, list, {});
    EXPECT_EQ(message([&] { file.write(1, 0, other, {}); }),
              path + ": the ensembles of step 1 are not those of the frames before");
    EXPECT_EQ(message([&] {
                file.write(1, 0, list, {.periodic = {false, true, false}});
              }),
              path + ": the boundary of axis y has changed at step 1");
    ions[1].mass = 2;
    EXPECT_EQ(message([&] { file.write(1, 0, list, {}); }),
              path + ": the field 'mass' of ensemble 'ions' was declared constant and has changed at step 1");
    ions[1].mass = 1;
    file.write(1, 0, list, {});
  }
  EXPECT_NE(message([&] {
              Trajectory::append_to(path, 9).write(2, 0, changed, {});
            }).find("of class Newton in 3D, not Coulomb in 3D"),
            std::string::npos);
  EXPECT_NE(
      message([&] { Trajectory::append_to(path, 9).write(2, 0, other, {}); }).find("has the ensembles ions, not dust"),
      std::string::npos);
  TrajectoryReader const reader(path);
  EXPECT_EQ(reader.frames(), 2U);
  EXPECT_EQ(message([&] { reader.read(2, "ions", "mass"); }), path + ": has no frame 2; its 2 frames count from 0");
  EXPECT_EQ(message([&] { reader.read(0, "ion", "mass"); }),
            path + ": has no ensemble 'ion'; it has ions; did you mean 'ions'?");
  EXPECT_EQ(
      message([&] { reader.read(0, "ions", "velocty"); }),
      path + ": its ensemble 'ions' has no field 'velocty'; it has position, mass, velocity; did you mean 'velocity'?");
  EXPECT_THROW(reader.load(0, charged), Error);
}

}  // namespace
}  // namespace boltzmann::trajectory_test
