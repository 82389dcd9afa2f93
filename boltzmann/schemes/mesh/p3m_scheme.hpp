// P3MScheme: mesh plus pairs. Near pairs are summed directly, because a mesh can't resolve them. Forces between Laplace
// particles in a periodic box have the requested accuracy (Hockney and Eastwood, ch. 8).
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
  /// `accuracy`: the rms error of forces relative to their rms at the first calculation. (If forces nearly vanish, as
  /// in a perfect crystal: relative to the force between two mean strengths at the mean distance.) Mesh, order, cut-off
  /// and splitting are chosen at that calculation. Throws Error if the box is not periodic in every direction, the law
  /// is softened, or the accuracy is not between 1e-10 and 0.1.
  P3MScheme(Box box, LaplaceLaw const& law, double accuracy);
  ~P3MScheme() override;

  double accuracy() const { return accuracy_; }
  /// The chosen parameters with their estimated errors. Chooses them at the first call.
  P3mParameters const& parameters();

  std::vector<MeshField const*> mesh_fields() override;
  void add_influences(double time) override;
  EnergyAndVirial measure(double time = 0) override;
  bool follows_box() const override { return true; }
  /// Keeps cells, order, splitting and cut-off, and recomputes the influence function for the new box.
  void box_changed() override;
  /// Chooses all parameters again if the estimated error exceeds the chosen one by a factor of 1.5, in a box that has
  /// grown. Throws PhysicsFailure if no parameters reach the accuracy.
  bool box_settled() override;
  void make_reversible(double quantum) override;
  /// Every rank has all particles. Each computes the influences on a part of the sources, by lists for a part of space.
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
  std::optional<P3mEnergyTerms> energy_terms_;  // of the current box, when first needed
  std::unique_ptr<Near> near_;
};

}  // namespace boltzmann
