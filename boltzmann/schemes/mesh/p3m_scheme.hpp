// P3MScheme: mesh plus pairs. What a mesh can't resolve is summed over near pairs, so that forces between Laplace
// particles in a periodic box have the accuracy that is asked for (Hockney and Eastwood, ch. 8).
//
//   P3MScheme scheme(Box(Vector{0., 0., 0.}, Vector{L, L, L}, Boundary::periodic), coulomb(k), 1e-5);
//   scheme.add(sodium);
//   scheme.add(chlorine);
#pragma once

#include <boltzmann/schemes/mesh/mesh_scheme.hpp>
#include <boltzmann/schemes/mesh/p3m_tuning.hpp>

#include <memory>
#include <optional>

namespace boltzmann {

class P3MScheme final : public MeshScheme {
 public:
  /// `accuracy`: the rms error of forces, as a part of their rms when the scheme first calculates. (Where forces nearly
  /// vanish, as in a perfect crystal: as a part of the force between two mean strengths at the mean distance.) Mesh,
  /// order, cut-off and splitting are chosen then. Error if the box is not periodic in every direction, the law is
  /// softened, or the accuracy is not between 1e-10 and 0.1.
  P3MScheme(Box box, LaplaceLaw const& law, double accuracy);
  ~P3MScheme() override;

  double accuracy() const { return accuracy_; }
  /// What was chosen; chooses if that has not been done. Estimated errors are there, too.
  P3mParameters const& parameters();

  std::vector<MeshField const*> mesh_fields() override;
  void add_influences(double time) override;
  EnergyAndVirial measure(double time = 0) override;
  bool follows_box() const override { return true; }
  /// Cells, order, splitting and cut-off stay what they are, the influence function is that of the new box.
  void box_changed() override;
  /// Chooses all of them anew where the error by estimate has become 1.5 times what it was chosen to be: in a box that
  /// has grown. PhysicsFailure if that can't be.
  bool box_settled() override;
  void make_reversible(double quantum) override;
  /// All ranks have all particles; each finds what acts on a part of the sources, by lists that have a part of space.
  void divide(Division* division) override;
  std::size_t bytes() const override;
  bool measures_sums() const override { return false; }
  std::string summary() const override { return MeshScheme::summary() + ", and near pairs (P3M)"; }
  std::string report() const override;
  std::vector<std::string> warnings(double step_size) override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

 protected:
  void add_virial(MeshField const& density, MeshField const& potential, MeshField const& field,
                  EnergyAndVirial& measures) const override;

 private:
  struct Near;

  void tune();
  void choose(P3mParameters const& parameters);
  void solve_in_this_box();
  P3mSystem system() const;
  void copy_particles();
  void update_sources();

  LaplaceLaw near_law_;
  double accuracy_, quantum_ = 0;
  bool tuned_ = false;
  P3mParameters parameters_;
  std::optional<P3mEnergyTerms> energy_terms_;  // of this box, once they are needed
  std::unique_ptr<Near> near_;
};

}  // namespace boltzmann
