// Systems for tests of meshes: charges at random, forces as vectors, images behind walls, and what a failure says.
#pragma once

#include <boltzmann/core/error.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace boltzmann::mesh_tests {

template <int D>
Box box_of(Vector<D> const& edges, Boundary boundary) {
  return Box(Vector<D>{}, edges, boundary);
}
template <int D>
Vector<D> filled(double x) {
  Vector<D> v;
  for (int a = 0; a < D; ++a) v[a] = x;
  return v;
}

/// Puts `count` particles at random between low and high, no two (nor images in a periodic box) nearer than `apart`,
/// with charges +1 and -1 in turn. The same places in every run: how accurate a mesh is depends on them (few charges
/// may happen to feel little), and only rounding on the processor.
template <int D>
void scatter(Ensemble<Coulomb<D>>& particles, std::size_t count, Vector<D> const& low, Vector<D> const& high,
             unsigned seed, double apart = 0) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  particles.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int attempt = 0;; ++attempt) {
      if (attempt > 100000) throw Error("scatter: no room");
      for (int a = 0; a < D; ++a) particles[i].position[a] = low[a] + (high[a] - low[a]) * uniform(random);
      bool free = true;
      for (std::size_t j = 0; j < i && apart > 0; ++j) {
        auto r = particles[i].position - particles[j].position;
        for (int a = 0; a < D; ++a) r[a] = std::remainder(r[a], high[a] - low[a]);
        free = free && norm2(r) >= apart * apart;
      }
      if (free) break;
    }
    particles[i].charge = i % 2 == 0 ? 1 : -1;
  }
}

template <class P>
std::vector<Vector<P::dimension>> forces(Ensemble<P> const& particles) {
  std::vector<Vector<P::dimension>> all(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) all[i] = particles.influence_on(i);
  return all;
}
template <class P>
std::vector<Vector<P::dimension>> positions(Ensemble<P> const& particles) {
  std::vector<Vector<P::dimension>> all(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) all[i] = particles[i].position;
  return all;
}

template <int D>
double rms(std::vector<Vector<D>> const& f) {
  double sum = 0;
  for (auto const& v : f) sum += norm2(v);
  return std::sqrt(sum / static_cast<double>(f.size()));
}
/// The rms of a - b over that of b.
template <int D>
double relative_error(std::vector<Vector<D>> const& a, std::vector<Vector<D>> const& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += norm2(a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size())) / rms(b);
}

/// The bits of all rows.
inline std::vector<std::uint64_t> bits(AnyEnsemble const& particles) {
  std::vector<std::uint64_t> all(particles.size() * particles.doubles());
  for (std::size_t i = 0; i < particles.size(); ++i)
    std::memcpy(all.data() + i * particles.doubles(), particles.row(i), particles.doubles() * sizeof(double));
  return all;
}

/// What stands between particles and the end of an axis: an image of sign `sign` at `scale` x + `shift`, x from the low
/// edge.
struct Image {
  double scale, shift, sign;
};
struct Images {
  double period;  ///< lengths of the axis after which all repeats
  std::vector<Image> images;
};

/// Walls as mirrors: Neumann images have the same sign, Dirichlet images the other.
inline Images images_of(FieldEnds const& ends, double length) {
  using enum FieldBoundary;
  if (ends.low == periodic) return {1, {{1, 0, 1}}};
  double const low = ends.low == neumann ? 1 : -1, high = ends.high == neumann ? 1 : -1;
  if (low == high) return {2, {{1, 0, 1}, {-1, 0, low}}};
  return {4, {{1, 0, 1}, {-1, 0, low}, {-1, 2 * length, high}, {1, -2 * length, low * high}}};
}

/// The box with all its images as one periodic box; the particles themselves come first.
template <int D>
struct Mirrored {
  Vector<D> edges;
  std::vector<Vector<D>> positions;
  std::vector<double> strengths;
  std::array<double, D> periods;
  std::size_t copies;
};
template <int D>
Mirrored<D> mirrored(Ensemble<Coulomb<D>> const& particles, Vector<D> const& edges,
                     std::array<FieldEnds, D> const& ends) {
  Mirrored<D> result;
  std::array<Images, D> images;
  result.copies = 1;
  for (int a = 0; a < D; ++a) {
    images[a] = images_of(ends[a], edges[a]);
    result.periods[a] = images[a].period;
    result.edges[a] = images[a].period * edges[a];
    result.copies *= images[a].images.size();
  }
  for (std::size_t c = 0; c < result.copies; ++c)
    for (std::size_t i = 0; i < particles.size(); ++i) {
      auto x = particles[i].position;
      double q = particles[i].charge;
      std::size_t rest = c;
      for (int a = 0; a < D; ++a) {
        auto const& image = images[a].images[rest % images[a].images.size()];
        rest /= images[a].images.size();
        x[a] = image.scale * x[a] + image.shift;
        if (x[a] < 0) x[a] += result.edges[a];
        q *= image.sign;
      }
      result.positions.push_back(x);
      result.strengths.push_back(q);
    }
  return result;
}

/// What call() throws, an Error or a PhysicsFailure; "no failure" if nothing.
std::string failure(auto const& call) {
  try {
    call();
  } catch (Error const& error) {
    return error.what();
  } catch (PhysicsFailure const& error) {
    return error.what();
  }
  return "no failure";
}
inline bool has(std::string const& text, std::string const& part) { return text.find(part) != std::string::npos; }

}  // namespace boltzmann::mesh_tests
