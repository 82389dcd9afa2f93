// Division: the decomposition of a run's particles over the ranks of a team.
#pragma once

#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/share.hpp>
#include <boltzmann/particles/share_sums.hpp>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace boltzmann {

/// Domain decomposition. Every rank has a row for every particle: row i is particle i everywhere, and all ranks store
/// the owners. The owner advances a particle; other ranks have copies that the owner has sent. Before influences are
/// calculated, owners send the rows that others read (RowExchange). Before any observer runs, all rows are gathered
/// (gather()). No result depends on the owners.
///
/// All calls except queries are for all ranks.
class Division {
 public:
  using Owners = std::vector<std::uint16_t>;  ///< the rank of each particle
  static constexpr int most_ranks = 65536;

  explicit Division(Team& team);
  /// Ends the decomposition: ensembles are whole again.
  ~Division() { end(); }
  Division(Division const&) = delete;
  Division& operator=(Division const&) = delete;

  Team& team() const { return team_; }
  /// Adds an ensemble, in equal parts by particle number until owners are set. All its rows must be current on all
  /// ranks.
  void add(AnyEnsemble& ensemble);
  bool has(AnyEnsemble const& ensemble) const;
  std::vector<AnyEnsemble*> const& ensembles() const { return ensembles_; }
  /// Sets the owners of particles. All rows must be current on all ranks.
  void owners(AnyEnsemble const& ensemble, Owners owners);
  /// Adds ensembles whose particles have the owners of consecutive particles of `leader`, also after changes.
  void follow(AnyEnsemble& leader, std::vector<AnyEnsemble*> const& followers);
  Owners const& owners(AnyEnsemble const& ensemble) const { return part(ensemble).owners; }
  /// Transfers particles among a few ranks. From now on this rank owns `own` (ascending), of which it has everything in
  /// held(). Owners of particles that it reads are to be written to owners_here(). Owners of other particles are
  /// exchanged when needed (make_whole()).
  void take(AnyEnsemble const& ensemble, std::vector<std::uint32_t> const& own);
  Owners& owners_here(AnyEnsemble const& ensemble) { return parts_[place(ensemble)].owners; }
  /// An array with numbers of particles: `count` numbers of particle i, at `numbers` + (i - first) * `stride`, where i
  /// - `first` is less than `size`.
  struct Held {
    double* numbers;
    std::size_t stride, count, first, size;
    double* of(std::size_t i) const { return i - first < size ? numbers + (i - first) * stride : nullptr; }
  };
  /// All state of an ensemble's particles, and of the followers' particles that belong to them, on their owner: rows,
  /// and state that integrators carry.
  std::vector<Held> held(AnyEnsemble const& ensemble) const;
  /// Migrates it: of the particles of this rank, those in to[r] go to rank r. Returns the numbers of the particles that
  /// come from each rank; for this rank itself those that stay. For all ranks.
  std::vector<std::vector<std::uint32_t>> hand_over(AnyEnsemble const& ensemble,
                                                    std::vector<std::vector<std::uint32_t>> to);
  /// Always assigns particle i of an ensemble to the owner of particle with[i]: particles that are advanced together
  /// (rigid molecules) need one owner.
  void keep_together(AnyEnsemble const& ensemble, std::vector<std::uint32_t> const& with);
  /// The number of times that owners have changed.
  std::uint64_t changes() const { return changes_; }

  /// The first neighbour lists that call lead() decide on the owners until the division ends; if other particles follow
  /// the owners of points, it is the lists of these points. The leading lists send the rows of these ensembles to the
  /// ranks that read them.
  void lead(void const* lists, std::vector<AnyEnsemble const*> brought);
  bool leads(void const* lists) const { return leader_ == lists; }
  bool brings(AnyEnsemble const& ensemble) const;
  /// From now on these lists are used too rarely to send rows.
  void brings_nothing() { brought_.clear(); }
  /// Rows that are read besides those in lists, until the division ends: rows(add) calls add(ensemble, i) for each.
  using Add = std::function<void(AnyEnsemble const& ensemble, std::uint32_t i)>;
  void also_read(std::function<void(Add const& add)> rows) { also_read_.push_back(std::move(rows)); }
  void add_also_read(Add const& add) const {
    for (auto const& rows : also_read_) rows(add);
  }
  /// Declares that other code than lists reads the ensembles' rows that lists name, until the division ends.
  void read_rows() { rows_are_read_ = true; }
  /// True if other code than lists reads rows of other ranks.
  bool rows_are_read() const { return rows_are_read_ || needs_all(); }
  /// True if all rows have to be current on all ranks when owners change.
  bool needs_all() const { return several_ || keeps_together_ || !also_read_.empty(); }

  /// begin() requires that all rows are current on all ranks. From then on ensembles have shares
  /// (AnyEnsemble::share()), until end().
  void begin();
  void end();
  bool goes_on() const { return goes_on_; }

  /// Further state of an ensemble's particles, which integrators carry inside a step: arrays, and how many numbers each
  /// has per particle.
  using Carried = std::vector<std::pair<double*, std::size_t>>;
  void carry(std::function<Carried(AnyEnsemble const&)> carried) { carried_ = std::move(carried); }
  /// Registers a callback for all ranks, called when all rows have been gathered, to gather further state of particles.
  void gathers(void const* whose, std::function<void()> gather);
  /// Identifies this division.
  std::uint64_t id() const { return id_; }

