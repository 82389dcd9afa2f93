// CSV: tables of numbers that grow by a row per step, readable by spreadsheets and plotting programs (RFC 4180, with "
// " line ends).
#pragma once

#include <boltzmann/files/text_file.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// A field of a row, quoted if necessary.
std::string csv_word(std::string const& word);

/// A table whose first column is the step. Every row has been handed to the operating system when `write` returns.
class CsvFile {
 public:
  /// Creates a file with a header row, for example {"step", "time (ps)", "kinetic energy (eV)"}. It replaces a file of
  /// that name.
  CsvFile(std::string path, std::vector<std::string> const& header);

  /// Continues a file. Rows from the first one with a step after `last_step` are cut off, and so is an incomplete last
  /// row (of a killed run). Throws Error if the file is missing or has another header, or if `checksum` is given and
  /// differs from that of the rows to keep; the file is then unchanged.
  static CsvFile append_to(std::string path, std::vector<std::string> const& header, std::int64_t last_step,
                           std::optional<std::uint64_t> checksum = std::nullopt);

  std::string const& path() const { return file_.path(); }
  void sync() { file_.sync(); }
  /// The crc64 of the whole file.
  std::uint64_t checksum() const { return checksum_; }

  /// Writes a row: the step, and a number for each other column, in the shortest form that reads back as the same
  /// double. Throws Error if their number is wrong or the file can't be written (an incomplete row is removed).
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
  std::vector<std::vector<double>> columns;  ///< one per word of the header, all of the same length

  /// The column of that name. Throws Error that names the most similar column if there is none.
  std::vector<double> const& column(std::string_view name) const;
};

/// Writes a whole table: columns of the same length, one per word of the header. It replaces a file of that name.
/// Throws Error if the file can't be written.
void write_csv(std::string const& path, CsvTable const& table);

/// Reads a table of numbers. Empty fields are NaN. Throws Error with the line number for a row of another length or a
/// field that is not a number.
CsvTable read_csv(std::string const& path);

}  // namespace boltzmann
