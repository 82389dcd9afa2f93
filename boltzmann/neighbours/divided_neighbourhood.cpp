// Lists over the ranks of a team. Each rank has the lists of a range of all rows, in sorted order. Between builds it
// receives the rows that its lists name. This file builds lists if every rank has all particles; build_in_parts.cpp
// builds them in parts.
#include <boltzmann/neighbours/neighbourhood.hpp>
#include <boltzmann/neighbours/shares_of_space.hpp>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <functional>
#include <numeric>

namespace boltzmann {
namespace {

/// Ranges of marked rows.
std::vector<Stretch> stretches_of(std::vector<char> const& marks) {
  std::vector<Stretch> stretches;
  for (std::size_t begin = 0, end = 0; begin < marks.size(); begin = end) {
    while (end < marks.size() && marks[end] == marks[begin]) ++end;
    if (marks[begin]) stretches.push_back({begin, end});
  }
  return stretches;
}

/// The parts of `all` that are not in `others`; both are ascending.
std::vector<Stretch> without(std::vector<Stretch> const& all, std::vector<Stretch> const& others) {
  std::vector<Stretch> rest;
  auto other = others.begin();
  for (auto [begin, end] : all) {
    for (; other != others.end() && other->begin < end; ++other) {
      if (begin < other->begin) rest.push_back({begin, other->begin});
      begin = std::max(begin, other->end);
      if (other->end > end) break;
    }
    if (begin < end) rest.push_back({begin, end});
  }
  return rest;
}

}  // namespace

void Neighbourhood::divide(Division* division, int threads) {
  if (division) {
    said_shares();  // throws an error of the environment before the run begins
    // A necessary build is noticed at the next refresh, and in states, as on one rank.
    bool const fit = std::all_of(copies_.begin(), copies_.end(),
                                 [](auto const& copy) { return copy.owned() == copy.ensemble().size(); });
    bool const old = stale_ || !fit;
    if (!old && !complete_ && division->id() != last_division_) complete(threads);
    division_ = division;
    last_division_ = division->id();
    division_->gathers(this, [this] { gather_others(); });
    if (lists_.empty()) return;
    std::vector<AnyEnsemble const*> ensembles;
    for (auto const& copy : copies_) ensembles.push_back(&copy.ensemble());
    division_->lead(this, std::move(ensembles));
    if (old) return;
    if (is_part()) {  // no other list changes the owners
      changes_ = division_->changes();
      return;
    }
    if (complete_) share_out();
    take_over(threads);
    complete_ = false;
    return find_needed(threads);
  }
  if (!divided()) return;
  division_->gathers(this, {});
  division_ = nullptr;
  if (is_part()) {
    if (!references_known_) stale_ = true;
    return;
  }
  bool const current = is_current();
  for (auto& copy : copies_) copy.everything();
  if (current && !stale_) follow(threads);  // rows of other ranks have not been refreshed
}

/// Builds the missing lists of rows when a run is no longer divided.
void Neighbourhood::complete(int threads) {
  if (complete_) return;
  if (is_part()) return become_whole(threads);
  marks_.clear();
  for (auto& list : lists_) {
    std::vector<Stretch> missing;
    std::size_t end = 0;
    for (auto const& there : own(*list.target)) {
      if (end < there.begin) missing.push_back({end, there.begin});
      end = there.end;
    }
    if (end < list.target->owned()) missing.push_back({end, list.target->owned()});
    list.list.build_more(*list.target, *list.source, missing, threads);
  }
  for (std::size_t e = 0; e < copies_.size(); ++e) own_[e] = {{0, copies_[e].owned()}};
  complete_ = true;
}

void Neighbourhood::refresh_together(int threads) {
  Team& team = division_->team();
  bool changed = false;
  if (!stale_) {
    if (changes_ != division_->changes()) {  // by other lists
      division_->make_whole();
      take_over(threads);
      find_needed(threads);
    }
    bool placed = false;
    if (!division_->is_whole()) {
      team.meet(Team::Occasion::exchanges);
      placed = bring_rows();
    }
    changed = follow(threads, !placed);
  }
  auto const all =
      team.meet(Team::Occasion::follows, {changed ? 1 : 0, std::bit_cast<std::int64_t>(largest_displacement2())});
  if (!stale_ && (all.most[0] == 0 || lists_hold(std::bit_cast<double>(all.most[1])))) return;
  build(threads);
  find_needed(threads);
  follow(threads);
}

/// Brings the rows that changed lists read up to date. This rank's own rows are current.
void Neighbourhood::follow_others() {
  find_needed(1);
  bool const placed = !division_->is_whole() && bring_rows();
  for (auto& copy : copies_) copy.refresh_others(1, !placed);
}

/// Owners send rows to the ranks that read them. True if they went directly to the sorted copies, so that the ensembles
/// still have old rows: no other code reads them.
bool Neighbourhood::bring_rows() {
  bool const straight = !also_read_ && !division_->rows_are_read() && division_->leads(this) && !box_->sheared();
  if (!straight) {
    exchange_.bring_rows(*division_);
    return false;
  }
  std::vector<std::size_t> numbers;
  for (auto const& copy : copies_) numbers.push_back(row_block * copy.followed_blocks());
  exchange_.bring_rows(*division_, numbers, [this](std::size_t e, std::size_t rank, double const* from) {
    copies_[e].place(received_rows_[e][rank], from);
  });
  return true;
}

/// The beginnings of the ranks' rows, and the end: equal work for each, as measured by earlier lists.
WorkShares::Cuts const& Neighbourhood::cut(std::size_t e) {
  shares_[e].divide(&division_->team());
  return cuts_[e] = shares_[e].balanced(copies_[e].ensemble().size());
}

/// The work for ghosts, particles of other ranks and images, in entries of lists.
std::size_t Neighbourhood::work_around(SortedCopy const& copy, std::size_t own) {
  constexpr std::size_t of_another = 6, of_an_image = 3;
  if (!copy.is_part()) return 0;
  return of_another * (std::max(copy.known(), own) - own) + of_an_image * (copy.total() - copy.owned());
}

/// The entries of all ranks' lists; records the measured work of rows.
std::size_t Neighbourhood::take_work(std::size_t entries) {
  if (!division_->leads(this)) return sum(entries);
  std::vector<WorkShares::Work> mine(copies_.size() + 1);
  mine.back()[0] = entries;
  for (std::size_t e = 0; e < copies_.size(); ++e) {
    if (cuts_[e].empty()) continue;  // not used
    std::size_t own = 0;
    for (auto const& [begin, end] : own_[e]) own += end - begin;
    auto const end_of = [own](std::size_t part) {
      return ((part + 1) * own + WorkShares::parts - 1) / WorkShares::parts;
    };
    auto const of_rows = [&](auto const& work_of) {
      std::size_t n = 0, part = 0, end_of_part = end_of(0);
      for (auto const& [begin, end] : own_[e])
        for (std::size_t k = begin; k < end; ++k, ++n) {
          while (n >= end_of_part) end_of_part = end_of(++part);
          mine[e][part] += work_of(k);
        }
    };
    of_rows([](std::size_t) { return static_cast<std::size_t>(work_of_a_row); });
    for (auto& work : mine[e]) work += work_around(copies_[e], own) / WorkShares::parts;
    for (auto const& list : lists_)
      if (list.target == &copies_[e])
        of_rows([lengths = list.list.lengths(list_rings - 1)](std::size_t k) { return lengths[k]; });
  }
  auto const all = division_->team().gather({reinterpret_cast<char const*>(mine.data()), mine.size() * sizeof mine[0]});
  std::vector<WorkShares::Work> work(all.size());
  auto const of_copy = [&](std::size_t e) {
    for (std::size_t r = 0; r < all.size(); ++r)
      std::memcpy(&work[r], all[r].data() + e * sizeof work[r], sizeof work[r]);
  };
  for (std::size_t e = 0; e < copies_.size(); ++e) {
    if (cuts_[e].empty()) continue;
    of_copy(e);
    shares_[e].took(cuts_[e], work);
  }
  of_copy(copies_.size());
  return std::transform_reduce(work.begin(), work.end(), std::size_t{0}, std::plus{},
                               [](WorkShares::Work const& one) { return std::size_t{one[0]}; });
}

/// Assigns each rank its range of rows, or the owners that other lists have set.
void Neighbourhood::share_out() {
  if (!division_->leads(this)) return take_shares();
  for (std::size_t e = 0; e < copies_.size(); ++e) {
    SortedCopy const& copy = copies_[e];
    Division::Owners owners(copy.owned());
    auto const& cut = this->cut(e);
    for (std::size_t r = 0; r + 1 < cut.size(); ++r)
      for (std::size_t k = cut[r]; k < cut[r + 1]; ++k) owners[copy.order()[k]] = static_cast<std::uint16_t>(r);
    division_->owners(copy.ensemble(), std::move(owners));
  }
  take_shares();
}

/// Gathers further state when all rows are gathered: whether others have moved, and references of a build in parts.
void Neighbourhood::gather_others() {
  if (lists_.empty()) return;
  others_rest_ = sum(is_current() ? 0 : 1) == 0;
  if (!is_part() || references_known_) return;
  auto const D = static_cast<std::size_t>(box_->dimension());
  for (auto& copy : copies_) division_->gather(copy.ensemble(), copy.references_by_number().data(), D, D);
  references_known_ = true;
}

/// Owners have changed: rows that are new to this rank get lists.
void Neighbourhood::take_over(int threads) {
  auto const before = own_;
  take_shares();
  for (auto& list : lists_) {
    std::size_t e = 0;
    while (&copies_[e] != list.target) ++e;
    auto const missing = without(own_[e], before[e]);
    if (!missing.empty()) list.list.build_more(*list.target, *list.source, missing, threads, marks(list.source));
  }
}

void Neighbourhood::take_shares() {
  changes_ = division_->changes();
  for (std::size_t e = 0; e < copies_.size(); ++e) {
    SortedCopy const& copy = copies_[e];
    auto const& owners = division_->owners(copy.ensemble());
    std::vector<char> marks(copy.owned());
    for (std::size_t k = 0; k < marks.size(); ++k)
      marks[k] = owners[copy.order()[k]] == division_->team().rank() ? 1 : 0;
    own_[e] = stretches_of(marks);
  }
}

bool Neighbourhood::is_own(SortedCopy const& copy, std::uint32_t row) const {
  auto const& rows = own(copy);
  auto const after = std::upper_bound(rows.begin(), rows.end(), row,
                                      [](std::uint32_t k, Stretch const& one) { return k < one.begin; });
  return after != rows.begin() && row < std::prev(after)->end;
}

/// In divided runs searches mark the rows that lists read, and some near them.
void Neighbourhood::begin_marks() {
  marks_.clear();
  for (auto const& copy : copies_)
    if (divided()) marks_.emplace_back(copy.total() + 1, 0);
}

char* Neighbourhood::marks(SortedCopy const* source) {
  if (marks_.empty()) return nullptr;
  std::size_t e = 0;
  while (&copies_[e] != source) ++e;
  marks_[e].resize(source->total() + 1);
  return marks_[e].data();
}

/// The rows of each copy, including images, that may be in this rank's lists, if the search has marked them. Otherwise
/// those that are, and the sentinel, with which lists are padded.
std::vector<std::vector<char>> Neighbourhood::rows_in_lists(int threads) const {
  std::vector<std::vector<char>> found = marks_;
  for (std::size_t e = 0; e < found.size(); ++e) found[e].resize(copies_[e].total() + 1);
  if (!found.empty()) return found;
  for (auto const& copy : copies_) found.emplace_back(copy.total() + 1, 0);
  for (auto const& list : lists_) {
    std::size_t e = 0;
    while (&copies_[e] != list.source) ++e;
    char* const in_lists = found[e].data();
    std::uint32_t const* const* const rows = list.list.rows();
    std::uint32_t const* const lengths = list.list.lengths(list_rings - 1);
    over_own(*list.target, 1024, threads, [=](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        for (std::uint32_t const *entry = rows[i], *const last = entry + lengths[i]; entry < last;
             entry += list_padding)
#pragma GCC unroll 8
          for (std::size_t n = 0; n < list_padding; ++n)
            std::atomic_ref(in_lists[row_of_item(entry[n])]).store(1, std::memory_order_relaxed);
    });
  }
  return found;
}

/// Finds the rows of others that this rank reads, and notifies their owners.
void Neighbourhood::find_needed(int threads) {
  row_of_.resize(copies_.size());
  for (std::size_t e = 0; e < copies_.size(); ++e) {
    SortedCopy const& copy = copies_[e];
    row_of_[e].resize(copy.owned());
    std::uint32_t* const row_of = row_of_[e].data();
    std::uint32_t const* const order = copy.order();
    for (std::size_t n = 0; n < copy.known(); ++n) row_of[order[copy.known(n)]] = copy.known(n);
  }
  auto in_lists = rows_in_lists(threads);
  Division::Add const add = [&](AnyEnsemble const& ensemble, std::uint32_t i) {
    for (std::size_t e = 0; e < copies_.size(); ++e)
      if (&copies_[e].ensemble() == &ensemble) in_lists[e][row_of_[e][i]] = 1;
  };
  if (also_read_) also_read_(add);
  if (division_->leads(this)) division_->add_also_read(add);
  std::vector<RowExchange::Needed> needed;
  for (std::size_t e = 0; e < copies_.size(); ++e) {
    SortedCopy& copy = copies_[e];
    char* const read = in_lists[e].data();
    for (std::size_t k = copy.sentinel() + 1, last = copy.total(); k <= last; ++k)
      if (read[k]) read[copy.owner(k)] = 1;
    std::vector<Stretch> rows;
    needed.push_back({const_cast<AnyEnsemble*>(&copy.ensemble()), {}});
    auto& numbers = needed.back().numbers;
    std::uint32_t const* const order = copy.order();
    auto own = own_[e].begin();
    auto const last_own = own_[e].end();
    for (std::size_t n = 0, all = copy.known(); n < all;) {
      std::size_t const k = copy.known(n);
      if (own != last_own && own->begin == k) {  // a new range: all of its rows are known
        n += own->end - own->begin;
        ++own;
        continue;
      }
      ++n;
      if (!read[k]) continue;
      numbers.push_back(order[k]);
      if (!rows.empty() && rows.back().end == k)
        ++rows.back().end;
      else
        rows.push_back({k, k + 1});
    }
    copy.only(own_[e], rows, in_lists[e]);
  }
  exchange_.plan(*division_, std::move(needed));
  received_rows_.assign(copies_.size(), {});
  for (std::size_t e = 0; e < copies_.size(); ++e)
    for (std::size_t r = 0; r < static_cast<std::size_t>(division_->team().size()); ++r) {
      auto const& numbers = exchange_.received(e, r);
      auto& rows = received_rows_[e].emplace_back(numbers.size());
      for (std::size_t n = 0; n < rows.size(); ++n) rows[n] = row_of_[e][numbers[n]];
    }
}

void Neighbourhood::bring_blocks(SortedCopy& copy, std::size_t first, std::size_t last) {
  auto const each = [&](std::uint32_t row, auto const& of_block) {
    for (std::size_t b = first; b < last; ++b) of_block(copy.block(b) + row_block * row, row_block * (b - first));
  };
  bring(
      copy, row_block * (last - first),
      [&](std::uint32_t row, double* to) {
        each(row, [&](double const* block, std::size_t at) { std::copy_n(block, row_block, to + at); });
      },
      [&](std::uint32_t row, double const* from) {
        each(row, [&](double* block, std::size_t at) { std::copy_n(from + at, row_block, block); });
      });
}

}  // namespace boltzmann
