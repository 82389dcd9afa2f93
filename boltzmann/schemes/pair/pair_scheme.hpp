// PairScheme: sums influences over pairs of particles (section 4.3): all pairs, pairs within a cut-off, or fixed
// connections.
#pragma once

#include <boltzmann/laws/formula_law.hpp>
#include <boltzmann/laws/parameter.hpp>
#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/neighbours/bonds.hpp>
#include <boltzmann/neighbours/connection.hpp>
#include <boltzmann/neighbours/neighbourhood.hpp>
#include <boltzmann/schemes/pair/external_kernels.hpp>
#include <boltzmann/schemes/pair/pair_kernels.hpp>
#include <boltzmann/schemes/scheme.hpp>
#include <boltzmann/schemes/velocity_influences.hpp>

#include <concepts>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace boltzmann {

inline constexpr double no_cutoff = std::numeric_limits<double>::infinity();

class PairScheme final : public Scheme, private VelocityInfluences {
 public:
  /// `cutoff`: the distance beyond which influences are taken as zero, for laws without a cut-off of their own. Throws
  /// Error if it is not positive or longer than a periodic axis. Without a cut-off all pairs are summed; periodic axes
  /// then have no finite sum and are rejected.
  explicit PairScheme(Box box, double cutoff = no_cutoff);
  ~PairScheme() override;

  /// Adds influences among the particles of one ensemble.
  template <class P, class Law>
  requires(!std::same_as<Law, FormulaLaw>) void internal(Ensemble<P>& ensemble, Law const& law) {
    internal(ensemble, law, cutoff_);
  }
  template <class P, class Law>
  requires(!std::same_as<Law, FormulaLaw>) void internal(Ensemble<P>& ensemble, Law const& law, double cutoff) {
    static_assert(detail::compiles_for_packs<detail::law_hint, Law, P, P>(),
                  "a pair law is a function law(p, q) of two particles, generic in the number type, [](auto const& p, "
                  "auto const& q) { ... }, which reads fields that their classes have");
    add_pairs(ensemble, ensemble, near_kernels<P, P, Law>(), keep(law), traits_of(law), cutoff);
  }

  /// Adds influences between two ensembles: law(p, q) on p in `a` and law(q, p) on q in `b`. A one-way law acts on `a`
  /// only.
  template <class P, class Q, class Law>
  requires(!std::same_as<Law, FormulaLaw>) void between(Ensemble<P>& a, Ensemble<Q>& b, Law const& law) {
    between(a, b, law, cutoff_);
  }
  template <class P, class Q, class Law>
  requires(!std::same_as<Law, FormulaLaw>) void between(Ensemble<P>& a, Ensemble<Q>& b, Law const& law, double cutoff) {
    static_assert(detail::compiles_for_packs<detail::law_hint, Law, P, Q>(),
                  "a pair law is a function law(p, q) of two particles, generic in the number type, [](auto const& p, "
                  "auto const& q) { ... }, which reads fields that their classes have");
    auto const kept = keep(law);
    add_pairs(a, b, near_kernels<P, Q, Law>(), kept, traits_of(law), cutoff);
    if constexpr (symmetry_of<Law>() != Symmetry::one_way)
      add_pairs(b, a, near_kernels<Q, P, Law>(), kept, traits_of(law), cutoff);
  }

  /// Adds influences between fixed pairs of one ensemble, over the nearest image on periodic axes.
  template <class P, class Law>
  requires(!std::same_as<Law, FormulaLaw>) void connect(Ensemble<P>& ensemble,
                                                        std::vector<Connection> const& connections, Law const& law) {
    static_assert(detail::compiles_for_packs<detail::law_hint, Law, P, P>(),
                  "a pair law is a function law(p, q) of two particles, generic in the number type, [](auto const& p, "
                  "auto const& q) { ... }, which reads fields that their classes have");
    add_connections(ensemble, connections, connection_kernels<P, Law>(), keep(law), traits_of(law));
  }

