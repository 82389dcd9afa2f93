// Displacements, accumulated from sample to sample.
#include <boltzmann/diagnoses/chosen.hpp>
#include <boltzmann/diagnoses/diffusion.hpp>

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>

#include <fmt/format.h>

#include <limits>

namespace boltzmann {

Diffusion::Diffusion(std::vector<AnyEnsemble const*> const& available, std::vector<std::string> const& names,
                     double since)
    : since_(since), prefixed_(!names.empty() || available.size() > 1) {
  for (auto const& name : chosen_names(available, names)) followed_.push_back({name, {}, {}, {}});
  dimension_ = available.front()->dimension();
}

std::vector<Column> Diffusion::columns() const {
  using namespace dimensions;
  std::vector<Column> columns;
  for (auto const& one : followed_) {
    std::string const prefix = prefixed_ ? one.name + " " : "";
    columns.push_back({prefix + "mean square displacement", length * length});
    columns.push_back({prefix + "diffusion coefficient", length * length / dimensions::time});
  }
  return columns;
}

void Diffusion::follow(Sample const& sample) {
  if (!begun_) return;
  auto const D = static_cast<std::size_t>(dimension_);
  for (auto& one : followed_) {
    AnyEnsemble const& ensemble = ensemble_of(sample, one.name);
    if (one.last.size() != D * ensemble.size())
      throw Error(fmt::format("diffusion follows the {} particles of '{}', which has {} now", one.last.size() / D,
                              one.name, ensemble.size()));
    for (std::size_t i = 0; i < ensemble.size(); ++i) {
      double const* x = ensemble.row(i);
      double moved[3] = {0, 0, 0};
      for (std::size_t a = 0; a < D; ++a) moved[a] = x[a] - one.last[D * i + a];
      sample.box.nearest_image(moved);
      for (std::size_t a = 0; a < D; ++a) {
        one.last[D * i + a] = x[a];
        one.displacement[D * i + a] += moved[a];
      }
    }
  }
}

void Diffusion::measure(Sample const& sample, std::vector<double>& values) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  auto const D = static_cast<std::size_t>(dimension_);
  if (!begun_ && sample.time >= since_) {
    begun_ = true;
    begin_ = sample.time;
    for (auto& one : followed_) {
      AnyEnsemble const& ensemble = ensemble_of(sample, one.name);
      one.displacement.assign(D * ensemble.size(), 0.0);
      one.last.clear();
      for (std::size_t i = 0; i < ensemble.size(); ++i)
        one.last.insert(one.last.end(), ensemble.row(i), ensemble.row(i) + D);
    }
  }
  follow(sample);
  for (auto& one : followed_) {
    if (!begun_ || one.last.empty()) {
      values.insert(values.end(), {nan, nan});
      continue;
    }
    std::size_t const count = one.last.size() / D;
    ExactSum all[3], square;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t a = 0; a < D; ++a) all[a] += one.displacement[D * i + a];
    double mean[3];
    for (std::size_t a = 0; a < 3; ++a) mean[a] = all[a].value() / static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t a = 0; a < D; ++a) {
        double const d = one.displacement[D * i + a] - mean[a];
        square += d * d;
      }
    double const msd = square.value() / static_cast<double>(count);
    one.line.add(sample.time - begin_, msd);
    values.insert(values.end(), {msd, one.line.fit().slope.mean / (2 * dimension_)});
  }
}

std::vector<double> Diffusion::state() const {
  if (!begun_) return {};
  std::vector<double> state{begin_};
  for (auto const& one : followed_) {
    state.push_back(static_cast<double>(one.last.size()));
    for (auto const& part : {one.last, one.displacement, one.line.state()})
      state.insert(state.end(), part.begin(), part.end());
  }
  return state;
}

void Diffusion::restore(std::span<double const> state) {
  begun_ = !state.empty();
  if (!begun_) return;
  std::size_t at = 0;
  auto const next = [&](std::size_t count) {
    if (count > state.size() - at)
      throw Error("the checkpoint does not fit this diagnosis: it follows other particles");
    at += count;
    return state.subspan(at - count, count);
  };
  begin_ = next(1)[0];
  for (auto& one : followed_) {
    auto const count = static_cast<std::size_t>(next(1)[0]);
    auto const last = next(count), displacement = next(count);
    one.last.assign(last.begin(), last.end());
    one.displacement.assign(displacement.begin(), displacement.end());
    one.line.restore(next(LineSums::state_size));
  }
}

}  // namespace boltzmann
