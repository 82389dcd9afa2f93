// Dissipative pair dissipation: friction, noise and heat conduction between near particles (DPD, DPDE).
#pragma once

#include <boltzmann/dissipation/dissipation.hpp>
#include <boltzmann/dissipation/dissipation_law.hpp>
#include <boltzmann/laws/state_law.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace boltzmann {

class ExactSum;

/// The method for all pairs together.
enum class DissipationMethod {
  simultaneous,  ///< all pairs act at once on the velocities at the end of the step; each particle then regains as heat
                 ///< what its motion has lost (energy reinjection)
  shardlow,      ///< one pair after the other (Shardlow), in an order that depends only on neighbour lists
};
Words<DissipationMethod> const& dissipation_method_words();
std::string to_string(DissipationMethod method);

/// Every method conserves total momentum to rounding, and total energy if particles have internal energies, for any
/// masses. Noise depends only on the seed, the step and the numbers of the two particles; the same bits for any number
/// of threads.
class PairDissipation final : public Dissipation {
 public:
  /// Uses the neighbour lists of this scheme, which must be one of the simulation's. Boltzmann's constant in the
  /// simulation's units.
  PairDissipation(PairScheme& scheme, double boltzmann_constant);
  ~PairDissipation() override;

  /// Sets the state law of an ensemble's internal energies: required unless the convention is fixed_temperature. Error
  /// if its class has no field "internal_energy".
  void state(AnyEnsemble& ensemble, StateLaw law);
  /// Adds dissipation among the particles of one ensemble. Error if its class has no mass or velocity, a parameter is
  /// invalid, or the range is longer than half of a periodic axis.
  void internal(AnyEnsemble& ensemble, DissipationLaw const& dissipation);
  /// Adds dissipation between those of two.
  void between(AnyEnsemble& a, AnyEnsemble& b, DissipationLaw const& dissipation);

  void method(DissipationMethod method) { method_ = method; }
  DissipationMethod method() const { return method_; }
  /// simultaneous: adds a second pass over the pairs (a third with internal energies), with the mean of the velocities
  /// before the step and after the previous pass. Kinetic temperatures, and the parts of the heat for different masses,
  /// are then accurate to second order in friction times step instead of first.
  void corrector(bool wanted) { corrector_ = wanted; }
  /// shardlow: accepts or rejects every pair's new velocities (Metropolis), so that each pair conserves the invariant
  /// law exactly, and internal energies can't become negative.
  void metropolis(bool wanted) { metropolis_ = wanted; }

  std::vector<AnyEnsemble*> ensembles() const override;
  void check() override;
  void box_changed() override;
  void act_in_flow(Box const& box) override;
  std::array<std::array<double, 3>, 3> virial() override;
  std::string kind() const override { return "dpd, " + to_string(method_); }
  void advance(StepContext const& context) override;
  void update_derived_fields() override;
  bool derives(AnyEnsemble const& ensemble, Field const& field) const override;
  double internal_energy() const override;
  double heat() const override { return heat_; }
  std::string undivided() const override;
  void divide(Division* division) override;
  bool keeps_momentum() const override { return true; }
  std::vector<std::string> warnings(double step_size) override;
  std::string report() const override;
  std::size_t bytes() const override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

 private:
  struct Member;    // an ensemble with its points
  struct Piece;     // of its rows
  struct Border;    // of a piece
  struct Coupling;  // a dissipation between two members, with its pairs
  struct Splitting;

  Member& member(AnyEnsemble& ensemble);
  void couple(AnyEnsemble& target, AnyEnsemble& source, DissipationLaw const& dissipation);
  template <class Function>
  void for_dissipating(Function const& function);
  template <class Function>
  void each_piece(StepContext const& context, double asymmetry, Function const& function);
  bool take_points();
  void bring_mean_velocities(Member& member);
  std::vector<Piece> pieces(Member const& member) const;
  void take_lists();
  void finish_piece(Member& member, Piece const& piece, double const* sums, ExactSum& by_bath);
  void simultaneous(StepContext const& context);
  void shardlow(StepContext const& context);

  PairScheme& scheme_;
  double boltzmann_constant_;
  DissipationMethod method_ = DissipationMethod::simultaneous;
  bool corrector_ = false, metropolis_ = false;
  double heat_ = 0;
  std::uint64_t proposed_ = 0, refused_ = 0;
  std::vector<std::unique_ptr<Member>> members_;
  std::vector<std::unique_ptr<Coupling>> couplings_;
  std::unique_ptr<Splitting> splitting_;
};

}  // namespace boltzmann
