// Division: how the particles of a run are divided over the ranks of a team.
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

/// Every rank has a row for every particle, row i is particle i everywhere, and all ranks know who owns it. Its owner
/// advances it; others have what the owner has sent: before influences are calculated the rows that they read
/// (RowExchange), and before anybody looks all rows (gather()). Nothing that is computed depends on who owns what.
///
/// All calls but the questions are for all ranks.
class Division {
 public:
  using Owners = std::vector<std::uint16_t>;  ///< the rank of each particle
  static constexpr int most_ranks = 65536;

  explicit Division(Team& team);
  /// Ensembles are whole again.
  ~Division() { end(); }
  Division(Division const&) = delete;
  Division& operator=(Division const&) = delete;

  Team& team() const { return team_; }
  /// An ensemble takes part, in equal shares by number until others are told. All its rows are known everywhere.
  void add(AnyEnsemble& ensemble);
  bool has(AnyEnsemble const& ensemble) const;
  std::vector<AnyEnsemble*> const& ensembles() const { return ensembles_; }
  /// From now on particles have these owners. All rows are known everywhere.
  void owners(AnyEnsemble const& ensemble, Owners owners);
  /// Ensembles whose particles have the owners of consecutive particles of `leader`, whatever these become.
  void follow(AnyEnsemble& leader, std::vector<AnyEnsemble*> const& followers);
  Owners const& owners(AnyEnsemble const& ensemble) const { return part(ensemble).owners; }
  /// Particles change hands among a few ranks: from now on this one has those of `own` (ascending), of which it knows all
  /// that is held of a particle (held()), and `owners` of particles that it reads are written in owners_here(). Who has
  /// the others it asks when it has to know (make_whole()).
  void take(AnyEnsemble const& ensemble, std::vector<std::uint32_t> const& own);
  Owners& owners_here(AnyEnsemble const& ensemble) { return parts_[place(ensemble)].owners; }
  /// What is held of particles: `count` numbers of particle i, at `numbers` + (i - first) * `stride`, where i - `first`
  /// is less than `size`.
  struct Held {
    double* numbers;
    std::size_t stride, count, first, size;
    double* of(std::size_t i) const { return i - first < size ? numbers + (i - first) * stride : nullptr; }
  };
  /// All that is held of an ensemble's particles, and of the followers' that they stand for, by whoever advances them:
  /// rows, and what integrators carry.
  std::vector<Held> held(AnyEnsemble const& ensemble) const;
  /// It goes, of particles that this rank has, to[r] to rank r. What comes: the numbers from each rank, and from itself
  /// those that stay. For all ranks.
  std::vector<std::vector<std::uint32_t>> hand_over(AnyEnsemble const& ensemble,
                                                    std::vector<std::vector<std::uint32_t>> to);
  /// From now on particle i of an ensemble has the owner that particle with[i] has, whoever it would be otherwise: what
  /// is advanced as one (rigid molecules) has one owner.
  void keep_together(AnyEnsemble const& ensemble, std::vector<std::uint32_t> const& with);
  /// How often particles have got other owners.
  std::uint64_t changes() const { return changes_; }

  /// Of several neighbour lists one says who owns what, until the division ends: the first that asks, or that of the
  /// points which others follow. It brings the rows of these ensembles to those who read them.
  void lead(void const* lists, std::vector<AnyEnsemble const*> brought);
  bool leads(void const* lists) const { return leader_ == lists; }
  bool brings(AnyEnsemble const& ensemble) const;
  /// From here on it is asked too seldom for that.
  void brings_nothing() { brought_.clear(); }
  /// Rows that are read besides those in lists, until the division ends: rows(add) calls add(ensemble, i) for each.
  using Add = std::function<void(AnyEnsemble const& ensemble, std::uint32_t i)>;
  void also_read(std::function<void(Add const& add)> rows) { also_read_.push_back(std::move(rows)); }
  void add_also_read(Add const& add) const {
    for (auto const& rows : also_read_) rows(add);
  }
  /// Somebody besides lists reads the ensembles' rows of those that lists name, until the division ends.
  void read_rows() { rows_are_read_ = true; }
  /// Whether anybody but lists reads rows of others.
  bool rows_are_read() const { return rows_are_read_ || needs_all(); }
  /// Whether all rows have to be known everywhere where particles get other owners.
  bool needs_all() const { return several_ || keeps_together_ || !also_read_.empty(); }

