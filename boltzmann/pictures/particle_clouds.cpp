// Converts rows to clouds in blocks of a few hundred particles, which stay in the first-level cache between numbers.
#include <boltzmann/core/pack.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/diagnoses/derived.hpp>
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/pictures/particle_clouds.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace boltzmann {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t block = 256, grain = 64 * block;

// The index of the component at the end of a name, "x" or "xy" (of a tensor); -1 if the field has no such component.
int component(Field const& field, std::string_view letters, int dimension) {
  auto const axis = [&](char letter) { return letter >= 'x' && letter <= 'z' ? letter - 'x' : 99; };
  bool const tensor = dimension > 1 && field.components == dimension * dimension;
  if (letters.size() != (tensor ? 2U : 1U)) return -1;
  int const last = axis(letters.back()), first = tensor ? axis(letters.front()) : 0;
  int const index = first * dimension + last;
  bool const there = tensor ? first < dimension && last < dimension : index < field.components;
  return there ? index : -1;
}

// Calls f(k, value of particle index(k), or its squared length) for k from 0 to count.
template <class Index, class Function>
void each_square(ParticleColumn const& column, std::size_t count, Index index, Function f) {
  double const* const first = column.first;
  std::size_t const stride = column.stride;
  auto const loop = [&](auto value) {
    for (std::size_t k = 0; k < count; ++k) f(k, value(first + index(k) * stride));
  };
  if (column.components == 1)
    loop([](double const* v) { return v[0]; });
  else if (column.components == 2)
    loop([](double const* v) { return v[0] * v[0] + v[1] * v[1]; });
  else
    loop([](double const* v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; });
}

// The same with the length itself.
template <class Index, class Function>
void each_value(ParticleColumn const& column, std::size_t count, Index index, Function f) {
  if (column.components == 1)
    each_square(column, count, index, f);
  else
    each_square(column, count, index, [&](std::size_t k, double square) { f(k, std::sqrt(square)); });
}

// Four numbers at once, on any processor.
using Four = Pack<float, 4>;
Four four(float const* from) {
  Four pack;
  std::memcpy(&pack, from, sizeof pack);
  return pack;
}

// The smallest and the largest of values; values that are not finite are ignored.
struct CloudLimits {
  double low = infinity, high = -infinity;
  void add(double v) {
    if (std::isfinite(v)) take(v);
  }
  // Faster, but includes infinities.
  void take(double v) {
    low = v < low ? v : low;
    high = v > high ? v : high;
  }
  void add(CloudLimits const& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }
  bool empty() const { return low > high; }
};

// The limits of numbers, infinities included, and how many are NaN.
CloudLimits limits_of(float const* values, std::size_t count, std::size_t& missing) {
  Four low(std::numeric_limits<float>::infinity()), high(-std::numeric_limits<float>::infinity());
  Mask<float, 4>::Native not_numbers{};
  std::size_t k = 0;
  for (; k + 4 <= count; k += 4) {
    Four const v = four(values + k);
    low = min(low, v);
    high = max(high, v);
    not_numbers -= (v != v).native;
  }
  CloudLimits limits;
  for (int lane = 0; lane < 4; ++lane) {
    limits.take(static_cast<double>(low[lane]));
    limits.take(static_cast<double>(high[lane]));
    missing += static_cast<std::size_t>(not_numbers[lane]);
  }
  if (k < 4) limits = {};  // the limits are not those of numbers
  for (; k < count; ++k) {
    limits.take(static_cast<double>(values[k]));
    missing += values[k] != values[k];
  }
  return limits;
}

// The number of particles, with this number of coordinates each, that have one that is not finite.
std::size_t nowhere(float const* places, std::size_t particles, std::size_t dimension) {
  Four sum(0.0F);
  float rest = 0;
  std::size_t const numbers = particles * dimension;
  std::size_t k = 0;
  for (; k + 4 <= numbers; k += 4) sum += four(places + k) * Four(0.0F);
  for (; k < numbers; ++k) rest += places[k] * 0;
  if (sum[0] + sum[1] + sum[2] + sum[3] + rest == 0) return 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < particles; ++i) {
    bool whole = true;
    for (std::size_t a = 0; a < dimension; ++a) whole = whole && std::isfinite(places[dimension * i + a]);
    count += !whole;
  }
  return count;
}

