// Files that are named: regular ones only, line by line.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/input_file.hpp>

#include <array>
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
  std::array<char, 4096> part;
  line.clear();
  while (true) {
    file.getline(part.data(), part.size());
    auto const got = static_cast<std::size_t>(file.gcount());
    if (file.bad()) throw Error("'" + path + "' can't be read");
    bool const ended = file.eof(), goes_on = file.fail() && got == part.size() - 1;
    line.append(part.data(), ended || goes_on ? got : got - 1);  // the end of the line is among them
    if (line.size() > longest) throw Error("'" + path + "' has a line of more than 1 MB: it is no file of text");
    if (ended) return !line.empty();
    if (!goes_on) return true;
    file.clear(file.rdstate() & ~std::ios::failbit);
  }
}

}  // namespace boltzmann
