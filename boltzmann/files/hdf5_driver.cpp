// The callbacks of the HDF5 file driver.
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/hdf5_driver.hpp>
#include <boltzmann/files/text_file.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace boltzmann::hdf5 {
namespace {

// The superblock of version 3: offsets of its fields.
constexpr unsigned char signature[] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t superblock_size = 48, version_at = 8, flags_at = 11, end_at = 28, checksum_at = 44;

struct Info {
  Disk* disk;
};

struct OpenFile {
  H5FD_t base;  // the part of HDF5; must come first
  Disk* disk;
  haddr_t end;  // the end of the address space that HDF5 has allocated
};

OpenFile* of(H5FD_t* file) { return reinterpret_cast<OpenFile*>(file); }
OpenFile const* of(H5FD_t const* file) { return reinterpret_cast<OpenFile const*>(file); }

std::uint64_t number_at(unsigned char const* bytes) {
  std::uint64_t number = 0;
  for (unsigned k = 0; k < 8; ++k) number |= static_cast<std::uint64_t>(bytes[k]) << (8 * k);
  return number;
}

void put(std::uint64_t number, unsigned count, unsigned char* bytes) {
  for (unsigned k = 0; k < count; ++k) bytes[k] = static_cast<unsigned char>(number >> (8 * k));
}

void write_bytes(Disk& disk, std::uint64_t address, unsigned char const* bytes, std::size_t size) {
  if (disk.holding) {
    disk.held.emplace_back(address, std::vector<unsigned char>(bytes, bytes + size));
    disk.size = std::max<std::uint64_t>(disk.size, address + size);
    return;
  }
  if (disk.undo && disk.error == 0) disk.undo->keep(disk.descriptor, address, size);
  while (size > 0 && disk.error == 0) {
    ssize_t const written = pwrite(disk.descriptor, bytes, size, static_cast<off_t>(address));
    if (written < 0) {
      if (errno != EINTR) disk.error = errno;
      continue;
    }
    address += static_cast<std::uint64_t>(written);
    bytes += written;
    size -= static_cast<std::size_t>(written);
    disk.size = std::max(disk.size, address);
  }
}

void set_size(Disk& disk, std::uint64_t size) {
  if (disk.error != 0 || disk.size == size) return;
  if (disk.undo && !disk.holding && size < disk.size) disk.undo->keep(disk.descriptor, size, disk.size - size);
  if (!disk.holding && ftruncate(disk.descriptor, static_cast<off_t>(size)) != 0)
    disk.error = errno;
  else
    disk.size = size;
}

// Writes the end of the file into the superblock, without the flag of a file in use.
void tell_end(Disk& disk, std::uint64_t end) {
  put(end, 8, disk.superblock.data() + end_at);
  disk.superblock[flags_at] = 0;
  put(lookup3(disk.superblock.data(), checksum_at), 4, disk.superblock.data() + checksum_at);
  if (disk.size < end) set_size(disk, end);
  write_bytes(disk, 0, disk.superblock.data(), superblock_size);
}

H5FD_t* open_file(char const*, unsigned, hid_t access, haddr_t) {
  auto const* info = static_cast<Info const*>(H5Pget_driver_info(access));
  if (info == nullptr || info->disk == nullptr) return nullptr;
  auto* file = new OpenFile{};
  file->disk = info->disk;
  ++file->disk->openings;
  return &file->base;
}

herr_t close_file(H5FD_t* base) {
  OpenFile* file = of(base);
  Disk& disk = *file->disk;
  if (disk.error == 0 && disk.has_superblock && number_at(disk.superblock.data() + end_at) != file->end) {
    tell_end(disk, file->end);
    set_size(disk, file->end);
  }
  --disk.openings;
  delete file;
  return 0;
}

int compare(H5FD_t const* a, H5FD_t const* b) {
  return of(a)->disk == of(b)->disk ? 0 : (of(a)->disk < of(b)->disk ? -1 : 1);
}

herr_t query(H5FD_t const*, unsigned long* flags) {
  if (flags != nullptr)
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DATA_SIEVE |
             H5FD_FEAT_SUPPORTS_SWMR_IO | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

// The current size.
std::uint64_t size_of(Disk& disk) {
  struct stat facts {};
  if (disk.read_only && fstat(disk.descriptor, &facts) == 0) disk.size = static_cast<std::uint64_t>(facts.st_size);
  return disk.size;
}

haddr_t get_end(H5FD_t const* base, H5FD_mem_t) {
  OpenFile const* file = of(base);
  return file->disk->read_only ? std::max<haddr_t>(file->end, size_of(*file->disk)) : file->end;
}

herr_t set_end(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  of(file)->end = end;
  return 0;
}

haddr_t get_size(H5FD_t const* file, H5FD_mem_t) { return size_of(*of(file)->disk); }

herr_t read_file(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, size_t size, void* buffer) {
  Disk const& disk = *of(file)->disk;
  auto* bytes = static_cast<unsigned char*>(buffer);
  for (size_t done = 0; done < size;) {
    ssize_t const got = pread(disk.descriptor, bytes + done, size - done, static_cast<off_t>(address + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return -1;
    if (got == 0) {  // allocated addresses that were not written yet
      std::memset(bytes + done, 0, size - done);
      break;
    }
    done += static_cast<size_t>(got);
  }
  for (auto const& [start, written] : disk.held) {
    haddr_t const from = std::max<haddr_t>(start, address),
                  to = std::min<haddr_t>(start + written.size(), address + size);
    if (from < to) std::memcpy(bytes + (from - address), written.data() + (from - start), to - from);
  }
  return 0;
}

herr_t write_file(H5FD_t* base, H5FD_mem_t type, hid_t, haddr_t address, size_t size, void const* buffer) {
  OpenFile* file = of(base);
  Disk& disk = *file->disk;
  auto const* bytes = static_cast<unsigned char const*>(buffer);
  if (address == 0 && size >= superblock_size && std::memcmp(bytes, signature, sizeof signature) == 0 &&
      bytes[version_at] == 3) {
    std::memcpy(disk.superblock.data(), bytes, superblock_size);
    disk.has_superblock = true;
    tell_end(disk, file->end);
    write_bytes(disk, superblock_size, bytes + superblock_size, size - superblock_size);
    return 0;
  }
  if (type != H5FD_MEM_DRAW && disk.has_superblock && number_at(disk.superblock.data() + end_at) < file->end)
    tell_end(disk, file->end);
  write_bytes(disk, address, bytes, size);
  return 0;
}

herr_t truncate_file(H5FD_t* base, hid_t, hbool_t) {
  OpenFile* file = of(base);
  Disk& disk = *file->disk;
  if (disk.has_superblock && number_at(disk.superblock.data() + end_at) != file->end) tell_end(disk, file->end);
  set_size(disk, file->end);
  return 0;
}

// Readers are never locked out. Disk::open has excluded other writers.
herr_t lock(H5FD_t*, hbool_t) { return 0; }
herr_t unlock(H5FD_t*) { return 0; }

hid_t registered_driver() {
  static hid_t const id = [] {
    H5FD_class_t driver{};
#if H5_VERSION_GE(1, 13, 0)
    driver.version = H5FD_CLASS_VERSION;
    driver.value = static_cast<H5FD_class_value_t>(511);  // from the range for private use
#endif
    driver.name = "boltzmann";
    driver.maxaddr = static_cast<haddr_t>(1) << 62;
    driver.fc_degree = H5F_CLOSE_WEAK;
    driver.fapl_size = sizeof(Info);
    driver.open = open_file;
    driver.close = close_file;
    driver.cmp = compare;
    driver.query = query;
    driver.get_eoa = get_end;
    driver.set_eoa = set_end;
    driver.get_eof = get_size;
    driver.read = read_file;
    driver.write = write_file;
    driver.truncate = truncate_file;
    driver.lock = lock;
    driver.unlock = unlock;
    H5FD_mem_t const one_kind_of_free_space[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
    std::copy(std::begin(one_kind_of_free_space), std::end(one_kind_of_free_space), driver.fl_map);
    return H5FDregister(&driver);
  }();
  return id;
}

std::uint32_t rotated(std::uint32_t x, int bits) { return (x << bits) | (x >> (32 - bits)); }

}  // namespace

Disk::~Disk() { close(); }

void Disk::close() {
  if (int const id = std::exchange(descriptor, -1); id >= 0) ::close(id);
  if (undo) undo->close();
}

void Disk::open(std::string const& path, Use use) {
  descriptor = use == Use::create
                   ? open_for_writing(path, O_RDWR | O_NONBLOCK)
                   : ::open(path.c_str(), (use == Use::read ? O_RDONLY : O_RDWR) | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0)
    throw Error(path + ": can't open it" + (use == Use::read ? ": " : " for writing: ") + reason(errno));
  struct stat facts {};
  if (fstat(descriptor, &facts) != 0) throw Error(path + ": " + reason(errno));
  if (!S_ISREG(facts.st_mode)) throw Error(path + ": is not a regular file");
  struct flock whole {};  // an open-file-description lock; readers do not check it
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  if (use != Use::read && fcntl(descriptor, F_OFD_SETLK, &whole) != 0 && (errno == EAGAIN || errno == EACCES))
    throw Error(path + ": another run is writing this file");
  if (use == Use::create && ftruncate(descriptor, 0) != 0) throw Error(path + ": can't be emptied: " + reason(errno));
  size = use == Use::create ? 0 : static_cast<std::uint64_t>(facts.st_size);
  read_only = use == Use::read;
  if (size < superblock_size) return;
  if (pread(descriptor, superblock.data(), superblock_size, 0) == static_cast<ssize_t>(superblock_size))
    has_superblock = std::memcmp(superblock.data(), signature, sizeof signature) == 0 && superblock[version_at] == 3;
}

void Disk::hold() {
  holding = true;
  size_in_file = size;
}

void Disk::release() {
  holding = false;
  std::uint64_t const wanted = std::exchange(size, size_in_file);
  if (wanted > size) set_size(*this, wanted);
  for (bool const behind : {true, false})
    for (auto const& [address, bytes] : held)
      if ((address >= size_in_file) == behind) write_bytes(*this, address, bytes.data(), bytes.size());
  set_size(*this, wanted);
  held.clear();
}

hid_t access_through(Disk* disk) {
  hid_t const access = H5Pcreate(H5P_FILE_ACCESS);
  Info const info{disk};
  if (access >= 0 && H5Pset_driver(access, registered_driver(), &info) < 0) {
    H5Pclose(access);
    return -1;
  }
  return access;
}

// Bob Jenkins, "lookup3" (2006): three words, twelve bytes at a time, and a final round for the rest.
std::uint32_t lookup3(unsigned char const* bytes, std::size_t size) {
  std::uint32_t a = 0xdeadbeefU + static_cast<std::uint32_t>(size), b = a, c = a;
  auto const add = [&](std::size_t count) {
    std::uint32_t words[3] = {};
    for (std::size_t k = 0; k < count; ++k) words[k / 4] += static_cast<std::uint32_t>(bytes[k]) << (8 * (k % 4));
    a += words[0];
    b += words[1];
    c += words[2];
  };
  for (; size > 12; size -= 12, bytes += 12) {
    add(12);
    a -= c, a ^= rotated(c, 4), c += b;
    b -= a, b ^= rotated(a, 6), a += c;
    c -= b, c ^= rotated(b, 8), b += a;
    a -= c, a ^= rotated(c, 16), c += b;
    b -= a, b ^= rotated(a, 19), a += c;
    c -= b, c ^= rotated(b, 4), b += a;
  }
  if (size == 0) return c;
  add(size);
  c ^= b, c -= rotated(b, 14);
  a ^= c, a -= rotated(c, 11);
  b ^= a, b -= rotated(a, 25);
  c ^= b, c -= rotated(b, 16);
  a ^= c, a -= rotated(c, 4);
  b ^= a, b -= rotated(a, 14);
  c ^= b, c -= rotated(b, 24);
  return c;
}

}  // namespace boltzmann::hdf5
