// MultipoleScheme: gravity, electrostatics and vortex flow of any distribution of particles in 2D and 3D, in open space
// or with periodic axes, by multipole expansions over a tree: O(N), with a controlled accuracy.
//   MultipoleScheme scheme(Box({-9, -9, -9}, {9, 9, 9}), gravity(1, 0.01), 1e-4);
//   scheme.add(stars);
//   Simulation simulation(scheme, dt);
#pragma once

#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/schemes/mesh/mesh_field.hpp>
#include <boltzmann/schemes/restored_influences.hpp>
#include <boltzmann/schemes/scheme.hpp>
#include <boltzmann/schemes/source_kind.hpp>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

class ErrorSamples;
class MultipoleEngine;
struct LoadedSources;

/// The measured accuracy of a multipole scheme and its chosen parameters.
struct MultipoleAccuracy {
  /// The error of at least 200 particles' influences against direct sums, as `tolerance`; 0: all pairs are summed
  /// directly.
  double measured = 0;
  int order = 0;                                       ///< of the expansions; 0: all pairs are summed directly
  std::size_t nodes = 0, translations = 0, pairs = 0;  ///< of the last calculation
};

class MultipoleScheme final : public Scheme, public RestoredInfluences {
 public:
  /// `tolerance`: the error of influences, sqrt(sum |error|^2 / sum |influence|^2) over all particles (in the second
  /// sum without the fiftieth with the strongest influences, so that a close pair does not dominate). The expansion
  /// parameters are tuned at the first calculation, by comparison with direct sums for 200 particles or more, and
  /// checked again every 64 calculations. Few particles are summed directly. Along periodic axes the system repeats
  /// infinitely. If all axes are periodic, strengths must cancel or have a background, with conducting boundary
  /// conditions at infinity as in ewald_sums(). If some are, potentials far from a strength approach -(C/2) |z|/area
  /// for a layer, -(C/2 pi) ln r / edge for a row. A softening acts on nearby particles. Throws Error if the box is not
  /// of 2 or 3 dimensions, has mirrors or regions, or if the tolerance is not between 1e-10 and 0.1.
  MultipoleScheme(Box box, LaplaceLaw const& law, double tolerance);
  /// Vortices advect each other and fluid particles, by BiotSavart or a similar law. In 3D the tolerance applies
  /// separately to velocities and to the rate of change of the vorticity of Inviscid and similar classes. If all axes
  /// are periodic, vorticities must cancel (in 2D, or have a rotating background), and the mean flow is zero. Mirror
  /// axes are slip walls at rest, in their positions at construction; vortices have images beyond them.
  MultipoleScheme(Box box, VortexLaw const& law, double tolerance);
  ~MultipoleScheme() override;

  double tolerance() const { return tolerance_; }
  /// The law of charges or masses; none: vortices.
  std::optional<LaplaceLaw> const& law() const { return law_; }

  /// Adds an ensemble whose particles influence each other: by their strength(), under gravity by their mass if the
  /// class has no other strength, vortices by their vorticity. Further schemes may act on the same ensemble. Throws
  /// Error if the law does not act between such particles.
  template <class P>
  void add(Ensemble<P>& ensemble) {
    static_assert(FieldParticle<P>,
                  "multipoles act on classes with mass and velocity and a force as influence, and on Tracer's");
    add(ensemble, source_kind<P>());
  }
  /// For code that selects classes at run time.
  void add(AnyEnsemble& ensemble, SourceKind const& kind);

  /// Adds test particles, which feel the field without creating it: of a class that could create it, or Tracer.
  template <class P>
  void add_test_particles(Ensemble<P>& ensemble) {
    static_assert(FieldParticle<P>,
                  "multipoles act on classes with mass and velocity and a force as influence, and on Tracer's");
    add_test_particles(ensemble, source_kind<P>());
  }
  void add_test_particles(AnyEnsemble& ensemble, SourceKind const& kind);
  /// A uniform background that neutralises a box whose axes are all periodic. Throws Error for other boxes, and for
  /// vortices in 3D, whose vorticities must cancel.
  void background(bool yes);

