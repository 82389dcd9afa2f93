// Decides whether lists are valid, how far they are read, and what is rebuilt otherwise.
#include <boltzmann/core/threads.hpp>
#include <boltzmann/neighbours/neighbourhood.hpp>

#include <boltzmann/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr double skin_of_cutoff = 0.12;
// If fewer particles than these are within reach in 1D, 2D and 3D (1.8 mean distances), builds cost more than longer
// lists. Then the skin is chosen to reach this number, up to this fraction of the cut-off.
constexpr double neighbours_in_reach[] = {3.6, 10, 24};
constexpr double longest_skin_of_cutoff = 0.75;
// Lists around particles that have moved further than all others are rebuilt alone, while that costs at most these
// fractions of a full build. The smaller one applies at any time, to read lists less far; the larger one if lists would
// become invalid.
constexpr double share_of_few = 0.005, share_of_some = 0.25;
constexpr std::size_t max_moved = 256;

void check_cutoff(double cutoff) {
  if (!(cutoff > 0) || !std::isfinite(cutoff))
    throw Error(fmt::format("the cut-off of a neighbour list is a positive length, not {}", cutoff));
}

}  // namespace

std::string skin_refused(double cutoff, double skin) {
  constexpr double most = 4;
  if (skin <= most * cutoff) return "";
  return fmt::format("the skin {:.6g} is more than {} cut-offs of {:.6g}: lists would hold {:.3g} times the neighbours",
                     skin, most, cutoff, std::pow(1 + skin / cutoff, 3));
}

Neighbourhood::~Neighbourhood() {
  if (divided()) division_->gathers(this, {});
}

std::size_t Neighbourhood::add(AnyEnsemble& target, AnyEnsemble& source, double cutoff, PairFilter filter,
                               bool positions_alone) {
  check_cutoff(cutoff);
  if (!positions_alone) copy(source);
  for (std::size_t n = 0; n < lists_.size(); ++n)
    if (&lists_[n].target->ensemble() == &target && &lists_[n].source->ensemble() == &source &&
        lists_[n].cutoff == cutoff && lists_[n].list.filter() == filter)
      return n;
  if (!filter.start.empty() && (&target != &source || filter.start.size() != target.size() + 1))
    throw Error(fmt::format("a filter of pairs is of the particles of one ensemble, all {} of '{}'", target.size(),
                            target.name()));
  lists_.push_back({&copy_of(target), &copy_of(source), cutoff, {}});
  lists_.back().list.filter(std::move(filter));
  stale_ = true;
  return lists_.size() - 1;
}

SortedCopy& Neighbourhood::copy_of(AnyEnsemble& ensemble, std::size_t extra_blocks) {
  for (auto& copy : copies_)
    if (&copy.ensemble() == &ensemble) return copy;
  stale_ = true;
  own_.emplace_back();
  shares_.emplace_back();
  cuts_.emplace_back();
  SortedCopy& made = copies_.emplace_back(ensemble, *box_, extra_blocks);
  made.positions_alone(true);
  return made;
}

std::vector<Stretch> const& Neighbourhood::own(SortedCopy const& copy) const {
  std::size_t e = 0;
  while (&copies_[e] != &copy) ++e;
  return own_[e];
}

void Neighbourhood::cutoff(std::size_t list, double length) {
  check_cutoff(length);
  if (lists_[list].cutoff == length) return;
  lists_[list].cutoff = length;
  stale_ = true;
}

void Neighbourhood::skin(double length) {
  if (!(length >= 0) || !std::isfinite(length))
    throw Error(fmt::format("the skin is a length of zero or more, not {}", length));
  skin_ = length;
  stale_ = true;
}

double Neighbourhood::skin() const {
  if (skin_) return *skin_;
  return skin_of_cutoff * (std::isfinite(cutoff_) ? cutoff_ : longest_cutoff());
}

double Neighbourhood::longest_cutoff() const {
  double longest = 0;
  for (auto const& list : lists_) longest = std::max(longest, list.cutoff);
  return longest;
}

double Neighbourhood::rows_around_one() const {
  std::size_t targets = 0;
  for (auto const& list : lists_) targets += list.list.size();
  // The neighbours at the old and at the new place, and the cost of finding them.
  return 2.0 * static_cast<double>(entries_) / static_cast<double>(targets + 1) + 20;
}

void Neighbourhood::build(int threads) {
  if (auto line = skin_refused(longest_cutoff(), skin()); !line.empty()) throw Error(line);
  double const reach = longest_cutoff() + skin();
  if (!divided() || !build_in_parts(threads)) {
    if (divided()) division_->make_whole();
    for (auto& copy : copies_) copy.build(reach, threads_for(copy.ensemble().size(), 1, threads));
    if (divided()) share_out();
  }
  find_neighbours(threads);
  if (!skin_) choose_skin(threads);
}