  /// While it lives, observers use global sums only (Share::sums).
  class Sums {
   public:
    explicit Sums(Division& of) : division_(of) { division_.add_up_by(&division_.team_); }
    ~Sums() { division_.add_up_by(nullptr); }
    Sums(Sums const&) = delete;
    Sums& operator=(Sums const&) = delete;

   private:
    Division& division_;
  };
  bool sums_suffice() const { return sums_suffice_; }

  /// Invalidates copies: owners have moved particles, so other ranks have old rows.
  void moved() { whole_ = false; }
  /// True if all rows are current on all ranks.
  bool is_whole() const { return whole_; }
  /// Gathers all rows of all ensembles on all ranks, unless they are current.
  void make_whole();
  /// Gathers influences and rates.
  void gather_influences();
  /// Gathers any array: `count` doubles of each particle, at intervals of `stride` doubles.
  void gather(AnyEnsemble const& ensemble, double* numbers, std::size_t stride, std::size_t count);
  /// The minimum of positive numbers over all ranks.
  double least(double mine);
  /// The sum over all ranks.
  std::size_t sum(std::size_t mine);
  /// Replaces sums by those over all ranks. All ranks throw if one has failed before.
  void sum(std::span<ExactSum> mine) { add_up(team_, mine); }
  void sum(ExactSum& mine) { sum({&mine, 1}); }

 private:
  struct Part {
    Owners owners;
    Share share;
    std::vector<std::vector<Stretch>> of_rank;
    std::vector<std::size_t> sizes;
    std::vector<AnyEnsemble*> followers;
    bool owners_known = true;         // of all particles
    std::vector<std::uint32_t> with;  // see keep_together(): with[i] <= i; empty: no groups
  };
  std::size_t place(AnyEnsemble const& ensemble) const;
  Part const& part(AnyEnsemble const& ensemble) const { return parts_[place(ensemble)]; }
  void divide(Part& part);
  void learn_owners(Part& part);
  void join(Part& part) const;
  void add_up_by(Team* team) {
    sums_suffice_ = team != nullptr;
    for (auto& part : parts_) part.share.sums = team;
  }

  Team& team_;
  std::vector<AnyEnsemble*> ensembles_;
  std::deque<Part> parts_;  // a deque, as ensembles point to the shares
  bool goes_on_ = false, whole_ = true, sums_suffice_ = false;
  std::function<Carried(AnyEnsemble const&)> carried_;
  std::vector<std::pair<void const*, std::function<void()>>> gathers_;
  std::uint64_t id_, changes_ = 0;
  void const* leader_ = nullptr;
  AnyEnsemble const* points_ = nullptr;  // which others follow
  std::vector<AnyEnsemble const*> brought_;
  std::vector<std::function<void(Add const&)>> also_read_;
  bool several_ = false, keeps_together_ = false, rows_are_read_ = false;
  std::vector<std::vector<double>> sent_, received_;  // of each rank
};

/// A plan for repeated exchanges of particles' numbers: one message between two ranks, for all ensembles together.
class RowExchange {
 public:
  /// The rows that this rank reads from others: for each ensemble the numbers of particles that it does not own. For
  /// all ranks.
  struct Needed {
    AnyEnsemble* ensemble;
    std::vector<std::uint32_t> numbers;
  };
  void plan(Division& division, std::vector<Needed> needed);

  /// Owners send rows to the same rows of the ensembles on other ranks. For all ranks.
  void bring_rows(Division& division);
  /// The same for the first numbers[e] of each row; calls take(e, rank, from), where from[0] is the first number of the
  /// first particle of received(e, rank).
  using Take = std::function<void(std::size_t e, std::size_t rank, double const* from)>;
  void bring_rows(Division& division, std::vector<std::size_t> const& numbers, Take const& take);
  std::vector<std::uint32_t> const& received(std::size_t e, std::size_t rank) const { return receives_[rank][e]; }
  /// The same for any numbers: give(e, i, to) writes `count(e)` doubles of particle i of ensemble e (in the order of
  /// the plan) on the owner, and take(e, i, from) reads them on the receiving rank.
  template <class Count, class Give, class Take>
  void bring(Division& division, Count const& count, Give const& give, Take const& take) {
    auto const over = [&](Numbers const& numbers, auto* at, auto const& copy) {
      for (std::size_t e = 0; e < numbers.size(); ++e)
        for (auto const i : numbers[e]) copy(e, i, at), at += count(e);
    };
    division.team().exchange(
        sizes(sends_, count), sizes(receives_, count), [&](std::size_t r, double* to) { over(sends_[r], to, give); },
        [&](std::size_t r, double const* from) { over(receives_[r], from, take); });
  }

 private:
  using Numbers = std::vector<std::vector<std::uint32_t>>;  // of each ensemble
  template <class Count>
  static std::vector<std::size_t> sizes(std::vector<Numbers> const& of_ranks, Count const& count) {
    std::vector<std::size_t> sizes(of_ranks.size());
    for (std::size_t r = 0; r < of_ranks.size(); ++r)
      for (std::size_t e = 0; e < of_ranks[r].size(); ++e) sizes[r] += of_ranks[r][e].size() * count(e);
    return sizes;
  }

  std::vector<AnyEnsemble*> ensembles_;
  std::vector<Numbers> sends_, receives_;  // to and from each rank
};

}  // namespace boltzmann
