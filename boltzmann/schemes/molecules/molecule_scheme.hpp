// MoleculeScheme: forces inside molecules, from the angles of three particles and the dihedrals of four. Bonds are
// pairs: PairScheme::connect().
#pragma once

#include <boltzmann/laws/formula_law.hpp>
#include <boltzmann/neighbours/bonds.hpp>
#include <boltzmann/schemes/molecules/over_tuples.hpp>
#include <boltzmann/schemes/molecules/rigid_bonds.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/schemes/scheme.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

class MoleculeScheme final : public Scheme {
 public:
  explicit MoleculeScheme(Box box);
  ~MoleculeScheme() override;

  /// An energy of the angle (0 to pi) at the second of each three particles, over nearest images on periodic axes;
  /// law(angle) returns an AngularEnergy (laws/angular.hpp). Throws Error in 1D, for numbers beyond the ensemble, or
  /// for a number that occurs twice in a tuple.
  template <class P, AngularLaw Law>
  void angles(Ensemble<P>& ensemble, std::vector<AngleMembers> const& angles, Law const& law) {
    static_assert(P::dimension > 1, "in 1D there are no angles");
    add_tuples(ensemble, 3, flat(angles), tuple_kernels<detail::AngleOf<P::dimension>, Law>(), law);
  }
  /// An energy of the dihedral (-pi to pi) of each four particles about the line from the second to the third: 0 in
  /// cis, pi in trans. For particles in 3D.
  template <class P, AngularLaw Law>
  void dihedrals(Ensemble<P>& ensemble, std::vector<DihedralMembers> const& dihedrals, Law const& law) {
    static_assert(P::dimension == 3, "there are dihedrals in 3D only");
    add_tuples(ensemble, 4, flat(dihedrals), tuple_kernels<detail::DihedralOf, Law>(), law);
  }
  // The same with a formula, an energy in `angle` or `dihedral`. Throws FormulaPartError if it is invalid.
  void angles(AnyEnsemble& ensemble, std::vector<AngleMembers> const& angles, FormulaLaw const& law);
  void dihedrals(AnyEnsemble& ensemble, std::vector<DihedralMembers> const& dihedrals, FormulaLaw const& law);

  /// Rigid bonds of one of its ensembles, or of another. From now on their virial is part of the measures. The
  /// integrator of with_rigid_bonds() enforces the constraints and, after heat baths, RigidVelocities.
  void keeps(std::shared_ptr<RigidBonds const> bonds);
  std::vector<std::shared_ptr<RigidBonds const>> const& rigid_bonds() const { return rigid_; }

  void add_influences(double time) override;
  std::optional<std::uint64_t> revision() const override;
  EnergyAndVirial measure(double time = 0) override;
  bool follows_box() const override { return true; }
  bool translation_invariant() const override { return box().all_open() && box().regions().empty(); }
  double length_scale(AnyEnsemble const&) const override { return __builtin_inf(); }
  std::string explain(AnyEnsemble const& ensemble, std::size_t i) const override;
  void make_reversible(double quantum) override { quantum_ = quantum; }
  std::string undivided() const override { return quantum_ > 0 ? "the reversible leap-frog" : ""; }
  std::string shear_refused() const override;
  void divide(Division* division) override;
  std::size_t bytes() const override;
  std::string summary() const override;
  std::vector<double> state() const override { return {quantum_}; }
  void restore(std::span<double const> state) override;

 private:
  struct Group;
  using LawPointer = std::shared_ptr<void const>;

  template <std::size_t N>
  static std::vector<std::uint32_t> flat(std::vector<std::array<std::uint32_t, N>> const& tuples) {
    std::vector<std::uint32_t> members;
    for (auto const& tuple : tuples) members.insert(members.end(), tuple.begin(), tuple.end());
    return members;
  }
  template <class Law>
  void add_tuples(AnyEnsemble& ensemble, std::size_t each, std::vector<std::uint32_t> members, TupleKernels kernels,
                  Law const& law) {
    check_parameters(law);
    add_tuples(ensemble, each, std::move(members), kernels, LawPointer(std::make_shared<Law>(law)),
               PairScheme::reads_outside<Law>());
  }
  void add_tuples(AnyEnsemble& ensemble, std::size_t each, std::vector<std::uint32_t> members, TupleKernels kernels,
                  LawPointer law, bool reads_outside);
  void add_tuples(AnyEnsemble& ensemble, std::size_t each, std::vector<std::uint32_t> members, FormulaLaw const& law);

  double quantum_ = 0;
  Division* division_ = nullptr;  // set during a divided run
  std::vector<std::unique_ptr<Group>> groups_;
  std::vector<std::shared_ptr<RigidBonds const>> rigid_;
};

}  // namespace boltzmann