// Results for one range of particles.
struct Told {
  CloudLimits value;
  double largest = 0;  // largest size
  std::size_t not_finite = 0, without_value = 0;
  std::vector<std::uint32_t> inside = {};  // particles in the region
};

Told sum(std::vector<Told> const& parts) {
  Told all;
  for (auto const& part : parts) {
    all.value.add(part.value);
    all.largest = std::max(all.largest, part.largest);
    all.not_finite += part.not_finite;
    all.without_value += part.without_value;
    all.inside.insert(all.inside.end(), part.inside.begin(), part.inside.end());
  }
  return all;
}

// Calls f(begin, end, part of the result) for ranges of whole grains on several threads.
template <class Function>
Told in_ranges(std::size_t count, int threads, Function f) {
  std::vector<Told> parts((count + grain - 1) / grain);
  for_ranges(count, grain, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t at = begin; at < end; at += grain) f(at, std::min(at + grain, end), parts[at / grain]);
  });
  return sum(parts);
}

// The conversion of values to numbers of a cloud: (value - zero) * factor, or a squared length.
struct Scale {
  double zero = 0, factor = 1;
  bool squares = false;
};

// The destination of the numbers of some particles.
struct Block {
  float *place, *value, *diameter;
};

// The particle shown of the k-th `stride` particles. A hash selects it, the same in every picture, so that the
// particles shown are a fair sample, independent of the loading order (a lattice, a quiet start).
std::size_t one_of(std::size_t k, std::size_t stride, std::size_t count) {
  std::uint64_t hash = (k + 1) * 0x9E3779B97F4A7C15U;
  hash = (hash ^ hash >> 32U) * 0xD6E8FEB86659FD93U;
  return k * stride + (hash ^ hash >> 32U) % std::min(stride, count - k * stride);
}

class CloudMaker {
 public:
  CloudMaker(std::span<CloudSource const> sources, CloudOptions const& options)
      : sources_(sources), options_(options), dimension_(sources.empty() ? 2 : sources[0].place.size()) {
    for (auto const& source : sources) {
      valued_ = valued_ || source.value;
      sized_ = sized_ || source.size;
    }
    for (std::size_t a = 0; a < 3; ++a) per_scale_[a] = 1 / options.scale[a];
  }

  ParticleClouds make() {
    for (auto const& source : sources_) result_.particles += source.ensemble->size();
    result_.inside = result_.particles;
    bool const all = options_.region.empty() && (options_.most == 0 || result_.particles <= options_.most);
    // Usually one pass over the particles suffices: values become colours once the last one is known.
    if (all && valued_ && !sized_ && draw_before_looking()) return std::move(result_);
    if (!options_.region.empty() || valued_ || sized_) look();
    choose_stride();
    choose_ends();
    double const width = result_.high - result_.low;
    draw({result_.low, width > 0 ? 1 / width : 0});
    finish_values(false, 0, 1);
    return std::move(result_);
  }

 private:
  // Finds the particles in the region. The limits of values and sizes are those of all particles, so that colours don't
  // depend on the region.
  void look() {
    if (!options_.region.empty()) result_.inside = 0;
    for (auto const& source : sources_) {
      Told told = in_ranges(source.ensemble->size(), options_.threads,
                            [&](std::size_t begin, std::size_t end, Told& part) { look(source, begin, end, part); });
      limits_.add(told.value);
      largest_ = std::max(largest_, told.largest);
      if (options_.region.empty()) continue;
      result_.inside += told.inside.size();
      inside_.push_back(std::move(told.inside));
    }
  }

  void look(CloudSource const& source, std::size_t begin, std::size_t end, Told& told) const {
    for (std::size_t at = begin; at < end; at += block) {
      std::size_t const count = std::min(block, end - at);
      auto const index = [at](std::size_t k) { return at + k; };
      if (!options_.region.empty()) add_inside(source, at, count, told.inside);
      if (source.value && source.value->first) {
        CloudLimits quick;
        each_value(*source.value, count, index, [&](std::size_t, double v) { quick.take(v); });
        if (std::isinf(quick.low) || std::isinf(quick.high))
          each_value(*source.value, count, index, [&](std::size_t, double v) { told.value.add(v); });
        else
          told.value.add(quick);
      }
      if (source.size && source.size->first)
        each_value(*source.size, count, index, [&](std::size_t, double v) {
          if (std::isfinite(v)) told.largest = std::max(told.largest, std::abs(v));
        });
    }
  }

