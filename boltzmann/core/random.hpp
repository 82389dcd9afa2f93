// Counter-based random streams, and the random variables of section 2.2 that are evaluated on them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace boltzmann {

// ---- Philox4x64-10 ----

/// Ten rounds of Philox on four 64-bit words (Salmon, Moraes, Dror and Shaw, "Parallel random numbers: as easy as 1, 2,
/// 3", SC11): a bijection of the counter for every key, whose outputs are random numbers. The bits are the same on
/// every machine.
constexpr std::array<std::uint64_t, 4> philox(std::array<std::uint64_t, 4> counter, std::array<std::uint64_t, 2> key) {
  __extension__ using Wide = unsigned __int128;
  for (int round = 0; round < 10; ++round) {
    Wide const first = static_cast<Wide>(0xD2E7470EE14C6C93U) * counter[0];
    Wide const second = static_cast<Wide>(0xCA5A826395121157U) * counter[2];
    counter = {static_cast<std::uint64_t>(second >> 64) ^ counter[1] ^ key[0], static_cast<std::uint64_t>(second),
               static_cast<std::uint64_t>(first >> 64) ^ counter[3] ^ key[1], static_cast<std::uint64_t>(first)};
    key[0] += 0x9E3779B97F4A7C15U;
    key[1] += 0xBB67AE8584CAA73BU;
  }
  return counter;
}

// ---- Streams ----

/// The use of random numbers. Two purposes never share numbers. The values are part of every stored result: append,
/// never renumber.
enum class Purpose : std::uint32_t {
  position = 0,
  velocity = 1,
  internal_energy = 2,
  selection = 3,    ///< which particle, which species, which order
  pair_noise = 4,   ///< the random force between two particles (DPD, DPDE)
  random_walk = 5,  ///< diffusion of one particle (viscous vortices)
  thermostat = 6,
  field_diffusion = 7,  ///< the random walk of a field with a rate of its own
  user = 0x10000,       ///< this and all above are for users: user_purpose(n)
};

/// The n-th purpose of a user.
constexpr Purpose user_purpose(std::uint32_t n) {
  return static_cast<Purpose>(static_cast<std::uint32_t>(Purpose::user) + n);
}

/// An endless sequence of random numbers that depends only on its key (seed, step, particle, purpose). The order of
/// evaluation, threads, processes and restarts do not change it. Different keys give independent sequences, as the key
/// is used whole instead of hashed. A stream costs nothing to make: each particle makes its own, draws and drops it.
class Stream {
 public:
  constexpr Stream(std::uint64_t seed, std::uint64_t step, std::uint64_t id, std::uint32_t purpose)
      : counter_{0, step, id, 0}, key_{seed, purpose} {}
  constexpr Stream(std::uint64_t seed, std::uint64_t step, std::uint64_t id, Purpose purpose)
      : Stream(seed, step, id, static_cast<std::uint32_t>(purpose)) {}

  /// The stream of a pair of particles: the same for (i, j) and (j, i), independent of all streams of single particles.
  static constexpr Stream pair(std::uint64_t seed, std::uint64_t step, std::uint64_t i, std::uint64_t j,
                               Purpose purpose = Purpose::pair_noise) {
    Stream stream(seed, step, i < j ? i : j, purpose);
    stream.counter_[3] = i < j ? j : i;
    stream.key_[1] |= std::uint64_t{1} << 32;
    return stream;
  }

  /// 64 random bits.
  constexpr std::uint64_t bits() {
    if (next_ == 4) {
      block_ = philox(counter_, key_);
      ++counter_[0];
      next_ = 0;
    }
    return block_[next_++];
  }

  /// Uniform in (0, 1): an odd multiple of 2^-53, so never 0 and never 1, and 1 - u is as likely as u.
  constexpr double uniform() { return static_cast<double>((bits() >> 11) | 1U) * 0x1p-53; }

