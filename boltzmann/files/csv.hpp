// CSV: tables of numbers that grow by a row per step, for every spreadsheet and plotting program (RFC 4180, with "\n"
// line ends).
#pragma once

#include <boltzmann/files/text_file.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// A word of a row: in quotation marks where it needs them.
std::string csv_word(std::string const& word);

/// A table whose first column is the step. Every row is with the system when `write` returns.
class CsvFile {
 public:
  /// A new file with a header row, for example {"step", "time (ps)", "kinetic energy (eV)"}; one of that name is
  /// replaced.
  CsvFile(std::string path, std::vector<std::string> const& header);

  /// Goes on with a file: the rows from the first one with a step after `last_step` on, and a last row without an end
  /// (of a killed run), are cut off. Error if the file is missing or has another header, or, where `checksum` is given,
  /// if what it keeps is not what had this checksum(); it is then as it was.
  static CsvFile append_to(std::string path, std::vector<std::string> const& header, std::int64_t last_step,
                           std::optional<std::uint64_t> checksum = std::nullopt);

  std::string const& path() const { return file_.path(); }
  void sync() { file_.sync(); }
  /// crc64 of the whole file.
  std::uint64_t checksum() const { return checksum_; }

  /// One row: the step, and one number for each other column, in the shortest form that reads back as the same double.
  /// Error if their number is wrong or the file can't be written (a torn row is taken back).
  void write(std::int64_t step, std::span<double const> values);

 private:
  CsvFile(TextFile file, std::size_t columns, std::uint64_t checksum)
      : file_(std::move(file)), columns_(columns), checksum_(checksum) {}
  void append(std::string const& row);

  TextFile file_;
  std::size_t columns_;
  std::uint64_t checksum_ = 0;
};

struct CsvTable {
  std::vector<std::string> header;
  std::vector<std::vector<double>> columns;  ///< as many as words in the header, all of the same length

  /// The column of that name; Error, naming the nearest, if there is none.
  std::vector<double> const& column(std::string_view name) const;
};

/// Writes a whole table, columns of the same length with as many words in the header; a file of that name is replaced.
/// Error if it can't be written.
void write_csv(std::string const& path, CsvTable const& table);

/// Reads a table of numbers. Empty fields are NaN. Error, with the line, for a row of another length or a field that is
/// no number.
CsvTable read_csv(std::string const& path);

}  // namespace boltzmann