  void add_inside(CloudSource const& source, std::size_t at, std::size_t count,
                  std::vector<std::uint32_t>& inside) const {
    std::array<bool, block> is_inside;
    is_inside.fill(true);
    for (std::size_t a = 0; a < options_.region.size() && a < dimension_; ++a) {
      auto const [low, high] = options_.region[a];
      if (!source.place[a].first) return;
      each_value(
          source.place[a], count, [at](std::size_t k) { return at + k; },
          [&, low = low, high = high](std::size_t k, double x) {
            is_inside[k] = is_inside[k] & (x >= low) & (x <= high);
          });
    }
    for (std::size_t k = 0; k < count; ++k)
      if (is_inside[k]) inside.push_back(static_cast<std::uint32_t>(at + k));
  }

  std::size_t inside(std::size_t s) const {
    return options_.region.empty() ? sources_[s].ensemble->size() : inside_[s].size();
  }

  void choose_stride() {
    if (options_.most == 0 || result_.inside <= options_.most) return;
    auto const shown = [&](std::size_t stride) {
      std::size_t total = 0;
      for (std::size_t s = 0; s < sources_.size(); ++s) total += (inside(s) + stride - 1) / stride;
      return total;
    };
    std::size_t stride = (result_.inside + options_.most - 1) / options_.most;
    while (shown(stride) > options_.most && stride < result_.inside) ++stride;
    result_.stride = static_cast<std::uint32_t>(stride);
  }

  void choose_ends() {
    result_.low = limits_.empty() ? 0 : limits_.low;
    result_.high = limits_.empty() ? 0 : limits_.high;
    if (result_.low < 0 && result_.high > 0) {
      result_.map = ColourMap::diverging;
      result_.high = std::max(-result_.low, result_.high);
      result_.low = -result_.high;
    }
    if (options_.high > 0 && options_.low == -options_.high) result_.map = ColourMap::diverging;
    if (std::isfinite(options_.low)) result_.low = options_.low;
    if (std::isfinite(options_.high)) result_.high = options_.high;
  }

  // Stores differences from one of the values (or squared lengths), and converts these to colours. Returns true if
  // single precision was sufficient for that.
  bool draw_before_looking() {
    Scale scale{options_.low};
    bool first = true;
    for (auto const& source : sources_) {
      if (!source.value || !source.value->first || source.ensemble->size() == 0) continue;
      if (!source.value->own.empty()) return false;
      bool const squares = source.value->components > 1;
      if (!first && squares != scale.squares) return false;
      if (!squares && !std::isfinite(scale.zero)) scale.zero = (*source.value)[0];
      scale.squares = squares;
      first = false;
    }
    if (scale.squares || !std::isfinite(scale.zero)) scale.zero = 0;
    draw(scale);
    if (fits(scale)) {
      choose_ends();
      double const width = result_.high - result_.low;
      finish_values(scale.squares, result_.low - scale.zero, width > 0 ? 1 / width : 0);
      return true;
    }
    result_.clouds.clear();
    limits_ = {};
    return false;
  }

  bool fits(Scale const& scale) {
    if (drawn_.empty()) return true;
    if (std::isinf(drawn_.low) || std::isinf(drawn_.high)) return false;
    limits_ = drawn_;
    if (scale.squares) {
      limits_ = {std::sqrt(drawn_.low), std::sqrt(drawn_.high)};
      if (drawn_.high > 1e37 || (drawn_.high > 0 && drawn_.high < 1e-30)) return false;
    } else {
      limits_ = {scale.zero + drawn_.low, scale.zero + drawn_.high};
    }
    choose_ends();
    double const width = result_.high - result_.low;
    double const far = scale.squares ? result_.high : std::max(std::abs(result_.low - scale.zero), width);
    return width > 1e-30 && far < 1e3 * width && far < 1e37;
  }