/// Chooses it for the density around the particles, as the first lists show it. The skin is kept, even if the density
/// changes.
void Neighbourhood::choose_skin(int threads) {
  double const reach = longest_cutoff() + skin();
  std::size_t neighbours = 0;
  double particles = 0, longest = (1 + longest_skin_of_cutoff) * longest_cutoff();
  for (auto const& list : lists_)
    for (std::size_t i = 0; i < list.list.size(); ++i) neighbours += list.list.lengths(list_rings - 1)[i];
  auto const entries = static_cast<double>(sum(neighbours));
  for (auto const& copy : copies_) particles += static_cast<double>(copy.owned());
  int const D = box_->dimension();
  for (int a = 0; a < D; ++a)
    if (box_->periodic(a)) longest = std::min(longest, 0.5 * box_->length(a));
  double const found = entries / particles, wanted = neighbours_in_reach[D - 1];
  double const longer = std::min(found > 0 ? reach * std::pow(wanted / found, 1.0 / D) : longest, longest);
  bool const again = found < wanted && longer > reach;
  skin_ = again ? longer - longest_cutoff() : skin();
  if (!again) return;
  --builds_;
  build(threads);
}

void Neighbourhood::find_neighbours(int threads) {
  if (!divided())
    for (std::size_t e = 0; e < copies_.size(); ++e) own_[e] = {{0, copies_[e].owned()}};
  complete_ = !divided();
  begin_marks();
  std::size_t entries = 0;
  for (auto& list : lists_) {
    list.list.build(*list.target, *list.source, list.cutoff, skin(), own(*list.target),
                    threads_for(list.target->owned(), 4, threads), marks(list.source));
    entries += list.list.entries();
  }
  entries_ = divided() ? take_work(entries) : entries;
  stale_ = false;
  ring_ = 0;
  found_again_ = 0;
  ++builds_;
  ++version_;
}

void Neighbourhood::move(std::vector<Moved> const& moved) {
  std::vector<std::vector<std::uint32_t>> affected(lists_.size());
  // Rows whose lists name a moved particle, or should: those near its reference, before and after.
  auto const look_around = [&] {
    for (std::size_t n = 0; n < lists_.size(); ++n)
      for (auto const& [copy, rows] : moved)
        if (copy == lists_[n].source)
          for (auto const row : rows)
            lists_[n].target->owned_near(copy->references() + 4 * std::size_t{row}, lists_[n].cutoff + skin(),
                                         affected[n]);
  };
  look_around();
  for (auto const& [copy, rows] : moved) copy->move(rows);
  look_around();
  for (std::size_t n = 0; n < lists_.size(); ++n) {
    List& list = lists_[n];
    auto& rows = affected[n];
    for (auto const& [copy, own] : moved)
      if (copy == list.target) rows.insert(rows.end(), own.begin(), own.end());
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    if (divided()) std::erase_if(rows, [&](std::uint32_t row) { return !is_own(*list.target, row); });
    found_again_ += static_cast<double>(sum(rows.size()));
    list.list.rebuild(*list.target, *list.source, rows, marks(list.source));
  }
  ++moves_;
}

double Neighbourhood::largest_displacement2() const {
  double largest2 = 0;
  for (auto const& copy : copies_) largest2 = std::max(largest2, copy.largest2());
  return largest2;
}

/// Gives new references to rows that are further than sqrt(square) from theirs, if there are at most `most`.
bool Neighbourhood::move_beyond(double square, std::size_t most) {
  std::vector<Moved> moved;
  std::size_t count = 0;
  for (auto& copy : copies_) {
    auto rows = copy.beyond(square, most);
    count += rows ? rows->size() : most + 1;
    moved.push_back({&copy, std::move(rows).value_or(std::vector<std::uint32_t>())});
  }
  count = sum(count);
  if (count > most) return false;
  if (count == 0) return true;
  if (divided()) tell_moved(moved);
  move(moved);
  if (divided()) follow_others();
  return true;
}

/// Chooses how far lists are read, for the current displacements. Rebuilds lists around a few particles that are ahead
/// of all others (a knock-on atom). False if the lists are no longer valid.
bool Neighbourhood::lists_hold(double largest2) {
  double all = 0;
  std::size_t moved_before = 0;
  for (auto const& copy : copies_) {
    all += static_cast<double>(copy.owned());
    moved_before += copy.moved().size();
  }
  // Every target tests the moved particles: allow some, until a full build is cheaper.
  bool const may_move = moved_before < max_moved && found_again_ < all;
  auto const affordable = [&](double share) {
    return may_move ? std::min(static_cast<std::size_t>(share * all / rows_around_one()), max_moved - moved_before) : 0;
  };
  std::size_t const few = affordable(share_of_few);
  for (int ring = 0; ring < list_rings; ++ring) {
    // A pair beyond this ring is further apart than the cut-off if neither particle has moved further.
    double const allowed = 0.5 * skin() * (ring + 1) / list_rings;
    if (largest2 <= allowed * allowed || (few > 0 && move_beyond(allowed * allowed, few))) {
      ring_ = ring;
      return true;
    }
  }
  ring_ = list_rings - 1;
  std::size_t const some = affordable(share_of_some);
  double const soon = 0.35 * skin();
  return some > few && move_beyond(soon * soon, some);
}

