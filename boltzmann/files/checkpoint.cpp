// Checkpoints in HDF5.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/input_file.hpp>
#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/files/checksum.hpp>
#include <boltzmann/files/disk_sync.hpp>
#include <boltzmann/files/hdf5_file.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace boltzmann {
namespace {

using hdf5::File;
using hdf5::Number;

constexpr std::size_t label_size = 512;
constexpr char const* label_start = "Boltzmann checkpoint\nformat ";
constexpr std::string_view hdf5_start("\x89HDF\r\n\x1a\n", 8);

class Descriptor {
 public:
  Descriptor(std::string path, int flags) : path_(std::move(path)), id_(::open(path_.c_str(), flags | O_CLOEXEC)) {
    if (id_ < 0) throw Error(fmt::format("{}: can't open it: {}", path_, reason(errno)));
  }
  ~Descriptor() { ::close(id_); }
  Descriptor(Descriptor const&) = delete;
  Descriptor& operator=(Descriptor const&) = delete;

  std::uint64_t size() const {
    struct stat facts {};
    if (fstat(id_, &facts) != 0) throw Error(fmt::format("{}: {}", path_, reason(errno)));
    return static_cast<std::uint64_t>(facts.st_size);
  }

  std::string read(std::uint64_t address, std::size_t size) const {
    std::string bytes(size, '\0');
    std::size_t done = 0;
    while (done < size) {
      ssize_t const got = pread(id_, bytes.data() + done, size - done, static_cast<off_t>(address + done));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) throw Error(fmt::format("{}: can't be read: {}", path_, reason(errno)));
      if (got == 0) break;
      done += static_cast<std::size_t>(got);
    }
    bytes.resize(done);
    return bytes;
  }

  void write(std::uint64_t address, std::string_view bytes) const {
    ssize_t const done = pwrite(id_, bytes.data(), bytes.size(), static_cast<off_t>(address));
    if (done != static_cast<ssize_t>(bytes.size()))
      throw Error(fmt::format("{}: can't be written: {}", path_, reason(done < 0 ? errno : ENOSPC)));
  }

  void sync() const {
    if (sync_file(id_, false) != 0)
      throw Error(fmt::format("{}: can't be brought to the disk: {}", path_, reason(errno)));
  }

  std::uint64_t checksum(std::uint64_t from) const {
    std::uint64_t sum = 0;
    while (true) {
      std::string const bytes = read(from, 1U << 20U);
      if (bytes.empty()) return sum;
      sum = crc64(bytes.data(), bytes.size(), sum);
      from += bytes.size();
    }
  }

 private:
  std::string path_;
  int id_;
};

std::string label(int format, std::uint64_t size, std::uint64_t checksum) {
  std::string text = fmt::format("{}{}\nbytes {}\ncrc64 {:016x}\n", label_start, format, size, checksum);
  text.resize(label_size, '\0');
  return text;
}

void write_contents(File& file, Checkpoint const& checkpoint) {
  file.set("/", "format", static_cast<std::int64_t>(Checkpoint::format));
  file.set("/", "step", checkpoint.step);
  file.set("/", "time", checkpoint.time);
  file.set("/", "step_size", checkpoint.step_size);
  file.set("/", "seed", std::bit_cast<std::int64_t>(checkpoint.seed));
  file.write_text("/program_version", checkpoint.program_version);
  file.write_text("/scenario", checkpoint.scenario);
  file.create_group("/ensembles");
  for (std::size_t k = 0; k < checkpoint.ensembles.size(); ++k) {
    auto const& ensemble = checkpoint.ensembles[k];
    if (ensemble.rows.size() != ensemble.size * ensemble.stride)
      throw Error(fmt::format("{}: ensemble '{}' has {} doubles for {} rows of {}", file.path(), ensemble.name,
                              ensemble.rows.size(), ensemble.size, ensemble.stride));
    std::string const dataset = fmt::format("/ensembles/{:06}", k);
    file.create(dataset, Number::real, {ensemble.size, ensemble.stride})
        .write(ensemble.rows.data(), {0, 0}, {ensemble.size, ensemble.stride});
    file.set_fixed(dataset, "name", ensemble.name);
    file.set_fixed(dataset, "class", ensemble.class_name);
  }
  file.create_group("/state");
  std::size_t k = 0;
  for (auto const& [name, values] : checkpoint.state) {
    std::string const dataset = fmt::format("/state/{:06}", k++);
    file.create(dataset, Number::real, {values.size()}).write(values.data(), {0}, {values.size()});
    file.set_fixed(dataset, "name", name);
  }
  file.close();
}

