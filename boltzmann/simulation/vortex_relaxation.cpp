// The curl at every vortex, and the change of its vorticity.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/schemes/multipole/multipole_scheme.hpp>
#include <boltzmann/schemes/vortices/vortex_flow.hpp>
#include <boltzmann/simulation/vortex_relaxation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace boltzmann {
namespace {

/// True if the flow changes its vorticity.
bool is_stretched(AnyEnsemble const& ensemble) { return ensemble.influence_size() >= 6; }

}  // namespace

VortexRelaxation::VortexRelaxation(Scheme& scheme, Relaxing const& relaxing)
    : VortexRelaxation(std::vector<Scheme*>{&scheme}, relaxing) {}

VortexRelaxation::VortexRelaxation(std::vector<Scheme*> schemes, Relaxing const& relaxing)
    : schemes_(std::move(schemes)), relaxing_(relaxing), sources_(vortex_sources(schemes_)) {
  if (!(relaxing.fraction > 0 && relaxing.fraction <= 1))
    throw Error(fmt::format("relaxation: the fraction must be above 0 and at most 1, not {}", relaxing.fraction));
  if (sources_.empty()) throw Error("relaxation: there are no vortices that act by a law of Biot and Savart");
  Box const& box = schemes_.front()->box();
  if (box.dimension() != 3) throw Error("relaxation: in a plane vorticity has no divergence; it is for vortices in 3D");
  if (std::none_of(sources_.begin(), sources_.end(), [](auto const& one) { return is_stretched(*one.ensemble); }))
    throw Error(fmt::format("relaxation: the vorticity of '{}' stays as it is; Inviscid and Viscous are relaxed",
                            sources_.front().ensemble->name()));
  double tolerance = 0;
  for (auto const& source : sources_) tolerance = std::max(tolerance, source.tolerance);
  if (tolerance == 0 && VortexFlow::repeats(box))
    throw Error("relaxation: where vortices have images without end it needs multipoles");
  if (tolerance > 0) {
    multipoles_ = MultipoleScheme::of_slopes(box, sources_.front().law, tolerance);
    for (auto const& source : sources_) multipoles_->add(*source.ensemble, vortex_kind(*source.ensemble));
  }
}

VortexRelaxation::~VortexRelaxation() = default;
VortexRelaxation::VortexRelaxation(VortexRelaxation&&) noexcept = default;

/// The velocity gradients of the flow at all vortices, in their order.
std::vector<double> VortexRelaxation::slopes() {
  int const threads = schemes_.front()->threads();
  if (multipoles_) {
    multipoles_->threads(threads);
    return multipoles_->slopes_at_particles();
  }
  std::vector<double> places;
  for (auto const& source : sources_)
    for (std::size_t i = 0; i < source.ensemble->size(); ++i)
      places.insert(places.end(), source.ensemble->row(i), source.ensemble->row(i) + 3);
  return VortexFlow(sources_, schemes_.front()->box(), threads).at_by_pairs(places);
}

void VortexRelaxation::change() {
  std::vector<double> const flow = slopes();
  double const f = relaxing_.fraction;
  ExactSum turned, all;
  std::size_t at = 0;
  for (auto const& source : sources_) {
    AnyEnsemble& ensemble = *source.ensemble;
    int const offset = ensemble.field("vorticity").offset, core = ensemble.field("core").offset;
    for (std::size_t i = 0; i < ensemble.size(); ++i, ++at) {
      if (!is_stretched(ensemble)) continue;
      double* const vorticity = ensemble.row(i) + offset;
      Vector<3> const alpha{vorticity[0], vorticity[1], vorticity[2]};
      Vector<3> curl = curl_of(flow.data() + at * VortexFlow::width(3));
      // Expansions exclude an element's own flow, which turns it without moving it.
      if (multipoles_) curl += alpha * own_turning(source.law, ensemble.row(i)[core]);
      double const length = magnitude(alpha), size = magnitude(curl);
      if (!(size > 0)) continue;
      Vector<3> const wanted = curl * (length / size);
      Vector<3> next = alpha * (1 - f) + wanted * f;
      double const left = magnitude(next);
      if (relaxing_.corrected) next = left > 0 ? next * (length / left) : alpha;
      turned += norm2(wanted - alpha), all += length * length;
      for (int a = 0; a < 3; ++a) vorticity[a] = next[a];
    }
  }
  misfit_ = all.value() > 0 ? std::sqrt(turned.value() / all.value()) : 0;
  if (times_ == 0) first_ = misfit_;
  ++times_;
}

std::string VortexRelaxation::report(UnitSystem const&) const {
  if (times_ == 0) return "";
  return fmt::format("vorticity relaxed {:.0f} time{}: {:.2g} of it had a divergence at first, {:.2g} the last time",
                     times_, times_ == 1 ? "" : "s", first_, misfit_);
}

std::vector<double> VortexRelaxation::state() const {
  std::vector<double> all{times_, misfit_, first_};
  if (multipoles_)
    for (double const number : multipoles_->state()) all.push_back(number);
  return all;
}

void VortexRelaxation::restore(std::span<double const> state) {
  bool const fits = multipoles_ ? state.size() == 7 || state.size() == 8 : state.size() == 3;
  if (!fits) throw Error("the checkpoint does not fit this simulation: it has no relaxation of vorticity");
  times_ = state[0], misfit_ = state[1], first_ = state[2];
  if (!multipoles_) return;
  multipoles_->restore(state.subspan(3));
  multipoles_->influences_restored();  // no calculation needs to be repeated
}

OptionTable const& relaxation_options() {
  using namespace option;
  using R = RelaxationOptions;
  static OptionTable const table = [] {
    OptionTable all;
    all.add("every", &R::every, whole(1, std::numeric_limits<double>::infinity()), "steps between relaxations");
    all.add("fraction", &R::relaxing, &Relaxing::fraction, number(dimensions::none, {0, 1, true}),
            "part of the divergence removed each time");
    all.add("corrected", &R::relaxing, &Relaxing::corrected, flag(),
            "keep the magnitude of vorticities; else they shorten as they turn");
    all.at("every").needed = std::string("5");
    return all;
  }();
  return table;
}

}  // namespace boltzmann
