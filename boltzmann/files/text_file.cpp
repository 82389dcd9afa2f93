// Text files on system calls.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/input_file.hpp>
#include <boltzmann/files/disk_sync.hpp>
#include <boltzmann/files/text_file.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

namespace boltzmann {

std::string reason(int error) { return std::system_category().message(error); }

void append_number(std::string& text, double number) {
  if (std::isnan(number)) {
    text += "nan";
    return;
  }
  std::array<char, 32> digits;
  text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr);
}

void append_number(std::string& text, std::int64_t number) {
  std::array<char, 24> digits;
  text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr);
}

int open_for_writing(std::string const& path, int flags) {
  flags |= O_CREAT | O_CLOEXEC;
  if (!path.ends_with(".part")) return ::open(path.c_str(), flags, 0666);
  ::unlink(path.c_str());
  return ::open(path.c_str(), flags | O_EXCL | O_NOFOLLOW, 0666);
}

TextFile::TextFile(std::string path, Mode mode) : path_(std::move(path)) {
  descriptor_ = open_for_writing(path_, O_WRONLY | (mode == Mode::replace ? O_TRUNC : 0));
  if (descriptor_ < 0) throw Error(path_ + ": can't open it for writing: " + reason(errno));
  struct stat facts {};
  if (mode == Mode::append && fstat(descriptor_, &facts) == 0 && S_ISREG(facts.st_mode))
    size_ = static_cast<std::uint64_t>(facts.st_size);
}

TextFile::~TextFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

TextFile::TextFile(TextFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)), size_(other.size_) {}

TextFile& TextFile::operator=(TextFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(size_, other.size_);
  return *this;
}

void TextFile::write(std::string_view text) {
  std::uint64_t at = size_;
  while (!text.empty()) {
    ssize_t written = pwrite(descriptor_, text.data(), text.size(), static_cast<off_t>(at));
    if (written < 0 && errno == ESPIPE) written = ::write(descriptor_, text.data(), text.size());  // a pipe
    if (written < 0) {
      int const error = errno;
      if (error == EINTR) continue;
      if (at != size_ && ftruncate(descriptor_, static_cast<off_t>(size_)) != 0)
        throw Error(path_ + ": can't be written: " + reason(error) + "; its last line is torn");
      throw Error(path_ + ": can't be written: " + reason(error));
    }
    at += static_cast<std::uint64_t>(written);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  size_ = at;
}

void TextFile::cut(std::uint64_t size) {
  if (ftruncate(descriptor_, static_cast<off_t>(size)) != 0)
    throw Error(path_ + ": can't be shortened: " + reason(errno));
  size_ = size;
}

void TextFile::sync() {
  if (sync_file(descriptor_, true) != 0) throw Error(path_ + ": can't be brought to the disk: " + reason(errno));
}

void TextFile::close() {
  int const descriptor = std::exchange(descriptor_, -1);
  if (descriptor >= 0 && ::close(descriptor) != 0) throw Error(path_ + ": can't be closed: " + reason(errno));
}

std::string read_text(std::string const& path) {
  need_regular_file(path);
  int const descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw Error(path + ": can't open it: " + reason(errno));
  std::string text;
  std::size_t size = 0;
  while (true) {
    text.resize(size + (1U << 16U) + size / 2);
    ssize_t const got = ::read(descriptor, text.data() + size, text.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      int const error = errno;
      ::close(descriptor);
      throw Error(path + ": can't be read: " + reason(error));
    }
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
  }
  ::close(descriptor);
  text.resize(size);
  return text;
}

PartFile::~PartFile() {
  std::error_code ignored;
  if (!finished_) std::filesystem::remove(path_ + ".part", ignored);
}

void PartFile::finish() {
  file_.close();
  std::error_code error;
  std::filesystem::rename(path_ + ".part", path_, error);
  if (error) throw Error(path_ + ": can't be written: " + error.message());
  finished_ = true;
}

void write_whole(std::string const& path, std::string_view text) {
  PartFile file(path);
  file.write(text);
  file.finish();
}

std::vector<std::string> split_words(std::string_view text, char separator) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at <= text.size();) {
    std::size_t const end = std::min(text.find(separator, at), text.size());
    std::string_view word = text.substr(at, end - at);
    while (word.starts_with(' ')) word.remove_prefix(1);
    while (word.ends_with(' ')) word.remove_suffix(1);
    if (!word.empty()) words.emplace_back(word);
    at = end + 1;
  }
  return words;
}

}  // namespace boltzmann