/// True if the particles of this rank have not moved since the last refresh.
bool Neighbourhood::is_current() const {
  return std::all_of(copies_.begin(), copies_.end(), [](auto const& copy) { return copy.is_current(); });
}

void Neighbourhood::refresh(int threads) {
  if (lists_.empty()) return;
  find_resized();
  if (divided())
    refresh_together(threads);
  else
    refresh_alone(threads);
  others_rest_ = true;
}

void Neighbourhood::refresh_alone(int threads) {
  if (is_part() && !stale_) become_whole(threads);
  if (!stale_ && (!follow(threads) || lists_hold(largest_displacement2()))) return complete(threads);
  build(threads);
  follow(threads);
}

/// Lists are invalid if the number of particles, or the set of walls, has changed.
void Neighbourhood::find_resized() {
  for (auto& copy : copies_)
    if (!copy.built_for_these()) stale_ = true;
}

/// `others`: rows of other ranks are copied from the ensembles here, too.
bool Neighbourhood::follow(int threads, bool others) {
  bool changed = false;
  for (auto& copy : copies_)
    if (copy.refresh(threads_for(copy.owned(), 1, threads), others)) changed = true;
  return changed;
}

// Contents: whether lists are stale, whether the ring was chosen for the current positions, the ring, the number of
// rebuilt rows, and the skin if it was chosen. For each sorted copy: the edges of the box, the slide of a sheared one,
// the references at its build, and for each particle that was moved since its number and reference.
std::vector<double> Neighbourhood::state() const {
  bool stale = stale_;  // numbers of particles may have changed since
  for (auto const& copy : copies_) stale = stale || copy.owned() != copy.ensemble().size();
  bool const decided = others_rest_ && is_current();
  std::vector<double> state{stale ? 1.0 : 0.0, decided ? 1.0 : 0.0, static_cast<double>(ring_), found_again_,
                            skin_.value_or(-1)};
  for (auto const& copy : copies_) {
    auto const& edges = copy.built_edges();
    state.insert(state.end(), edges.begin(), edges.end());
    if (box_->sheared()) state.push_back(copy.built_slide());
    auto const built = copy.built_references();
    state.insert(state.end(), built.begin(), built.end());
    state.push_back(static_cast<double>(copy.moved().size()));
    for (auto const row : copy.moved()) {
      state.push_back(copy.order()[row]);
      double const* reference = copy.references() + 4 * std::size_t{row};
      state.insert(state.end(), reference, reference + 3);
    }
  }
  return state;
}

void Neighbourhood::restore(std::span<double const> state, int threads) {
  std::size_t at = 0;
  auto const next = [&](std::size_t count) {
    if (at + count > state.size())
      throw Error(
          fmt::format("the checkpoint's neighbour lists have {} numbers, too few for this simulation", state.size()));
    at += count;
    return state.subspan(at - count, count);
  };
  auto const head = next(5);
  stale_ = head[0] != 0;
  others_rest_ = true;
  if (head[4] >= 0) skin_ = head[4];
  if (stale_ || lists_.empty()) return;
  double const reach = longest_cutoff() + skin();
  for (auto& copy : copies_) {
    Box::Edges edges;
    std::ranges::copy(next(edges.size()), edges.begin());
    double const slide = box_->sheared() ? next(1)[0] : 0;
    copy.build(reach, next(copy.ensemble().size() * box_->dimension()), edges, slide);
    auto const row_of = copy.rows_by_number();
    std::vector<std::uint32_t> rows;
    std::vector<double> references;
    for (auto count = static_cast<std::size_t>(next(1)[0]); count > 0; --count) {
      auto const moved = next(4);
      if (!(moved[0] >= 0 && moved[0] < static_cast<double>(row_of.size())))
        throw Error(fmt::format("the checkpoint's neighbour lists name particle {} of '{}', which has {}", moved[0],
                                copy.ensemble().name(), row_of.size()));
      rows.push_back(row_of[static_cast<std::size_t>(moved[0])]);
      references.insert(references.end(), moved.begin() + 1, moved.end());
    }
    copy.move(rows, references);
  }
  find_neighbours(threads);
  if (head[1] != 0)
    for (auto& copy : copies_) copy.refresh(1);
  ring_ = static_cast<int>(head[2]);
  found_again_ = head[3];
}

std::size_t Neighbourhood::bytes() const {
  std::size_t bytes = 0;
  for (auto const& copy : copies_) bytes += copy.bytes();
  for (auto const& list : lists_) bytes += list.list.bytes();
  return bytes;
}

}  // namespace boltzmann
