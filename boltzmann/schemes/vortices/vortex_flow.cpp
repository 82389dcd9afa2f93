// Copies vortices to rows of one class, and sums over them.
#include <boltzmann/boundaries/flow_images.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/kernel_dispatch.hpp>
#include <boltzmann/schemes/multipole/multipole_scheme.hpp>
#include <boltzmann/schemes/vortices/flow_kernels.hpp>
#include <boltzmann/schemes/vortices/vortex_flow.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr double most_pairs = 2e9;

FlowKernels const& kernels_of_flow(int dimension) {
  return for_instruction_set(
      [&](auto set) -> FlowKernels const& { return flow_kernels<decltype(set)::value>().of[dimension - 2]; });
}

/// True if the system repeats along this axis.
bool repeats_along(Box const& box, int axis) {
  return box.periodic(axis) || (box.boundary(axis) == Boundary::mirror && box.walled(axis, Box::End::low) &&
                                box.walled(axis, Box::End::high));
}

bool same(VortexLaw const& a, VortexLaw const& b) { return a.core == b.core; }

template <int D>
std::unique_ptr<AnyEnsemble> elements_of(std::vector<VortexSource> const& sources) {
  auto all = std::make_unique<Ensemble<Vortex<D>>>("vortices");
  std::size_t total = 0, at = 0;
  for (auto const& source : sources) total += source.ensemble->size();
  all->resize(total);
  for (auto const& source : sources) {
    AnyEnsemble const& one = *source.ensemble;
    int const vorticity = one.field("vorticity").offset, core = one.field("core").offset;
    for (std::size_t i = 0; i < one.size(); ++i, ++at) {
      double const* const row = one.row(i);
      auto& element = (*all)[at];
      for (int a = 0; a < D; ++a) element.position[a] = row[a];
      for (int k = 0; k < cross_dimension<D>; ++k) element.vorticity[k] = row[vorticity + k];
      element.core = row[core];
    }
  }
  return all;
}

template <class Core>
double own_strength(BiotSavartOf<Core> const&, double core2) {
  return core2 > 0 ? Core::turning_3d(0.0, core2).strength : 0;
}

template <int D>
std::unique_ptr<AnyEnsemble> places_of(std::span<double const> places) {
  auto all = std::make_unique<Ensemble<Vortex<D>>>("places", places.size() / D);
  for (std::size_t i = 0; i < all->size(); ++i)
    for (int a = 0; a < D; ++a) (*all)[i].position[a] = places[i * D + static_cast<std::size_t>(a)];
  return all;
}

/// The sums over all sources at these targets, `width` numbers for each.
std::vector<double> sums(PairKernel kernel, VortexLaw const& law, AnyEnsemble const& targets,
                         AnyEnsemble const& sources, std::size_t width, int threads) {
  std::vector<double> found(targets.size() * width);
  if (sources.size() == 0) return found;
  PairTask task;
  task.target = targets.row(0);
  task.targets = targets.size();
  task.target_row_stride = targets.stride();
  task.source = sources.row(0);
  task.sources = sources.size();
  task.source_row_stride = sources.stride();
  task.overwrite = true;
  task.influence = found.data();
  for_ranges(targets.size(), 64, threads_for(targets.size(), static_cast<double>(sources.size()) / 8, threads),
             [&](std::size_t begin, std::size_t end) { kernel(&law, task, begin, end); });
  return found;
}

}  // namespace

std::vector<VortexSource> vortex_sources(std::vector<Scheme*> const& schemes) {
  std::vector<VortexSource> all;
  for (auto const* scheme : schemes)
    for (auto const& source : scheme->vortices()) {
      auto const known = std::find_if(all.begin(), all.end(),
                                      [&](VortexSource const& one) { return one.ensemble == source.ensemble; });
      if (known == all.end())
        all.push_back(source);
      else if (!same(known->law, source.law))
        throw Error(fmt::format("the vortices of '{}' act by laws with different cores, so that their flow is not one",
                                source.ensemble->name()));
      else
        known->tolerance = std::max(known->tolerance, source.tolerance);
    }
  return all;
}