  /// Adds an external influence, law(p) or law(p, time), on all particles of an ensemble or on the selected ones.
  template <class P, class Law>
  requires(!std::same_as<Law, FormulaLaw>) void external(Ensemble<P>& ensemble, Law const& law) {
    static_assert(ExternalLaw<Law, P>, "an external law is a function law(p) or law(p, time) of a particle");
    add_external(ensemble, external_kernels<P, Law>(), keep(law), traits_of(law), nullptr);
  }
  template <class P, class Law>
  requires(!std::same_as<Law, FormulaLaw>) void external(Ensemble<P>& ensemble, Law const& law,
                                                         std::vector<std::uint32_t> const& only) {
    static_assert(ExternalLaw<Law, P>, "an external law is a function law(p) or law(p, time) of a particle");
    add_external(ensemble, external_kernels<P, Law>(), keep(law), traits_of(law), &only);
  }

  // The same with a law given as a formula, for particles of any class. Throws FormulaPartError if it is invalid.
  void internal(AnyEnsemble& ensemble, FormulaLaw const& law) { internal(ensemble, law, cutoff_); }
  void internal(AnyEnsemble& ensemble, FormulaLaw const& law, double cutoff);
  void between(AnyEnsemble& a, AnyEnsemble& b, FormulaLaw const& law) { between(a, b, law, cutoff_); }
  void between(AnyEnsemble& a, AnyEnsemble& b, FormulaLaw const& law, double cutoff);
  /// Acts on `target` only: p is in the target, q in the source.
  void one_way(AnyEnsemble& target, AnyEnsemble& source, FormulaLaw const& law) {
    one_way(target, source, law, cutoff_);
  }
  void one_way(AnyEnsemble& target, AnyEnsemble& source, FormulaLaw const& law, double cutoff);
  void connect(AnyEnsemble& ensemble, std::vector<Connection> const& connections, FormulaLaw const& law);
  void external(AnyEnsemble& ensemble, FormulaLaw const& law, std::vector<std::uint32_t> const* only = nullptr);
  /// Adds the rates of fields (AnyEnsemble::driven()) and their diffusion. Throws FormulaPartError if one is invalid.
  void rates(AnyEnsemble& ensemble, FieldRates const& rates);

  /// Scaling of laws between bonded particles. Laws within this ensemble that are added from now on act between
  /// particles 1, 2, ... bonds apart with these factors; 0 excludes a pair. Empty: no scaling. Throws Error unless
  /// factors are finite. Such a law needs a cut-off, and periodic axes must be twice as long, so that no second image
  /// is in range.
  void bonded_factors(AnyEnsemble& ensemble, std::vector<BondMembers> const& bonds, std::vector<double> const& factors);

  /// The distance that particles may move before lists are rebuilt; lists have the range cutoff + skin. Default: 0.12
  /// of the cut-off, longer if few particles are within it.
  void skin(double length) { neighbourhood_.skin(length); }
  double skin() const { return neighbourhood_.skin(); }
  /// Mirrors and lists, as of the last calculation, for other code that acts between near particles.
  Neighbourhood& neighbourhood() { return neighbourhood_; }
  /// True (the default): energies of laws with a cut-off are counted from their value there, which is the energy that
  /// the truncated forces conserve. False: energies are those of the law, and jump whenever a pair crosses the cut-off.
  void shifted(bool yes) { shifted_ = yes; }
  double cutoff() const { return cutoff_; }
  /// The pairs connected by connect(), for drawings: (ensemble, i, j), each once.
  struct Bond {
    AnyEnsemble const* ensemble;
    std::uint32_t i, j;
  };
  std::vector<Bond> bonds() const;
  /// The vortices that act, and their law.
  std::vector<VortexSource> vortices() const override;
  /// Adds the external influence on the first advected ensemble.
  void add_stream(std::span<double const> places, double time, std::span<double> velocities) override;

