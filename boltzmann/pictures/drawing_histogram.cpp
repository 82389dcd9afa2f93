// Histograms as step curves.
#include <boltzmann/core/error.hpp>
#include <boltzmann/pictures/draw_arrays.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace boltzmann {
namespace {

constexpr std::size_t min_bins = 10, max_bins = 200;

// The bin width of D. Freedman and P. Diaconis (Z. Wahrscheinlichkeitstheorie 57 (1981) 453); 0 if half of the values
// are equal. For many values, about ten thousand determine the quartiles well enough.
double fitting_width(std::vector<double> const& all) {
  if (all.size() < 2) return 0;
  std::size_t const every = all.size() / 10'000 + 1;
  std::vector<double> values;
  for (std::size_t i = 0; i < all.size(); i += every) values.push_back(all[i]);
  auto const quantile = [&](double part) {
    auto const at = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
  };
  double const lower = quantile(0.25);
  return 2 * (quantile(0.75) - lower) / std::cbrt(static_cast<double>(all.size()));
}

}  // namespace

std::vector<Histogram> histograms(std::span<std::span<double const> const> samples, std::size_t bins, double low,
                                  double high) {
  double smallest = std::numeric_limits<double>::infinity(), largest = -smallest;
  std::vector<std::vector<double>> finite(samples.size());
  for (std::size_t s = 0; s < samples.size(); ++s)
    for (double const v : samples[s])
      if (std::isfinite(v)) {
        finite[s].push_back(v);
        smallest = std::min(smallest, v);
        largest = std::max(largest, v);
      }
  if (smallest > largest) return {};
  bool const open_low = !std::isfinite(low), open_high = !std::isfinite(high);
  if (open_low) low = smallest;
  if (open_high) high = largest;
  if (low > high && !open_low && !open_high) std::swap(low, high);
  if (!(high > low)) {  // all values are equal
    double const room = low != 0 ? 0.05 * std::abs(low) : 1;
    if (open_high || !open_low) high = low + room;
    if (open_low) low = high - (open_high ? 2 * room : room);
  }
  if (bins == 0) {
    double narrowest = 0;
    for (auto const& values : finite)
      if (double const width = fitting_width(values); width > 0 && (narrowest == 0 || width < narrowest))
        narrowest = width;
    double const wanted = narrowest > 0 ? std::ceil((high - low) / narrowest) : 0;
    bins = static_cast<std::size_t>(std::clamp(wanted, static_cast<double>(min_bins), static_cast<double>(max_bins)));
  }
  std::vector<Histogram> all;
  double const width = (high - low) / static_cast<double>(bins);
  for (auto const& values : finite) {
    Histogram one{low, width, std::vector<double>(bins, 0.0), values.size(), 0};
    for (double const v : values) {
      if (v < low || v > high) {
        ++one.outside;
        continue;
      }
      double const place = (v - low) / (high - low) * static_cast<double>(bins);
      ++one.density[std::min(static_cast<std::size_t>(place), bins - 1)];
    }
    for (double& d : one.density) d /= static_cast<double>(std::max<std::size_t>(values.size(), 1)) * width;
    all.push_back(std::move(one));
  }
  return all;
}

Canvas draw_histogram(std::span<Histogram const> histograms, std::span<std::string const> labels,
                      std::span<Colour const> colours, Axis x, Axis y, std::string title) {
  if (labels.size() != histograms.size() || colours.size() != histograms.size())
    throw Error("a drawing of " + std::to_string(histograms.size()) + " histograms needs as many names and colours, " +
                "found " + std::to_string(labels.size()) + " and " + std::to_string(colours.size()));
  Canvas canvas;
  canvas.title(std::move(title));
  double least = std::numeric_limits<double>::infinity(), most = 0;
  std::size_t outside = 0;
  for (auto const& one : histograms) {
    outside += one.outside;
    for (double const d : one.density) {
      if (d > 0) least = std::min(least, d);
      most = std::max(most, d);
    }
    if (!std::isfinite(x.low)) x.low = one.low;
    if (!std::isfinite(x.high)) x.high = one.low + one.width * static_cast<double>(one.density.size());
  }
  double nothing = 0;
  if (y.logarithmic) {
    nothing = most > 0 ? 1e-3 * least : 1e-3;  // below the axis
    if (!std::isfinite(y.low) && most > 0) y.low = 0.5 * least;
  } else {
    if (!std::isfinite(y.low)) y.low = 0;
  }
  canvas.axes(std::move(x), std::move(y));
  canvas.grid(true);
  for (std::size_t s = 0; s < histograms.size(); ++s) {
    auto const& one = histograms[s];
    Canvas::Curve stairs;
    stairs.width = 2.2F;
    stairs.colour = colours[s];
    stairs.label = labels[s];
    auto const step = [&](double at, double height) {
      stairs.x.push_back(at);
      stairs.y.push_back(std::max(height, nothing));
    };
    step(one.low, 0);
    for (std::size_t b = 0; b < one.density.size(); ++b) {
      step(one.low + static_cast<double>(b) * one.width, one.density[b]);
      step(one.low + static_cast<double>(b + 1) * one.width, one.density[b]);
    }
    if (!one.density.empty()) step(stairs.x.back(), 0);
    canvas.curve(std::move(stairs));
  }
  if (outside > 0)
    canvas.note(std::to_string(outside) + (outside == 1 ? " value is" : " values are") + " outside the picture");
  return canvas;
}

}  // namespace boltzmann
