// Undo log: the previous contents of overwritten parts of a file, so that the file can be restored byte for byte (a
// rollback journal in the terms of databases).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace boltzmann {

/// The log of one file, beside it. A record is written before its bytes are overwritten in the file, so a process that
/// is killed at any moment leaves a consistent log. A loss of power may lose either of them; then only a log that was
/// closed is used. If the log can't be written, it is removed and the file can't be restored.
class UndoLog {
 public:
  /// Identifies the state of the file when its log began.
  using Label = std::array<std::uint64_t, 2>;

  /// Starts a log of a file of this size; the current contents can be restored later. Replaces an earlier log.
  UndoLog(std::string path, std::uint64_t size, Label const& label);
  ~UndoLog();
  UndoLog(UndoLog const&) = delete;
  UndoLog& operator=(UndoLog const&) = delete;

  /// Records these bytes of the file before they are overwritten or cut off.
  void keep(int file, std::uint64_t address, std::uint64_t count);
  /// Call it when the file has been closed: syncs the log to the disk, so that it can be used even after a loss of
  /// power.
  void close();

  /// Restores the contents of the file when the log of this label began, if `right` confirms them. `right` is called
  /// before the file is truncated to its old length; otherwise the file is unchanged. Returns true if the contents were
  /// restored.
  static bool take_back(std::string const& path, int file, Label const& label, std::function<bool()> const& right);

 private:
  struct Head {                                           // numbers in native byte order
    std::uint64_t signature = 0x31'6f'64'6e'75'20'7a'62;  // "bz undo1"
    std::uint64_t size = 0;                               // of the file
    Label label{};
    std::uint64_t records = 0, closed = 0;
    std::array<char, 36> boot{};
    std::uint32_t unused = 0;
    std::uint64_t checksum = 0;  // of the preceding members

    std::uint64_t sum() const;
  };

  void write_head();
  void write(std::uint64_t at, void const* bytes, std::size_t count);

  std::string path_;
  int descriptor_ = -1;
  Head head_;
  std::uint64_t used_ = sizeof(Head);  // size of the log
  std::vector<bool> kept_;             // by page
};

}  // namespace boltzmann