  void calculate(double time = 0) override;
  void add_influences(double time) override;
  /// Nothing if a law may read data outside of it (a lambda with captures), which can change unnoticed.
  std::optional<std::uint64_t> revision() const override;
  /// Updates fields that are sums, as laws have given them at the last calculation.
  void complete(double time) override;
  bool derives(AnyEnsemble const& ensemble, Field const& field) const override;
  SmallSystem small_system() override;
  EnergyAndVirial measure(double time = 0) override { return measure(time, true); }
  /// `zeros`: if no pair acts, virial_per_particle contains zeros; otherwise it is empty then.
  EnergyAndVirial measure(double time, bool zeros);
  std::vector<Rotation> rotations(AnyEnsemble const& ensemble, bool taken) override;
  RateSource* rate_source(AnyEnsemble const& ensemble) override;
  bool velocity_dependent(AnyEnsemble const& ensemble) const override;
  /// Detects C++ laws that read velocities without declaring it, by trials on the current particles.
  VelocityInfluences* velocity_influences() override;
  bool follows_box() const override { return true; }
  /// Invalidates the lists. Throws PhysicsFailure if a cut-off is now longer than a periodic axis.
  void box_changed() override;
  /// For pairs without cut-offs in open space, without external influences.
  bool translation_invariant() const override;
  double length_scale(AnyEnsemble const& ensemble) const override;
  std::string explain(AnyEnsemble const& ensemble, std::size_t i) const override;
  /// A line if two particles overlap, else empty. They overlap if the energy of a hard core would move them in one such
  /// step by a good part of their distance. On a lattice the forces of such neighbours cancel.
  std::string overlap(double step_size);
  /// True if equal particles of this ensemble feel equal external influences at all places: only uniform fields act.
  bool acts_uniformly(AnyEnsemble const& ensemble) const;
  /// Adds the influence of such fields (except those that an integrator has taken) on one row of the ensemble.
  void add_outside(AnyEnsemble const& ensemble, double const* row, double time, double* influence) const;
  void make_reversible(double quantum) override;
  std::string undivided() const override;
  bool measures_sums() const override { return connected_.empty(); }
  std::string shear_refused() const override { return ""; }
  bool shares_out() const override { return !neighbourhood_.empty(); }
  void bring_particles() override;
  void divide(Division* division) override;
  std::size_t bytes() const override;
  /// Warns of steps in which particles on a collision course move further than a quarter of the length over which the
  /// law between them changes: such steps do not resolve collisions.
  double collision_step() const override;
  std::vector<std::string> warnings(double step_size) override;
  std::string report() const override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  // For code that selects classes at run time (scenarios): the same as the members above, with kernels already
  // selected.
  struct LawTraits {
    double length_scale = no_cutoff;
    bool velocity_dependent = false;
    bool one_way = false;                    ///< targets do not influence the sources
    bool uniform = false;                    ///< an external law that acts equally on equal particles at all places
    std::optional<VortexLaw> vortices = {};  ///< the law of Biot and Savart, if it is one
    int changes = -1;  ///< the driven field of the target whose rate it gives; -1: it moves particles

    bool reads_outside = false;  ///< it may depend on data outside of it
    bool rates = false;          ///< it gives the rates of all driven fields; sums must be known before