struct VortexFlow::Elements {
  std::unique_ptr<AnyEnsemble> rows;
};

VortexFlow::VortexFlow(std::vector<VortexSource> const& sources, Box const& box, int threads)
    : law_(sources.empty() ? VortexLaw(BiotSavart{}) : sources.front().law),
      box_(box),
      dimension_(box.dimension()),
      threads_(threads),
      elements_(std::make_unique<Elements>()) {
  if (sources.empty()) throw Error("there are no vortices that make a flow: no law of Biot and Savart acts");
  for (auto const& source : sources) {
    if (!same(source.law, law_))
      throw Error(
          fmt::format("the vortices of '{}' and '{}' act by laws with different cores, so that their flow is "
                      "not one",
                      sources.front().ensemble->name(), source.ensemble->name()));
    tolerance_ = std::max(tolerance_, source.tolerance);
    background_ = background_ || source.background;
  }
  elements_->rows = dimension_ == 2 ? elements_of<2>(sources) : elements_of<3>(sources);
  size_ = elements_->rows->size();
}

VortexFlow::~VortexFlow() = default;
VortexFlow::VortexFlow(VortexFlow&&) noexcept = default;

bool VortexFlow::repeats(Box const& box) {
  for (int a = 0; a < box.dimension(); ++a)
    if (repeats_along(box, a)) return true;
  return false;
}

void VortexFlow::refuse_images(Box const& box) {
  for (int a = 0; a < box.dimension(); ++a)
    if (box.periodic(a) || box.boundary(a) == Boundary::mirror)
      throw Error(fmt::format("axis {} is {}, and the energy of the vortices is known in open space only", "xyz"[a],
                              box.periodic(a) ? "periodic" : "a mirror"));
}

FlowMeasures VortexFlow::measure() const {
  refuse_images(box_);
  FlowMeasures measures;
  AnyEnsemble const& all = *elements_->rows;
  int const numbers = dimension_ == 2 ? 1 : 3;
  std::size_t const width = dimension_ == 2 ? 3 : 12;
  auto const found =
      sums(kernels_of_flow(dimension_).sums[static_cast<int>(law_.core)], law_, all, all, width, threads_);
  int const vorticity = all.field("vorticity").offset;
  ExactSum energy, enstrophy, misfit, curls;
  for (std::size_t i = 0; i < size_; ++i) {
    double const *const own = all.row(i) + vorticity, *const sum = found.data() + i * width;
    double size2 = 0;
    double const* const flow = dimension_ == 2 ? sum : sum + 3;  // vorticity, of both, potential
    for (int k = 0; k < numbers; ++k) {
      energy += 0.5 * own[k] * flow[2 * numbers + k];
      enstrophy += own[k] * flow[numbers + k];
      size2 += flow[k] * flow[k];
    }
    measures.largest_vorticity = std::max(measures.largest_vorticity, std::sqrt(size2));
    if (dimension_ == 2) continue;
    double strength2 = 0, difference2 = 0;
    for (int k = 0; k < 3; ++k) strength2 += own[k] * own[k], difference2 += (sum[k] - flow[k]) * (sum[k] - flow[k]);
    misfit += std::sqrt(strength2) * difference2;
    curls += std::sqrt(strength2) * size2;
  }
  measures.energy = energy.value();
  measures.enstrophy = enstrophy.value();
  if (curls.value() > 0) measures.divergence = std::sqrt(misfit.value() / curls.value());
  return measures;
}

