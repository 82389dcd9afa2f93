// CSV: what is written comes back, after a kill and a resume as well.
#include <gtest/gtest.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/csv.hpp>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <bit>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>

#include "temporary_folder.hpp"

namespace boltzmann::csv_test {
namespace {

void put(std::string const& path, std::string const& text) { std::ofstream(path, std::ios::binary) << text; }

std::vector<double> row(double a, double b) { return {a, b}; }

TEST(Csv, WritesHeaderAndRowsAsText) {
  TemporaryFolder const folder;
  CsvFile file(folder / "a.csv", {"step", "time (ps)", "energy, \"kinetic\" (eV)"});
  file.write(100000, row(0.1, -1e300));
  EXPECT_EQ(read_text(folder / "a.csv"), "step,time (ps),\"energy, \"\"kinetic\"\" (eV)\"\n100000,0.1,-1e+300\n");
}

TEST(Csv, QuotesAsRfc4180AndReadsItBack) {
  TemporaryFolder const folder;
  std::vector<std::string> const header{"step", "a,b", "say \"hi\"", "two\nlines", "cr\r", "", " blank "};
  CsvFile(folder / "a.csv", header).write(1, std::vector<double>(6, 2.0));
  auto const table = read_csv(folder / "a.csv");
  EXPECT_EQ(table.header, header);
  EXPECT_EQ(table.column("two\nlines"), std::vector<double>{2.0});
  // Example 6 and 7 of RFC 4180, section 2, with numbers below.
  put(folder / "b.csv", "\"aaa\",\"b\r\nbb\",\"c\"\"cc\"\r\n1,2,3\r\n");
  EXPECT_EQ(read_csv(folder / "b.csv").header, (std::vector<std::string>{"aaa", "b\r\nbb", "c\"cc"}));
  EXPECT_EQ(read_csv(folder / "b.csv").columns[2], std::vector<double>{3});
}

TEST(Csv, DoublesComeBackWithTheSameBits) {
  TemporaryFolder const folder;
  std::mt19937_64 random(test_seed(1));
  std::vector<double> written{0.0,
                              -0.0,
                              std::numeric_limits<double>::denorm_min(),
                              std::numeric_limits<double>::max(),
                              0.1 + 0.2,
                              std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity()};
  for (int k = 0; k < 5000; ++k) {
    double const x = std::bit_cast<double>(random());
    if (!std::isnan(x)) written.push_back(x);
  }
  {
    CsvFile file(folder / "a.csv", {"step", "x"});
    for (std::size_t k = 0; k < written.size(); ++k) file.write(static_cast<std::int64_t>(k), {&written[k], 1});
  }
  auto const table = read_csv(folder / "a.csv");
  ASSERT_EQ(table.columns[1].size(), written.size());
  for (std::size_t k = 0; k < written.size(); ++k)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(table.columns[1][k]), std::bit_cast<std::uint64_t>(written[k]));
}

TEST(Csv, NanIsAnEmptyCellAndReadAsNan) {
  TemporaryFolder const folder;
  CsvFile(folder / "a.csv", {"step", "x", "y"}).write(0, row(std::nan(""), -std::nan("")));
  auto const table = read_csv(folder / "a.csv");
  EXPECT_EQ(read_text(folder / "a.csv"), "step,x,y\n0,,\n");
  EXPECT_TRUE(std::isnan(table.columns[1][0]) && std::isnan(table.columns[2][0]));
}

TEST(Csv, ResumedRunLeavesTheFileOfARunWithoutAStop) {
  TemporaryFolder const folder;
  std::vector<std::string> const header{"step", "t", "x, y"};
  auto const write = [](CsvFile& file, int from, int to) {
    for (int step = from; step < to; step += 10) file.write(step, row(step * 0.1, std::sin(step)));
  };
  CsvFile whole(folder / "whole.csv", header);
  write(whole, 0, 500);
  for (int last = -1; last < 320; last += 7) {
    {
      CsvFile file(folder / "a.csv", header);
      write(file, 0, 300);
    }
    std::ofstream(folder / "a.csv", std::ios::app) << "300,30";  // torn by a kill
    auto resumed = CsvFile::append_to(folder / "a.csv", header, last);
    int const kept = last < 0 ? 0 : last / 10 * 10 + 10;
    write(resumed, kept > 300 ? 300 : kept, 500);
    ASSERT_EQ(read_text(folder / "a.csv"), read_text(folder / "whole.csv")) << last;
  }
}

TEST(Csv, ResumeAtEveryLengthOfATruncatedFile) {
  TemporaryFolder const folder;
  std::vector<std::string> const header{"step", "a \"b\"\n"};
  std::string text;
  {
    CsvFile file(folder / "a.csv", header);
    for (int k = 0; k < 5; ++k) file.write(k, std::vector<double>{k + 0.5});
    text = read_text(folder / "a.csv");
  }
  std::size_t const first = text.find("0,0.5");
  for (std::size_t size = 0; size <= text.size(); ++size) {
    put(folder / "b.csv", text.substr(0, size));
    if (size < first) {
      EXPECT_THROW(CsvFile::append_to(folder / "b.csv", header, 99), Error) << size;
    } else {
      CsvFile::append_to(folder / "b.csv", header, 99);
      std::string const kept = read_text(folder / "b.csv");
      EXPECT_EQ(kept, text.substr(0, kept.size()));
      EXPECT_EQ(kept.back(), '\n');
      EXPECT_LE(size - kept.size(), 5U) << "a whole row was lost";
    }
  }
}

TEST(Csv, ErrorsAreOneLine) {
  TemporaryFolder const folder;
  EXPECT_EQ(message([&] { CsvFile(folder / "no/a.csv", {"step"}); }),
            folder / "no/a.csv" + ": can't open it for writing: No such file or directory");
  EXPECT_EQ(message([&] { CsvFile::append_to(folder / "a.csv", {"step"}, 0); }),
            folder / "a.csv" + ": can't open it: No such file or directory");
  put(folder / "a.csv", "step,x\n1,2\n");
  EXPECT_EQ(message([&] {
              CsvFile::append_to(folder / "a.csv", {"step", "y"}, 0);
            }),
            folder / "a.csv" + ": its columns are step, x, not step, y");
  EXPECT_EQ(message([&] {
              CsvFile(folder / "b.csv", {"step", "x"}).write(1, {});
            }),
            folder / "b.csv" + ": a row of 1 numbers for 2 columns");
  put(folder / "c.csv", "step,x\n1,2\n2,two\n");
  EXPECT_EQ(message([&] { read_csv(folder / "c.csv"); }),
            folder / "c.csv" + ": row 3: 'two' in column 'x' is not a number");
  put(folder / "c.csv", "step,x\n1\n");
  EXPECT_EQ(message([&] { read_csv(folder / "c.csv"); }), folder / "c.csv" + ": row 2 has 1 fields, the header has 2");
  put(folder / "c.csv", "step,\"x\n1\n");
  EXPECT_EQ(message([&] { read_csv(folder / "c.csv"); }), folder / "c.csv" + ":1: a quotation has no end");
  put(folder / "c.csv", "step,energy\n1,2\n");
  EXPECT_EQ(message([&] { read_csv(folder / "c.csv").column("enrgy"); }),
            "there is no column 'enrgy'; there are step, energy; did you mean 'energy'?");
}

TEST(Csv, FullDiskIsOneErrorLine) {
  EXPECT_EQ(message([] { CsvFile("/dev/full", {"step"}); }), "/dev/full: can't be written: No space left on device");
}

}  // namespace
}  // namespace boltzmann::csv_test
