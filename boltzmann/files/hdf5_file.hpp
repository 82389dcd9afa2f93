// HDF5 files: small owners of files, datasets and attributes. Every failure is one readable Error.
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

/// Prevents HDF5 from closing open objects when the program ends (Files close themselves). After a damaged file it
/// would print errors about objects that it has itself left open. Has no effect once HDF5 has been used.
void leave_without_words();

/// Callbacks for another user of the same HDF5 library in this program, in other threads; HDF5 is not thread-safe. Both
/// are called around each of this module's calls, by the same thread, and may be nested.
struct Neighbour {
  void (*enter)() = nullptr;
  void (*leave)() = nullptr;
};
/// Takes effect immediately. Call it before the first file is opened.
void share_with(Neighbour neighbour);

using Extents = std::vector<std::uint64_t>;

enum class Number { real, integer };  ///< double, or std::int64_t

/// A block of a dataset in another file, and its place in a view. A count of 0 along the first axis includes all rows,
/// even if the dataset grows.
struct Piece {
  std::string dataset;
  Extents extents, start, count;  ///< extents of that dataset; start and count of the block
  Extents at, size;               ///< its place in the view, with as many numbers
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
  /// Writes or reads the block of `count` numbers per axis that begins at `start`. An empty block is a no-op.
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
/// file and the reason. Not thread-safe.
class File {
 public:
  /// Creates an empty file and replaces one of that name. The first `user_block` bytes (0 or a power of two from 512
  /// on) are reserved for the caller. `ordered` permits a later call of start_ordered_writes.
  static std::unique_ptr<File> create(std::string path, bool ordered = false, std::uint64_t user_block = 0);
  /// The same with HDF5's own driver, for views: the files that they refer to are opened with the same driver.
  static std::unique_ptr<File> create_plain(std::string path);
  /// Opens an existing file for reading. Another process may be writing it, or may have been killed while writing it.
  static std::unique_ptr<File> open(std::string path);
  /// Opens an existing file for changes.
  static std::unique_ptr<File> open_for_writing(std::string path);

  ~File();
  File(File const&) = delete;
  File& operator=(File const&) = delete;

  std::string const& path() const { return path_; }

  /// From now on HDF5 orders its writes such that the file can be read at any moment (its "single writer, multiple
  /// readers" mode). Groups, datasets and attributes can no longer be created.
  void start_ordered_writes();

  /// Between hold and release the file is not changed. Release writes all changes at once (within microseconds). For
  /// changes to an existing file before the ordered writes start.
  void hold();
  void release();

  /// Hands everything written so far to the operating system. Throws if that, or any write since the last flush, has
  /// failed. Data up to the last successful flush remain readable.
  void flush();
  /// Syncs flushed data to the disk, so that they survive a loss of power.
  void sync();
  /// From now on a log records changes, so that the current contents can be restored. The file must have been flushed.
  void keep_in(std::string log, UndoLog::Label const& label);
  /// Calls UndoLog::take_back for a closed file. Throws Error if another run is writing it.
  static bool take_back(std::string const& path, std::string const& log, UndoLog::Label const& label,
                        std::function<bool()> const& right);
  /// Flushes and closes, and reports failures, which the destructor can't.
  void close();

  bool has(std::string const& object) const;
  bool is_dataset(std::string const& object) const;
  std::vector<std::string> children(std::string const& group) const;

  void create_group(std::string const& group);
  /// Adds a second name of the same object.
  void link(std::string const& object, std::string const& new_name);

  Dataset create(std::string const& dataset, Number, Extents const& extents);
  /// Creates a chunked dataset with growing axes, the first one from 0. An axis with 0 in `growing` keeps its extent.
  Dataset create_growing(std::string const& dataset, Number, Extents const& extents, Extents const& chunk,
                         std::vector<bool> const& growing);
  /// Creates a view of pieces of datasets of another file in the same folder. If these grow along their first axis, so
  /// does the view, and missing values are NaN; otherwise missing values are 0.
  void create_view(std::string const& dataset, Number, Extents const& extents, std::string const& file,
                   std::vector<Piece> const& pieces);
  /// Creates a dataset that repeats one number and takes no space.
  void create_same(std::string const& dataset, std::uint64_t count, double number);
  Dataset dataset(std::string const& path) const;

  void write_text(std::string const& dataset, std::string const& text);
  std::string read_text(std::string const& dataset) const;

  /// Sets a text of variable length, which all programs read. HDF5 stores it in a part of the file without a checksum.
  void set(std::string const& object, std::string const& attribute, std::string const& text);
  /// Sets a text of fixed length for internal use. HDF5 stores it in an object header, which has a checksum.
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
  std::unique_ptr<Disk> disk_;  // declared first: the identifier writes through it
  std::int64_t id_ = -1;
};

}  // namespace boltzmann::hdf5
