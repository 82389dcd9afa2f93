// Text files that grow: a write is whole or taken back, and doubles are written so that they read back as the same
// bits.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// What errno says, as words: "No space left on device".
std::string reason(int error);

/// Appends the shortest decimal text that reads back as the same double ("nan" and "inf" for those).
void append_number(std::string& text, double number);
void append_number(std::string& text, std::int64_t number);

/// Opens a file for writing, with further flags of open(2); negative, with errno, if it can't be. A name that ends in
/// ".part" stands for a moment until it is renamed: such a file is made anew, so that no link leads elsewhere.
int open_for_writing(std::string const& path, int flags);

/// A file of text that is written at its end. Every write goes to the system at once, so that a killed run loses
/// nothing; a write that fails (disk full) is taken back as far as the system allows. Failures throw Error with path
/// and reason.
class TextFile {
 public:
  enum class Mode { replace, append };

  TextFile(std::string path, Mode mode);
  ~TextFile();
  TextFile(TextFile&&) noexcept;
  TextFile& operator=(TextFile&&) noexcept;

  std::string const& path() const { return path_; }
  void write(std::string_view text);
  /// Cuts the file to its first `size` bytes; the next write follows there.
  void cut(std::uint64_t size);
  /// Brings all that was written to the disk, so that a machine without power loses none of it.
  void sync();
  /// Closes the file. The destructor closes as well, but can't tell of a failure.
  void close();

 private:
  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// The whole content of a file; Error if it can't be read.
std::string read_text(std::string const& path);

/// A new file that is there whole or not at all: path + ".part", which gets its name when it is finished, and goes if
/// it is not.
class PartFile {
 public:
  explicit PartFile(std::string path) : path_(std::move(path)), file_(path_ + ".part", TextFile::Mode::replace) {}
  ~PartFile();
  PartFile(PartFile const&) = delete;
  PartFile& operator=(PartFile const&) = delete;

  void write(std::string_view text) { file_.write(text); }
  /// Error if it can't be written.
  void finish();

 private:
  std::string path_;
  TextFile file_;
  bool finished_ = false;
};

/// The same of one text.
void write_whole(std::string const& path, std::string_view text);

/// The words between separators, without blanks around them; empty ones are left out.
std::vector<std::string> split_words(std::string_view text, char separator);

}  // namespace boltzmann
