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

/// The reason why lists of this cut-off can't have this skin, in one line; empty if they can.
std::string skin_refused(double cutoff, double skin);

/// One sorted copy for each ensemble, and lists between them, each with a cut-off of its own. Lists reach cutoff +
/// skin. They are rebuilt when particles have moved too far for that. Around a few particles that are ahead of all
/// others (knock-on atoms) only the lists nearby are rebuilt.
class Neighbourhood {
 public:
  /// The box must outlive the neighbourhood. The default skin is 0.12 of `cutoff`; by default that is the longest
  /// cut-off of the lists. If so few particles are within reach that builds would cost more than longer lists (soft
  /// spheres, polymers), the first build chooses a longer skin.
  explicit Neighbourhood(Box const& box, double cutoff = std::numeric_limits<double>::infinity())
      : box_(&box), cutoff_(cutoff) {}
  ~Neighbourhood();
  Neighbourhood(Neighbourhood const&) = delete;
  Neighbourhood& operator=(Neighbourhood const&) = delete;

  /// A list of the neighbours of every particle of `target` among those of `source`; returns its number, that of an
  /// equal list if there is one. Error if the cut-off is not a positive length.
  std::size_t add(AnyEnsemble& target, AnyEnsemble& source, double cutoff) { return add(target, source, cutoff, {}); }
  /// The same without pairs that a filter rejects. Error if the filter has another number of particles, or the list is
  /// of two ensembles. `positions_alone`: users of the list read no other fields of the source.
  std::size_t add(AnyEnsemble& target, AnyEnsemble& source, double cutoff, PairFilter filter,
                  bool positions_alone = false);
  /// The sorted copy of an ensemble, created at the first call, with this number of extra blocks (see SortedCopy). For
  /// code that reads all of its rows.
  SortedCopy& copy(AnyEnsemble& ensemble, std::size_t extra_blocks = 0) {
    SortedCopy& all = copy_of(ensemble, extra_blocks);
    all.positions_alone(false);
    return all;
  }
  /// True if there is one.
  bool has(AnyEnsemble const& ensemble) const {
    for (auto const& copy : copies_)
      if (&copy.ensemble() == &ensemble) return true;
    return false;
  }
  /// Changes the cut-off of a list; all lists are rebuilt at the next refresh.
  void cutoff(std::size_t list, double length);
  double cutoff(std::size_t list) const { return lists_[list].cutoff; }
  /// Sets the skin: lists reach cutoff + skin, and are rebuilt when particles have moved too far for it. Error if it is
  /// negative or not finite.
  void skin(double length);
  double skin() const;
  /// Invalidates the lists: they are rebuilt at the next refresh.
  void stale() { stale_ = true; }

  /// From here on lists have only the rows that this rank owns, and builds assign each rank a part of space. Null ends
  /// that; valid lists are kept. For all ranks. While divided, all calls that use lists are for all ranks.
  void divide(Division* division, int threads);
  /// For schemes that process rows in their order, and do less work if the rows of a rank are contiguous: ranks get
  /// columns of space only if layers would need many more ghosts.
  void keep_together() { columns_worth_ = 0.6; }
  /// Rows that are read besides those in lists: the callback calls add(ensemble, i) for each; it is called after each
  /// build.
  using AlsoRead = std::function<void(std::function<void(AnyEnsemble const& ensemble, std::uint32_t i)> const& add)>;
  void also_read(AlsoRead also) { also_read_ = std::move(also); }  // null: builds need not have all particles
  /// The rows of a target that have lists: all, or those that this rank owns.
  std::vector<Stretch> const& own(SortedCopy const& copy) const;

  /// Calls function(begin, end) for ranges of at most `grain` of them, on this number of threads.
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
  /// Owners send `count` numbers of a copy's rows to the ranks that read them: give(row, to) writes them on the owner,
  /// take(row, from) reads them on the receiver. For all ranks.
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
  /// The same for blocks [first, last).
  void bring_blocks(SortedCopy& copy, std::size_t first, std::size_t last);

  /// Copies the current rows of the ensembles. Afterwards every pair within the cut-off is in its list, no further than
  /// ring(). PhysicsFailure if a position is not finite.
  void refresh(int threads);

  bool empty() const { return lists_.empty(); }
  NeighbourList const& list(std::size_t list) const { return lists_[list].list; }
  SortedCopy const& target(std::size_t list) const { return *lists_[list].target; }
  SortedCopy const& source(std::size_t list) const { return *lists_[list].source; }
  /// The ring up to which lists have to be read: the argument of NeighbourList::lengths().
  int ring() const { return ring_; }

  /// The state, besides the particles, that determines the order of neighbours and the ring. restore() restores it;
  /// Error if it does not fit.
  std::vector<double> state() const;
  void restore(std::span<double const> state, int threads);

  /// Counts builds of lists; the other: rebuilds around fast particles alone.
  std::size_t builds() const { return builds_; }
  /// Changes whenever rows, images or lists change, by a build or otherwise, except moves.
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

  // build_in_parts.cpp: the same if no rank has all particles.
  struct Sorting;
  bool build_in_parts(int threads);
  void agree_on_extents(std::vector<Sorting>& all, double reach);
  bool agree_on_order(std::vector<Sorting>& all, double reach);
  void find_who_reads(std::vector<Sorting>& all, double reach) const;
  std::vector<std::vector<std::uint32_t>> readers(Sorting const& one) const;
  void build_part(Sorting const& one, std::vector<std::uint32_t> numbers, std::size_t e, double reach, int threads);
  void become_whole(int threads);
  void tell_moved(std::vector<Moved>& moved);
  /// The distance beyond the reach of its lists up to which a rank has particles.
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
  double found_again_ = 0;   // rows rebuilt since the lists were built
  std::size_t entries_ = 0;  // of all lists, on all ranks, at the build
  std::size_t builds_ = 0, moves_ = 0, version_ = 0;
  Division* division_ = nullptr;                   // while a run is divided
  std::uint64_t last_division_ = 0, changes_ = 0;  // changes of owners at the last share-out
  std::deque<WorkShares> shares_;                  // of the rows of each copy
  std::deque<WorkShares::Cuts> cuts_;              // begins of the ranks' rows since the last build; empty: columns
  double columns_worth_ = 0.95;                    // in units of the ghosts of layers
  AlsoRead also_read_;
  RowExchange exchange_;
  bool complete_ = true;          // every row has its lists
  bool references_known_ = true;  // of all particles, if sorted copies are parts
  bool others_rest_ = true;       // no particle of other ranks is known to have moved since the last refresh
  std::deque<SortedCopy> copies_;
  std::deque<std::vector<Stretch>> own_;            // rows of each copy that have lists
  std::vector<std::vector<char>> marks_;            // of rows of each copy: they may be in lists; empty: unknown
  std::vector<std::vector<std::uint32_t>> row_of_;  // of each particle in each copy, while a run is divided
  std::vector<std::vector<std::vector<std::uint32_t>>> received_rows_;  // of each copy, from each rank
  std::deque<List> lists_;
};

}  // namespace boltzmann
