#include <boltzmann/core/error.hpp>
#include <boltzmann/core/input_file.hpp>

#include <filesystem>
#include <istream>

namespace boltzmann {

void need_regular_file(std::string const& path) {
  std::error_code failure;
  auto const status = std::filesystem::status(path, failure);
  if (std::filesystem::is_directory(status)) throw Error("'" + path + "' is a directory, not a file");
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw Error("'" + path + "' is a device or a pipe, not a file");
}

bool read_line(std::istream& file, std::string& line, std::string const& path) {
  constexpr std::size_t longest = 1'000'000;
  using Traits = std::istream::traits_type;
  line.clear();
  while (true) {
    auto const next = file.rdbuf()->sbumpc();
    if (Traits::eq_int_type(next, Traits::eof())) return !line.empty();
    char const letter = Traits::to_char_type(next);
    if (letter == '\n') return true;
    if (line.size() == longest) throw Error("'" + path + "' has a line of more than 1 MB: it is no file of text");
    line.push_back(letter);
  }
}

}  // namespace boltzmann