std::vector<double> VortexFlow::at(std::span<double const> places) const {
  auto const D = static_cast<std::size_t>(dimension_);
  double const pairs = static_cast<double>(places.size() / D) * static_cast<double>(size_);
  if (dimension_ == 3 && (repeats(box_) || pairs > most_pairs)) {
    auto const scheme = MultipoleScheme::of_slopes(box_, law_, tolerance_ > 0 ? tolerance_ : 1e-4);
    scheme->threads(threads_);
    scheme->add(*elements_->rows, source_kind<Vortex<3>>());
    return scheme->slopes_at(places.data(), places.size() / D);
  }
  if (!repeats(box_)) return at_by_pairs(places);
  std::vector<Vector<2>> plane(places.size() / 2);
  for (std::size_t k = 0; k < plane.size(); ++k) plane[k] = {places[2 * k], places[2 * k + 1]};
  MultipoleScheme scheme(box_, law_, tolerance_ > 0 ? tolerance_ : 1e-4);
  scheme.threads(threads_);
  scheme.add(*elements_->rows, source_kind<Vortex<2>>());
  scheme.background(background_);
  auto const velocities = scheme.velocity_at(plane);
  // Vorticity is nonzero only in cores: those in the box and in the images beside it.
  auto found = sums_at(places, with_images());
  for (std::size_t k = 0; k < plane.size(); ++k) found[3 * k] = velocities[k][0], found[3 * k + 1] = velocities[k][1];
  return found;
}

std::unique_ptr<AnyEnsemble> VortexFlow::with_images() const {
  AnyEnsemble const& own = *elements_->rows;
  auto all = dimension_ == 2 ? elements_of<2>({}) : elements_of<3>({});
  std::vector<double> rows, beyond;
  for (std::size_t i = 0; i < own.size(); ++i) rows.insert(rows.end(), own.row(i), own.row(i) + own.stride());
  find_flow_images(own, box_, flow_images(box_), beyond);
  rows.insert(rows.end(), beyond.begin(), beyond.end());
  for (std::size_t first = 0; first < rows.size(); first += own.stride())
    for (int a = 0; a < dimension_; ++a)
      if (double& x = rows[first + static_cast<std::size_t>(a)]; box_.periodic(a))
        x -= box_.length(a) * std::floor((x - box_.low(a)) / box_.length(a));
  // Add one more period on both sides of a repeating axis.
  for (int a = 0; a < dimension_; ++a) {
    if (!repeats_along(box_, a)) continue;
    double const period = box_.length(a) * (box_.periodic(a) ? 1 : 2);
    std::size_t const before = rows.size();
    for (double const shift : {-period, period})
      for (std::size_t k = 0; k < before; ++k)
        rows.push_back(rows[k] + (k % own.stride() == static_cast<std::size_t>(a) ? shift : 0));
  }
  all->resize(rows.size() / own.stride());
  if (all->size() > 0) std::copy(rows.begin(), rows.end(), all->row(0));
  return all;
}

std::vector<double> VortexFlow::at_by_pairs(std::span<double const> places) const {
  if (repeats(box_)) throw Error("where vortices have images without end their flow is found by multipoles");
  return sums_at(places, box_.any_wall() ? with_images() : nullptr);
}

std::vector<double> VortexFlow::sums_at(std::span<double const> places, std::unique_ptr<AnyEnsemble> sources) const {
  auto const targets = dimension_ == 2 ? places_of<2>(places) : places_of<3>(places);
  return sums(kernels_of_flow(dimension_).slopes[static_cast<int>(law_.core)], law_, *targets,
              sources ? *sources : *elements_->rows, width(dimension_), threads_);
}

SourceKind vortex_kind(AnyEnsemble const& ensemble) {
  SourceKind kind;
  kind.carried = true;
  kind.vorticity = ensemble.field("vorticity").offset;
  kind.core = ensemble.field("core").offset;
  return kind;
}

double own_turning(VortexLaw const& law, double core) {
  return law.visit([&](auto const& own) { return own_strength(own, core * core); }) / (2 * pi);
}

Vector<3> curl_of(double const* flow) {
  double const* const d = flow + 3;  // d[3 a + b]: of component a along b
  return {d[7] - d[5], d[2] - d[6], d[3] - d[1]};
}

double q_of(double const* flow) {
  double const* const d = flow + 3;
  double sum = 0;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) sum += d[3 * a + b] * d[3 * b + a];
  return -0.5 * sum;
}

}  // namespace boltzmann
