// Text files that grow. A write is complete or undone, and doubles are written such that they read back as the same
// bits.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// The message for an errno: "No space left on device".
std::string reason(int error);

/// Appends the shortest decimal text that reads back as the same double ("nan" and "inf" for those).
void append_number(std::string& text, double number);
void append_number(std::string& text, std::int64_t number);

/// Opens a file for writing, with further flags of open(2). Returns a negative number, with errno, on failure. A name
/// that ends in ".part" is temporary until the file is renamed; such a file is created anew, so that a link can't
/// redirect it.
int open_for_writing(std::string const& path, int flags);

/// A text file that is written at its end. Every write goes to the operating system at once, so that a killed run loses
/// nothing. A failed write (disk full) is undone as far as the system allows. Failures throw Error with path and
/// reason.
class TextFile {
 public:
  enum class Mode { replace, append };

  TextFile(std::string path, Mode mode);
  ~TextFile();
  TextFile(TextFile&&) noexcept;
  TextFile& operator=(TextFile&&) noexcept;

  std::string const& path() const { return path_; }
  void write(std::string_view text);
  /// Truncates the file to its first `size` bytes; the next write follows there.
  void cut(std::uint64_t size);
  /// Syncs all written data to the disk, so that they survive a loss of power.
  void sync();
  /// Closes the file. The destructor closes it too, but can't report a failure.
  void close();

 private:
  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// Returns the whole contents of a file. Throws Error if it can't be read.
std::string read_text(std::string const& path);

/// A new file that appears only when it is complete: it is written to path + ".part" and renamed by finish(), or else
/// removed.
class PartFile {
 public:
  explicit PartFile(std::string path) : path_(std::move(path)), file_(path_ + ".part", TextFile::Mode::replace) {}
  ~PartFile();
  PartFile(PartFile const&) = delete;
  PartFile& operator=(PartFile const&) = delete;

  void write(std::string_view text) { file_.write(text); }
  /// Renames the file. Throws Error if it can't be written.
  void finish();

 private:
  std::string path_;
  TextFile file_;
  bool finished_ = false;
};

/// Writes a file with this text in the same way.
void write_whole(std::string const& path, std::string_view text);

/// The words between separators, without surrounding blanks. Empty words are omitted.
std::vector<std::string> split_words(std::string_view text, char separator);

}  // namespace boltzmann
