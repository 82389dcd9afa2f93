// Selection and weights of samples.
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/schemes/multipole/error_samples.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace boltzmann {
namespace {

/// Several hundred samples, or more if they take little time.
std::size_t sample_count(std::size_t candidates, std::size_t particles, std::size_t least) {
  return std::min(candidates, std::max(least, 20'000'000 / std::max<std::size_t>(1, particles)));
}

}  // namespace

ErrorSamples::ErrorSamples(MultipoleEngine const& engine, std::size_t particles, std::size_t least, double exact_to,
                           int threads)
    : engine_(engine), exact_to_(exact_to), threads_(threads) {
  for (std::size_t i = 0; i < particles; ++i)
    if (engine.feels(i)) shuffled_.push_back(static_cast<std::uint32_t>(i));
  wanted_ = sample_count(shuffled_.size(), particles, least);
  Stream stream(0, 0, particles, Purpose::selection);
  for (std::size_t i = shuffled_.size(); i > 1; --i) std::swap(shuffled_[i - 1], shuffled_[stream.bits() % i]);
}

/// The mean without the largest fiftieth of the values.
double ErrorSamples::typical(std::vector<Square> squares) {
  std::stable_sort(squares.begin(), squares.end(), [](auto const& a, auto const& b) { return a.value < b.value; });
  double all = 0, kept = 0;
  for (auto const& one : squares) all += one.weight;
  ExactSum sum;
  for (auto const& one : squares) {
    double const weight = std::min(one.weight, 0.98 * all - kept);
    if (!(weight > 0)) break;
    kept += weight;
    sum += weight * one.value;
  }
  return kept > 0 ? sum.value() / kept : 0;
}

double ErrorSamples::typical_field() {
  std::vector<Sample> samples;
  for (std::size_t k = 0; k < wanted_; ++k) samples.push_back({shuffled_[k], 1});
  find_exact(samples);
  std::vector<Square> squares;
  for (auto const& sample : samples) {
    squares.push_back({square(engine_.least_field()), sample.weight});
    for (std::size_t a = 0; a < engine_.dimension(); ++a) squares.back().value += square(exact(sample.particle)[a]);
  }
  return std::sqrt(typical(std::move(squares))) / engine_.constant();
}

/// Ranks of 2 m, 8 m, 32 m, ... particles, each in random order; takes m samples of each rank, and all of the first.
std::vector<ErrorSamples::Sample> ErrorSamples::by_ranks() const {
  std::vector<Sample> samples;
  std::size_t const of_each = wanted_ == shuffled_.size() ? wanted_ : std::max<std::size_t>(wanted_ / 8, 1);
  auto const& nearness = engine_.nearness();
  std::vector<std::uint32_t> ranked(shuffled_.size());
  std::iota(ranked.begin(), ranked.end(), 0U);
  std::stable_sort(ranked.begin(), ranked.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return nearness[shuffled_[a]] > nearness[shuffled_[b]]; });
  for (std::size_t begin = 0, size = 2 * of_each; begin < ranked.size(); begin += size, size *= 4) {
    std::size_t const end = std::min(ranked.size(), begin + size);
    std::size_t const drawn = begin == 0 ? end : std::min(end - begin, of_each);
    std::sort(ranked.begin() + static_cast<std::ptrdiff_t>(begin), ranked.begin() + static_cast<std::ptrdiff_t>(end));
    for (std::size_t k = 0; k < drawn; ++k)
      samples.push_back({shuffled_[ranked[begin + k]], static_cast<double>(end - begin) / static_cast<double>(drawn)});
  }
  return samples;
}

/// Computes exact influences of the samples that lack them.
void ErrorSamples::find_exact(std::vector<Sample> const& samples) {
  std::vector<std::size_t> wanted;
  for (auto const& sample : samples)
    if (!place_.contains(sample.particle)) wanted.push_back(sample.particle);
  if (wanted.empty()) return;
  std::sort(wanted.begin(), wanted.end());
  auto const found = engine_.exact(wanted, exact_to_, threads_);
  for (std::size_t const i : wanted) place_.emplace(static_cast<std::uint32_t>(i), place_.size());
  exact_.insert(exact_.end(), found.begin(), found.end());
}

double ErrorSamples::error() {
  auto const samples = by_ranks();
  find_exact(samples);
  double worst = 0;
  for (int part = 0; part < engine_.parts(); ++part) {
    ExactSum errors, all;
    std::vector<Square> felt;
    for (auto const& [particle, weight] : samples) {
      auto const squares =
          engine_.compare(part, particle, engine_.field().data() + particle * engine_.width(), exact(particle));
      errors += weight * squares.error, all += weight;
      felt.push_back({squares.felt, weight});
    }
    double const scale = typical(std::move(felt));
    if (scale > 0) worst = std::max(worst, std::sqrt(errors.value() / all.value() / scale));
  }
  return worst;
}

}  // namespace boltzmann
