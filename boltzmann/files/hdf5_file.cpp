// HDF5 files with the C API.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/input_file.hpp>
#include <boltzmann/files/disk_sync.hpp>
#include <boltzmann/files/hdf5_driver.hpp>
#include <boltzmann/files/hdf5_file.hpp>
#include <boltzmann/files/text_file.hpp>

#include <unistd.h>

#include <string.h>  // strnlen

#include <algorithm>
#include <cerrno>
#include <limits>
#include <utility>

namespace boltzmann::hdf5 {
namespace {

static_assert(sizeof(hid_t) == sizeof(std::int64_t), "HDF5 1.10 or later");

Neighbour neighbour;

// Wraps each call of this module: locks out the other user of HDF5, and suppresses the error stack that HDF5 prints.
// The user's setting is restored afterwards.
class Silence {
 public:
  Silence() {
    if (neighbour.enter) neighbour.enter();
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Silence() {
    H5Eset_auto2(H5E_DEFAULT, function_, data_);
    if (neighbour.leave) neighbour.leave();
  }
  Silence(Silence const&) = delete;
  Silence& operator=(Silence const&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

// An HDF5 identifier that is closed at the end of its scope.
template <herr_t (*close)(hid_t)>
class Scoped {
 public:
  explicit Scoped(hid_t id) : id_(id) {}
  ~Scoped() {
    if (id_ >= 0) close(id_);
  }
  Scoped(Scoped const&) = delete;
  Scoped& operator=(Scoped const&) = delete;
  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor)
  bool bad() const { return id_ < 0; }

 private:
  hid_t id_;
};
using Properties = Scoped<H5Pclose>;
using Space = Scoped<H5Sclose>;
using Type = Scoped<H5Tclose>;
using Attribute = Scoped<H5Aclose>;
using Object = Scoped<H5Oclose>;
using Opened = Scoped<H5Dclose>;

// The innermost error message of HDF5, on one line.
std::string last_reason() {
  std::string text;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_DOWNWARD,
      [](unsigned, H5E_error2_t const* error, void* data) -> herr_t {
        if (error->desc != nullptr && *error->desc != 0) *static_cast<std::string*>(data) = error->desc;
        return 0;
      },
      &text);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

// A creation property list without times in the header, so that two runs write the same bytes.
hid_t creation_list(hid_t kind) {
  hid_t const list = H5Pcreate(kind);
  H5Pset_obj_track_times(list, false);
  return list;
}

hid_t file_type(Number number) { return number == Number::real ? H5T_IEEE_F64LE : H5T_STD_I64LE; }

hid_t variable_text_type() {
  hid_t const type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

hid_t fixed_text_type(std::size_t size) {
  hid_t const type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, std::max<std::size_t>(size, 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

std::size_t product(Extents const& extents) {
  std::size_t total = 1;
  for (auto const extent : extents) {
    if (extent != 0 && total > std::numeric_limits<std::size_t>::max() / 64 / extent) return 0;
    total *= extent;
  }
  return total;
}

bool is_empty(Extents const& count) { return std::find(count.begin(), count.end(), 0U) != count.end(); }

// Makes the memory and file spaces of a block and calls transfer(memory space, file space).
template <class Transfer>
bool transfer_block(hid_t dataset, Extents const& start, Extents const& count, Transfer transfer) {
  static_assert(sizeof(hsize_t) == sizeof(std::uint64_t));
  std::vector<hsize_t> const from(start.begin(), start.end()), size(count.begin(), count.end());
  Space const in_file(H5Dget_space(dataset));
  Space const in_memory(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr));
  return !in_file.bad() && !in_memory.bad() && H5Sget_simple_extent_ndims(in_file) == static_cast<int>(size.size()) &&
         H5Sselect_hyperslab(in_file, H5S_SELECT_SET, from.data(), nullptr, size.data(), nullptr) >= 0 &&
         transfer(in_memory, in_file) >= 0;
}

}  // namespace

void leave_without_words() { H5dont_atexit(); }

void share_with(Neighbour other) { neighbour = other; }

Dataset::~Dataset() {
  Silence const silence;
  if (id_ >= 0) H5Dclose(id_);
}

Dataset::Dataset(Dataset&& other) noexcept
    : file_(std::exchange(other.file_, nullptr)), id_(std::exchange(other.id_, -1)), path_(std::move(other.path_)) {}

Dataset& Dataset::operator=(Dataset&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(id_, other.id_);
  std::swap(path_, other.path_);
  return *this;
}

Extents Dataset::extents() const {
  Silence const silence;
  Space const space(H5Dget_space(id_));
  int const rank = space.bad() ? -1 : H5Sget_simple_extent_ndims(space);
  if (rank < 0) file_->fail("can't read the extents of " + path_);
  std::vector<hsize_t> sizes(static_cast<std::size_t>(rank));
  if (rank > 0) H5Sget_simple_extent_dims(space, sizes.data(), nullptr);
  return {sizes.begin(), sizes.end()};
}

void Dataset::resize(Extents const& extents) {
  Silence const silence;
  std::vector<hsize_t> const sizes(extents.begin(), extents.end());
  if (H5Dset_extent(id_, sizes.data()) < 0) file_->fail("can't resize " + path_);
}

template <class Call, class Number>
void Dataset::transfer(Call call, Number* values, Extents const& start, Extents const& count, char const* what) const {
  if (is_empty(count)) return;
  Silence const silence;
  hid_t const type = std::is_same_v<std::remove_const_t<Number>, double> ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64;
  if (!transfer_block(id_, start, count,
                      [&](hid_t memory, hid_t file) { return call(id_, type, memory, file, H5P_DEFAULT, values); }))
    file_->fail(what + path_);
}

void Dataset::write(double const* values, Extents const& start, Extents const& count) {
  transfer(H5Dwrite, values, start, count, "can't write ");
}
void Dataset::write(std::int64_t const* values, Extents const& start, Extents const& count) {
  transfer(H5Dwrite, values, start, count, "can't write ");
}
void Dataset::read(double* values, Extents const& start, Extents const& count) const {
  transfer(H5Dread, values, start, count, "can't read ");
}
void Dataset::read(std::int64_t* values, Extents const& start, Extents const& count) const {
  transfer(H5Dread, values, start, count, "can't read ");
}

std::vector<double> Dataset::reals() const {
  Extents const size = extents();
  std::vector<double> values(product(size));
  read(values.data(), Extents(size.size(), 0), size);
  return values;
}

std::vector<std::int64_t> Dataset::integers() const {
  Extents const size = extents();
  std::vector<std::int64_t> values(product(size));
  read(values.data(), Extents(size.size(), 0), size);
  return values;
}

File::File(std::string path) : path_(std::move(path)), disk_(std::make_unique<Disk>()) {}

void File::fail(std::string const& what) const {
  std::string why = disk_->error != 0 ? reason(disk_->error) : last_reason();
  if (!why.empty()) why = ": " + why;
  throw Error(path_ + ": " + what + why);
}

namespace {

// The access property list: uses this module's driver, and closes open datasets with the file.
hid_t access_list(Disk* disk, bool ordered) {
  hid_t const access = access_through(disk);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  if (ordered) {
    H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110);
    // A killed process may leave a write torn at a page boundary. So no block that is rewritten may cross the end of a
    // page. (A size of 0 allocates blocks individually instead of from larger ones.)
    H5Pset_meta_block_size(access, 0);
    H5Pset_alignment(access, 1, 2048);
    // Without a cache, chunks are allocated when they are written, not when they are evicted. So a file does not depend
    // on what was written before it was opened, and a resumed run writes the same bytes.
    H5Pset_cache(access, 0, 1, 0, 0);
  }
  // A half-finished write of another process is complete a moment later. HDF5 waits 1 ns, then 2, 4, ...: 17 ms in all.
  // Its default of 100 attempts takes very long on each damaged block.
  H5Pset_metadata_read_attempts(access, 24);
  return access;
}

}  // namespace

std::unique_ptr<File> File::create(std::string path, bool ordered, std::uint64_t user_block) {
  Silence const silence;
  std::unique_ptr<File> file(new File(std::move(path)));
  file->disk_->open(file->path_, Disk::Use::create);
  Properties const access(access_list(file->disk_.get(), ordered)), creation(creation_list(H5P_FILE_CREATE));
  if (user_block > 0) H5Pset_userblock(creation, user_block);
  file->id_ = H5Fcreate(file->path_.c_str(), H5F_ACC_TRUNC, creation, access);
  if (file->id_ < 0 || file->disk_->error != 0) file->fail("can't be made");
  return file;
}

std::unique_ptr<File> File::create_plain(std::string path) {
  Silence const silence;
  std::unique_ptr<File> file(new File(std::move(path)));
  Properties const access(H5Pcreate(H5P_FILE_ACCESS)), creation(creation_list(H5P_FILE_CREATE));
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110);
  file->id_ = H5Fcreate(file->path_.c_str(), H5F_ACC_TRUNC, creation, access);
  if (file->id_ < 0) file->fail("can't be made");
  return file;
}

std::unique_ptr<File> File::open(std::string path) {
  Silence const silence;
  need_regular_file(path);
  std::unique_ptr<File> file(new File(std::move(path)));
  file->disk_->open(file->path_, Disk::Use::read);
  if (file->disk_->size == 0) throw Error(file->path_ + ": is empty");
  if (H5Fis_hdf5(file->path_.c_str()) <= 0) throw Error(file->path_ + ": is not an HDF5 file");
  Properties const access(access_list(file->disk_.get(), false));
  unsigned const use = file->disk_->has_superblock ? H5F_ACC_RDONLY | H5F_ACC_SWMR_READ : H5F_ACC_RDONLY;
  file->id_ = H5Fopen(file->path_.c_str(), use, access);
  if (file->id_ < 0) file->fail("can't be opened as HDF5, truncated or damaged");
  return file;
}

std::unique_ptr<File> File::open_for_writing(std::string path) {
  open(path);  // throws the reason
  Silence const silence;
  std::unique_ptr<File> file(new File(std::move(path)));
  file->disk_->open(file->path_, Disk::Use::change);
  Properties const access(access_list(file->disk_.get(), true));
  file->id_ = H5Fopen(file->path_.c_str(), H5F_ACC_RDWR, access);
  if (file->id_ < 0) file->fail("can't be opened for writing");
  return file;
}

File::~File() {
  Silence const silence;
  if (id_ >= 0) H5Fclose(id_);
  if (disk_->openings == 0) return;
  // HDF5 leaves objects of a damaged file open and compares the file with others opened later, so its Disk stays
  // allocated.
  disk_->close();
  (void)disk_.release();
}

void File::start_ordered_writes() {
  Silence const silence;
  if (H5Fstart_swmr_write(id_) < 0 || disk_->error != 0) fail("can't be prepared for ordered writes");
}

void File::hold() { disk_->hold(); }

void File::release() {
  Silence const silence;
  bool const flushed = H5Fflush(id_, H5F_SCOPE_LOCAL) >= 0;
  disk_->release();
  if (!flushed || disk_->error != 0) fail("can't be written");
}

void File::flush() {
  Silence const silence;
  if (H5Fflush(id_, H5F_SCOPE_LOCAL) < 0 || disk_->error != 0) fail("can't be written");
}

void File::sync() {
  if (sync_file(disk_->descriptor, true) != 0) throw Error(path_ + ": can't be brought to the disk: " + reason(errno));
}

void File::keep_in(std::string log, UndoLog::Label const& label) {
  disk_->undo.emplace(std::move(log), disk_->size, label);
}

bool File::take_back(std::string const& path, std::string const& log, UndoLog::Label const& label,
                     std::function<bool()> const& right) {
  Disk disk;
  disk.open(path, Disk::Use::change);
  return UndoLog::take_back(log, disk.descriptor, label, right);
}

void File::close() {
  Silence const silence;
  hid_t const id = std::exchange(id_, -1);
  if (id < 0) return;
  if (H5Fclose(id) < 0 || disk_->error != 0) fail("can't be written");
}

bool File::has(std::string const& object) const {
  Silence const silence;
  if (object == "/") return true;
  for (std::size_t slash = object.find('/', 1);; slash = object.find('/', slash + 1)) {
    if (H5Lexists(id_, object.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
    if (slash == std::string::npos) return H5Oexists_by_name(id_, object.c_str(), H5P_DEFAULT) > 0;
  }
}

bool File::is_dataset(std::string const& object) const {
  if (!has(object)) return false;
  Silence const silence;
  Object const opened(H5Oopen(id_, object.c_str(), H5P_DEFAULT));
  return H5Iget_type(opened) == H5I_DATASET;
}

std::vector<std::string> File::children(std::string const& group) const {
  Silence const silence;
  std::vector<std::string> names;
  auto const collect = [](hid_t, char const* name, H5L_info_t const*, void* data) -> herr_t {
    static_cast<std::vector<std::string>*>(data)->emplace_back(name);
    return 0;
  };
  // HDF5 crashes on a damaged group if it must sort the names itself.
  if (H5Literate_by_name(id_, group.c_str(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, collect, &names, H5P_DEFAULT) < 0)
    fail("can't read the group " + group);
  std::sort(names.begin(), names.end());
  return names;
}

void File::create_group(std::string const& group) {
  Silence const silence;
  Properties const creation(creation_list(H5P_GROUP_CREATE));
  Object const made(H5Gcreate2(id_, group.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT));
  if (made.bad()) fail("can't make the group " + group);
}

void File::link(std::string const& object, std::string const& new_name) {
  Silence const silence;
  if (H5Lcreate_hard(id_, object.c_str(), id_, new_name.c_str(), H5P_DEFAULT, H5P_DEFAULT) < 0)
    fail("can't link " + object + " as " + new_name);
}

Dataset File::create(std::string const& dataset, Number number, Extents const& extents) {
  return create_growing(dataset, number, extents, {}, {});
}

Dataset File::create_growing(std::string const& dataset, Number number, Extents const& extents, Extents const& chunk,
                             std::vector<bool> const& growing) {
  Silence const silence;
  std::vector<hsize_t> const sizes(extents.begin(), extents.end()), chunks(chunk.begin(), chunk.end());
  std::vector<hsize_t> limits = sizes;
  for (std::size_t k = 0; k < growing.size(); ++k)
    if (growing[k]) limits[k] = H5S_UNLIMITED;
  Space const space(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), limits.data()));
  Properties const creation(creation_list(H5P_DATASET_CREATE));
  if (number == Number::real && !chunks.empty()) {
    double const missing = std::numeric_limits<double>::quiet_NaN();
    H5Pset_fill_value(creation, H5T_NATIVE_DOUBLE, &missing);
  }
  if (!chunks.empty()) H5Pset_chunk(creation, static_cast<int>(chunks.size()), chunks.data());
  Dataset made;
  made.file_ = this;
  made.path_ = dataset;
  made.id_ = H5Dcreate2(id_, dataset.c_str(), file_type(number), space, H5P_DEFAULT, creation, H5P_DEFAULT);
  if (made.id_ < 0) fail("can't make the dataset " + dataset);
  return made;
}

namespace {

// A dataspace with one block selected; a count of 0 is unlimited.
hid_t space_with(Extents const& extents, Extents const& start, Extents const& count) {
  bool const grows = !count.empty() && count[0] == 0;
  std::vector<hsize_t> const sizes(extents.begin(), extents.end()), from(start.begin(), start.end());
  std::vector<hsize_t> limits = sizes, counts(count.begin(), count.end());
  if (grows) limits[0] = counts[0] = H5S_UNLIMITED;
  hid_t const space = H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), limits.data());
  if (space >= 0) H5Sselect_hyperslab(space, H5S_SELECT_SET, from.data(), nullptr, counts.data(), nullptr);
  return space;
}

}  // namespace

void File::create_view(std::string const& dataset, Number number, Extents const& extents, std::string const& file,
                       std::vector<Piece> const& pieces) {
  Silence const silence;
  Properties const creation(creation_list(H5P_DATASET_CREATE));
  bool const grows = std::any_of(pieces.begin(), pieces.end(), [](Piece const& piece) { return piece.count[0] == 0; });
  if (number == Number::real && grows) {
    double const missing = std::numeric_limits<double>::quiet_NaN();
    H5Pset_fill_value(creation, H5T_NATIVE_DOUBLE, &missing);
  }
  bool right = true;
  for (auto const& piece : pieces) {
    Space const here(space_with(extents, piece.at, piece.size)),
        there(space_with(piece.extents, piece.start, piece.count));
    right = right && H5Pset_virtual(creation, here, file.c_str(), piece.dataset.c_str(), there) >= 0;
  }
  std::vector<hsize_t> const sizes(extents.begin(), extents.end());
  std::vector<hsize_t> limits = sizes;
  if (grows) limits[0] = H5S_UNLIMITED;
  Space const space(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), limits.data()));
  Opened const made(H5Dcreate2(id_, dataset.c_str(), file_type(number), space, H5P_DEFAULT, creation, H5P_DEFAULT));
  if (!right || made.bad()) fail("can't make the view " + dataset);
}

