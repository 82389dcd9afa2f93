// FIRE 2.0 with a limit on each particle's motion: far from a minimum it is a descent by steps of that length, near it
// the published method.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/loaders/ensemble_seed.hpp>
#include <boltzmann/simulation/descent.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace boltzmann {
namespace {

// Parameters of the paper.
constexpr double first_mixing = 0.25, mixing_falls = 0.99, step_grows = 1.1, step_falls = 0.5, most_growth = 10;
constexpr int delay = 20;
// Steps may become far shorter than the first one, which is the step of the run.
constexpr double least_step = 1e-6;
constexpr int most_separations = 50;

using Three = std::array<double, 3>;

double square_of(Three const& a) { return a[0] * a[0] + a[1] * a[1] + a[2] * a[2]; }

Three force_on(AnyEnsemble const& ensemble, std::size_t i) {
  Three force{};
  std::copy_n(ensemble.influence(i), ensemble.dimension(), force.begin());
  return force;
}

/// The factor that shortens a vector of this square to at most `most`.
double shortening(double square, double most) { return square > most * most ? most / std::sqrt(square) : 1; }

/// Calls f(i) for all that move.
template <class F>
void each_of(Descending const& part, F const& f) {
  for (std::size_t i = 0; i < part.ensemble->size(); ++i)
    if (part.rests.empty() || !part.rests[i]) f(i);
}

}  // namespace

Descent::Descent(std::vector<Descending>& parts, double mass, double step, std::uint64_t seed, int threads,
                 std::function<void()> influences)
    : parts_(parts),
      mass_(mass),
      step_(step),
      longest_(most_growth * step),
      shortest_(least_step * step),
      seed_(seed),
      threads_(threads),
      influences_(std::move(influences)),
      mixing_(first_mixing) {
  for (auto& part : parts_)
    part.velocities.assign(part.ensemble->size() * static_cast<std::size_t>(part.ensemble->dimension()), 0.0);
}

void Descent::calculate() {
  influences_();
  for (int k = 0; separate(); ++k) {
    if (k == most_separations) throw Error("forces are not finite, however particles are moved apart");
    influences_();
  }
  largest_ = {};
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    press_on_walls(parts_[k]);
    each_of(parts_[k], [&](std::size_t i) {
      double const square = square_of(force_on(*parts_[k].ensemble, i));
      if (square > largest_.square) largest_ = {square, k, i};
    });
  }
}

/// Displaces particles whose force is not finite by a little; false if there are none.
bool Descent::separate() {
  bool some = false;
  ++calls_;
  for (auto& part : parts_) {
    int const D = part.ensemble->dimension();
    std::uint64_t const key = ensemble_seed(seed_, part.ensemble->name(), "minimise");
    bool moved = false;
    each_of(part, [&](std::size_t i) {
      if (std::isfinite(square_of(force_on(*part.ensemble, i)))) return;
      Stream stream(key, calls_, i, Purpose::position);
      for (int a = 0; a < D; ++a) {
        part.ensemble->row(i)[a] += part.distance / std::sqrt(D) * (2 * stream.uniform() - 1);
        part.velocities[i * static_cast<std::size_t>(D) + static_cast<std::size_t>(a)] = 0;
      }
      ++separated_;
      moved = true;
    });
    if (moved) bring_back(part);
    some = some || moved;
  }
  return some;
}

/// Removes the component of forces that presses particles at a wall against it.
void Descent::press_on_walls(Descending& part) {
  Box const& box = *part.box;
  for (int a = 0; a < box.dimension(); ++a) {
    if (box.boundary(a) != Boundary::reflecting) continue;
    bool const low = box.walled(a, Box::End::low), high = box.walled(a, Box::End::high);
    each_of(part, [&](std::size_t i) {
      double const x = part.ensemble->row(i)[a];
      double& force = part.ensemble->influence(i)[a];
      if ((low && x <= box.low(a) && force < 0) || (high && x >= box.high(a) && force > 0)) force = 0;
    });
  }
}

