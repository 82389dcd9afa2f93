// Reads files that gzip has compressed, as a stream.
#pragma once

#include <array>
#include <cstddef>
#include <fstream>
#include <memory>
#include <streambuf>
#include <string>

namespace boltzmann {

/// The decompressed bytes of a gzip file with one member or more (RFC 1952). Throws an Error if the file is truncated or
/// damaged, or if other bytes follow the last member.
class GzipBuffer final : public std::streambuf {
 public:
  explicit GzipBuffer(std::string path);
  ~GzipBuffer() override;
  GzipBuffer(GzipBuffer const&) = delete;
  GzipBuffer& operator=(GzipBuffer const&) = delete;

 protected:
  int_type underflow() override;

 private:
  struct State;
  bool refill();
  [[noreturn]] void refuse(std::string const& what) const;

  std::string path_;
  std::ifstream file_;
  std::array<char, 16384> packed_, plain_;
  std::unique_ptr<State> state_;
};

}  // namespace boltzmann
