// Shares of ranks, and the messages that carry rows between them.
#include <boltzmann/core/error.hpp>
#include <boltzmann/particles/division.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstring>
#include <numeric>

namespace boltzmann {
namespace {

/// The sizes of what each rank sends to each: [from][to].
std::vector<std::vector<std::uint64_t>> all_sizes(Team& team, std::vector<std::uint64_t> const& mine) {
  std::string const bytes(reinterpret_cast<char const*>(mine.data()), mine.size() * sizeof mine[0]);
  std::vector<std::vector<std::uint64_t>> all;
  for (auto const& row : team.gather(bytes)) {
    all.emplace_back(row.size() / sizeof(std::uint64_t));
    std::memcpy(all.back().data(), row.data(), row.size());
  }
  return all;
}

/// Copies the remainder, which is too short for a call of memcpy.
double* copy_few(double const* from, std::size_t count, double* to) {
  for (; count >= 4; count -= 4, from += 4, to += 4) std::memcpy(to, from, 4 * sizeof(double));
  if (count > 0) *to++ = from[0];
  if (count > 1) *to++ = from[1];
  if (count > 2) *to++ = from[2];
  return to;
}

/// Copies the first `count` numbers of the rows of these particles to `to`; returns their end.
double* pack(std::vector<std::uint32_t> const& particles, AnyEnsemble const& ensemble, std::size_t count, double* to) {
  constexpr std::size_t ahead = 12;
  std::size_t const size = particles.size(), stride = ensemble.stride();
  double const* const rows = size == 0 ? nullptr : ensemble.row(0);
  auto const each = [&](auto const& copy) {
    std::size_t n = 0;
    for (; n + ahead < size; ++n, to += count) {
      __builtin_prefetch(rows + stride * particles[n + ahead]);
      copy(rows + stride * particles[n]);
    }
    for (; n < size; ++n, to += count) copy(rows + stride * particles[n]);
  };
  if (count == row_block)
    each([&](double const* row) { std::memcpy(to, row, row_block * sizeof(double)); });
  else
    each([&](double const* row) { copy_few(row, count, to); });
  return to;
}

}  // namespace

Division::Division(Team& team) : team_(team) {
  static std::atomic<std::uint64_t> made{0};
  id_ = ++made;
}

void Division::add(AnyEnsemble& ensemble) {
  if (has(ensemble)) return;
  auto const ranks = static_cast<std::size_t>(team_.size());
  std::size_t const size = ensemble.size();
  Part part;
  part.owners.resize(size);
  for (std::size_t r = 0; r < ranks; ++r)
    std::fill(part.owners.begin() + static_cast<std::ptrdiff_t>(size * r / ranks),
              part.owners.begin() + static_cast<std::ptrdiff_t>(size * (r + 1) / ranks), static_cast<std::uint16_t>(r));
  divide(part);
  ensembles_.push_back(&ensemble);
  parts_.push_back(std::move(part));
  if (goes_on_) ensemble.share(&parts_.back().share);
}

bool Division::has(AnyEnsemble const& ensemble) const {
  return std::find(ensembles_.begin(), ensembles_.end(), &ensemble) != ensembles_.end();
}

std::size_t Division::place(AnyEnsemble const& ensemble) const {
  return static_cast<std::size_t>(std::find(ensembles_.begin(), ensembles_.end(), &ensemble) - ensembles_.begin());
}

void Division::divide(Part& part) {
  part.owners_known = true;
  auto const ranks = static_cast<std::size_t>(team_.size());
  part.of_rank.assign(ranks, {});
  part.sizes.assign(ranks, 0);
  part.share.stretches.clear();
  part.share.size = 0;
  for (std::size_t begin = 0, end = 0; begin < part.owners.size(); begin = end) {
    auto const owner = part.owners[begin];
    while (end < part.owners.size() && part.owners[end] == owner) ++end;
    part.of_rank[owner].push_back({begin, end});
    part.sizes[owner] += end - begin;
    if (owner == team_.rank()) part.share.add(begin, end);
  }
}

/// Gives the members of each group (keep_together()) one owner.
void Division::join(Part& part) const {
  auto const join_from = [&](std::size_t first, std::vector<std::uint32_t> const& with) {
    for (std::size_t i = 0; i < with.size(); ++i) part.owners[first + i] = part.owners[first + with[i]];
  };
  join_from(0, part.with);
  for (std::size_t first = 0; auto const* follower : part.followers) {
    join_from(first, this->part(*follower).with);
    first += follower->size();
  }
}

void Division::owners(AnyEnsemble const& ensemble, Owners owners) {
  if (carried_)
    for (auto const& [numbers, count] : carried_(ensemble)) gather(ensemble, numbers, count, count);
  ++changes_;
  Part& part = parts_[place(ensemble)];
  part.owners = std::move(owners);
  join(part);
  divide(part);
  auto first = part.owners.begin();
  for (auto* follower : std::vector(part.followers)) {
    auto const end = first + static_cast<std::ptrdiff_t>(follower->size());
    this->owners(*follower, Owners(first, end));
    first = end;
  }
}

void Division::follow(AnyEnsemble& leader, std::vector<AnyEnsemble*> const& followers) {
  add(leader);
  Part& part = parts_[place(leader)];
  part.followers = followers;
  points_ = &leader;
  owners(leader, part.owners);
}

void Division::take(AnyEnsemble const& ensemble, std::vector<std::uint32_t> const& own) {
  ++changes_;
  Part& part = parts_[place(ensemble)];
  part.owners_known = false;
  part.share.stretches.clear();
  part.share.size = 0;
  for (std::size_t n = 0, next = 0; n < own.size(); n = next) {
    while (next < own.size() && own[next] - own[n] == next - n) ++next;
    part.share.add(own[n], own[n] + (next - n));
  }
  auto at = own.begin();
  std::uint32_t first = 0;
  for (auto* follower : part.followers) {
    auto const size = static_cast<std::uint32_t>(follower->size());
    auto const end = std::lower_bound(at, own.end(), first + size);
    std::vector<std::uint32_t> numbers(at, end);
    for (auto& number : numbers) number -= first;
    take(*follower, numbers);
    first += size;
    at = end;
  }
  whole_ = false;
}

std::vector<Division::Held> Division::held(AnyEnsemble const& ensemble) const {
  std::vector<Held> all;
  auto const add = [&](AnyEnsemble& one, std::size_t first) {
    if (one.size() == 0) return;
    all.push_back({one.row(0), one.stride(), one.doubles(), first, one.size()});
    if (!carried_) return;
    for (auto const& [numbers, count] : carried_(one)) all.push_back({numbers, count, count, first, one.size()});
  };
  add(*ensembles_[place(ensemble)], 0);
  std::size_t first = 0;
  for (auto* follower : part(ensemble).followers) {
    add(*follower, first);
    first += follower->size();
  }
  return all;
}

// One message: particle numbers, as doubles, then the state of each.
std::vector<std::vector<std::uint32_t>> Division::hand_over(AnyEnsemble const& ensemble,
                                                            std::vector<std::vector<std::uint32_t>> to) {
  auto const all_held = held(ensemble);
  auto const ranks = static_cast<std::size_t>(team_.size()), mine = static_cast<std::size_t>(team_.rank());
  std::vector<std::uint64_t> counts(2 * ranks);  // of particles and of doubles
  std::vector<std::size_t> sent(ranks), received(ranks);
  for (std::size_t r = 0; r < ranks; ++r) {
    if (r == mine) continue;
    sent[r] = to[r].size();
    for (auto const& one : all_held)
      for (std::uint32_t const i : to[r]) sent[r] += one.of(i) ? one.count : 0;
    counts[2 * r] = to[r].size();
    counts[2 * r + 1] = sent[r];
  }
  auto const all = all_sizes(team_, counts);
  for (std::size_t r = 0; r < ranks; ++r)
    if (r != mine) received[r] = all[r][2 * mine + 1];
  auto result = to;
  team_.exchange(
      sent, received,
      [&](std::size_t r, double* at) {
        at = std::copy(to[r].begin(), to[r].end(), at);
        for (std::uint32_t const i : to[r])
          for (auto const& one : all_held)
            if (double const* const numbers = one.of(i)) at = copy_few(numbers, one.count, at);
      },
      [&](std::size_t r, double const* from) {
        auto const count = all[r][2 * mine];
        result[r].assign(from, from + count);
        from += count;
        for (std::uint32_t const i : result[r])
          for (auto const& one : all_held)
            if (double* const at = one.of(i)) copy_few(from, one.count, at), from += one.count;
      });
  for (std::size_t r = 0; r < ranks; ++r)
    if (received[r] == 0 && r != mine) result[r].clear();
  return result;
}

void Division::gathers(void const* whose, std::function<void()> gather) {
  std::erase_if(gathers_, [&](auto const& one) { return one.first == whose; });
  if (gather) gathers_.emplace_back(whose, std::move(gather));
}

/// Every rank broadcasts the numbers of its particles.
void Division::learn_owners(Part& part) {
  if (part.owners_known) return;
  std::vector<Stretch> const& mine = part.share.stretches;
  auto const all = team_.gather({reinterpret_cast<char const*>(mine.data()), mine.size() * sizeof mine[0]});
  for (std::size_t r = 0; r < all.size(); ++r) {
    std::vector<Stretch> stretches(all[r].size() / sizeof(Stretch));
    if (!stretches.empty()) std::memcpy(stretches.data(), all[r].data(), all[r].size());
    for (auto const& [begin, end] : stretches)
      std::fill(part.owners.begin() + static_cast<std::ptrdiff_t>(begin),
                part.owners.begin() + static_cast<std::ptrdiff_t>(end), static_cast<std::uint16_t>(r));
  }
  divide(part);
}

void Division::keep_together(AnyEnsemble const& ensemble, std::vector<std::uint32_t> const& with) {
  Part& part = parts_[place(ensemble)];
  keeps_together_ = true;
  std::vector<std::uint32_t> root = part.with;
  if (root.empty()) {
    root.resize(ensemble.size());
    std::iota(root.begin(), root.end(), 0U);
  }
  auto const find = [&](std::uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (std::uint32_t i = 0; i < with.size(); ++i) {
    auto const a = find(i), b = find(with[i]);
    root[std::max(a, b)] = std::min(a, b);
  }
  for (std::uint32_t i = 0; i < root.size(); ++i) root[i] = find(i);
  if (root == part.with) return;
  part.with = std::move(root);
  owners(ensemble, part.owners);
}

void Division::lead(void const* lists, std::vector<AnyEnsemble const*> brought) {
  bool const may = !points_ || std::find(brought.begin(), brought.end(), points_) != brought.end();
  if (!leader_ && may) leader_ = lists;
  if (leader_ == lists)
    brought_ = std::move(brought);
  else
    several_ = true;
}

bool Division::brings(AnyEnsemble const& ensemble) const {
  return std::find(brought_.begin(), brought_.end(), &ensemble) != brought_.end();
}

void Division::begin() {
  for (std::size_t e = 0; e < parts_.size(); ++e) ensembles_[e]->share(&parts_[e].share);
  goes_on_ = whole_ = true;
  leader_ = nullptr;
  points_ = nullptr;
  brought_.clear();
  also_read_.clear();
  several_ = rows_are_read_ = false;
}

void Division::end() {
  if (!goes_on_) return;  // ensembles may already be destroyed
  for (auto* ensemble : ensembles_) ensemble->share(nullptr);
  goes_on_ = false;
}

void Division::make_whole() {
  if (whole_) return;
  team_.meet(Team::Occasion::gathers);
  for (auto* ensemble : ensembles_) gather(*ensemble, ensemble->row(0), ensemble->stride(), ensemble->doubles());
  for (auto const& [whose, gather] : gathers_) gather();
  whole_ = true;
}

void Division::gather_influences() {
  team_.meet(Team::Occasion::gathers);
  for (auto* ensemble : ensembles_) {
    gather(*ensemble, ensemble->influence(0), ensemble->influence_size(), ensemble->influence_size());
    std::size_t const numbers = ensemble->influences().size() - ensemble->size() * ensemble->influence_size();
    if (ensemble->size() == 0) continue;
    std::size_t const rates = numbers / (ensemble->size() * ensemble->rate_stride());
    for (std::size_t k = 0; k < rates; ++k)
      gather(*ensemble, ensemble->rate(k), ensemble->rate_stride(), ensemble->rate_stride());
  }
}

void Division::gather(AnyEnsemble const& ensemble, double* numbers, std::size_t stride, std::size_t count) {
  if (count == 0) return;
  Part& part = parts_[place(ensemble)];
  learn_owners(part);
  auto const ranks = static_cast<std::size_t>(team_.size()), mine = static_cast<std::size_t>(team_.rank());
  received_.resize(ranks);
  sent_.resize(1);
  auto const over = [&](std::size_t rank, double* buffer, auto const& copy) {
    for (auto const& [begin, end] : part.of_rank[rank])
      for (std::size_t i = begin; i < end; ++i, buffer += count) copy(buffer, numbers + i * stride);
  };
  sent_[0].resize(part.sizes[mine] * count);
  over(mine, sent_[0].data(), [&](double* to, double const* from) { copy_few(from, count, to); });
  std::vector<Team::Message> messages;
  for (std::size_t r = 0; r < ranks; ++r) {
    if (r == mine) continue;
    received_[r].resize(part.sizes[r] * count);
    messages.push_back({static_cast<int>(r), true, received_[r].data(), received_[r].size() * sizeof(double)});
    messages.push_back({static_cast<int>(r), false, sent_[0].data(), sent_[0].size() * sizeof(double)});
  }
  team_.exchange(messages);
  for (std::size_t r = 0; r < ranks; ++r)
    if (r != mine) over(r, received_[r].data(), [&](double const* from, double* to) { copy_few(from, count, to); });
}

double Division::least(double mine) {
  auto const bits = std::bit_cast<std::int64_t>(mine);
  return std::bit_cast<double>(~team_.meet(Team::Occasion::gathers, {~bits}).most[0]);
}

std::size_t Division::sum(std::size_t mine) {
  std::array<std::int64_t, 1> number{static_cast<std::int64_t>(mine)};
  team_.sum(number);
  return static_cast<std::size_t>(number[0]);
}

void RowExchange::plan(Division& division, std::vector<Needed> needed) {
  Team& team = division.team();
  auto const ranks = static_cast<std::size_t>(team.size());
  std::size_t const count = needed.size();
  ensembles_.clear();
  sends_.assign(ranks, Numbers(count));
  receives_.assign(ranks, Numbers(count));
  for (std::size_t e = 0; e < count; ++e) {
    ensembles_.push_back(needed[e].ensemble);
    auto const& owners = division.owners(*needed[e].ensemble);
    for (auto const i : needed[e].numbers) receives_[owners[i]][e].push_back(i);
  }
  // Each rank requests the rows that it needs from their owners.
  std::vector<std::uint64_t> sizes;
  for (auto const& from : receives_)
    for (auto const& numbers : from) sizes.push_back(numbers.size());
  auto const all = all_sizes(team, sizes);
  std::vector<Team::Message> messages;
  for (std::size_t r = 0; r < ranks; ++r)
    for (std::size_t e = 0; e < count; ++e) {
      auto& asked = receives_[r][e];
      auto& given = sends_[r][e];
      given.resize(all[r][static_cast<std::size_t>(team.rank()) * count + e]);
      messages.push_back({static_cast<int>(r), false, asked.data(), asked.size() * sizeof asked[0]});
      messages.push_back({static_cast<int>(r), true, given.data(), given.size() * sizeof given[0]});
    }
  team.exchange(messages);
}

void RowExchange::bring_rows(Division& division) {
  std::vector<std::size_t> numbers;
  for (auto const* ensemble : ensembles_) numbers.push_back(ensemble->stride());
  bring_rows(division, numbers, [&](std::size_t e, std::size_t r, double const* from) {
    for (auto const i : receives_[r][e]) {
      copy_few(from, numbers[e], ensembles_[e]->row(i));
      from += numbers[e];
    }
  });
}

void RowExchange::bring_rows(Division& division, std::vector<std::size_t> const& numbers, Take const& take) {
  auto const count = [&](std::size_t e) { return numbers[e]; };
  division.team().exchange(
      sizes(sends_, count), sizes(receives_, count),
      [&](std::size_t r, double* to) {
        for (std::size_t e = 0; e < ensembles_.size(); ++e) to = pack(sends_[r][e], *ensembles_[e], numbers[e], to);
      },
      [&](std::size_t r, double const* from) {
        for (std::size_t e = 0; e < ensembles_.size(); ++e) {
          take(e, r, from);
          from += receives_[r][e].size() * numbers[e];
        }
      });
}

}  // namespace boltzmann