  void draw(Scale const& scale) {
    result_.shown = result_.not_finite = result_.without_value = 0;
    drawn_ = {};
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      auto const& source = sources_[s];
      Canvas::Cloud cloud;
      cloud.dimension = static_cast<int>(dimension_);
      cloud.origin = options_.origin;
      cloud.scale = options_.scale;
      cloud.colour = source.colour;
      cloud.ensemble = source.ensemble->name();
      cloud.stride = result_.stride;
      if (!source.size) cloud.common_diameter = source.diameter;
      std::size_t const count = (inside(s) + result_.stride - 1) / result_.stride;
      if (!options_.region.empty() || result_.stride > 1) {
        cloud.number.resize(count);
        for (std::size_t k = 0; k < count; ++k) {
          std::size_t const i = one_of(k, result_.stride, inside(s));
          cloud.number[k] = options_.region.empty() ? static_cast<std::uint32_t>(i) : inside_[s][i];
        }
      }
      if (options_.memory) {
        cloud.position = options_.memory->take(dimension_ * count);
        if (valued_) cloud.value = options_.memory->take(count);
        if (source.size) cloud.diameter = options_.memory->take(count);
      }
      Told const told = fill(source, count, scale, cloud);
      drawn_.add(told.value);
      result_.shown += count;
      result_.not_finite += told.not_finite;
      result_.without_value += told.without_value;
      result_.clouds.push_back(std::move(cloud));
    }
  }

  Told fill(CloudSource const& source, std::size_t count, Scale const& scale, Canvas::Cloud& cloud) const {
    if (options_.threads > 1 && count > grain) {
      cloud.position.resize(dimension_ * count);
      if (valued_) cloud.value.resize(count);
      if (source.size) cloud.diameter.resize(count);
      return in_ranges(count, options_.threads, [&](std::size_t begin, std::size_t end, Told& told) {
        for (std::size_t at = begin; at < end; at += block)
          draw_block(source, cloud, at, std::min(block, end - at), scale,
                     {&cloud.position[dimension_ * at], valued_ ? &cloud.value[at] : nullptr,
                      source.size ? &cloud.diameter[at] : nullptr},
                     told);
      });
    }
    // Avoid initialisation, so that each number is written to memory only once.
    cloud.position.clear(), cloud.value.clear(), cloud.diameter.clear();
    Told told;
    std::array<float, 3 * block> place;
    std::array<float, block> value, diameter;
    cloud.position.reserve(dimension_ * count);
    if (valued_) cloud.value.reserve(count);
    if (source.size) cloud.diameter.reserve(count);
    for (std::size_t at = 0; at < count; at += block) {
      std::size_t const some = std::min(block, count - at);
      draw_block(source, cloud, at, some, scale, {place.data(), value.data(), diameter.data()}, told);
      cloud.position.insert(cloud.position.end(), place.data(), place.data() + dimension_ * some);
      if (valued_) cloud.value.insert(cloud.value.end(), value.data(), value.data() + some);
      if (source.size) cloud.diameter.insert(cloud.diameter.end(), diameter.data(), diameter.data() + some);
    }
    return told;
  }

  // Converts the particles at, at + 1, ... of a cloud.
  void draw_block(CloudSource const& source, Canvas::Cloud const& cloud, std::size_t at, std::size_t count,
                  Scale const& scale, Block const& out, Told& told) const {
    if (cloud.number.empty()) {
      draw_block(
          source, count, [at](std::size_t k) { return at + k; }, scale, out, told);
    } else {
      std::uint32_t const* const number = cloud.number.data() + at;
      draw_block(
          source, count, [number](std::size_t k) { return std::size_t{number[k]}; }, scale, out, told);
    }
  }

  template <class Index>
  void draw_block(CloudSource const& source, std::size_t count, Index index, Scale const& scale, Block const& out,
                  Told& told) const {
    auto const& x = source.place[0];
    auto const& y = source.place[1];
    bool const pair = x.first && y.first == x.first + 1 && y.stride == x.stride && x.components + y.components == 2;
    if (pair) draw_pairs(x, count, index, out.place);
    for (std::size_t a = pair ? 2 : 0; a < dimension_; ++a)
      draw_places(source.place[a], count, index, options_.origin[a], per_scale_[a], out.place + a);
    told.not_finite += nowhere(out.place, count, dimension_);
    if (valued_) draw_values(source, count, index, scale, out.value, told);
    if (source.size)
      for (std::size_t k = 0; k < count; ++k) out.diameter[k] = diameter(source, index(k));
  }

  // Converts two adjacent coordinates.
  template <class Index>
  void draw_pairs(ParticleColumn const& column, std::size_t count, Index index, float* out) const {
    using Two = Pack<double, 2>;
    typedef float TwoFloats __attribute__((vector_size(8)));
    Two const origin(Two::Native{options_.origin[0], options_.origin[1]});
    Two const factor(Two::Native{per_scale_[0], per_scale_[1]});
    double const* const first = column.first;
    std::size_t const stride = column.stride, next = dimension_;
    for (std::size_t k = 0; k < count; ++k) {
      Two place;
      std::memcpy(&place, first + index(k) * stride, sizeof place);
      auto const single = __builtin_convertvector(((place - origin) * factor).native, TwoFloats);
      std::memcpy(out + k * next, &single, sizeof single);
    }
  }

  template <class Index>
  void draw_places(ParticleColumn const& column, std::size_t count, Index index, double origin, double factor,
                   float* out) const {
    std::size_t const next = dimension_;
    if (!column.first)
      for (std::size_t k = 0; k < count; ++k) out[k * next] = std::numeric_limits<float>::quiet_NaN();
    else
      each_value(column, count, index,
                 [=](std::size_t k, double x) { out[k * next] = static_cast<float>((x - origin) * factor); });
  }

  template <class Index>
  void draw_values(CloudSource const& source, std::size_t count, Index index, Scale const& scale, float* out,
                   Told& told) const {
    if (!source.value || !source.value->first) {
      std::fill_n(out, count, std::numeric_limits<float>::quiet_NaN());
      told.without_value += count;
      return;
    }
    auto const put = [out, zero = scale.zero, factor = scale.factor](std::size_t k, double v) {
      out[k] = static_cast<float>((v - zero) * factor);
    };
    if (scale.squares)
      each_square(*source.value, count, index, put);
    else
      each_value(*source.value, count, index, put);
    told.value.add(limits_of(out, count, told.without_value));
  }

  float diameter(CloudSource const& source, std::size_t i) const {
    double const v = (*source.size)[i];
    bool const own = !(largest_ > 0) || std::isnan(v);
    return static_cast<float>(own ? source.diameter : source.diameter * std::min(std::abs(v) / largest_, 1.0));
  }

  // Converts stored values to positions between the ends, 0 to 1 (the middle if both are equal): (value or its root,
  // minus `low`) times `factor`.
  void finish_values(bool root, double low, double factor) {
    Four const from(static_cast<float>(low)), times(static_cast<float>(factor)), nothing(0.0F), all(1.0F);
    auto const between = [=](Four v) {
      v = (v - from) * times;
      // NaN stays NaN, because the comparisons are false.
      return select(v > all, all, select(v < nothing, nothing, v));
    };
    if (!(result_.high > result_.low))
      finish_each([](Four v) { return select(v == v, Four(0.5F), v); });
    else if (root)
      finish_each([=](Four v) { return between(sqrt(v)); });
    else
      finish_each(between);
  }
  template <class Function>
  void finish_each(Function f) {
    for (auto& cloud : result_.clouds) {
      cloud.map = result_.map;
      for_ranges(cloud.value.size(), grain, options_.threads, [&](std::size_t begin, std::size_t end) {
        float* const values = cloud.value.data();
        std::size_t k = begin;
        for (; k + 4 <= end; k += 4) {
          Four const v = f(four(values + k));
          std::memcpy(values + k, &v, sizeof v);
        }
        for (; k < end; ++k) values[k] = f(Four(values[k]))[0];
      });
    }
  }

  std::span<CloudSource const> sources_;
  CloudOptions const& options_;
  std::size_t dimension_;
  bool valued_ = false, sized_ = false;
  std::array<double, 3> per_scale_;
  std::vector<std::vector<std::uint32_t>> inside_;  // per source: the particles in the region
  CloudLimits limits_, drawn_;
  double largest_ = 0;
  ParticleClouds result_;
};

}  // namespace