void Descent::step() {
  double power = 0;
  for (auto const& part : parts_) {
    auto const D = static_cast<std::size_t>(part.ensemble->dimension());
    double const most = mass_ * part.distance / (step_ * step_);
    each_of(part, [&](std::size_t i) {
      Three const force = force_on(*part.ensemble, i);
      double along = 0;
      for (std::size_t a = 0; a < D; ++a) along += force[a] * part.velocities[i * D + a];
      power += shortening(square_of(force), most) * along;
    });
  }
  if (power > 0) {
    if (++downhill_ > delay) {
      step_ = std::min(step_grows * step_, longest_);
      mixing_ *= mixing_falls;
    }
  } else if (power < 0) {
    halve();
  }
  move();
}

/// Uphill: moves half a step back, and restarts from rest with shorter steps.
void Descent::halve() {
  downhill_ = 0;
  step_ = std::max(step_falls * step_, shortest_);
  mixing_ = first_mixing;
  for (auto& part : parts_) {
    auto const D = static_cast<std::size_t>(part.ensemble->dimension());
    each_of(part, [&](std::size_t i) {
      for (std::size_t a = 0; a < D; ++a) part.ensemble->row(i)[a] -= 0.5 * step_ * part.velocities[i * D + a];
    });
    std::fill(part.velocities.begin(), part.velocities.end(), 0.0);
  }
}

void Descent::move() {
  double velocity2 = 0, force2 = 0;
  for (auto& part : parts_) {
    auto const D = static_cast<std::size_t>(part.ensemble->dimension());
    double const most = mass_ * part.distance / (step_ * step_);
    each_of(part, [&](std::size_t i) {
      Three const force = force_on(*part.ensemble, i);
      double const part_of_it = shortening(square_of(force), most);
      force2 += part_of_it * part_of_it * square_of(force);
      for (std::size_t a = 0; a < D; ++a) {
        double& v = part.velocities[i * D + a];
        v += step_ / mass_ * part_of_it * force[a];
        velocity2 += v * v;
      }
    });
  }
  double const turned = force2 > 0 ? mixing_ * std::sqrt(velocity2 / force2) : 0;
  for (auto& part : parts_) {
    auto const D = static_cast<std::size_t>(part.ensemble->dimension());
    double const most = mass_ * part.distance / (step_ * step_);
    each_of(part, [&](std::size_t i) {
      Three const force = force_on(*part.ensemble, i);
      double const part_of_it = shortening(square_of(force), most);
      Three v{};
      for (std::size_t a = 0; a < D; ++a)
        v[a] = (1 - mixing_) * part.velocities[i * D + a] + turned * part_of_it * force[a];
      double const bounded = shortening(square_of(v), part.distance / step_);
      for (std::size_t a = 0; a < D; ++a) {
        part.velocities[i * D + a] = bounded * v[a];
        part.ensemble->row(i)[a] += step_ * bounded * v[a];
      }
    });
    bring_back(part);
  }
}

/// Into the box: a particle that a wall stops comes to rest there; the faces of regions are as in the run.
void Descent::bring_back(Descending& part) {
  Box const& box = *part.box;
  AnyEnsemble& ensemble = *part.ensemble;
  auto const D = static_cast<std::size_t>(ensemble.dimension());
  for (int a = 0; a < box.dimension(); ++a) {
    bool const low = box.walled(a, Box::End::low), high = box.walled(a, Box::End::high),
               mirror = box.boundary(a) == Boundary::mirror;
    if (!box.periodic(a) && !low && !high) continue;
    each_of(part, [&](std::size_t i) {
      double& x = ensemble.row(i)[a];
      if (box.periodic(a)) {
        x = box.wrapped(x, a);
      } else if ((low && x < box.low(a)) || (high && x > box.high(a))) {
        double const wall = x < box.low(a) ? box.low(a) : box.high(a);
        x = mirror ? std::clamp(2 * wall - x, box.low(a), box.high(a)) : wall;
        part.velocities[i * D + static_cast<std::size_t>(a)] = 0;
      }
    });
  }
  if (box.regions().empty()) return;
  int const velocity = ensemble.field("velocity").offset;
  each_of(part, [&](std::size_t i) { std::copy_n(&part.velocities[i * D], D, ensemble.row(i) + velocity); });
  box.apply(ensemble, threads_);
  each_of(part, [&](std::size_t i) {
    std::copy_n(ensemble.row(i) + velocity, D, &part.velocities[i * D]);
    std::fill_n(ensemble.row(i) + velocity, D, 0.0);
  });
}

}  // namespace boltzmann
