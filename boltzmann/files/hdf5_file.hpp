// HDF5 files: a small owner of files, datasets and attributes in which every failure is one readable Error.
#pragma once

#include <boltzmann/files/undo_log.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace boltzmann::hdf5 {

struct Disk;
class File;

/// Keeps HDF5 from closing at the end of the program what is still open (nothing is: Files close themselves). After a
/// damaged file it would complain there of what it has left open itself. Without effect once HDF5 has been used.
void leave_without_words();

/// Somebody else who uses the same HDF5 in this program, from other threads: HDF5 itself knows nothing of threads. Each
/// is called around all that we ask of it, by the same thread, and nested at times.
struct Neighbour {
  void (*enter)() = nullptr;
  void (*leave)() = nullptr;
};
/// From now on, and before the first file is opened.
void share_with(Neighbour neighbour);

using Extents = std::vector<std::uint64_t>;

enum class Number { real, integer };  ///< double, or std::int64_t

/// A block of a dataset in another file, and where it is seen in a view. A count of 0 along the first axis: all that there
/// is, however far it grows.
struct Piece {
  std::string dataset;
  Extents extents, start, count;  ///< of that dataset, and of the block
  Extents at, size;               ///< where the view has it: as many numbers
};

/// An open dataset. Valid as long as its File.
class Dataset {
 public:
  Dataset() = default;
  ~Dataset();
  Dataset(Dataset&&) noexcept;
  Dataset& operator=(Dataset&&) noexcept;

  Extents extents() const;
  /// Changes the extents of a dataset made by create_growing.
  void resize(Extents const& extents);
  /// Writes or reads the block of `count` numbers per axis that begins at `start`. Nothing happens if the block is
  /// empty.
  void write(double const* values, Extents const& start, Extents const& count);
  void write(std::int64_t const* values, Extents const& start, Extents const& count);
  void read(double* values, Extents const& start, Extents const& count) const;
  void read(std::int64_t* values, Extents const& start, Extents const& count) const;
  /// All numbers, in C order.
  std::vector<double> reals() const;
  std::vector<std::int64_t> integers() const;

 private:
  friend class File;
  template <class Call, class Number>
  void transfer(Call call, Number* values, Extents const& start, Extents const& count, char const* what) const;

  File const* file_ = nullptr;
  std::int64_t id_ = -1;
  std::string path_;
};

/// An HDF5 file. All paths inside are absolute ("/particles/ions"). Every function throws Error with the name of the
/// file and the reason. Not for use by several threads at a time.
class File {
 public:
  /// A new, empty file that replaces one of that name. `user_block` bytes (0 or a power of two from 512 on) before
  /// HDF5's own first byte are the caller's. `ordered` makes the file one that start_ordered_writes can be called for.
  static std::unique_ptr<File> create(std::string path, bool ordered = false, std::uint64_t user_block = 0);
  /// The same by HDF5's own ways, for views: what they look at is opened as they are.
  static std::unique_ptr<File> create_plain(std::string path);
  /// An existing file, for reading: also one that another process is writing, or was writing when it was killed.
  static std::unique_ptr<File> open(std::string path);
  /// An existing file, for changing it.
  static std::unique_ptr<File> open_for_writing(std::string path);

  ~File();
  File(File const&) = delete;
  File& operator=(File const&) = delete;

  std::string const& path() const { return path_; }

  /// From here on HDF5 writes in such an order that the file can be read at any moment (its "single writer, multiple
  /// readers" mode). Groups, datasets and attributes can no longer be made.
  void start_ordered_writes();

  /// From hold to release the file stays as it is; release writes all changes in one go (a flush that takes
  /// microseconds). For changes to an existing file before the ordered writes start.
  void hold();
  void release();

  /// Hands everything written so far to the system. Throws if that, or any write since the last flush, has failed; what
  /// the last good flush wrote can still be read.
  void flush();
  /// Brings what has been flushed to the disk, so that a machine without power loses none of it.
  void sync();
  /// From here on a log keeps what the file, which has been flushed, is now.
  void keep_in(std::string log, UndoLog::Label const& label);
  /// UndoLog::take_back, of a file that is closed. Error if another run is writing it.
  static bool take_back(std::string const& path, std::string const& log, UndoLog::Label const& label,
                        std::function<bool()> const& right);
  /// Flushes and closes, and tells of failures, which the destructor can't.
  void close();

  bool has(std::string const& object) const;
  bool is_dataset(std::string const& object) const;
  std::vector<std::string> children(std::string const& group) const;

  void create_group(std::string const& group);
  /// A second name for the same object.
  void link(std::string const& object, std::string const& new_name);

  Dataset create(std::string const& dataset, Number, Extents const& extents);
  /// A dataset stored in chunks whose axes can grow, the first one from 0; an axis with 0 in `growing` keeps its
  /// extent.
  Dataset create_growing(std::string const& dataset, Number, Extents const& extents, Extents const& chunk,
                         std::vector<bool> const& growing);
  /// Shows pieces of datasets of another file, which is looked for in the folder of this one. Where they grow along their
  /// first axis, it does, and what is nowhere is NaN; else it is 0.
  void create_view(std::string const& dataset, Number, Extents const& extents, std::string const& file,
                   std::vector<Piece> const& pieces);
  /// A dataset of one number, again and again, that takes no space.
  void create_same(std::string const& dataset, std::uint64_t count, double number);
  Dataset dataset(std::string const& path) const;

  void write_text(std::string const& dataset, std::string const& text);
  std::string read_text(std::string const& dataset) const;

  /// A text of variable length, which all programs read, in a part of the file that has no checksum.
  void set(std::string const& object, std::string const& attribute, std::string const& text);
  /// A text of fixed length, for us: it stands in a header, which has one.
  void set_fixed(std::string const& object, std::string const& attribute, std::string const& text);
  void set(std::string const& object, std::string const& attribute, std::vector<std::string> const& texts);
  void set(std::string const& object, std::string const& attribute, double value);
  void set(std::string const& object, std::string const& attribute, std::vector<std::int64_t> const& values);
  void set(std::string const& object, std::string const& attribute, std::int64_t value);
  bool has(std::string const& object, std::string const& attribute) const;
  std::string text(std::string const& object, std::string const& attribute) const;
  std::vector<std::string> texts(std::string const& object, std::string const& attribute) const;
  double real(std::string const& object, std::string const& attribute) const;
  std::int64_t integer(std::string const& object, std::string const& attribute) const;
  std::vector<std::int64_t> integers(std::string const& object, std::string const& attribute) const;

 private:
  friend class Dataset;
  explicit File(std::string path);
  [[noreturn]] void fail(std::string const& what) const;
  void set_values(std::string const& object, std::string const& attribute, std::int64_t type, Extents const& extents,
                  void const* values);
  void get_values(std::string const& object, std::string const& attribute, std::int64_t type, std::size_t count,
                  void* values) const;

  std::string path_;
  std::unique_ptr<Disk> disk_;  // outlives the identifier, which writes through it
  std::int64_t id_ = -1;
};

}  // namespace boltzmann::hdf5