double ParticleColumn::operator[](std::size_t i) const {
  if (!first) return no_value;
  double const* v = first + i * stride;
  if (components == 1) return v[0];
  return std::hypot(v[0], v[1], components > 2 ? v[2] : 0.0);
}

ParticleColumn column_of(AnyEnsemble const& ensemble, std::string_view name, std::span<double const> potential,
                         UnitSystem const* units) {
  if (ensemble.size() > 0) {
    std::size_t const dot = name.find('.');
    auto const dimension = static_cast<std::size_t>(ensemble.dimension());
    if (Field const* field = ensemble.find_field(name.substr(0, dot))) {
      int const at = dot != std::string_view::npos ? component(*field, name.substr(dot + 1), ensemble.dimension())
                                                   : (field->components == 1 ? 0 : -1);
      // A scalar other than position and velocity (in one dimension) has no components.
      bool const along_axes = field->components > 1 || field->name == "position" || field->name == "velocity";
      if (at >= 0 && (dot == std::string_view::npos || along_axes))
        return {ensemble.row(0) + field->offset + at, ensemble.stride()};
    }
    if (name == "speed" && has_velocities(ensemble) && ensemble.dimension() > 1) {
      auto const velocities = velocities_of(ensemble);
      return {velocities.first, velocities.stride, ensemble.dimension()};
    }
    bool const of_influence =
        name.starts_with("influence.") || (name.starts_with("velocity.") && !ensemble.find_field("velocity"));
    if (of_influence && ensemble.influence_size() >= dimension && name.size() == name.find('.') + 2) {
      auto const a = static_cast<std::size_t>(name.back() - 'x');
      if (a < dimension) return {ensemble.influence(0) + a, ensemble.influence_size()};
    }
  }
  ParticleColumn column;
  column.own = quantity(ensemble, name, potential, units);
  column.first = column.own.data();
  return column;
}

