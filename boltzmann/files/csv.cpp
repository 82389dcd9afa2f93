// Writing and reading CSV.
#include <fmt/format.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/checksum.hpp>
#include <boltzmann/files/csv.hpp>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace boltzmann {

std::string csv_word(std::string const& word) {
  if (word.find_first_of(",\"\r\n") == std::string::npos) return word;
  std::string text = "\"";
  for (char const c : word) {
    if (c == '"') text += '"';
    text += c;
  }
  return text + '"';
}

namespace {

std::string header_row(std::vector<std::string> const& header) {
  std::string row;
  for (std::size_t k = 0; k < header.size(); ++k) row += (k > 0 ? "," : "") + csv_word(header[k]);
  return row + '\n';
}

// Reads a row that begins at `at` and moves `at` to the next one. If the text ends within a quotation, returns nothing
// and leaves `at` unchanged.
std::optional<std::vector<std::string>> next_row(std::string_view text, std::size_t& at) {
  std::vector<std::string> words(1);
  bool inside = false;
  std::size_t k = at;
  for (; k < text.size(); ++k) {
    char const c = text[k];
    if (inside) {
      if (c != '"')
        words.back() += c;
      else if (k + 1 < text.size() && text[k + 1] == '"')
        words.back() += text[++k];
      else
        inside = false;
    } else if (c == '"' && words.back().empty()) {
      inside = true;
    } else if (c == ',') {
      words.emplace_back();
    } else if (c == '\n') {
      break;
    } else if (c != '\r' || (k + 1 < text.size() && text[k + 1] != '\n')) {
      words.back() += c;
    }
  }
  if (inside) return std::nullopt;
  at = k < text.size() ? k + 1 : k;
  return words;
}

/// Appends a cell; it is empty for NaN, a number that does not exist.
void append_cell(std::string& row, double value) {
  if (!std::isnan(value)) append_number(row, value);
}

std::optional<double> number(std::string_view word) {
  while (!word.empty() && word.front() == ' ') word.remove_prefix(1);
  while (!word.empty() && word.back() == ' ') word.remove_suffix(1);
  if (word.empty()) return std::numeric_limits<double>::quiet_NaN();
  if (word.front() == '+') word.remove_prefix(1);
  double value = 0;
  auto const [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace

CsvFile::CsvFile(std::string path, std::vector<std::string> const& header)
    : file_(std::move(path), TextFile::Mode::replace), columns_(header.size()) {
  if (header.empty()) throw Error(file_.path() + ": a table needs a column for the step");
  append(header_row(header));
}

void CsvFile::append(std::string const& row) {
  file_.write(row);
  checksum_ = crc64(row.data(), row.size(), checksum_);
}

CsvFile CsvFile::append_to(std::string path, std::vector<std::string> const& header, std::int64_t last_step,
                           std::optional<std::uint64_t> checksum) {
  std::string const text = read_text(path);
  std::size_t at = 0;
  auto const found = next_row(text, at);
  if (!found || *found != header)
    throw Error(
        fmt::format("{}: its columns are {}, not {}", path, found ? quoted(join(*found)) : "unreadable", join(header)));
  if (at == 0 || text[at - 1] != '\n') throw Error(path + ": its header row has no end");
  while (at < text.size()) {
    std::size_t after = at;
    auto const row = next_row(text, after);
    if (!row || text[after - 1] != '\n' || row->size() != header.size()) break;
    auto const step = number((*row)[0]);
    if (!step || !(*step <= static_cast<double>(last_step))) break;
    at = after;
  }
  std::uint64_t const found_checksum = crc64(text.data(), at);
  if (checksum && *checksum != found_checksum)
    throw Error(
        fmt::format("{}: its rows up to step {} are not those that this run has written (edited, or of another "
                    "run)",
                    path, last_step));
  TextFile file(std::move(path), TextFile::Mode::append);
  file.cut(at);
  return {std::move(file), header.size(), found_checksum};
}

void CsvFile::write(std::int64_t step, std::span<double const> values) {
  if (values.size() + 1 != columns_)
    throw Error(fmt::format("{}: a row of {} numbers for {} columns", file_.path(), values.size() + 1, columns_));
  std::string row;
  append_number(row, step);
  for (double const value : values) {
    row += ',';
    append_cell(row, value);
  }
  row += '\n';
  append(row);
}

std::vector<double> const& CsvTable::column(std::string_view name) const {
  for (std::size_t k = 0; k < header.size(); ++k)
    if (header[k] == name) return columns[k];
  throw Error(fmt::format("there is no column '{}'{}", name, choices(name, header)));
}

void write_csv(std::string const& path, CsvTable const& table) {
  std::string text = header_row(table.header);
  std::size_t const rows = table.columns.empty() ? 0 : table.columns[0].size();
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      if (table.columns.size() > 1)
        append_cell(text, table.columns[c][r]);
      else
        append_number(text, table.columns[c][r]);  // otherwise the row would be an empty line, which readers skip
      text += c + 1 < table.columns.size() ? ',' : '\n';
    }
  write_whole(path, text);
}

CsvTable read_csv(std::string const& path) {
  std::string const text = read_text(path);
  std::size_t at = 0;
  if (text.empty()) throw Error(path + ": is empty");
  auto header = next_row(text, at);
  if (!header) throw Error(path + ":1: a quotation has no end");
  CsvTable table{std::move(*header), {}};
  table.columns.resize(table.header.size());
  for (std::size_t line = 2; at < text.size(); ++line) {
    auto const row = next_row(text, at);
    if (!row) throw Error(fmt::format("{}: row {}: a quotation has no end", path, line));
    if (row->size() == 1 && (*row)[0].empty() && at == text.size()) break;
    if (row->size() != table.header.size())
      throw Error(
          fmt::format("{}: row {} has {} fields, the header has {}", path, line, row->size(), table.header.size()));
    for (std::size_t k = 0; k < row->size(); ++k) {
      auto const value = number((*row)[k]);
      if (!value)
        throw Error(fmt::format("{}: row {}: '{}' in column '{}' is not a number", path, line, quoted((*row)[k]),
                                quoted(table.header[k])));
      table.columns[k].push_back(*value);
    }
  }
  return table;
}

}  // namespace boltzmann
