// The circle theorem.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/kernel_dispatch.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/schemes/cylinder/cylinder_flow.hpp>
#include <boltzmann/schemes/cylinder/image_kernel.hpp>
#include <boltzmann/schemes/flow_classes.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace boltzmann {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t image_doubles = row_stride<Vortex<2>>;
constexpr std::size_t grain = 64;  // a multiple of the kernel's block

}  // namespace

OptionTable const& cylinder_options() {
  static OptionTable const all = [] {
    using namespace option;
    OptionTable all;
    auto const vector_of = [](Vector<2> CylinderOptions::*member) {
      return [member](CylinderOptions& of) -> OptionPlace { return std::span((of.*member).component); };
    };
    all.add("radius", &CylinderOptions::radius, number(dimensions::length, positive), "radius of the cylinder");
    all.add_of<CylinderOptions>("centre", vector_of(&CylinderOptions::centre), vector(dimensions::length),
                                "centre of the cylinder", "0 on each axis");
    all.add_of<CylinderOptions>("stream", vector_of(&CylinderOptions::stream), vector(dimensions::velocity),
                                "velocity far from the cylinder", "none");
    all.add("circulation", &CylinderOptions::circulation, number(dimensions::circulation), "around the cylinder");
    all.at("radius").needed = "0.5";
    return all;
  }();
  return all;
}

CylinderFlow::CylinderFlow(Box box, CylinderOptions const& options) : Scheme(std::move(box)), options_(options) {
  if (this->box().dimension() != 2)
    throw Error(fmt::format("cylinder: images in a circle are of 2D; the box has {} dimension{}",
                            this->box().dimension(), this->box().dimension() == 1 ? "" : "s"));
  for (int a = 0; a < 2; ++a)
    if (this->box().boundary(a) != Boundary::open)
      throw Error(fmt::format(
          "cylinder: axis {} is {}, where images would have images; the cylinder needs open space: boundary = \"open\"",
          "xy"[a], to_string(this->box().boundary(a))));
  if (!(options.radius > 0 && std::isfinite(options.radius)))
    throw Error(fmt::format("cylinder: the radius is a positive length, not {}", options.radius));
  for (double const x :
       {options.centre[0], options.centre[1], options.stream[0], options.stream[1], options.circulation})
    if (!std::isfinite(x)) throw Error(fmt::format("cylinder: {} is not finite", x));
}

bool CylinderFlow::outside(double const* position) const {
  double const x = position[0] - options_.centre[0], y = position[1] - options_.centre[1];
  return x * x + y * y >= options_.radius * options_.radius;
}

void CylinderFlow::add(AnyEnsemble& ensemble, SourceKind const& kind) {
  if (!kind.carried)
    throw Error(fmt::format("cylinder: class {} of '{}' is not carried by a flow; {} are", ensemble.class_name(),
                            ensemble.name(), classes_carried_by_flows));
  for (std::size_t i = 0; kind.vorticity >= 0 && i < ensemble.size(); ++i)
    if (!outside(ensemble.row(i)))
      throw Error(fmt::format("cylinder: vortex {} of '{}' is inside; its image would be outside", i, ensemble.name()));
  if (supervises(ensemble)) return;
  Scheme::add(ensemble);
  carried_.push_back({&ensemble, kind});
}

void CylinderFlow::find_images() {
  images_.clear();
  double const square = options_.radius * options_.radius;
  auto const add = [&](double x, double y, double circulation, double core) {
    std::size_t const at = images_.size();
    images_.resize(at + image_doubles);
    images_[at] = options_.centre[0] + x, images_[at + 1] = options_.centre[1] + y;
    images_[at + 2] = circulation, images_[at + 3] = core;
  };
  ExactSum circulations;
  for (auto const& [ensemble, kind] : carried_) {
    for (std::size_t i = 0; kind.vorticity >= 0 && i < ensemble->size(); ++i) {
      double const* const row = ensemble->row(i);
      if (!outside(row))
        throw PhysicsFailure(fmt::format("particle {} of '{}' has come into the cylinder{}", i, ensemble->name(),
                                         std::isfinite(row[0] + row[1]) ? "; take a shorter step" : ""));
      double const x = row[0] - options_.centre[0], y = row[1] - options_.centre[1];
      double const scale = square / (x * x + y * y), circulation = row[kind.vorticity];
      add(scale * x, scale * y, -circulation, scale * row[kind.core]);
      circulations += circulation;
    }
  }
  add(0, 0, options_.circulation + circulations.value(), 0);
}

