// Neighbourhood: sorted copies of ensembles and the neighbour lists between them, kept up to date while particles move.
#pragma once

#include <boltzmann/neighbours/neighbour_list.hpp>
#include <boltzmann/neighbours/sorted_copy.hpp>
#include <boltzmann/particles/division.hpp>
#include <boltzmann/particles/work_shares.hpp>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

/// Why lists of this cut-off can't have so long a skin, in one line; empty if they can.
std::string skin_refused(double cutoff, double skin);

/// One sorted copy for each ensemble, and lists between them, each with a cut-off of its own. Lists reach cutoff +
/// skin; they are built anew when particles have moved too far for that, and around a few particles that are ahead of
/// all others (knock-on atoms) neighbours are found anew alone.
class Neighbourhood {
 public:
  /// The box outlives the neighbourhood. `cutoff` is what the default skin, 0.12 of a cut-off, is a share of; without
  /// it, that is the longest cut-off of the lists. Where so few particles are within reach that builds would cost more
  /// than longer lists (soft spheres, polymers), the first build chooses a longer one.
  explicit Neighbourhood(Box const& box, double cutoff = std::numeric_limits<double>::infinity())
      : box_(&box), cutoff_(cutoff) {}
  ~Neighbourhood();
  Neighbourhood(Neighbourhood const&) = delete;
  Neighbourhood& operator=(Neighbourhood const&) = delete;

  /// A list of the neighbours of every particle of `target` among those of `source`; returns its number, that of an
  /// equal list if there is one. Error if the cut-off is not a positive length.
  std::size_t add(AnyEnsemble& target, AnyEnsemble& source, double cutoff) { return add(target, source, cutoff, {}); }
  /// The same but for pairs that a filter does not let through. Error if it is not of as many particles, or of two
  /// ensembles. `positions_alone`: whoever uses the list reads no other fields of the source.
  std::size_t add(AnyEnsemble& target, AnyEnsemble& source, double cutoff, PairFilter filter,
                  bool positions_alone = false);
  /// The sorted copy of an ensemble, made when it is first asked for, with so many extra blocks (see SortedCopy): for
  /// whoever reads all of its rows.
  SortedCopy& copy(AnyEnsemble& ensemble, std::size_t extra_blocks = 0) {
    SortedCopy& all = copy_of(ensemble, extra_blocks);
    all.positions_alone(false);
    return all;
  }
  /// Whether there is one.
  bool has(AnyEnsemble const& ensemble) const {
    for (auto const& copy : copies_)
      if (&copy.ensemble() == &ensemble) return true;
    return false;
  }
  /// Changes the cut-off of a list: all lists are built anew at the next refresh.
  void cutoff(std::size_t list, double length);
  double cutoff(std::size_t list) const { return lists_[list].cutoff; }
  /// How far particles may move before lists are built anew. Error if it is not a length of zero or more.
  void skin(double length);
  double skin() const;
  /// Lists are built anew at the next refresh.
  void stale() { stale_ = true; }

  /// From here on lists are of the rows of this rank's share alone, and builds give each rank a part of space; null: no
  /// more, and what is known stays. For all ranks. Everything that asks for lists is for all ranks then, too.
  void divide(Division* division, int threads);
  /// Whoever does rows in their order does less where those of a rank are one stretch: they get columns of space only
  /// where layers would know much more.
  void keep_together() { columns_worth_ = 0.6; }
  /// Rows that are read besides those in lists: add(ensemble, i) tells a particle; asked for after each build.
  using AlsoRead = std::function<void(std::function<void(AnyEnsemble const& ensemble, std::uint32_t i)> const& add)>;
  void also_read(AlsoRead also) { also_read_ = std::move(also); }  // none: builds need not know all particles
  /// The rows of a target whose lists there are: all, or those of this rank's share.
  std::vector<Stretch> const& own(SortedCopy const& copy) const;

  /// Calls function(begin, end) for ranges of so many of them or fewer, on so many threads.
  template <class Function>
  void over_own(SortedCopy const& copy, std::size_t grain, int threads, Function const& function) const {
    auto const& rows = own(copy);
    if (rows.size() == 1 && rows[0].begin == 0) return for_ranges(rows[0].end, grain, threads, function);
    std::vector<Stretch> parts;
    for (auto const& [begin, end] : rows)
      for (std::size_t first = begin; first < end; first += grain)
        parts.push_back({first, std::min(first + grain, end)});
    for_stretches(parts, threads, [&](Stretch const* part, Stretch const* last) {
      for (; part != last; ++part) function(part->begin, part->end);
    });
  }
  /// So many numbers of a copy's rows come from their owners to those who read them: give(row, to) writes them there,
  /// take(row, from) gets them here. For all ranks.
  template <class Give, class Take>
  void bring(SortedCopy const& copy, std::size_t count, Give const& give, Take const& take) {
    exchange_.bring(
        *division_, [&](std::size_t e) { return &copies_[e] == &copy ? count : 0; },
        [&](std::size_t e, std::uint32_t i, double* to) {
          if (&copies_[e] == &copy) give(row_of_[e][i], to);
        },
        [&](std::size_t e, std::uint32_t i, double const* from) {
          if (&copies_[e] == &copy) take(row_of_[e][i], from);
        });
  }
  /// The same of blocks [first, last).
  void bring_blocks(SortedCopy& copy, std::size_t first, std::size_t last);

