// Undo log: what stood where a file is written over, so that the file can be made what it was, byte for byte (databases
// call it a rollback journal).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace boltzmann {

/// A log of one file, beside it. A record stands in the log before its bytes go from the file, so a process that is
/// killed at any moment leaves a log that fits. A machine without power may lose the one and not the other: then only a
/// log that was closed is used. Where the log can't be written it goes, and nothing is kept: the file can't be taken back.
class UndoLog {
 public:
  /// Tells what a file was when its log began.
  using Label = std::array<std::uint64_t, 2>;

  /// From here on the file, of so many bytes, can be made what it is now. A log of before is replaced.
  UndoLog(std::string path, std::uint64_t size, Label const& label);
  ~UndoLog();
  UndoLog(UndoLog const&) = delete;
  UndoLog& operator=(UndoLog const&) = delete;

  /// Keeps what stands in these bytes of the file, before they are written over or cut off.
  void keep(int file, std::uint64_t address, std::uint64_t count);
  /// The file has been closed: brings the log to the disk, where it can be used after a loss of power, too.
  void close();

  /// Makes the file what it was when the log of this label began, if `right` says that it is that, having been asked
  /// before the file is cut to its length of then; else the file stays what it is. Whether it was done.
  static bool take_back(std::string const& path, int file, Label const& label, std::function<bool()> const& right);

 private:
  struct Head {                                           // numbers as the machine has them
    std::uint64_t signature = 0x31'6f'64'6e'75'20'7a'62;  // "bz undo1"
    std::uint64_t size = 0;                               // of the file
    Label label{};
    std::uint64_t records = 0, closed = 0;
    std::array<char, 36> boot{};
    std::uint32_t unused = 0;
    std::uint64_t checksum = 0;  // of what stands before it

    std::uint64_t sum() const;
  };

  void write_head();
  void write(std::uint64_t at, void const* bytes, std::size_t count);

  std::string path_;
  int descriptor_ = -1;
  Head head_;
  std::uint64_t used_ = sizeof(Head);  // of the log
  std::vector<bool> kept_;             // pages
};

}  // namespace boltzmann
