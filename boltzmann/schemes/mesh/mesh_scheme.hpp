// MeshScheme: influences of Laplace particles through a potential on a mesh (section 4.4 of the 1990 thesis).
//
//   MeshScheme mesh(Box(Vector{0.}, Vector{L}, Boundary::periodic), {512}, coulomb(k));
//   mesh.add(electrons);
//   mesh.background(true);
//   Simulation simulation(mesh, dt);
#pragma once

#include <boltzmann/core/words.hpp>
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/schemes/mesh/mesh_field.hpp>
#include <boltzmann/schemes/mesh/poisson.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/schemes/scheme.hpp>
#include <boltzmann/schemes/source_kind.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

struct AssignTask;

/// The spreading of strengths over nodes and the interpolation of the field: the nearest node, the 2 (4, 8) nodes of
/// the cell, or the 3 (9, 27) nearest, by B-splines of order 1, 2, 3.
enum class Assignment { ngp = 1, cic = 2, tsc = 3 };
Words<Assignment> const& assignment_words();

/// The storage of particles in the mesh's own loop; the user's rows are always doubles.
enum class Precision {
  full,    ///< doubles
  single,  ///< velocities as floats, positions as integers of 32 bits (2^-24 of a cell, or 2^-29 of the longest axis if
           ///< that is more): half the memory, and faster
};
Words<Precision> const& precision_words();

class MeshScheme : public Scheme {
 public:
  /// A mesh of these cells along each axis over the box. `law` relates field and strengths (coulomb(k), gravity(G): div
  /// E = C rho); it can't be softened. The field is periodic if the box is; other axes have free space outside
  /// (FieldBoundary::open) unless boundary() sets another condition.
  /// Throws Error if the box has regions or an axis has no cells; at the first use, if the mesh would need more memory
  /// than this machine has.
  MeshScheme(Box box, std::vector<std::size_t> cells, LaplaceLaw const& law);
  ~MeshScheme() override;

  /// The boundary condition of the field at the ends of an axis that is not periodic. Throws Error for a periodic axis,
  /// or if only one end is open.
  void boundary(int axis, FieldBoundary low, FieldBoundary high);
  void boundary(int axis, FieldBoundary both) { boundary(axis, both, both); }
  void assignment(Assignment order) { assignment(static_cast<int>(order)); }
  /// B-splines of any order from 1 to 7. Throws Error for others.
  void assignment(int order);
  int assignment() const { return order_; }
  void form(PoissonForm form);
  PoissonForm form() const { return form_; }
  /// Adds a uniform background that neutralises the system. A periodic field (or one enclosed by Neumann walls) does
  /// not exist without it.
  void background(bool yes);
  void precision(Precision precision) {
    precision_ = precision;
    changed();
  }
  Precision precision() const { return precision_; }

  /// The particles of an ensemble create the field and feel it: by their strength(), or under gravity by their mass if
  /// the class has no other strength. Further schemes may act on the same ensemble (gravity on a gas of smooth
  /// particles).
  template <class P>
  void add(Ensemble<P>& ensemble) {
    static_assert(ForcedParticle<P>, "a mesh acts on classes with mass and velocity, and a force as influence");
    add(ensemble, source_kind<P>());
  }
  /// For code that selects classes at run time.
  void add(AnyEnsemble& ensemble, SourceKind const& kind);

  /// An external influence, as in PairScheme.
  template <class P, class Law>
  void external(Ensemble<P>& ensemble, Law const& law) {
    pairs_.external(ensemble, law);
  }
  /// Interactions besides the mesh: pair laws, connections and external influences. Their measures are included.
  PairScheme& pairs() { return pairs_; }
  PairScheme const& pairs() const { return pairs_; }

  // The four stages of section 4.4. A user's function may replace each; an empty function restores the built-in stage.
  // Fields have their grid and size() numbers per component. The density is passed as zero, other fields as the last
  // calculation left them.
  /// Computes the density of strength on the nodes.
  using DensityAssignment = std::function<void(MeshScheme& mesh, MeshField& density)>;
  /// Solves laplacian phi = -C rho. If the field is closed (periodic, Neumann), the mean of phi must be zero, because
  /// energies assume it.
  using PotentialCalculation = std::function<void(MeshScheme& mesh, MeshField const& density, MeshField& potential)>;
  /// Computes E from phi: a component for each axis.
  using InfluenceField = std::function<void(MeshScheme& mesh, MeshField const& potential, MeshField& field)>;
  /// Computes E at each particle of an ensemble, dimension() numbers per particle.
  using Interpolation = std::function<void(MeshScheme& mesh, MeshField const& field, AnyEnsemble const& ensemble,
                                           std::vector<double>& E)>;
  void density_assignment(DensityAssignment stage);
  void potential_calculation(PotentialCalculation stage);
  void influence_field(InfluenceField stage);
  void interpolation(Interpolation stage);
  // The built-in stages, for functions that extend them.
  void assign_density(MeshField& density);
  void calculate_potential(MeshField const& density, MeshField& potential);
  void calculate_field(MeshField const& potential, MeshField& field);
  void interpolate(MeshField const& field, AnyEnsemble const& ensemble, std::vector<double>& E);

