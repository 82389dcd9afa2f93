// Converts connections (first : last : interval) to a list of partners.
#include <boltzmann/neighbours/connection.hpp>

#include <boltzmann/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {
namespace {

/// Names the connections that have this pair.
std::string naming(std::span<Connection const> connections, std::size_t i, std::size_t j) {
  std::string text;
  for (std::size_t k = 0; k < connections.size(); ++k) {
    auto const& c = connections[k];
    if (j - i == c.interval && i >= c.first && j <= c.last && (i - c.first) % c.interval == 0)
      text +=
          fmt::format("{}[{}, {}, {}] (number {} from 0)", text.empty() ? "" : " and ", c.first, c.last, c.interval, k);
  }
  return text;
}

}  // namespace

PartnerList connected_pairs(std::span<Connection const> connections, std::size_t size) {
  std::vector<std::vector<std::uint32_t>> partners(size);
  for (auto const& c : connections) {
    if (c.interval == 0) throw Error(fmt::format("connection {}:{}:0: the interval is at least 1", c.first, c.last));
    if (c.first > c.last) throw Error(fmt::format("connection {}:{}:{} runs backwards", c.first, c.last, c.interval));
    if (c.last >= size)
      throw Error(fmt::format("connection {}:{}:{} names particle {}, but there are {} (0 to {})", c.first, c.last,
                              c.interval, c.last, size, size == 0 ? 0 : size - 1));
    for (std::size_t i = c.first; c.last - i >= c.interval; i += c.interval) {
      partners[i].push_back(static_cast<std::uint32_t>(i + c.interval));
      partners[i + c.interval].push_back(static_cast<std::uint32_t>(i));
    }
  }
  PartnerList list;
  list.start.push_back(0);
  for (std::size_t i = 0; i < size; ++i) {
    auto& mine = partners[i];
    std::sort(mine.begin(), mine.end());
    if (auto const twice = std::adjacent_find(mine.begin(), mine.end()); twice != mine.end())
      throw Error(
          fmt::format("particles {} and {} are connected twice: {}; leave one out, or for two laws write two "
                      "influences",
                      i, *twice, naming(connections, i, *twice)));
    list.index.insert(list.index.end(), mine.begin(), mine.end());
    while (list.index.size() % PartnerList::padding != 0) list.index.push_back(static_cast<std::uint32_t>(i));
    list.start.push_back(list.index.size());
  }
  return list;
}

}  // namespace boltzmann