  /// From here on, where all rows are known everywhere, ensembles know their shares; and none any more, until it begins
  /// again.
  void begin();
  void end();
  bool goes_on() const { return goes_on_; }

  /// What else is held of an ensemble's particles, by integrators inside a step: where, and how many numbers of each.
  using Carried = std::vector<std::pair<double*, std::size_t>>;
  void carry(std::function<Carried(AnyEnsemble const&)> carried) { carried_ = std::move(carried); }
  /// Called where all rows have come to all ranks, by all of them: what else is known of particles comes along.
  void gathers(void const* whose, std::function<void()> gather);
  /// Tells divisions apart.
  std::uint64_t id() const { return id_; }

  /// While it lives whoever looks asks for sums alone (Share::sums).
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

  /// Owners have moved particles: others know old rows.
  void moved() { whole_ = false; }
  /// Whether all rows are known everywhere.
  bool is_whole() const { return whole_; }
  /// All rows of all ensembles come to all ranks, unless they are there.
  void make_whole();
  /// So do influences and rates.
  void gather_influences();
  /// So does any array: `count` doubles of each particle, from each `stride` doubles.
  void gather(AnyEnsemble const& ensemble, double* numbers, std::size_t stride, std::size_t count);
  /// The least of positive numbers over all ranks.
  double least(double mine);
  /// The sum over all ranks.
  std::size_t sum(std::size_t mine);
  /// They become those of all ranks. What a rank has failed of until then, all throw.
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
    std::vector<std::uint32_t> with;  // see keep_together(): no later than the particle; empty: each by itself
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
  std::deque<Part> parts_;  // whose shares ensembles know
  bool goes_on_ = false, whole_ = true, sums_suffice_ = false;
  std::function<Carried(AnyEnsemble const&)> carried_;
  std::vector<std::pair<void const*, std::function<void()>>> gathers_;
  std::uint64_t id_, changes_ = 0;
  void const* leader_ = nullptr;
  AnyEnsemble const* points_ = nullptr;  // that others follow
  std::vector<AnyEnsemble const*> brought_;
  std::vector<std::function<void(Add const&)>> also_read_;
  bool several_ = false, keeps_together_ = false, rows_are_read_ = false;
  std::vector<std::vector<double>> sent_, received_;  // of each rank
};

/// Who sends which particles' numbers to whom, again and again: one message between two ranks, whatever ensembles it is
/// of.
class RowExchange {
 public:
  /// What this rank reads of others: for each ensemble numbers that it does not own. For all ranks.
  struct Needed {
    AnyEnsemble* ensemble;
    std::vector<std::uint32_t> numbers;
  };
  void plan(Division& division, std::vector<Needed> needed);

  /// Owners send rows, for all ranks, to where they are in the ensembles.
  void bring_rows(Division& division);
  /// The same of the first numbers[e] of each row, to take(e, rank, from): from[0] is the first of the first particle of
  /// received(e, rank).
  using Take = std::function<void(std::size_t e, std::size_t rank, double const* from)>;
  void bring_rows(Division& division, std::vector<std::size_t> const& numbers, Take const& take);
  std::vector<std::uint32_t> const& received(std::size_t e, std::size_t rank) const { return receives_[rank][e]; }
  /// The same of any numbers: give(e, i, to) writes `count(e)` doubles of particle i of ensemble e (in the order of the
  /// plan) for another rank, and take(e, i, from) gets them there.
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