void File::create_same(std::string const& dataset, std::uint64_t count, double number) {
  Silence const silence;
  Properties const creation(creation_list(H5P_DATASET_CREATE));
  hsize_t const size = count, chunk = std::min<hsize_t>(count, 4096);
  H5Pset_fill_value(creation, H5T_NATIVE_DOUBLE, &number);
  H5Pset_chunk(creation, 1, &chunk);
  Space const space(H5Screate_simple(1, &size, nullptr));
  Opened const made(H5Dcreate2(id_, dataset.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT));
  if (made.bad()) fail("can't make the dataset " + dataset);
}

Dataset File::dataset(std::string const& path) const {
  Silence const silence;
  Dataset opened;
  opened.file_ = this;
  opened.path_ = path;
  opened.id_ = H5Dopen2(id_, path.c_str(), H5P_DEFAULT);
  if (opened.id_ < 0) fail("has no dataset " + path);
  return opened;
}

void File::write_text(std::string const& dataset, std::string const& text) {
  Silence const silence;
  Type const type(fixed_text_type(text.size()));
  Space const space(H5Screate(H5S_SCALAR));
  Properties const creation(creation_list(H5P_DATASET_CREATE));
  Opened const made(H5Dcreate2(id_, dataset.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT));
  if (made.bad() || H5Dwrite(made, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()) < 0)
    fail("can't write " + dataset);
}

