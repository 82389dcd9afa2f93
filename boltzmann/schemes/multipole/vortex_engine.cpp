// Vortices: their vorticity and cores, the velocity of the flow, and the rate of change of vorticity.
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/schemes/flow_classes.hpp>
#include <boltzmann/schemes/multipole/multipole_engine.hpp>

#include <fmt/format.h>

namespace boltzmann {
namespace {

template <class Kind>
class VortexEngine final : public EngineOf<Kind> {
  using Base = EngineOf<Kind>;
  static constexpr int D = Kind::dimension;
  static constexpr bool of_slopes = std::is_same_v<Kind, VortexSlopes>;
  using Base::points_;

 public:
  VortexEngine(VortexLaw const& law, Box const& box) : Base(law, box), box_(box) {}

  void check(AnyEnsemble const& ensemble, SourceKind const& kind, bool acts) const override {
    if (!kind.carried)
      throw Error(fmt::format("multipoles: class {} of '{}' is not carried by a flow; vortices act on {}",
                              ensemble.class_name(), ensemble.name(), classes_carried_by_flows));
    if (acts && kind.vorticity < 0)
      throw Error("multipoles: class " + ensemble.class_name() + " of '" + ensemble.name() +
                  "' has no vorticity: add it as test particles");
    if (!acts && kind.vorticity >= 0)
      throw Error("multipoles: '" + ensemble.name() +
                  "' has vorticity, which acts; test particles are of class Tracer");
  }

  void collect(std::vector<LoadedSources> const& loaded, bool background, int threads) override {
    this->collect_points(loaded, threads,
                         [&](LoadedSources const& one, std::size_t i, std::size_t, typename Base::Point& point) {
                           if (one.kind.vorticity < 0) return;
                           double const* const row = one.ensemble->row(i);
                           for (int k = 0; k < Kind::densities; ++k) point.vorticity[k] = row[one.kind.vorticity + k];
                           point.core = row[one.kind.core];
                           if (!(point.core >= 0 && std::isfinite(norm2(point.vorticity))))
                             throw PhysicsFailure(
                                 fmt::format("particle {} of '{}' has a core below zero, or a vorticity or core that "
                                             "is not finite",
                                             i, one.ensemble->name()));
                         });
    add_images();
    ExactSum sums[Kind::densities], all, squares, cores;
    for (auto const& p : points_) {
      for (int k = 0; k < Kind::densities; ++k) sums[k] += p.vorticity[k];
      all += magnitude(p.vorticity);
      squares += norm2(p.vorticity), cores += p.core * p.core;
    }
    for (auto const& sum : sums)
      if (this->periodic() && !(background && D == 2) && std::abs(sum.value()) > 1e-9 * all.value())
        refuse_sum(sum.value(), D == 2 ? use_background : "close the vortex lines");
    double const count = static_cast<double>(std::max<std::size_t>(1, this->count())),
                 rms = std::sqrt(squares.value() / count);
    double const core = std::sqrt(cores.value() / count);
    // In a row of vortices all influences may cancel, and a ring is hardly stretched. Use a hundredth of the influence
    // of a neighbour.
    least_field_ = this->any_periodic() ? 1e-2 * this->constant() * rms * std::pow(this->spacing(), 1 - D) : 0;
    least_slope_ = core > 0 ? 1e-2 * this->constant() * rms / (core * core * core) : 0;
  }

  double least_field() const override { return least_field_; }
  bool feels(std::size_t) const override { return true; }
  int parts() const override { return D == 3 ? 2 : 1; }
  MultipoleEngine::Squares compare(int part, std::size_t i, double const* found, double const* exact) const override {
    double const least = part == 0 ? least_field_ : least_slope_ * (of_slopes ? 1 : magnitude(points_[i].vorticity));
    MultipoleEngine::Squares squares{0, least * least};
    for (int a = part * D; a < (part == 0 ? D : Kind::width); ++a)
      squares.error += square(found[a] - exact[a]), squares.felt += square(exact[a]);
    return squares;
  }

  void add_influences(std::vector<LoadedSources> const& loaded, int threads) const override {
    std::size_t at = 0;
    for (auto const& one : loaded) {
      AnyEnsemble& ensemble = *one.ensemble;
      std::size_t const felt = std::min<std::size_t>(Kind::width, ensemble.influence_size());
      for_share(ensemble, 4096, threads_for(ensemble.size(), 1, threads), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          for (std::size_t a = 0; a < felt; ++a) ensemble.influence(i)[a] += this->field()[(at + i) * Kind::width + a];
      });
      at += ensemble.size();
    }
  }

  EnergyAndVirial measure(std::vector<LoadedSources> const&) const override {
    EnergyAndVirial measures;
    measures.unknown = "the law of Biot and Savart";
    measures.no_virial = "vortices have no forces";
    return measures;
  }

  bool singular() const override { return false; }

 private:
  /// Adds the images of the vortices beyond walls, after the particles.
  void add_images() {
    if (!box_.any_wall()) return;
    check_walls_of_flow(box_, "multipoles");
    std::size_t const particles = points_.size();
    Images const at(box_);
    for (Turns const& turns : flow_images(box_))
      for (std::size_t i = 0; i < particles; ++i) {
        auto image = points_[i];
        if (!(norm2(image.vorticity) > 0)) continue;
        for (int a = 0; a < D; ++a) image.position[a] = at.at(a, turns[a], image.position[a]);
        for (int k = 0; k < Kind::densities; ++k) image.vorticity[k] *= vorticity_sign(box_, k, turns);
        points_.push_back(image);
      }
  }

  Box box_;
  double least_field_ = 0, least_slope_ = 0;
};

}  // namespace

std::unique_ptr<MultipoleEngine> multipole_engine(VortexLaw const& law, Box const& box) {
  if (box.dimension() == 2) return std::make_unique<VortexEngine<Vortices<2>>>(law, box);
  return std::make_unique<VortexEngine<Vortices<3>>>(law, box);
}

std::unique_ptr<MultipoleEngine> slopes_engine(VortexLaw const& law, Box const& box) {
  if (box.dimension() != 3) throw Error("multipoles: slopes of the flow of vortices are found in 3D");
  return std::make_unique<VortexEngine<VortexSlopes>>(law, box);
}

}  // namespace boltzmann