std::vector<float> CloudMemory::take(std::size_t count) {
  std::scoped_lock const lock(mutex_);
  auto const waste = [count](std::vector<float> const& array) {
    if (array.size() == count) return std::size_t{0};
    return array.capacity() < count ? std::numeric_limits<std::size_t>::max() : 1 + array.capacity() - count;
  };
  auto const best =
      std::min_element(spare_.begin(), spare_.end(), [&](auto const& a, auto const& b) { return waste(a) < waste(b); });
  if (best == spare_.end() || waste(*best) > 1 + count) return {};
  std::vector<float> taken = std::move(*best);
  spare_.erase(best);
  return taken;
}

void CloudMemory::keep(std::vector<Canvas::Cloud> clouds) {
  std::scoped_lock const lock(mutex_);
  for (auto& cloud : clouds)
    for (auto* array : {&cloud.position, &cloud.value, &cloud.diameter})
      if (array->capacity() > 0 && spare_.size() < most) spare_.push_back(std::move(*array));
}

ParticleClouds particle_clouds(std::span<CloudSource const> sources, CloudOptions const& options) {
  return CloudMaker(sources, options).make();
}

std::vector<Canvas::Cloud> interleaved(std::vector<Canvas::Cloud> clouds) {
  constexpr std::size_t turns = 16;
  std::size_t const filled = static_cast<std::size_t>(
      std::count_if(clouds.begin(), clouds.end(), [](Canvas::Cloud const& c) { return c.count() > 0; }));
  if (filled < 2) return clouds;
  std::vector<Canvas::Cloud> parts;
  for (std::size_t turn = 0; turn < turns; ++turn)
    for (auto const& whole : clouds) {
      Canvas::Cloud part;
      part.dimension = whole.dimension;
      part.origin = whole.origin, part.scale = whole.scale;
      part.map = whole.map, part.colour = whole.colour;
      part.common_diameter = whole.common_diameter, part.size = whole.size, part.shaded = whole.shaded;
      part.ensemble = whole.ensemble, part.stride = whole.stride;
      auto const dimension = static_cast<std::size_t>(whole.dimension);
      for (std::size_t k = turn; k < whole.count(); k += turns) {
        for (std::size_t a = 0; a < dimension; ++a) part.position.push_back(whole.position[dimension * k + a]);
        if (!whole.value.empty()) part.value.push_back(whole.value[k]);
        if (!whole.diameter.empty()) part.diameter.push_back(whole.diameter[k]);
        part.number.push_back(whole.number.empty() ? static_cast<std::uint32_t>(k) : whole.number[k]);
      }
      if (part.count() > 0) parts.push_back(std::move(part));
    }
  return parts;
}

}  // namespace boltzmann
