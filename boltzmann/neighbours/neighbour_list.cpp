// Builds lists in chunks of targets, each with memory of its own, which is kept from build to build.
#include <boltzmann/neighbours/neighbour_list.hpp>

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/neighbours/neighbour_kernels.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

namespace boltzmann {
namespace {

constexpr std::size_t rows_per_task = 1024;
constexpr std::size_t first_guess = 48;  // entries a row

NearTask task_of(SortedCopy const& target, SortedCopy const& source, double cutoff, double skin) {
  NearTask task = source.near_task();
  task.reference = target.references();
  task.reference_steps = target.reference_steps();
  task.same = &target == &source;
  task.reach = cutoff + skin;
  for (int r = 0; r < list_rings; ++r) task.ring[r] = cutoff + skin * (r + 1) / list_rings;
  return task;
}

/// Scratch memory of a search, kept while one thread processes chunks.
struct Scratch {
  std::array<std::vector<float>, 3> positions;
  std::array<std::vector<std::uint32_t>, list_rings> items;
  std::vector<std::size_t> offset;

  void lend(NearRows& out, std::size_t size) {
    for (auto& column : positions) column.resize(size);
    for (auto& column : items) column.resize(size);
    for (std::size_t a = 0; a < 3; ++a) out.near_position[a] = positions[a].data();
    out.near_item = items[0].data();
    for (std::size_t r = 1; r < list_rings; ++r) out.shell_item[r - 1] = items[r].data();
    out.scratch = size;
  }
};

/// Runs the kernel over [begin, end), growing `index` as needed.
void find(NearKernel kernel, NearTask const& task, std::size_t begin, std::size_t end, NearRows& out,
          std::vector<std::uint32_t>& index, Scratch& scratch) {
  for (;;) {
    out.index = index.data();
    out.room = index.size();
    begin = kernel(task, begin, end, out);
    if (begin == end) return;
    if (out.used + out.wanted > index.size()) {
      // Extrapolates from the rows found so far, or exactly what the last row needs.
      std::size_t const found = begin - out.first, rest = end - begin;
      std::size_t const more = found > 0 ? out.used * rest / found + out.used / 32 : 0;
      index.reserve(out.used + more + out.wanted);
      index.resize(index.capacity());
    }
    if (out.wanted_scratch > out.scratch) scratch.lend(out, out.wanted_scratch + out.wanted_scratch / 2);
  }
}

}  // namespace

void NeighbourList::build(SortedCopy const& target, SortedCopy const& source, double cutoff, double skin,
                          std::vector<Stretch> const& rows, int threads, char* marks) {
  cutoff_ = cutoff;
  skin_ = skin;
  std::size_t const all = target.owned();
  if (!filter_.start.empty() && filter_.start.size() != all + 1)
    throw Error(fmt::format("ensemble '{}' had {} particles when its bonded pairs were set, now it has {}",
                            target.ensemble().name(), filter_.start.size() - 1, all));
  if (size() != all) {
    row_.resize(all);
    length_.assign(list_rings * all, 0);
  } else {
    for (auto const& [begin, end] : found_)
      for (int r = 0; r < list_rings; ++r)
        std::fill(length_.data() + r * all + begin, length_.data() + r * all + end, 0U);
  }
  found_.clear();
  replaced_.clear();
  more_.clear();
  entries_ = 0;
  find_rows(target, source, rows, chunks_, threads, marks);
}

void NeighbourList::build_more(SortedCopy const& target, SortedCopy const& source, std::vector<Stretch> const& rows,
                               int threads, char* marks) {
  find_rows(target, source, rows, more_.emplace_back(), threads, marks);
}

void NeighbourList::find_rows(SortedCopy const& target, SortedCopy const& source, std::vector<Stretch> const& rows,
                              std::vector<std::vector<std::uint32_t>>& chunks, int threads, char* marks) {
  found_.insert(found_.end(), rows.begin(), rows.end());
  NearTask const task = task_of(target, source, cutoff_, skin_);
  NearKernel const kernel = neighbour_kernels().near[target.ensemble().dimension() - 1];
  std::vector<Stretch> parts;  // each with memory of its own
  for (auto const& [first, last] : rows)
    for (std::size_t begin = first, end = first; begin < last; begin = end) {
      end = std::min((begin / rows_per_task + 1) * rows_per_task, last);
      parts.push_back({begin, end});
    }
  chunks.resize(std::max(parts.size(), chunks.size()));
  std::atomic<std::size_t> entries{0};
  for_ranges(parts.size(), 1, threads, [&](std::size_t first, std::size_t last) {
    Scratch scratch;
    scratch.offset.resize(rows_per_task);
    for (std::size_t k = first; k < last; ++k) {
      auto const [begin, end] = parts[k];
      auto& index = chunks[k];
      if (index.empty()) index.resize(first_guess * (end - begin));
      NearRows out;
      out.offset = scratch.offset.data();
      out.first = begin;
      out.length = length_.data();
      out.rows = size();
      out.marks = marks;
      find(kernel, task, begin, end, out, index, scratch);
      for (std::size_t i = begin; i < end; ++i) row_[i] = index.data() + scratch.offset[i - begin];
      if (!filter_.start.empty())
        for (std::size_t i = begin; i < end; ++i) sift(target, source, i);
      entries += out.used;
    }
  });
  entries_ += entries;
}

void NeighbourList::rebuild(SortedCopy const& target, SortedCopy const& source, std::span<std::uint32_t const> rows,
                            char* marks) {
  rebuilt_.assign(rows.begin(), rows.end());
  NearTask const task = task_of(target, source, cutoff_, skin_);
  NearKernel const kernel = neighbour_kernels().near[target.ensemble().dimension() - 1];
  auto const padded = [](std::size_t n) { return (n + list_padding - 1) / list_padding * list_padding; };
  std::vector<std::uint32_t> index;
  Scratch scratch;
  for (std::uint32_t const i : rows) {
    std::uint32_t const before = lengths(list_rings - 1)[i];
    std::size_t offset = 0;
    NearRows out;
    out.offset = &offset;
    out.first = i;
    out.length = length_.data();
    out.rows = size();
    out.marks = marks;
    find(kernel, task, i, i + 1, out, index, scratch);
    if (out.used > padded(before)) {
      replaced_.emplace_back(out.used);
      row_[i] = replaced_.back().data();
    }
    std::copy_n(index.data(), out.used, row_[i]);
    if (!filter_.start.empty()) sift(target, source, i);
  }
}

/// Removes the entries that the filter rejects from a row; later entries move up in their order.
void NeighbourList::sift(SortedCopy const& target, SortedCopy const& source, std::size_t i) {
  std::uint32_t const particle = target.order()[i];
  std::uint32_t const* const first = filter_.index.data() + filter_.start[particle];
  std::uint32_t const* const last = filter_.index.data() + filter_.start[particle + 1];
  if (!filter_.only && first == last) return;
  std::uint32_t* const row = row_[i];
  std::uint32_t read = 0, kept = 0;
  for (int ring = 0; ring < list_rings; ++ring) {
    std::uint32_t& length = length_[static_cast<std::size_t>(ring) * size() + i];
    for (; read < length; ++read) {
      std::uint32_t const partner = source.order()[source.owner(row_of_item(row[read]))];
      if (std::binary_search(first, last, partner) == filter_.only) row[kept++] = row[read];
    }
    length = kept;
  }
  std::fill(row + kept, row + read, item_of_row(source.sentinel()));
}

std::size_t NeighbourList::bytes() const {
  std::size_t total = row_.capacity() * sizeof(row_[0]) + length_.capacity() * sizeof(length_[0]);
  for (auto const& chunk : chunks_) total += chunk.capacity() * sizeof(chunk[0]);
  for (auto const& more : more_)
    for (auto const& chunk : more) total += chunk.capacity() * sizeof(chunk[0]);
  for (auto const& row : replaced_) total += row.capacity() * sizeof(row[0]) + sizeof(row);
  return total;
}

}  // namespace boltzmann
