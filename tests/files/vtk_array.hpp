// The numbers of an array of a .vti or .vtp, as the VTK file format defines appended raw data with 64-bit headers.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace boltzmann {

template <class T = double>
std::vector<T> array_of(std::string const& file, std::string const& name) {
  std::size_t const tag = file.find("Name=\"" + name + "\"");
  if (tag == std::string::npos) return {};
  std::size_t const offset = std::stoul(file.substr(file.find("offset=\"", tag) + 8));
  std::size_t const data = file.find('_', file.find("<AppendedData encoding=\"raw\">")) + 1 + offset;
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, file.data() + data, 8);
  std::vector<T> values(bytes / sizeof(T));
  if (bytes > 0) std::memcpy(values.data(), file.data() + data + 8, bytes);
  return values;
}

}  // namespace boltzmann
