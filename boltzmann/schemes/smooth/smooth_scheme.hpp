// SmoothScheme: continuum mechanics with smooth particles (SPAM): the recipe of Hoover and Hoover as passes over pairs.
#pragma once

#include <boltzmann/core/words.hpp>
#include <boltzmann/neighbours/neighbourhood.hpp>
#include <boltzmann/schemes/pair/external_kernels.hpp>
#include <boltzmann/schemes/scheme.hpp>
#include <boltzmann/schemes/smooth/force_on.hpp>
#include <boltzmann/schemes/smooth/material_kernels.hpp>
#include <boltzmann/schemes/smooth/smooth_kernels.hpp>
#include <boltzmann/schemes/smooth/transport_kernels.hpp>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

class ExactSum;

/// The definition of a particle's density.
enum class DensityFrom {
  summation,   ///< sum of the weights around it (Eq 8): mass is conserved exactly
  continuity,  ///< integrated in time (Eq 1), with the rate of the sum: no deficit at free surfaces; set densities at
               ///< the start
  volumes  ///< the same, for contacts of bodies of different densities: neighbours are weighted by volume, not by mass
};
Words<DensityFrom> const& density_from_words();
/// The mean density in gradients (Eq 17).
enum class MeanDensity { arithmetic, geometric };
Words<MeanDensity> const& mean_density_words();
/// Distribution of the heat from pressure work on a pair: to both equally (Eq 14), or to each by the work of its own
/// pressure, so that in smooth flow each stays on its isentrope. Total energy is conserved either way.
enum class Heating { shared, own };
Words<Heating> const& heating_words();

/// Monaghan's artificial viscosity: alpha for weak shocks, beta against interpenetration.
struct ArtificialViscosity {
  double alpha = 1, beta = 2;
  bool balsara = false;  ///< reduced in shear (Balsara 1995)
};

/// Ranges that follow the density: range = spacings (mass / density)^(1/D), between two limits.
struct VariableRange {
  double spacings = 3;
  double shortest = 0;
  double longest = 0;  ///< 0: four times the longest at the start, or the greatest that the box permits
};

class SmoothScheme final : public Scheme {
 public:
  /// Smooth particles with weights of this shape; their ranges are fields of the particles.
  explicit SmoothScheme(Box box, WeightShape shape = WeightShape::lucy);
  ~SmoothScheme() override;

  /// Adds an ensemble of a class derived from Smooth, with its material. Particles of all ensembles interact.
  template <class P, class M>
  void material(Ensemble<P>& ensemble, M const& material) {
    static_assert(std::is_base_of_v<Smooth<P::dimension>, P>, "a smooth particle is of a class derived from Smooth");
    static_assert(Material<M, P>, "a material has a function State state(auto const& p) const; see laws/material.hpp");
    check_parameters(material);
    add_material(ensemble, material_kernels<P>(material), std::make_shared<M>(material));
  }

  /// Adds an external force on all particles of an ensemble: law(p) or law(p, time) returns a force or an Interaction.
  template <class P, class Law>
  void external(Ensemble<P>& ensemble, Law const& law) {
    static_assert(ExternalLaw<Law, P>, "an external law is a function law(p) or law(p, time) of a particle");
    check_parameters(law);
    add_external(ensemble, external_kernels<P, ForceOn<Law>>(), std::make_shared<ForceOn<Law>>(ForceOn<Law>{law}),
                 !std::is_empty_v<Law> && !std::is_aggregate_v<Law>);
  }

  // Options of the calculation. Set them at any time before the first calculation, in any order.
  void density_from(DensityFrom from) {
    density_from_ = from;
    changed();
  }
  void mean_density(MeanDensity mean) {
    mean_density_ = mean;
    changed();
  }
  void heating(Heating heating);
  /// Throws Error if alpha or beta is negative.
  void artificial_viscosity(ArtificialViscosity const& viscosity);
  /// Enables variable ranges and sets them for the current state. From then on they evolve with the density. Add all
  /// ensembles before; densities must be summed. Throws Error if no solution is found.
  void variable_range(VariableRange const& variable);
  /// The distance that particles may move before lists are rebuilt; lists have the range range + skin. Default: 0.08 of
  /// the longest range.
  void skin(double length);

  /// The longest time step that resolves sound, forces and diffusion between particles. It is the smallest of 0.4 h /
  /// (c (1 + 0.6 alpha)), sqrt(h / acceleration) / 4 and range^2 / 32 over the diffusivity, with h the smoothing
  /// length: half the range, or a third for the quintic spline. In solids also 0.35 spacing / shear speed, for
  /// hourglass control. Accelerations are those of the last calculation, if there was one.
  double courant_step();

