// Input files: regular ones only, line by line.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/gzip_stream.hpp>
#include <boltzmann/core/input_file.hpp>

#include <array>
#include <filesystem>
#include <fstream>
#include <istream>
#include <string_view>

namespace boltzmann {
namespace {

/// A stream that owns its buffer, and rethrows exceptions of the buffer.
struct GzipStream final : std::istream {
  explicit GzipStream(std::string const& path) : std::istream(nullptr), buffer(path) {
    rdbuf(&buffer);
    exceptions(std::ios::badbit);
  }
  GzipBuffer buffer;
};

}  // namespace

std::string without_gz(std::string const& path) {
  return path.ends_with(".gz") ? path.substr(0, path.size() - 3) : path;
}

std::unique_ptr<std::istream> open_text(std::string const& path, std::string const& what) {
  need_regular_file(path);
  auto file = std::make_unique<std::ifstream>(path, std::ios::binary);
  if (!*file) throw Error(path + ": can't open the " + what);
  std::array<char, 6> start{};
  file->read(start.data(), start.size());
  std::string_view const begins(start.data(), static_cast<std::size_t>(file->gcount()));
  file->clear();
  file->seekg(0);
  if (begins.starts_with("\x1f\x8b")) return std::make_unique<GzipStream>(path);
  if (path.ends_with(".gz")) throw Error("'" + path + "' ends in .gz, but is not compressed by gzip");
  for (auto const& [magic, name] : {std::pair<std::string_view, char const*>{"BZh", "bzip2"},
                                    {"\xfd"
                                     "7zXZ",
                                     "xz"},
                                    {"\x28\xb5\x2f\xfd", "zstd"},
                                    {"PK\x03\x04", "zip"}})
    if (begins.starts_with(magic))
      throw Error("'" + path + "' is compressed by " + name + "; unpack it, or compress it by gzip");
  return file;
}

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
    line.append(part.data(), ended || goes_on ? got : got - 1);  // includes the end of the line
    if (line.size() > longest) throw Error("'" + path + "' has a line of more than 1 MB: it is no file of text");
    if (ended) return !line.empty();
    if (!goes_on) return true;
    file.clear(file.rdstate() & ~std::ios::failbit);
  }
}

}  // namespace boltzmann