  /// The field at arbitrary places, and its potential. The influence on and the energy of a particle there are its
  /// strength times these. The accuracy and the cost are those of influences. Throws PhysicsFailure if a particle is at
  /// such a place (unless the law is softened); Error if the scheme is of vortices.
  template <int D>
  struct FieldAt {
    Vector<D> field;
    double potential;
  };
  template <int D>
  std::vector<FieldAt<D>> field_at(std::vector<Vector<D>> const& places);
  /// The velocity of the flow at places. Throws Error unless the scheme is of vortices.
  template <int D>
  std::vector<Vector<D>> velocity_at(std::vector<Vector<D>> const& places);
  /// A scheme for the velocity gradient of vortices in 3D, to the tolerance. It can't be part of a simulation. Its
  /// result is 12 numbers at each particle, or at each place of 3 numbers: the velocity, and the gradients of its
  /// components one after the other. The contribution of a particle's own vorticity is excluded.
  static std::unique_ptr<MultipoleScheme> of_slopes(Box const& box, VortexLaw const& law, double tolerance);
  std::vector<double> slopes_at_particles();
  std::vector<double> slopes_at(double const* places, std::size_t count);
  /// Makes mesh_fields() return the potential and the field (for vortices the velocity) on the nodes of a grid with
  /// these cells, for pictures and files. Particles don't feel it. Throws Error unless there is a number for each axis.
  void grid(std::vector<std::size_t> const& cells);
  std::vector<MeshField const*> mesh_fields() override;

  /// The current error and the chosen parameters. Chooses them at the first call. Measuring costs 200 N pairs.
  MultipoleAccuracy accuracy();
  /// The accuracy at another tolerance for these particles, and the seconds to calculate all influences.
  struct Trial {
    MultipoleAccuracy accuracy;
    double seconds;
  };
  Trial try_tolerance(double tolerance);

  std::vector<VortexSource> vortices() const override;
  void add_influences(double time) override;
  std::optional<std::uint64_t> revision() const override { return revision_with({}); }
  EnergyAndVirial measure(double time = 0) override;
  double length_scale(AnyEnsemble const& ensemble) const override;
  std::string explain(AnyEnsemble const& ensemble, std::size_t i) const override;
  void make_reversible(double quantum) override;
  std::string undivided() const override { return ""; }
  /// All ranks have all particles, and each calculates the influences on a part of them.
  void divide(Division* division) override { division_ = division; }
  std::size_t bytes() const override;
  std::string summary() const override;
  std::string report() const override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;
  void influences_restored() override;

 private:
  MultipoleScheme(Box box, double tolerance, std::optional<LaplaceLaw> law);
  class Look;
  class Together;
  class Watched;

  void load(AnyEnsemble& ensemble, SourceKind const& kind, bool acts);
  void calculate_field(bool with_potential);
  /// Calculates at this number of places of D numbers, after the particles.
  void calculate_at(double const* places, std::size_t count);
  template <int D>
  void calculate_at(std::vector<Vector<D>> const& places);
  void choose_and_calculate(bool with_potential);
  ErrorSamples choose_samples() const;
  std::size_t leaf() const;
  bool sums_directly() const;
  bool everything_is_summed() const;
  MultipoleAccuracy chosen_and_taken() const;
  void tune(bool with_potential);
  struct Fit {
    int order;
    double criterion, work, of_pairs;
  };
  Fit fit(int order, double criterion, ErrorSamples& samples, bool with_potential);

  std::optional<LaplaceLaw> law_;
  std::optional<VortexLaw> vortex_law_;
  double tolerance_;
  Division* division_ = nullptr;  // set during a divided run
  std::vector<LoadedSources> loaded_;
  std::unique_ptr<MultipoleEngine> engine_;
  double criterion_ = 0;  // allowed error of one interaction; 0: not chosen yet
  double measured_ = 0;
  int order_ = 0;  // 0: not chosen yet
  std::size_t until_check_ = 0;
  std::size_t repeated_ = 0;  // calculations that a resumed run repeats
  // checksum of the particles of the last influences, if that calculation counted
  std::uint64_t counted_ = 0;
  std::optional<MultipoleAccuracy> last_;  // of the last influences
  bool background_ = false;
  std::optional<MeshGrid> grid_;
  MeshField potential_, field_;  // on its nodes
};

}  // namespace boltzmann