std::string File::read_text(std::string const& dataset) const {
  Silence const silence;
  Opened const opened(H5Dopen2(id_, dataset.c_str(), H5P_DEFAULT));
  if (opened.bad()) fail("has no dataset " + dataset);
  Type const type(H5Dget_type(opened));
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) fail(dataset + " is not a text");
  std::string text(H5Tget_size(type), '\0');
  if (H5Dread(opened, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) fail("can't read " + dataset);
  text.resize(text.find_last_not_of('\0') + 1);
  return text;
}

void File::set_values(std::string const& object, std::string const& attribute, std::int64_t type,
                      Extents const& extents, void const* values) {
  std::vector<hsize_t> const sizes(extents.begin(), extents.end());
  Space const space(sizes.empty() ? H5Screate(H5S_SCALAR)
                                  : H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr));
  Attribute const made(
      H5Acreate_by_name(id_, object.c_str(), attribute.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  if (made.bad() || H5Awrite(made, type, values) < 0) fail("can't write the attribute " + attribute + " of " + object);
}

void File::set(std::string const& object, std::string const& attribute, std::string const& text) {
  Silence const silence;
  Type const type(variable_text_type());
  char const* pointer = text.c_str();
  set_values(object, attribute, type, {}, &pointer);
}

void File::set_fixed(std::string const& object, std::string const& attribute, std::string const& text) {
  Silence const silence;
  Type const type(fixed_text_type(text.size()));
  std::string padded = text.empty() ? std::string(1, '\0') : text;
  set_values(object, attribute, type, {}, padded.data());
}

void File::set(std::string const& object, std::string const& attribute, std::vector<std::string> const& texts) {
  Silence const silence;
  Type const type(variable_text_type());
  std::vector<char const*> pointers;
  pointers.reserve(texts.size());
  for (auto const& text : texts) pointers.push_back(text.c_str());
  set_values(object, attribute, type, {texts.size()}, pointers.data());
}

void File::set(std::string const& object, std::string const& attribute, double value) {
  Silence const silence;
  set_values(object, attribute, H5T_NATIVE_DOUBLE, {}, &value);
}

void File::set(std::string const& object, std::string const& attribute, std::vector<std::int64_t> const& values) {
  Silence const silence;
  set_values(object, attribute, H5T_NATIVE_INT64, {values.size()}, values.data());
}

void File::set(std::string const& object, std::string const& attribute, std::int64_t value) {
  Silence const silence;
  set_values(object, attribute, H5T_NATIVE_INT64, {}, &value);
}

bool File::has(std::string const& object, std::string const& attribute) const {
  Silence const silence;
  return H5Aexists_by_name(id_, object.c_str(), attribute.c_str(), H5P_DEFAULT) > 0;
}

std::string File::text(std::string const& object, std::string const& attribute) const {
  auto const all = texts(object, attribute);
  if (all.size() != 1) fail("the attribute " + attribute + " of " + object + " is not one text");
  return all[0];
}

std::vector<std::string> File::texts(std::string const& object, std::string const& attribute) const {
  Silence const silence;
  Attribute const opened(H5Aopen_by_name(id_, object.c_str(), attribute.c_str(), H5P_DEFAULT, H5P_DEFAULT));
  if (opened.bad()) fail(object + " has no attribute " + attribute);
  Type const stored(H5Aget_type(opened));
  Space const space(H5Aget_space(opened));
  hssize_t const count = H5Sget_simple_extent_npoints(space);
  if (H5Tget_class(stored) != H5T_STRING || count < 0)
    fail("the attribute " + attribute + " of " + object + " is not text");
  std::vector<std::string> result;
  if (count == 0) return result;
  if (H5Tis_variable_str(stored) > 0) {
    Type const type(variable_text_type());
    H5Tset_cset(type, H5Tget_cset(stored));
    std::vector<char*> pointers(static_cast<std::size_t>(count), nullptr);
    if (H5Aread(opened, type, pointers.data()) < 0) fail("can't read the attribute " + attribute + " of " + object);
    for (char const* pointer : pointers) result.emplace_back(pointer != nullptr ? pointer : "");
    H5Dvlen_reclaim(type, space, H5P_DEFAULT, pointers.data());
  } else {
    std::size_t const size = H5Tget_size(stored);
    std::vector<char> bytes(size * static_cast<std::size_t>(count));
    if (H5Aread(opened, stored, bytes.data()) < 0) fail("can't read the attribute " + attribute + " of " + object);
    for (std::size_t k = 0; k < bytes.size(); k += size) result.emplace_back(&bytes[k], strnlen(&bytes[k], size));
  }
  return result;
}

void File::get_values(std::string const& object, std::string const& attribute, std::int64_t type, std::size_t count,
                      void* values) const {
  Attribute const opened(H5Aopen_by_name(id_, object.c_str(), attribute.c_str(), H5P_DEFAULT, H5P_DEFAULT));
  if (opened.bad()) fail(object + " has no attribute " + attribute);
  Space const space(H5Aget_space(opened));
  if (H5Sget_simple_extent_npoints(space) != static_cast<hssize_t>(count) || H5Aread(opened, type, values) < 0)
    fail("can't read the attribute " + attribute + " of " + object);
}

double File::real(std::string const& object, std::string const& attribute) const {
  Silence const silence;
  double value = 0;
  get_values(object, attribute, H5T_NATIVE_DOUBLE, 1, &value);
  return value;
}

std::vector<std::int64_t> File::integers(std::string const& object, std::string const& attribute) const {
  Silence const silence;
  Attribute const opened(H5Aopen_by_name(id_, object.c_str(), attribute.c_str(), H5P_DEFAULT, H5P_DEFAULT));
  Space const space(opened.bad() ? -1 : H5Aget_space(opened));
  hssize_t const count = space.bad() ? -1 : H5Sget_simple_extent_npoints(space);
  if (count < 0 || count > 65536) fail("can't read the attribute " + attribute + " of " + object);
  std::vector<std::int64_t> values(static_cast<std::size_t>(count));
  get_values(object, attribute, H5T_NATIVE_INT64, values.size(), values.data());
  return values;
}

std::int64_t File::integer(std::string const& object, std::string const& attribute) const {
  Silence const silence;
  std::int64_t value = 0;
  get_values(object, attribute, H5T_NATIVE_INT64, 1, &value);
  return value;
}

}  // namespace boltzmann::hdf5