// Checks the label and the checksum before HDF5 reads the file.
void check_label(std::string const& path) {
  need_regular_file(path);
  Descriptor const file(path, O_RDONLY);
  std::uint64_t const size = file.size();
  std::string const head = file.read(0, label_size);
  std::string_view const start = label_start;
  if (!head.starts_with(start.substr(0, head.size())) || head.empty()) {
    if (head.starts_with(hdf5_start)) throw Error(path + ": is an HDF5 file but not a checkpoint");
    throw Error(path + (head.empty() ? ": is empty" : ": is not a checkpoint"));
  }
  int format = 0;
  unsigned long long bytes = 0, sum = 0;
  char const* after = head.size() > start.size() ? head.c_str() + start.size() : "";
  int const found = std::sscanf(after, "%9d\nbytes %20llu\ncrc64 %16llx", &format, &bytes, &sum);
  if (found >= 1 && format != Checkpoint::format && head.size() == label_size)
    throw Error(fmt::format("{}: has format {}, this program reads {}", path, format, Checkpoint::format));
  if (head.size() < label_size || (found == 3 && size < bytes))
    throw Error(found == 3 ? fmt::format("{}: is truncated: {} of {} bytes", path, size, bytes)
                           : fmt::format("{}: is truncated after {} bytes", path, size));
  if (found != 3 || size != bytes || head != label(format, bytes, sum) || file.checksum(label_size) != sum)
    throw Error(path + ": is damaged (its checksum is wrong)");
}

/// Advice after an unreadable checkpoint; empty if the previous one can't be read either.
std::string previous_left(std::string const& path) {
  std::string const previous = path + ".previous";
  try {
    check_label(previous);
  } catch (Error const&) {
    return "";
  }
  return fmt::format("; the one before it is whole: cp '{}' '{}' goes back to it", previous, path);
}

void keep(std::string const& path, std::string const& previous) {
  ::unlink(previous.c_str());
  // Make a second link first, so that `path` exists all the time. On a file system without links it is missing for a
  // moment.
  if (::link(path.c_str(), previous.c_str()) != 0 && errno != ENOENT) std::rename(path.c_str(), previous.c_str());
}

}  // namespace

Checkpoint::Rows copy_rows(AnyEnsemble const& ensemble) {
  Checkpoint::Rows rows{ensemble.name(), ensemble.class_name(), ensemble.size(), ensemble.stride(), {}};
  if (ensemble.size() > 0) rows.rows.assign(ensemble.row(0), ensemble.row(0) + ensemble.size() * ensemble.stride());
  return rows;
}

void restore_rows(Checkpoint::Rows const& rows, AnyEnsemble& ensemble) {
  if (rows.name != ensemble.name() || rows.class_name != ensemble.class_name() || rows.stride != ensemble.stride())
    throw Error(fmt::format(
        "the checkpoint has an ensemble '{}' of class {} with {} doubles a row, not '{}' of class {} with {}",
        rows.name, rows.class_name, rows.stride, ensemble.name(), ensemble.class_name(), ensemble.stride()));
  ensemble.resize(rows.size);
  if (rows.size > 0) std::memcpy(ensemble.row(0), rows.rows.data(), rows.rows.size() * sizeof(double));
}

void write_checkpoint(std::string const& path, Checkpoint const& checkpoint, bool keep_previous) {
  std::string const part = path + ".part";
  try {
    auto const file = File::create(part, false, label_size);
    write_contents(*file, checkpoint);
    Descriptor const written(part, O_RDWR);
    written.write(0, label(Checkpoint::format, written.size(), written.checksum(label_size)));
    written.sync();
  } catch (Error const& error) {
    ::unlink(part.c_str());
    throw;
  }
  if (keep_previous) keep(path, path + ".previous");
  if (std::rename(part.c_str(), path.c_str()) != 0) {
    int const error = errno;
    ::unlink(part.c_str());
    throw Error(fmt::format("{}: can't be replaced: {}", path, reason(error)));
  }
  std::size_t const slash = path.rfind('/');
  Descriptor const folder(slash == std::string::npos ? "." : path.substr(0, slash + 1), O_RDONLY | O_DIRECTORY);
  folder.sync();
}

Checkpoint read_checkpoint(std::string const& path) {
  try {
    check_label(path);
  } catch (Error const& error) {
    throw Error(error.what() + previous_left(path));
  }
  auto const file = File::open(path);
  Checkpoint checkpoint;
  checkpoint.step = file->integer("/", "step");
  checkpoint.time = file->real("/", "time");
  checkpoint.step_size = file->real("/", "step_size");
  checkpoint.seed = std::bit_cast<std::uint64_t>(file->integer("/", "seed"));
  checkpoint.program_version = file->read_text("/program_version");
  checkpoint.scenario = file->read_text("/scenario");
  for (auto const& child : file->children("/ensembles")) {
    std::string const dataset = "/ensembles/" + child;
    auto const rows = file->dataset(dataset);
    auto const extents = rows.extents();
    if (extents.size() != 2) throw Error(fmt::format("{}: {} has not two axes", path, dataset));
    checkpoint.ensembles.push_back(
        {file->text(dataset, "name"), file->text(dataset, "class"), extents[0], extents[1], rows.reals()});
  }
  for (auto const& child : file->children("/state")) {
    std::string const dataset = "/state/" + child;
    checkpoint.state[file->text(dataset, "name")] = file->dataset(dataset).reals();
  }
  return checkpoint;
}

}  // namespace boltzmann