  /// Normal of mean 0 and variance 1 (Box and Muller 1958; both numbers of a pair are used).
  double normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    double const radius = std::sqrt(-2.0 * std::log(uniform()));
    double const angle = 2.0 * std::numbers::pi * uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
  }

  /// A whole number in [0, count), each exactly as likely. Throws Error if count is 0.
  std::uint64_t below(std::uint64_t count);

 private:
  std::array<std::uint64_t, 4> counter_;
  std::array<std::uint64_t, 2> key_;
  std::array<std::uint64_t, 4> block_{};
  double spare_ = 0.0;
  std::uint32_t next_ = 4;
  bool has_spare_ = false;
};

// ---- Random variables: x(stream) draws, x.quantile(u) is the value below which the fraction u lies ----

/// Uniform in (low, high), or the number low if both are equal (section 2.2.1). Throws Error if low > high or either is
/// not finite.
struct Uniform {
  double low;
  double high;

  Uniform(double low, double high);
  double operator()(Stream& stream) const { return low + (high - low) * stream.uniform(); }
  /// For u in [0, 1]; throws Error otherwise.
  double quantile(double u) const;
};

/// p(x) = exp(-(x - mean)^2 / 2 s^2) / (s sqrt(2 pi)), s the standard deviation (Eq 2.1). The text there calls s "the
/// variance", and its listing uses the square root of s, but its formula has the standard deviation, as here. Throws
/// Error if s < 0 or a parameter is not finite.
struct Normal {
  double mean;
  double standard_deviation;

  Normal(double mean, double standard_deviation);
  double operator()(Stream& stream) const { return mean + standard_deviation * stream.normal(); }
  /// For u in [0, 1], infinite at the ends; absolute accuracy about 1e-15 standard deviations. Throws Error otherwise.
  double quantile(double u) const;
};

/// One component of the velocity of a particle in equilibrium: Normal of mean 0 and s = sqrt(k T / m) (Eq 2.2). The
/// order is always (temperature, mass). With boltzmann_constant 1 the temperature is an energy. Throws Error if
/// temperature < 0, mass <= 0, boltzmann_constant <= 0 or a parameter is not finite.
struct Maxwellian {
  double temperature;
  double mass;
  double boltzmann_constant;

  Maxwellian(double temperature, double mass, double boltzmann_constant = 1.0);
  double standard_deviation() const { return std::sqrt(boltzmann_constant * temperature / mass); }
  double operator()(Stream& stream) const { return standard_deviation() * stream.normal(); }
  /// For u in [0, 1], infinite at the ends. Throws Error otherwise.
  double quantile(double u) const;
};

/// p(x) = rate exp(-rate x), x >= 0 (Eq 2.3): waiting times, heights in gravity. Throws Error if rate <= 0 or not
/// finite.
struct Exponential {
  double rate;

  explicit Exponential(double rate);
  double operator()(Stream& stream) const { return -std::log(stream.uniform()) / rate; }
  /// For u in [0, 1], infinite at 1. Throws Error otherwise.
  double quantile(double u) const;
};

/// Density proportional to nu + mu sin(alpha x + beta) on [a, b] (appendix A.4, C.16): particles with a wave in their
/// density. The condition is |mu| <= nu; the listing's test of its parameters is wrong. Throws Error if a >= b, |mu| >
/// nu, the density vanishes everywhere or a parameter is not finite.
struct Ripple {
  double a;
  double b;
  double alpha;
  double beta;
  double mu;
  double nu;

  Ripple(double a, double b, double alpha, double beta, double mu, double nu);
  double operator()(Stream& stream) const { return quantile(stream.uniform()); }
  /// The normalised density at x; 0 outside [a, b].
  double density(double x) const;
  /// The fraction below x; 0 and 1 outside [a, b].
  double distribution(double x) const;
  /// The inverse of `distribution`, to rounding: N particles at quantile((i + 1/2) / N) are a quiet start. Throws Error
  /// for u outside [0, 1].
  double quantile(double u) const;
};

}  // namespace boltzmann