  /// Mirrors take the ensembles' rows of now. Afterwards every pair within the cut-off is in its list, no further than
  /// ring(). PhysicsFailure if a position is not finite.
  void refresh(int threads);

  bool empty() const { return lists_.empty(); }
  NeighbourList const& list(std::size_t list) const { return lists_[list].list; }
  SortedCopy const& target(std::size_t list) const { return *lists_[list].target; }
  SortedCopy const& source(std::size_t list) const { return *lists_[list].source; }
  /// How far lists are to be read: the argument of NeighbourList::lengths().
  int ring() const { return ring_; }

  /// What, besides the particles, determines the order of neighbours and how far lists are read; restore() takes it
  /// back. Error if it does not fit.
  std::vector<double> state() const;
  void restore(std::span<double const> state, int threads);

  /// How often lists were built, and how often neighbours were found anew around fast particles alone.
  std::size_t builds() const { return builds_; }
  /// Changes whenever rows, images or lists are others than before, by a build or otherwise; moves apart.
  std::size_t version() const { return version_; }
  std::size_t moves() const { return moves_; }
  std::size_t bytes() const;

 private:
  struct List {
    SortedCopy *target, *source;
    double cutoff;
    NeighbourList list;
  };
  struct Moved {  // rows of a sorted copy that need new references
    SortedCopy* copy;
    std::vector<std::uint32_t> rows;
  };

  bool divided() const { return division_ != nullptr; }
  SortedCopy& copy_of(AnyEnsemble& ensemble, std::size_t extra_blocks = 0);
  void find_resized();
  bool follow(int threads, bool others = true);
  bool lists_hold(double largest2);
  bool move_beyond(double square, std::size_t most);
  void move(std::vector<Moved> const& moved);
  void build(int threads);
  void choose_skin(int threads);
  void find_neighbours(int threads);
  std::size_t sum(std::size_t mine) const { return divided() ? division_->sum(mine) : mine; }
  double largest_displacement2() const;

  // divided_neighbourhood.cpp: over the ranks of a team.
  void refresh_together(int threads);
  void follow_others();
  bool bring_rows();
  bool is_own(SortedCopy const& copy, std::uint32_t row) const;
  void share_out();
  void take_shares();
  void take_over(int threads);
  void find_needed(int threads);
  std::vector<std::vector<char>> rows_in_lists(int threads) const;
  void begin_marks();
  char* marks(SortedCopy const* source);
  void complete(int threads);
  WorkShares::Cuts const& cut(std::size_t e);
  static std::size_t work_around(SortedCopy const& copy, std::size_t own);
  std::size_t take_work(std::size_t entries);
  bool is_part() const { return !copies_.empty() && copies_.front().is_part(); }

  // build_in_parts.cpp: the same where no rank knows all particles.
  struct Sorting;
  bool build_in_parts(int threads);
  void agree_on_extents(std::vector<Sorting>& all, double reach);
  bool agree_on_order(std::vector<Sorting>& all, double reach);
  void find_who_reads(std::vector<Sorting>& all, double reach) const;
  std::vector<std::vector<std::uint32_t>> readers(Sorting const& one) const;
  void build_part(Sorting const& one, std::vector<std::uint32_t> numbers, std::size_t e, double reach, int threads);
  void become_whole(int threads);
  void tell_moved(std::vector<Moved>& moved);
  /// How far beyond what its lists need a rank knows particles.
  double margin() const { return skin(); }
  bool is_current() const;
  void gather_others();
  void refresh_alone(int threads);

  double rows_around_one() const;
  double longest_cutoff() const;

  Box const* box_;
  double cutoff_;
  std::optional<double> skin_;
  bool stale_ = true;
  int ring_ = 0;
  double found_again_ = 0;   // rows found anew since the lists were built
  std::size_t entries_ = 0;  // of all lists, on all ranks, at the build
  std::size_t builds_ = 0, moves_ = 0, version_ = 0;
  Division* division_ = nullptr;                   // while a run is divided
  std::uint64_t last_division_ = 0, changes_ = 0;  // of owners, when shares were taken
  std::deque<WorkShares> shares_;                  // of the rows of each copy
  std::deque<WorkShares::Cuts> cuts_;              // where those of ranks begin, since the last build; empty: columns
  double columns_worth_ = 0.95;                    // as much of what layers know
  AlsoRead also_read_;
  RowExchange exchange_;
  bool complete_ = true;          // every row has its lists
  bool references_known_ = true;  // of all particles, where sorted copies are parts
  bool others_rest_ = true;       // nothing that others advance has moved since the last refresh, as far as is known
  std::deque<SortedCopy> copies_;
  std::deque<std::vector<Stretch>> own_;            // rows of each copy, of which there are lists
  std::vector<std::vector<char>> marks_;            // of rows of each copy: they may be in lists; none: not known
  std::vector<std::vector<std::uint32_t>> row_of_;  // of each particle in each copy, while a run is divided
  std::vector<std::vector<std::vector<std::uint32_t>>> received_rows_;  // of each copy, from each rank
  std::deque<List> lists_;
};

}  // namespace boltzmann