    bool moves() const { return changes < 0; }
    /// True if it is a force (or another influence) that depends on velocities.
    bool pushes_by_velocity() const { return velocity_dependent && moves() && !rates; }
    std::shared_ptr<PairNumbers const> typed = {};  ///< a formula, which is sampled to find its length
    bool positions_alone = false;                   ///< it reads no fields of particles but the position
  };
  template <class Law>
  static LawTraits traits_of(Law const& law) {
    return {length_scale_of(law),
            depends_on_velocity<Law>(),
            symmetry_of<Law>() == Symmetry::one_way,
            is_uniform<Law>(),
            vortex_law(law),
            -1,
            reads_outside<Law>(),
            false,
            {},
            reads_positions_alone<Law>()};
  }
  /// A law declares this by `static constexpr bool positions_alone = true`.
  template <class Law>
  static constexpr bool reads_positions_alone() {
    if constexpr (requires { Law::positions_alone; })
      return Law::positions_alone;
    else
      return false;
  }
  /// An empty class or a plain struct contains all its data; another law may have captured references.
  template <class Law>
  static constexpr bool reads_outside() {
    return !std::is_empty_v<Law> && !std::is_aggregate_v<Law>;
  }
  template <class Law>
  static std::optional<VortexLaw> vortex_law(Law const& law) {
    if constexpr (std::is_constructible_v<VortexLaw, Law const&>)
      return VortexLaw(law);
    else
      return std::nullopt;
  }
  using LawPointer = std::shared_ptr<void const>;
  void add_pairs(AnyEnsemble& target, AnyEnsemble& source, PairKernels kernels, LawPointer law, LawTraits traits,
                 double cutoff);
  void add_connections(AnyEnsemble& ensemble, std::vector<Connection> const& connections, PairKernels kernels,
                       LawPointer law, LawTraits traits);
  void add_external(AnyEnsemble& ensemble, ExternalKernels kernels, LawPointer law, LawTraits traits,
                    std::vector<std::uint32_t> const* only);
  /// The number of external influences; replaces one of them, by number, with another law of the same type.
  std::size_t externals() const { return external_.size(); }
  void replace_external(std::size_t number, LawPointer law, LawTraits traits);
  template <class Law>
  static LawPointer keep(Law const& law) {
    check_parameters(law);
    return std::make_shared<Law>(law);
  }

 private:
  struct Near;
  struct Connected;
  struct BondedPairs;
  struct External;

  // velocity_laws.cpp
  bool act_from_outside(AnyEnsemble const& ensemble) const override;
  bool act_between(AnyEnsemble const& target) const override;
  bool couple(AnyEnsemble const& target, AnyEnsemble const& source) const override;
  bool push(AnyEnsemble const& ensemble) const override;
  void separate(std::vector<AnyEnsemble const*> from_outside, bool between) override;
  void add_from_outside(AnyEnsemble const& ensemble, OutsideTask const& task) const override;
  void add_between() override;
  /// True if add_influences() calculates this law between particles, or these external laws.
  bool calculated(LawTraits const& traits) const { return !(separate_between_ && traits.pushes_by_velocity()); }
  bool calculated(External const& external) const;

  void calculate(double time, bool overwrite);
  void apply(Near& near, bool overwrite);
  void apply(Connected const& connected);
  void find_rows();
  External* only_rates(AnyEnsemble const& ensemble) const;
  void clear_driven(AnyEnsemble& ensemble) const;
  template <class Kernel>
  void over_targets(Near const& near, PairTask const& task, std::size_t pairs, int threads, Kernel const& kernel) const;
  void measure(Near& near, std::vector<double>& energies, std::vector<double>& virials);
  void add_up(EnergyAndVirial& measures, std::vector<std::vector<double>> const& field, bool pairs);
  void gather_measures(EnergyAndVirial& measures, std::vector<std::vector<double>>& field);
  void add_near(AnyEnsemble& target, AnyEnsemble& source, PairKernels kernels, LawPointer law, LawTraits traits,
                double cutoff, PairFilter filter, double factor);
  bool has_reaction(Near const& near) const;
  void warn_of_typed(Near const& near, std::vector<std::string>& lines) const;
  std::string overlap(Near& near, double step_size);

  double cutoff_;
  double quantum_ = 0;
  bool shifted_ = true;
  std::size_t calculations_ = 0;
  Division* division_ = nullptr;   // set during a divided run
  bool reads_all_ = false;         // of other ranks' particles
  bool brought_ = false;           // rows were exchanged for the next calculation
  bool separate_between_ = false;  // laws that add_influences() omits
  std::vector<AnyEnsemble const*> separate_outside_;
  Neighbourhood neighbourhood_;
  std::vector<std::unique_ptr<Near>> near_;
  std::vector<std::unique_ptr<Connected>> connected_;
  std::vector<std::unique_ptr<External>> external_;
  std::vector<std::unique_ptr<BondedPairs>> bonded_;  // with scaling factors
};

}  // namespace boltzmann