void CylinderFlow::add_influences(double /*time*/) {
  if (division_) division_->make_whole();
  find_images();
  for (auto const& carried : carried_) carry(*carried.ensemble);
}

void CylinderFlow::add_stream(std::span<double const> places, double /*time*/, std::span<double> velocities) {
  find_images();
  Ensemble<Tracer<2>> tracers("places", places.size() / 2);
  for (std::size_t i = 0; i < tracers.size(); ++i) tracers[i].position = {places[2 * i], places[2 * i + 1]};
  carry(tracers);
  double const nowhere = std::numeric_limits<double>::quiet_NaN();  // there is no fluid inside
  for (std::size_t i = 0; i < tracers.size(); ++i)
    for (std::size_t a = 0; a < 2; ++a)
      velocities[2 * i + a] = outside(tracers.row(i)) ? velocities[2 * i + a] + tracers.influence(i)[a] : nowhere;
}

/// Adds the velocity of the present images.
void CylinderFlow::carry(AnyEnsemble& ensemble) {
  PairKernel const kernel = for_instruction_set([](auto set) { return image_kernel<decltype(set)::value>(); });
  ImageLaw const law{};
  Complex const stream(options_.stream[0], options_.stream[1]);
  double const square = options_.radius * options_.radius;
  std::size_t const sources = images_.size() / image_doubles;
  if (ensemble.size() == 0) return;
  std::size_t const felt = ensemble.influence_size();
  velocity_.resize(2 * ensemble.size());
  PairTask task;
  task.target = ensemble.row(0), task.targets = ensemble.size(), task.target_row_stride = ensemble.stride();
  task.source = images_.data(), task.sources = sources, task.source_row_stride = image_doubles;
  task.overwrite = true;
  task.influence = velocity_.data();
  double const work = static_cast<double>(sources * ensemble.size());
  for_share(ensemble, grain * (1 + 2048 / (sources + 1)), threads_for(static_cast<std::size_t>(work), 0.125, threads()),
            [&](std::size_t begin, std::size_t end) {
              kernel(&law, task, begin, end);
              for (std::size_t i = begin; i < end; ++i) {
                double const* const row = ensemble.row(i);
                if (!outside(row)) continue;
                Complex const z(row[0] - options_.centre[0], row[1] - options_.centre[1]);
                Complex const flow = std::conj(stream) - stream * square / (z * z);  // u - i v
                ensemble.influence(i)[0] += velocity_[2 * i] + flow.real();
                ensemble.influence(i)[felt > 1 ? 1 : 0] += velocity_[2 * i + 1] - flow.imag();
              }
            });
}

EnergyAndVirial CylinderFlow::measure(double /*time*/) {
  EnergyAndVirial measures;
  measures.unknown = "the flow past a cylinder";
  measures.no_virial = "a flow has no forces";
  return measures;
}

double CylinderFlow::length_scale(AnyEnsemble const& /*ensemble*/) const { return __builtin_inf(); }

std::string CylinderFlow::explain(AnyEnsemble const& /*ensemble*/, std::size_t /*i*/) const { return ""; }

void CylinderFlow::make_reversible(double /*quantum*/) {
  throw Error("the flow past a cylinder can't be reversed to the bit; use leap-frog's relatives for forces, rk4 here");
}

std::size_t CylinderFlow::bytes() const { return (images_.capacity() + velocity_.capacity()) * sizeof(double); }

std::string CylinderFlow::summary() const {
  return fmt::format("flow past a cylinder of radius {}", spoken_units().text(options_.radius, dimensions::length, 4));
}

}  // namespace boltzmann
