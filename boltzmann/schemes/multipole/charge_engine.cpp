// Charges and masses: strengths, fields, energies and the virial.
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/schemes/multipole/multipole_engine.hpp>

namespace boltzmann {
namespace {

template <int D>
class ChargeEngine final : public EngineOf<Charges<D>> {
  using Base = EngineOf<Charges<D>>;
  using Base::law_;
  using Base::points_;

 public:
  using Base::Base;

  void check(AnyEnsemble const& ensemble, SourceKind const& kind, bool /*acts*/) const override {
    if (!kind.strengths)
      throw Error("multipoles: class " + ensemble.class_name() + " of '" + ensemble.name() +
                  "' has neither strength nor mass, and feels no force");
    kind.check(ensemble, law_.constant, "multipoles");
  }

  void collect(std::vector<LoadedSources> const& loaded, bool background, int threads) override {
    std::size_t total = 0, at = 0;
    for (auto const& one : loaded) total += one.ensemble->size();
    strengths_.resize(total);
    ExactSum sum, all, squares;
    for (auto const& one : loaded) {
      std::size_t const count = one.ensemble->size();
      one.kind.strengths(one.ensemble->row(0), one.ensemble->stride(), 0, count, strengths_.data() + at);
      for (std::size_t i = at; one.acts && i < at + count; ++i) {
        double const s = strengths_[i];
        sum += s, all += std::abs(s), squares += s * s;
      }
      at += count;
    }
    if (this->periodic() && !background && std::abs(sum.value()) > 1e-9 * all.value())
      refuse_sum(sum.value(), use_background);
    this->collect_points(loaded, threads,
                         [&](LoadedSources const& one, std::size_t, std::size_t k, typename Base::Point& point) {
                           point.amount = one.acts ? strengths_[k] : 0;
                         });
    // In a crystal all influences on a particle may cancel. Use a hundredth of that of a neighbour.
    least_field_ = 0;
    if (this->any_periodic())
      least_field_ = 1e-2 * this->constant() * std::sqrt(squares.value() / static_cast<double>(this->count())) *
                     std::pow(this->spacing(), 1 - D);
  }

  double least_field() const override { return least_field_; }
  bool feels(std::size_t i) const override { return strengths_[i] != 0; }
  MultipoleEngine::Squares compare(int /*part*/, std::size_t i, double const* found,
                                   double const* exact) const override {
    double const strength = strengths_[i];
    MultipoleEngine::Squares squares{0, square(strength * least_field_)};
    for (int a = 0; a < D; ++a) {
      squares.error += square(strength * (found[a] - exact[a]));
      squares.felt += square(strength * exact[a]);
    }
    return squares;
  }

  void add_influences(std::vector<LoadedSources> const& loaded, int threads) const override {
    std::size_t at = 0;
    for (auto const& one : loaded) {
      AnyEnsemble& ensemble = *one.ensemble;
      for_share(ensemble, 4096, threads_for(ensemble.size(), 1, threads), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          for (std::size_t a = 0; a < D; ++a)
            ensemble.influence(i)[a] += strengths_[at + i] * this->field()[(at + i) * D + a];
      });
      at += ensemble.size();
    }
  }

  EnergyAndVirial measure(std::vector<LoadedSources> const& loaded) const override {
    EnergyAndVirial measures = EnergyAndVirial::known();
    ExactSum potential;
    std::array<std::array<ExactSum, 3>, 3> virial;
    std::size_t at = 0;
    bool reaction = true;
    for (auto const& one : loaded) {
      reaction = reaction && one.acts;
      std::vector<double> energies(one.ensemble->size());
      for (std::size_t i = 0; i < energies.size(); ++i) {
        energies[i] = (one.acts ? 0.5 : 1) * strengths_[at + i] * this->potential()[at + i];
        potential += energies[i];
        // The sum over pairs of r_a F_b equals the sum over particles of position times force, because all forces
        // cancel.
        for (std::size_t a = 0; a < D; ++a)
          for (std::size_t b = 0; b < D; ++b)
            virial[a][b] += one.ensemble->row(i)[a] * strengths_[at + i] * this->field()[(at + i) * D + b];
      }
      at += energies.size();
      measures.per_particle.push_back(std::move(energies));
    }
    measures.potential = potential.value();
    measures.reciprocal = reaction;
    measures.driven = !reaction;  // the sources do work on them
    if (this->any_periodic())
      measures.no_virial =
          "multipoles in a periodic box don't have it (P3M does); in 3D, unsoftened, its trace is the potential energy";
    else if (!reaction)
      measures.no_virial = "test particles feel forces without exerting any";
    else
      for (std::size_t a = 0; a < D; ++a)
        for (std::size_t b = 0; b < D; ++b) measures.virial[a][b] = virial[a][b].value();
    return measures;
  }

  bool singular() const override { return law_.softening == 0; }

 private:
  std::vector<double> strengths_;  // times the field gives the influence
  double least_field_ = 0;
};

}  // namespace

std::unique_ptr<MultipoleEngine> multipole_engine(LaplaceLaw const& law, Box const& box) {
  law.check();
  if (law.constant == 0) throw Error("multipoles: the constant of the law is 0: no particle would feel a force");
  if (box.dimension() == 2) return std::make_unique<ChargeEngine<2>>(law, box);
  return std::make_unique<ChargeEngine<3>>(law, box);
}

}  // namespace boltzmann