  void add_influences(double time) override;
  /// Nothing if an external law reads data outside of it.
  std::optional<std::uint64_t> revision() const override;
  void complete(double time) override;
  bool derives(AnyEnsemble const& ensemble, Field const& field) const override;
  EnergyAndVirial measure(double time = 0) override;
  bool velocity_dependent(AnyEnsemble const& ensemble) const override { return supervises(ensemble); }
  double length_scale(AnyEnsemble const& ensemble) const override;
  double longest_step() override { return courant_step(); }
  double sound_step() const override;
  std::string explain(AnyEnsemble const& ensemble, std::size_t i) const override;
  void make_reversible(double quantum) override;
  std::string undivided() const override { return ""; }
  std::string shear_refused() const override { return ""; }
  bool shares_out() const override { return true; }
  bool has_points() const override { return true; }
  void bring_particles() override;
  void divide(Division* division) override;
  std::size_t bytes() const override;
  std::vector<std::string> warnings(double step_size) override;
  std::string summary() const override { return "smooth particles, weight " + to_string(shape_); }
  std::string report() const override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  WeightShape shape() const { return shape_; }
  /// Throws Error if materials with heat share it with materials without; also called by the first calculation.
  void check_heating() const;

  // For code that selects classes at run time (scenarios).
  void add_material(AnyEnsemble& ensemble, MaterialKernels const& kernels, std::shared_ptr<void const> material);
  void add_external(AnyEnsemble& ensemble, ExternalKernels const& kernels, std::shared_ptr<void const> law,
                    bool reads_outside = false);

 private:
  struct Loaded;
  struct Outside;

  enum class Until { state, fluxes, rates };
  struct Recipe {
    bool own_ranges = false;  // particles have different ranges
    bool viscous = false;     // artificially
    bool gradients = false;   // gradients are needed
    bool solids = false;      // with a shear stiffness
    bool transport = false;   // there are viscosities or conductivities
    bool fused = false;       // the pass of rates includes them
    bool uniform = false;     // P / rho^2 is the same for all: forces need no density
    SmoothPasses const* passes = nullptr;
    PairKernel rates = nullptr;  // of the passes
    TransportPasses const* transport_passes = nullptr;
  };
  Recipe recipe() const;
  SolidPasses solid_passes_of(Recipe const& recipe) const;
  void strain_solids(Recipe const& recipe, SortedCopy& copy);
  void add_solid_forces(Recipe const& recipe);
  void set_tasks(Recipe const& recipe, SortedCopy& copy);
  void find_places(bool looking = false);
  void find(Until until, bool looking = false);
  void find_motion(Recipe const& recipe, SortedCopy& copy);
  void add_transport(Recipe const& recipe);
  Tensor<3> stress();
  void add_viscous_stress(Recipe const& recipe, std::array<ExactSum, 9>& sums);
  /// For each particle: its grad-h factor, and lower and upper bounds of its range.
  struct RangeBracket {
    std::vector<double> factor, shorter, longer;
  };
  double new_ranges(RangeBracket& bracket);
  void prepare(bool keep_lists = false);
  void reach(double cutoff);
  bool all_rest() const;
  struct Extent;
  Extent take_places(Loaded const& loaded);
  void take_places();
  void agree_on_ranges();
  void bring(SortedCopy& copy, std::size_t first_block, std::size_t last_block);
  void gather_particles();
  void sum_densities(Recipe const& recipe);
  void run_pass(PairKernel kernel, std::size_t components, std::vector<double>& sums);
  void run_material(MaterialKernel MaterialKernels::*kernel);
  void find_members();
  std::size_t count() const;

  WeightShape shape_;
  DensityFrom density_from_ = DensityFrom::summation;
  MeanDensity mean_density_ = MeanDensity::arithmetic;
  ArtificialViscosity viscosity_{0, 0, false};
  PassParameters parameters_;
  std::optional<VariableRange> variable_;
  double skin_ = -1;                     // negative: default
  double longest_ = 0, shortest_ = 0;    // ranges of the particles
  Division* division_ = nullptr;         // set during a divided run
  bool brought_ = false;                 // rows were exchanged for the next calculation
  std::unique_ptr<AnyEnsemble> points_;  // the positions of all particles, ensemble after ensemble
  std::unique_ptr<Neighbourhood> hood_;  // of the points; null before the first calculation
  std::vector<std::unique_ptr<Loaded>> loaded_;
  std::vector<std::unique_ptr<Outside>> outside_;
  /// Results of the density pass, in the order of rows.
  struct Summed {
    struct For {
      std::size_t lists = 0;     // their version
      std::uint64_t images = 0;  // the box's revision
      bool own_ranges = false;
      bool operator==(For const&) const = default;
    };
    std::vector<double> sums;
    For are_for;
    bool hold = false;  // positions, masses and ranges have not changed since
  } summed_;
  std::vector<double> sums_;  // of the last other pass
  std::vector<double> solid_sums_;
  std::vector<double> factors_;  // grad-h
  std::size_t calculations_ = 0, members_of_build_ = 0;
  double time_ = 0;
  double sound_rate_ = 0;  // greatest sound speed / range at the last calculation that needed states
};

}  // namespace boltzmann
