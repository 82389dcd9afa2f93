// Statistics for tests of random processes: means with standard errors, Kolmogorov and Smirnov's distance.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace boltzmann {

/// A mean with its standard error.
struct Estimate {
  double mean = 0, error = 0;
};

/// Of independent samples.
inline Estimate estimate(std::vector<double> const& samples) {
  double const n = static_cast<double>(samples.size());
  double sum = 0, square = 0;
  for (double const x : samples) sum += x;
  for (double const x : samples) square += (x - sum / n) * (x - sum / n);
  return {sum / n, std::sqrt(square / (n - 1) / n)};
}

/// Of a time series, whose neighbours depend on each other: by the means of so many blocks.
inline Estimate estimate(std::vector<double> const& series, std::size_t blocks) {
  std::size_t const length = series.size() / blocks;
  std::vector<double> means(blocks, 0.0);
  for (std::size_t i = 0; i < blocks * length; ++i) means[i / length] += series[i] / static_cast<double>(length);
  return estimate(means);
}

/// What `kolmogorov_smirnov` of independent samples of the distribution is above with the probability of five standard
/// errors: 2 exp(-2 x^2) = 6e-7.
inline constexpr double kolmogorov_smirnov_limit = 2.74;

/// sqrt(n) times the largest distance of the samples' distribution from the given one.
template <class Distribution>
double kolmogorov_smirnov(std::vector<double> samples, Distribution const& distribution) {
  std::sort(samples.begin(), samples.end());
  double const n = static_cast<double>(samples.size());
  double largest = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    double const f = distribution(samples[i]), below = static_cast<double>(i);
    largest = std::max({largest, f - below / n, (below + 1) / n - f});
  }
  return std::sqrt(n) * largest;
}

/// The distribution with a density that is known up to its factor, by Simpson's rule between two ends.
class Tabulated {
 public:
  template <class Density>
  Tabulated(Density const& density, double from, double to, std::size_t cells = 4000)
      : from_(from), width_((to - from) / static_cast<double>(cells)), below_(cells + 1, 0.0) {
    for (std::size_t i = 0; i < cells; ++i) {
      double const x = from + width_ * static_cast<double>(i);
      below_[i + 1] = below_[i] + density(x) + 4 * density(x + width_ / 2) + density(x + width_);
    }
    for (double& x : below_) x /= below_.back();
  }
  double operator()(double x) const {
    double const place = std::clamp((x - from_) / width_, 0.0, static_cast<double>(below_.size() - 1));
    auto const i = std::min(static_cast<std::size_t>(place), below_.size() - 2);
    return below_[i] + (place - static_cast<double>(i)) * (below_[i + 1] - below_[i]);
  }

 private:
  double from_, width_;
  std::vector<double> below_;
};

}  // namespace boltzmann