  /// The strengths of an ensemble's particles.
  std::vector<double> strengths(AnyEnsemble const& ensemble) const;
  /// C of div E = C rho.
  double constant() const { return law_.constant; }
  /// The nodes. Along open axes the mesh extends beyond the box by some cells.
  MeshGrid const& grid();
  /// Density, potential and field of the current particles. In a divided run: for observers, on any rank.
  std::vector<MeshField const*> mesh_fields() override;

  /// The ensembles that create the field, then those of pairs() only.
  std::vector<AnyEnsemble*> const& ensembles() const override;
  void add_influences(double time) override;
  /// Nothing if the user has replaced a stage.
  std::optional<std::uint64_t> revision() const override;
  void complete(double time) override { pairs_.complete(time); }
  bool derives(AnyEnsemble const& ensemble, Field const& field) const override {
    return pairs_.derives(ensemble, field);
  }
  void calculate(double time = 0) override;
  std::unique_ptr<FusedSteps> fused_steps(std::vector<Mover> const& movers, double dt) override;
  std::vector<Rotation> rotations(AnyEnsemble const& ensemble, bool taken) override;
  bool velocity_dependent(AnyEnsemble const& ensemble) const override { return pairs_.velocity_dependent(ensemble); }
  VelocityInfluences* velocity_influences() override { return pairs_.velocity_influences(); }
  std::string undivided() const override;
  bool measures_sums() const override { return pairs_.measures_sums(); }
  bool shares_out() const override { return pairs_.shares_out(); }
  /// Each rank counts its particles onto the mesh. A small mesh is then solved by all ranks, a large one in parts.
  void divide(Division* division) override;
  void bring_particles() override;
  EnergyAndVirial measure(double time = 0) override;
  double length_scale(AnyEnsemble const& ensemble) const override;
  std::string explain(AnyEnsemble const& ensemble, std::size_t i) const override;
  void make_reversible(double quantum) override;
  std::size_t bytes() const override;
  std::string summary() const override;
  std::string report() const override;
  double collision_step() const override { return pairs_.collision_step(); }
  std::vector<std::string> warnings(double step_size) override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

 protected:
  /// Replaces the solution of Poisson's equation (P3M): the mesh, the order, Green's function.
  void solve_by(std::vector<std::size_t> cells, int order, GreensFunction green);
  /// Adds the virial of the mesh, or states why it is unavailable.
  virtual void add_virial(MeshField const& density, MeshField const& potential, MeshField const& field,
                          EnergyAndVirial& measures) const;
  /// While a run is divided.
  Division* division() const { return division_; }
  /// From now on assignment(), form() and boundary() throw.
  void chosen_by_accuracy() { chosen_by_accuracy_ = true; }

 private:
  template <class Real>
  friend class MeshSteps;
  struct Loaded;
  struct Work;

  void changed();
  Work& work();
  void refuse_choice(char const* what) const;
  bool closed() const;
  double total_strength() const;
  std::vector<double> shares_inside(MeshGrid const& grid) const;
  void add_background(Work& work) const;
  void check_neutral() const;
  AssignTask task_for(Work const& work, Loaded const& loaded) const;
  enum class Whose { everybody, own };  // `own`: owned particles of this rank
  double scale_of_counts() const;
  std::int64_t count(Work& work, double per_strength, Whose whose) const;
  [[noreturn]] void refuse_outside(std::int64_t particle) const;
  SolvingRanks const* deposit(Work& work);
  void solve(Work& work, bool with_potential, SolvingRanks const* ranks);
  void gather(Work& work, Loaded const& loaded, bool potential, double* result, bool overwrite, Whose whose) const;
  bool plain() const;
  bool has_users_stage() const;

  // divided_mesh.cpp: a mesh over the ranks of a team.
  SolvingRanks const* deposit_share(Work& work, Whose readers);
  SolvingRanks const* solving_ranks(Work& work, bool whole_steps) const;
  std::vector<char> planes_read(Work const& work) const;
  void learn_readers(Work& work) const;
  void sum_in_planes(Work& work, std::int64_t* counts) const;
  void agree_on_strengths(Work& work);

  LaplaceLaw law_;
  PairScheme pairs_;
  std::vector<std::size_t> cells_;
  std::array<FieldEnds, 3> ends_;
  int order_ = 2;
  PoissonForm form_ = PoissonForm::finite_difference;
  Precision precision_ = Precision::full;
  bool background_ = false, chosen_by_accuracy_ = false;
  double quantum_ = 0;
  GreensFunction green_;
  DensityAssignment density_assignment_;
  PotentialCalculation potential_calculation_;
  InfluenceField influence_field_;
  Interpolation interpolation_;
  std::vector<std::unique_ptr<Loaded>> loaded_;
  std::unique_ptr<Work> work_;
  Division* division_ = nullptr;  // set during a divided run
  bool agreed_ = false;           // all ranks have the current strengths
  bool measured_ = false;         // the data on the nodes are of the particles that observers see
  std::size_t solves_ = 0;
  mutable std::vector<AnyEnsemble*> supervised_;
};

}  // namespace boltzmann
