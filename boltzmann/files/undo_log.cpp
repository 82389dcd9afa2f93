// The log consists of records of pages.
#include <boltzmann/files/checksum.hpp>
#include <boltzmann/files/disk_sync.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/files/undo_log.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <optional>
#include <utility>

namespace boltzmann {
namespace {

constexpr std::uint64_t page = 4096;

struct Record {
  std::uint64_t address = 0, count = 0, checksum = 0;  // checksum: of the following bytes
};

// Returns fewer bytes at the end of the file.
std::size_t read_at(int file, std::uint64_t address, void* bytes, std::size_t count) {
  std::size_t done = 0;
  while (done < count) {
    ssize_t const got = pread(file, static_cast<char*>(bytes) + done, count - done, static_cast<off_t>(address + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

bool write_at(int file, std::uint64_t address, void const* bytes, std::size_t count) {
  for (std::size_t done = 0; done < count;) {
    ssize_t const put =
        pwrite(file, static_cast<char const*>(bytes) + done, count - done, static_cast<off_t>(address + done));
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return false;
    done += static_cast<std::size_t>(put);
  }
  return true;
}

struct Kept {
  std::uint64_t address;
  std::vector<unsigned char> bytes;
};

bool put_back(int file, std::vector<Kept> const& all, std::uint64_t size) {
  bool whole = true;
  for (auto const& one : all) whole = write_at(file, one.address, one.bytes.data(), one.bytes.size()) && whole;
  return ftruncate(file, static_cast<off_t>(size)) == 0 && whole;
}

// All records of a log; nothing if one is damaged or missing.
std::optional<std::vector<Kept>> records(int log, std::uint64_t at, std::uint64_t count) {
  struct stat facts {};
  if (fstat(log, &facts) != 0) return {};
  auto const end = static_cast<std::uint64_t>(facts.st_size);
  std::vector<Kept> found;
  while (found.size() < count) {
    Record record;
    if (read_at(log, at, &record, sizeof record) != sizeof record) return {};
    at += sizeof record;
    if (record.count > end - at) return {};
    Kept one{record.address, std::vector<unsigned char>(record.count)};
    if (read_at(log, at, one.bytes.data(), one.bytes.size()) != record.count ||
        crc64(one.bytes.data(), one.bytes.size(), record.address) != record.checksum)
      return {};
    at += record.count;
    found.push_back(std::move(one));
  }
  return found;
}

// An identifier of this boot of the machine; zeros if it is unknown.
std::array<char, 36> this_boot() {
  std::array<char, 36> id{};
  int const file = open("/proc/sys/kernel/random/boot_id", O_RDONLY | O_CLOEXEC);
  if (file < 0) return id;
  if (read_at(file, 0, id.data(), id.size()) != id.size()) id.fill(0);
  close(file);
  return id;
}

}  // namespace

std::uint64_t UndoLog::Head::sum() const { return crc64(this, offsetof(Head, checksum)); }

UndoLog::UndoLog(std::string path, std::uint64_t size, Label const& label)
    : path_(std::move(path)),
      descriptor_(open_for_writing(path_, O_RDWR | O_TRUNC)),
      head_{.size = size, .label = label, .boot = this_boot()},
      kept_((size + page - 1) / page) {
  write_head();
}

UndoLog::~UndoLog() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void UndoLog::close() {
  if (descriptor_ < 0 || sync_file(descriptor_, true, true) != 0) return;
  head_.closed = 1;
  write_head();
  if (descriptor_ < 0) return;
  sync_file(descriptor_, true, true);
  ::close(std::exchange(descriptor_, -1));
}

void UndoLog::write_head() {
  head_.checksum = head_.sum();
  write(0, &head_, sizeof head_);
}

void UndoLog::write(std::uint64_t at, void const* bytes, std::size_t count) {
  if (descriptor_ < 0 || write_at(descriptor_, at, bytes, count)) return;
  (void)!ftruncate(descriptor_, 0);
  unlink(path_.c_str());
  ::close(std::exchange(descriptor_, -1));
}

void UndoLog::keep(int file, std::uint64_t address, std::uint64_t count) {
  std::uint64_t const end = std::min(head_.size, address + count);
  for (std::uint64_t p = address / page; descriptor_ >= 0 && p * page < end; ++p) {
    std::uint64_t const first = p;
    while (p * page < end && !kept_[p]) kept_[p++] = true;
    if (p == first) continue;
    Record record{first * page, std::min(head_.size, p * page) - first * page};
    std::vector<unsigned char> bytes(sizeof record + record.count);
    read_at(file, record.address, bytes.data() + sizeof record, record.count);
    record.checksum = crc64(bytes.data() + sizeof record, record.count, record.address);
    std::memcpy(bytes.data(), &record, sizeof record);
    write(used_, bytes.data(), bytes.size());
    used_ += bytes.size();
    ++head_.records;
    write_head();
  }
}

bool UndoLog::take_back(std::string const& path, int file, Label const& label, std::function<bool()> const& right) {
  int const log = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (log < 0) return false;
  Head head;
  std::optional<std::vector<Kept>> then;
  if (read_at(log, 0, &head, sizeof head) == sizeof head && head.signature == Head().signature &&
      head.checksum == head.sum() && head.label == label &&
      (head.closed != 0 || (head.boot == this_boot() && head.boot != decltype(head.boot){})))
    then = records(log, sizeof head, head.records);
  ::close(log);
  struct stat facts {};
  if (!then || fstat(file, &facts) != 0) return false;
  auto const size = static_cast<std::uint64_t>(facts.st_size);
  std::vector<Kept> now = *then;
  for (auto& one : now) one.bytes.resize(read_at(file, one.address, one.bytes.data(), one.bytes.size()));
  if (put_back(file, *then, std::max(size, head.size)) && right() && put_back(file, {}, head.size)) return true;
  put_back(file, now, size);
  return false;
}

}  // namespace boltzmann
