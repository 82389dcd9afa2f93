// Sorting, images, and updates between two builds.
#include <boltzmann/boundaries/far_from_box.hpp>
#include <boltzmann/neighbours/sorted_copy.hpp>

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/in_dimension.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/neighbours/neighbour_kernels.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace boltzmann {
namespace {

constexpr std::size_t together = 256;                    // rows that share one largest displacement
constexpr std::size_t refresh_grain = 2048;              // a multiple of it
constexpr std::size_t max_rows = std::size_t{1} << 30U;  // items are 32 bits
constexpr double max_lengths = 8;                        // the most lengths of a periodic axis between an image and its
                                                         // particle
constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();

[[noreturn]] void not_finite(AnyEnsemble const& ensemble, std::size_t particle) {
  throw PhysicsFailure(
      fmt::format("particle {} of '{}' is at a position that is not finite, or more than 2^53 lengths of a periodic "
                  "axis from the box",
                  particle, ensemble.name()));
}

/// x in steps, modulo 2^32.
std::int32_t in_steps(double x, double reach) {
  double steps = x / reach * steps_of_reach + 0.5;
  if (!(std::abs(steps) < 0x1p62)) steps = std::fmod(std::floor(steps), 0x1p32);
  auto const truncated = static_cast<std::int64_t>(steps);
  std::int64_t const below = truncated - (steps < static_cast<double>(truncated) ? 1 : 0);
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(below));
}
/// Lists all rows that have been moved, and their images, for the search.
template <class Images>
void list_images(std::vector<Images> const& of_rows, double reach, std::array<std::vector<std::int32_t>, 3>& position,
                 std::vector<std::uint32_t>& item) {
  for (auto& column : position) column.clear();
  item.clear();
  for (auto const& images : of_rows)
    for (auto const& image : images) {
      item.push_back(item_of_row(image.row));
      for (std::size_t a = 0; a < 3; ++a) position[a].push_back(in_steps(image.position[a], reach));
    }
  item.resize(item.size() + candidate_padding, 0);
  for (auto& column : position) column.resize(item.size(), 0);
}
/// The largest distance modulo 2^32.
std::int32_t opposite(std::int32_t steps) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(steps) + (1U << 31U));
}

}  // namespace

SortedCopy::SortedCopy(AnyEnsemble const& ensemble, Box const& box, std::size_t extra_blocks)
    : ensemble_(&ensemble),
      box_(&box),
      images_(box),
      extra_blocks_(extra_blocks),
      components_(row_block * all_blocks()) {
  for (auto const& [name, rule] : {std::pair{"position", ImageRule::position}, {"velocity", ImageRule::velocity}}) {
    Field const* field = ensemble.find_field(name);
    if (!field || field->components != box.dimension()) continue;  // a user's class with another meaning
    for (int a = 0; a < field->components; ++a) components_[field->offset + a] = {rule, a, 0};
  }
}

void SortedCopy::components(std::vector<ImageComponent> components) {
  if (components.size() != row_block * all_blocks())
    throw Error(fmt::format("images of '{}': there are transformations for {} numbers of a row, which has {}",
                            ensemble_->name(), components.size(), row_block * all_blocks()));
  for (auto const& component : components)
    for (int const axis : {component.axis, component.axis2})
      if (axis < 0 || axis >= box_->dimension())
        throw Error(fmt::format("images of '{}': a rule names axis {}, the box has {} (from 0)", ensemble_->name(),
                                axis, box_->dimension()));
  components_ = std::move(components);
  if (!turns_.empty()) find_image_maps();
}

void SortedCopy::build(double reach, int threads) {
  int const dimension = box_->dimension();
  bool const sheared = box_->sheared();
  std::vector<double> references(ensemble_->size() * dimension);
  for_ranges(ensemble_->size(), refresh_grain, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (int a = 0; a < dimension; ++a) {
        double const x = ensemble_->row(i)[a];
        if (!std::isfinite(x) || far_from_box(*box_, x, a)) not_finite(*ensemble_, i);
        references[i * dimension + a] = sheared ? x : reference_of(x, a);
      }
    for (std::size_t i = begin; sheared && i < end; ++i)
      wrap_reference(references.data() + i * dimension, box_->slide_in_lattice());
  });
  build(reach, references, threads);
}

void SortedCopy::build(double reach, std::span<double const> references, int threads) {
  build(reach, references, box_->edges(), box_->slide(), threads);
}

void SortedCopy::build(double reach, std::span<double const> references, Box::Edges const& edges, double slide,
                       int threads) {
  begin_build(reach, edges, slide);
  part_ = false;
  known_.clear();
  Cells const sorted = sort(reach, references, threads);
  add_ghosts(nullptr, threads);
  finish_build(sorted, nullptr, threads);
  everything();
}

void SortedCopy::build_part(double reach, Part part, int threads) {
  begin_build(reach, box_->edges(), box_->slide());
  part_ = true;
  known_ = std::move(part.rows);
  std::size_t const all = ensemble_->size();
  order_.resize(all);
  references_.resize(4 * all);
  steps_.resize(4 * all);
  built_by_number_.resize(static_cast<std::size_t>(box_->dimension()) * all);
  in_dimension(box_->dimension(), [&](auto D) {
    for_ranges(known_.size(), refresh_grain, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) {
        std::size_t const item = part.sorted.items()[n];
        std::uint32_t const i = part.particles[item];
        double const* const reference = part.references.get() + D * item;
        for (int a = 0; a < D; ++a) built_by_number_[D * std::size_t{i} + a] = reference[a];
        order_[known_[n]] = i;
        take_reference<D>(known_[n], reference);
      }
    });
  });
  add_ghosts(&part, threads);
  finish_build(part.sorted, &part.grid, threads);
}

double SortedCopy::reference_of(double x, int axis) const { return box_->periodic(axis) ? box_->wrapped(x, axis) : x; }

template <int D>
void SortedCopy::take_reference(std::size_t k, double const* reference) {
  double* const to = references_.data() + 4 * k;
  std::int32_t* const steps = steps_.data() + 4 * k;
  for (int a = 0; a < 4; ++a) to[a] = a < D ? reference[a] : 0, steps[a] = a < D ? in_steps(to[a], reach_) : 0;
}

std::unique_ptr<double[]> SortedCopy::references_of(std::span<std::uint32_t const> particles) const {
  auto references =
      std::make_unique_for_overwrite<double[]>(particles.size() * static_cast<std::size_t>(box_->dimension()));
  in_dimension(box_->dimension(), [&](auto D) {
    auto const edges = box_->edges();
    double* to = references.get();
    for (std::uint32_t const i : particles) {
      double const* const row = ensemble_->row(i);
      for (int a = 0; a < D; ++a) {
        double const x = row[a];
        bool const inside = x >= edges[a] && x < edges[3 + a];
        if (!inside && (!std::isfinite(x) || far_from_box(*box_, x, a))) not_finite(*ensemble_, i);
        *to++ = inside ? x : reference_of(x, a);
      }
    }
  });
  return references;
}

/// Checked before allocation: a larger reach would exhaust the memory.
void SortedCopy::check_reach(double reach, Box::Edges const& edges) const {
  for (int a = 0; a < box_->dimension(); ++a)
    if (box_->boundary(a) == Boundary::mirror && box_->walled(a, Box::End::low) && box_->walled(a, Box::End::high) &&
        reach > edges[3 + a] - edges[a])
      throw Error(fmt::format(
          "neighbours of '{}' are found up to a distance of {}, the walls of axis {} are {} apart: they must "
          "not be nearer to each other than that",
          ensemble_->name(), reach, "xyz"[a], edges[3 + a] - edges[a]));
  double images = static_cast<double>(ensemble_->size());
  for (int a = 0; a < box_->dimension(); ++a) {
    if (!box_->periodic(a)) continue;
    if (reach > max_lengths * box_->length(a))
      throw Error(
          fmt::format("neighbours of '{}' are found up to a distance of {:.6g}; a periodic axis of {:.6g} ({}) "
                      "allows at most {:.6g}",
                      ensemble_->name(), reach, box_->length(a), "xyz"[a], max_lengths * box_ -> length(a)));
    images *= 1 + 2 * reach / box_->length(a);
  }
  if (images >= static_cast<double>(max_rows)) too_many_rows(images);
}

void SortedCopy::begin_build(double reach, Box::Edges const& edges, double slide) {
  check_reach(reach, edges);
  reach_ = reach;
  built_edges_ = edges;
  built_walls_ = box_->walled();
  built_slide_ = slide;
  images_ = Images(*box_, edges, slide - box_->whole_slide(slide));
  ups_.assign(box_->sheared() ? ensemble_->size() : 0, 0.0);
  moved_.clear();
  built_.clear();
  moved_images_.clear();
  free_.clear();
}

void SortedCopy::finish_build(Cells const& sorted, Grid const* grid, int threads) {
  if (total() >= max_rows) too_many_rows(static_cast<double>(total()));
  capacity_ = 0;
  make_room(total() + 1);
  sort_all(sorted, grid, threads);
  for (auto& column : moved_position_) column.assign(candidate_padding, 0);
  moved_item_.assign(candidate_padding, 0);
  // NaN, as the sentinel stays, until the next refresh, which then reports a change.
  for (std::size_t b = 0; b < all_blocks(); ++b) {
    std::size_t const from = part_ ? owned() : 0;
    for (std::uint32_t const k : known_) std::fill_n(block(b) + row_block * k, row_block, nowhere);
    std::fill_n(block(b) + row_block * from, row_block * ((b < blocks() ? owned() : total()) + 1 - from), nowhere);
  }
}

void SortedCopy::everything() {
  pieces_.clear();
  others_.clear();
  for (std::size_t first = 0; first < owned(); first += together)
    pieces_.push_back({first, std::min(first + together, owned())});
  largest2_.assign(pieces_.size(), 0.0);
  all_images();
}

void SortedCopy::all_images() { images_of_ = {{0, ghost_source_.size()}}; }

void SortedCopy::only(std::vector<Stretch> const& own, std::vector<Stretch> const& others,
                      std::vector<char> const& read) {
  pieces_.clear();
  for (auto const& rows : own)
    for (std::size_t first = rows.begin; first < rows.end; first += together)
      pieces_.push_back({first, std::min(first + together, rows.end)});
  others_ = others;
  largest2_.assign(pieces_.size(), 0.0);
  images_of_.clear();
  constexpr std::size_t few = 4;  // refreshing this many unused rows costs less than another range
  for (std::size_t g = 0; g < ghost_source_.size(); ++g) {
    if (!read[owned() + 1 + g]) continue;
    bool const goes_on = !images_of_.empty() && images_of_.back().end + few >= g &&
                         images_of_.back().end - images_of_.back().begin < refresh_grain;
    if (goes_on)
      images_of_.back().end = g + 1;
    else
      images_of_.push_back({g, g + 1});
  }
}

void SortedCopy::too_many_rows(double count) const {
  throw Error(fmt::format("ensemble '{}' has {:.10g} particles and images within reach, lists allow {}",
                          ensemble_->name(), count, max_rows - 1));
}

double SortedCopy::sorting_reach(double reach, Box::Edges const& edges) const {
  // Cells should not be mostly empty, or the order of rows would be that of distant particles.
  double const size = static_cast<double>(ensemble_->size() + 1);
  double volume = 1;
  for (int a = 0; a < box_->dimension(); ++a) volume *= edges[3 + a] - edges[a];
  return std::max(reach, 2.5 * std::pow(volume / size, 1.0 / box_->dimension()));
}

Cells SortedCopy::sort(double reach, std::span<double const> references, int threads) {
  auto const stride = static_cast<std::size_t>(box_->dimension());
  Cells sorted(box_->dimension(), references.data(), stride, ensemble_->size(), sorting_reach(reach, built_edges_),
               threads);
  order_ = sorted.items();
  references_.resize(4 * owned());
  steps_.resize(4 * owned());
  in_dimension(box_->dimension(), [&](auto D) {
    for_ranges(owned(), refresh_grain, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) take_reference<D>(k, references.data() + order_[k] * stride);
    });
  });
  return sorted;
}

std::uint32_t SortedCopy::code_of(Turns const& turns) const {
  int const base = 2 * max_images_ + 1;
  return static_cast<std::uint32_t>(((turns[2] + max_images_) * base + turns[1] + max_images_) * base + turns[0] +
                                    max_images_);
}

/// Maps of images, for the current walls.
void SortedCopy::find_image_maps() {
  // Blocks after the last number that changes are copied.
  mapped_blocks_ = 0;
  for (std::size_t n = 0; n < components_.size(); ++n) {
    ImageRule const rule = components_[n].rule;
    bool const flows = box_->sheared() && rule == ImageRule::velocity;
    if (rule == ImageRule::position || flows || (box_->any_wall() && rule != ImageRule::same))
      mapped_blocks_ = n / row_block + 1;
  }
  std::size_t const numbers = row_block * mapped_blocks_;
  image_sign_.resize(turns_.size() * numbers);
  image_shift_.resize(image_sign_.size());
  for (std::size_t code = 0; code < turns_.size(); ++code) {
    if (!images_.exists(turns_[code], reach_)) continue;
    for (std::size_t n = 0; n < numbers; ++n) {
      ImageMap const map = image_map(*box_, components_[n], turns_[code], box_->whole_slide(built_slide_));
      image_sign_[code * numbers + n] = map.sign;
      image_shift_[code * numbers + n] = map.shift;
    }
  }
}

double SortedCopy::images_moved() const {
  if (box_->sheared()) {
    // Two references at least a reach apart: the flow has shortened a distance of one reach at most by its shortening
    // along the direction of strongest compression. Each row counts half of that.
    double const half = 0.5 * std::abs(strain());
    return 0.5 * reach_ * (1 + half - std::sqrt(1 + half * half));
  }
  if (!box_->any_wall()) return 0;
  double square = 0;
  for (int a = 0; a < box_->dimension(); ++a) {
    double const d = std::max(std::abs(edges_[a] - built_edges_[a]), std::abs(edges_[3 + a] - built_edges_[3 + a]));
    square += d * d;
  }
  return std::sqrt(square);
}

void SortedCopy::add_ghosts(Part const* part, int threads) {  // long: counts and places images, in one order
  ghost_source_.clear();
  ghost_turns_.clear();
  max_images_ = 0;
  for (int a = 0; a < box_->dimension(); ++a) max_images_ = std::max(max_images_, images_.most(a, reach_));
  turns_.clear();  // in the order of code_of()
  for (int k = -max_images_; k <= max_images_; ++k)
    for (int j = -max_images_; j <= max_images_; ++j)
      for (int i = -max_images_; i <= max_images_; ++i) turns_.push_back({i, j, k});
  edges_ = box_->edges();
  find_image_maps();
  if (max_images_ == 0) return;
  struct Found {
    std::vector<std::uint32_t> source, turns;
  };
  std::vector<Found> parts((known() + refresh_grain - 1) / refresh_grain);
  int const dimension = box_->dimension();
  auto const is_near_any = [&](int a, double from, double to) {
    if (!part) return true;
    auto const& [places, axes, square] = part->near;
    double const wide = std::sqrt(square) * (1 + 1e-12);
    for (int n = 0; n < 2; ++n)
      if (axes[n] == a) {
        for (auto const& place : places)
          if (place.low[n] - wide <= to && place.high[n] + wide >= from) return true;
        return false;
      }
    return true;
  };
  // Rows inside these edges have no images, or none that is needed.
  std::array<double, 3> low, high;
  low.fill(-std::numeric_limits<double>::infinity()), high.fill(std::numeric_limits<double>::infinity());
  for (int a = 0; a < dimension; ++a) {
    int const most = images_.most(a, reach_);
    if (most == 0) continue;
    double const begin = built_edges_[a], end = built_edges_[3 + a];
    bool const any = !box_->periodic(a) || most > 1;
    if (any || is_near_any(a, end, end + reach_)) low[a] = begin + reach_;
    if (any || is_near_any(a, begin - reach_, begin)) high[a] = end - reach_;
  }
  for_ranges(known(), refresh_grain, threads, [&](std::size_t begin, std::size_t end) {
    Found& found = parts[begin / refresh_grain];  // of one thread: whole ranges, or all in the first
    // Local copies, which the compiler keeps in registers.
    Images const images = images_;
    double const reach = reach_, *const references = references_.data();
    std::array<double, 3> const least = low, greatest = high;
    NearPlaces const* const near = part ? &part->near : nullptr;
    for (std::size_t n = begin; n < end; ++n) {
      std::uint32_t const k = known(n);
      double const* const x = references + 4 * std::size_t{k};
      auto const is_inside = [&](std::size_t a) { return x[a] > least[a] && x[a] < greatest[a]; };
      if (is_inside(0) && is_inside(1) && is_inside(2)) continue;
      auto const take = [&](Turns const& turns) {
        if (turns == Turns{}) return;
        found.source.push_back(k);
        found.turns.push_back(code_of(turns));
      };
      if (box_->sheared()) {
        images.each(x, reach, [&](Turns const& turns, auto const&) { take(turns); });
        continue;
      }
      std::array<Images::Range, 3> range{};
      for (std::size_t a = 0; a < 3; ++a)
        if (!is_inside(a)) range[a] = images.turns_within(static_cast<int>(a), reach, x[a]);
      bool const any_along_first = range[0].first != range[0].last;
      // In 1D places differ along the first axis only.
      for (int t2 = range[2].first; t2 <= range[2].last; ++t2)
        for (int t1 = range[1].first; t1 <= range[1].last; ++t1) {
          if (t1 == 0 && t2 == 0 && !any_along_first) continue;
          if (near && dimension > 1 && !near->contains(images.at(1, t1, x[1]), images.at(2, t2, x[2]))) continue;
          for (int t0 = range[0].first; t0 <= range[0].last; ++t0)
            if (!near || dimension > 1 || near->contains(images.at(0, t0, x[0]), 0)) take({t0, t1, t2});
        }
    }
  });
  for (auto const& found : parts) {
    ghost_source_.insert(ghost_source_.end(), found.source.begin(), found.source.end());
    ghost_turns_.insert(ghost_turns_.end(), found.turns.begin(), found.turns.end());
  }
}

void SortedCopy::make_room(std::size_t rows) {
  if (rows <= capacity_) return;
  std::size_t const spare = 64 + rows / 64, before = block_stride();
  capacity_ = rows + spare;
  AlignedVector<double> moved;
  auto& target = before == 0 ? rows_ : moved;
  target.resize(all_blocks() * block_stride());
  if (before == 0) return;
  for (std::size_t b = 0; b < all_blocks(); ++b)
    std::copy_n(rows_.data() + b * before, before, moved.data() + b * block_stride());
  rows_ = std::move(moved);
}

void SortedCopy::move_ghosts(std::size_t first_block, std::size_t last_block, std::size_t begin, std::size_t end) {
  ImageTask task;
  task.copy = rows_.data();
  task.block_stride = block_stride();
  task.first_block = first_block;
  task.last_block = last_block;
  task.mapped_blocks = mapped_blocks_;
  task.first = owned() + 1;
  task.source = ghost_source_.data();
  task.turns = ghost_turns_.data();
  task.sign = image_sign_.data();
  task.shift = image_shift_.data();
  neighbour_kernels().images(task, begin, end);
}

/// Sorts all rows and their images into the cells of this grid, or of a fitting one. If both grids have the same edges,
/// the cells of rows follow from the cells by which they were sorted.
void SortedCopy::sort_all(Cells const& sorted, Grid const* grid, int threads) {
  std::size_t const rows = known(), images = ghost_source_.size(), count = rows + images;
  auto const D = static_cast<std::size_t>(box_->dimension());
  auto const at = std::make_unique_for_overwrite<double[]>(D * images);
  for_ranges(images, refresh_grain, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      double const* const source = references_.data() + 4 * std::size_t{ghost_source_[g]};
      Turns const& turns = turns_[ghost_turns_[g]];
      for (std::size_t a = 0; a < D; ++a) at[D * g + a] = images_.at(static_cast<int>(a), turns, source[a]);
    }
  });
  Grid fitting;
  if (!grid) {
    Bounds bounds = Bounds::of(box_->dimension(), references_.data(), 4, rows);
    if (images > 0) bounds.take(Bounds::of(box_->dimension(), at.get(), D, images));
    fitting = Cells::grid_for(box_->dimension(), bounds, count, reach_);
    grid = &fitting;
  }
  std::vector<std::uint32_t> cell(count);
  if (sorted.tell_cells_in(*grid))
    sorted.cells_in(*grid, cell.data());
  else
    find_cells(
        *grid, rows, [&](std::size_t n) { return references_.data() + 4 * std::size_t{known(n)}; }, cell.data(),
        threads);
  find_cells(
      *grid, images, [&](std::size_t g) { return at.get() + D * g; }, cell.data() + rows, threads);
  cells_ = Cells(*grid, cell, reach_);
  auto const& items = cells_.items();
  for (int a = 0; a < 3; ++a) position_[a].resize(count + candidate_padding);
  item_.resize(count + candidate_padding);
  for_ranges(count, refresh_grain, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      std::size_t const n = items[s];
      if (n < rows) {
        std::size_t const k = known(n);
        item_[s] = item_of_row(k);
        for (std::size_t a = 0; a < D; ++a) position_[a][s] = steps_[4 * k + a];
      } else {
        item_[s] = item_of_row(n - rows + owned() + 1);
        for (std::size_t a = 0; a < D; ++a) position_[a][s] = in_steps(at[D * (n - rows) + a], reach_);
      }
    }
  });
}

void SortedCopy::find_not_finite() const {
  for (auto const& [begin, end] : pieces_)
    for (std::size_t k = begin; k < end; ++k)
      for (int a = 0; a < box_->dimension(); ++a)
        if (!(std::abs(ensemble_->row(order_[k])[a] - references_[4 * k + a]) <=
              std::sqrt(std::numeric_limits<double>::max())))
          not_finite(*ensemble_, order_[k]);
}

RefreshTask SortedCopy::refresh_task() const {
  RefreshTask task;
  task.ensemble = ensemble_->row(0);
  task.order = order_.data();
  task.stride = ensemble_->stride();
  task.copy = const_cast<double*>(rows_.data());
  task.block_stride = block_stride();
  task.reference = references_.data();
  task.dimension = box_->dimension();
  for (int a = 0; a < box_->dimension(); ++a)
    if (box_->periodic(a)) {
      task.period[a] = box_->length(a);
      task.inverse_period[a] = 1 / box_->length(a);
    }
  return task;
}

void SortedCopy::place(std::span<std::uint32_t const> rows, double const* from) {
  auto task = refresh_task();
  task.ensemble = from;
  task.stride = row_block * followed_blocks();
  neighbour_kernels().place(task, rows.data(), rows.size());
}

bool SortedCopy::refresh(int threads, bool others) {
  RefreshTask const task = refresh_task();
  RefreshKernel const kernel = neighbour_kernels().refresh;
  bool const sheared = box_->sheared();
  std::atomic<bool> changed{false}, finite{true};
  for_ranges(pieces_.size(), refresh_grain / together, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      auto const [first, last] = pieces_[k];
      Refreshed const part = sheared ? refresh_sheared(task, first, last) : kernel(task, first, last);
      largest2_[k] = part.largest2;
      if (part.changed) changed.store(true, std::memory_order_relaxed);
      if (!part.finite) finite.store(false, std::memory_order_relaxed);
    }
  });
  if (!finite) find_not_finite();
  if (box_->any_wall() || sheared) {
    auto const now = box_->edges();
    if (now != edges_ || box_->slide() != slide_) changed = true;
    edges_ = now;
    slide_ = box_->slide();
    find_image_maps();
  }
  refresh_others(threads, others);
  return changed;
}

void SortedCopy::refresh_others(int threads, bool others) {
  RefreshTask const task = refresh_task();
  RefreshKernel const kernel = neighbour_kernels().refresh;
  if (others)
    for_stretches(others_, threads, [&](Stretch const* first, Stretch const* last) {
      for (; first != last; ++first)
        if (box_->sheared())
          refresh_sheared(task, first->begin, first->end);
        else
          kernel(task, first->begin, first->end);
    });
  refresh_images(0, followed_blocks(), threads);
}

void SortedCopy::refresh_images(std::size_t first_block, std::size_t last_block, int threads) {
  for (auto const& images : images_of_)
    if (images.end - images.begin > refresh_grain)
      return for_ranges(ghost_source_.size(), refresh_grain, threads,
                        [&](std::size_t begin, std::size_t end) { move_ghosts(first_block, last_block, begin, end); });
  for_stretches(images_of_, threads, [&](Stretch const* first, Stretch const* last) {
    for (; first != last; ++first) move_ghosts(first_block, last_block, first->begin, first->end);
  });
}

bool SortedCopy::is_current() const {
  if (owned() != ensemble_->size() || (box_->any_wall() && box_->edges() != edges_)) return false;
  if (box_->sheared()) return is_current_in_shear();
  for (auto const& [begin, end] : pieces_)
    for (std::size_t k = begin; k < end; ++k)
      for (int a = 0; a < box_->dimension(); ++a) {
        double x = ensemble_->row(order_[k])[a];
        if (box_->periodic(a))
          x -= box_->length(a) * std::nearbyint((x - references_[4 * k + a]) * (1 / box_->length(a)));
        if (x != rows_[row_block * k + a]) return false;
      }
  return true;
}

double SortedCopy::largest2() const {
  double largest = 0;
  for (double const square : largest2_) largest = std::max(largest, square);
  // An image moves twice as far as its wall (the root of the sum of squares for several walls), and one row of a pair
  // is an owned particle.
  double const moved = images_moved();
  return moved == 0 ? largest : (std::sqrt(largest) + moved) * (std::sqrt(largest) + moved);
}

std::optional<std::vector<std::uint32_t>> SortedCopy::beyond(double square, std::size_t most) const {
  std::vector<std::uint32_t> rows;
  bool const sheared = box_->sheared();
  if (double const moved = images_moved(); moved > 0) {
    double const left = std::sqrt(square) - moved;
    square = left < 0 ? -1 : left * left;
  }
  auto const may_have = [square](double largest2) { return largest2 > square; };
  // Each such piece has at least one.
  if (static_cast<std::size_t>(std::ranges::count_if(largest2_, may_have)) > most) return {};
  for (std::size_t b = 0; b < largest2_.size(); ++b) {
    if (!may_have(largest2_[b])) continue;
    for (std::size_t k = pieces_[b].begin; k < pieces_[b].end; ++k) {
      double moved2 = 0;
      for (int a = 0; a < box_->dimension(); ++a) {
        double const d = rows_[row_block * k + a] - references_[4 * k + a];
        moved2 += d * d;
      }
      if (sheared) moved2 = placed(k, rows_.data() + row_block * k).moved2;
      if (moved2 <= square * (1 - 1e-12)) continue;
      if (rows.size() == most) return {};
      rows.push_back(static_cast<std::uint32_t>(k));
    }
  }
  return rows;
}

void SortedCopy::move(std::span<std::uint32_t const> rows) {
  std::vector<double> references(3 * rows.size(), 0.0);
  for (std::size_t n = 0; n < rows.size(); ++n) {
    if (box_->sheared()) {
      put_back_to_build(rows_.data() + row_block * rows[n], references.data() + 3 * n);
      continue;
    }
    for (int a = 0; a < box_->dimension(); ++a) {
      double const x = rows_[row_block * rows[n] + a];
      references[3 * n + a] = box_->periodic(a) ? box_->wrapped(x, a) : x;
    }
  }
  move(rows, references);
}

void SortedCopy::move(std::span<std::uint32_t const> rows, std::span<double const> references) {
  int const dimension = box_->dimension();
  for (std::size_t n = 0; n < rows.size(); ++n) {
    std::uint32_t const k = rows[n];
    double* const reference = references_.data() + 4 * std::size_t{k};
    auto const known = std::find(moved_.begin(), moved_.end(), k);
    auto const m = static_cast<std::size_t>(known - moved_.begin());
    if (known == moved_.end()) {
      // Removes the row and all its images from the cells.
      images_.each(reference, reach_, [&](Turns const&, auto const& at) {
        std::size_t const cell = cells_.grid().cell_of(at.data());
        for (std::uint32_t s = cells_.start()[cell]; s < cells_.start()[cell + 1]; ++s) {
          std::size_t const row = row_of_item(item_[s]);
          if ((row < owned() ? row : ghost_source_[row - owned() - 1]) == k)
            position_[0][s] = opposite(in_steps(at[0], reach_));
        }
      });
      moved_.push_back(k);
      built_.push_back({reference[0], reference[1], reference[2]});
      moved_images_.emplace_back();
    }
    for (auto const& image : moved_images_[m])
      if (image.row != k) free_.push_back(image.row - static_cast<std::uint32_t>(owned()) - 1);
    moved_images_[m].clear();
    for (int a = 0; a < dimension; ++a) {
      reference[a] = references[3 * n + a];
      steps_[4 * k + a] = in_steps(reference[a], reach_);
    }
    if (box_->sheared())
      place(k, placed(k, rows_.data() + row_block * k));
    else
      refresh_row(k);  // its position far from the new reference may have been rounded
    images_.each(reference, reach_, [&](Turns const& turns, auto const& at) {
      if (turns == Turns{}) {
        moved_images_[m].push_back({k, at});
        return;
      }
      if (free_.empty()) {
        free_.push_back(static_cast<std::uint32_t>(ghost_source_.size()));
        ghost_source_.push_back(k);
        ghost_turns_.push_back(0);
        make_room(total() + 1);
        all_images();
      }
      std::uint32_t const g = free_.back();
      free_.pop_back();
      ghost_source_[g] = k;
      ghost_turns_[g] = code_of(turns);
      moved_images_[m].push_back({static_cast<std::uint32_t>(owned() + 1 + g), at});
      move_ghosts(0, all_blocks(), g, g + 1);
    });
  }
  list_images(moved_images_, reach_, moved_position_, moved_item_);
}

void SortedCopy::owned_near(double const* x, double reach, std::vector<std::uint32_t>& rows) const {
  std::array<std::int32_t, 3> steps{};
  double const furthest = reach / reach_ * steps_of_reach * (1 + 1e-6) + 4;
  auto const take = [&](auto const& position, std::size_t s, std::uint32_t item) {
    double square = 0;
    for (int a = 0; a < box_->dimension(); ++a) {
      double const d = wrapped_difference(position[a][s], steps[a]);
      square += d * d;
    }
    if (square > furthest * furthest) return;
    std::size_t const row = row_of_item(item);
    rows.push_back(row < owned() ? static_cast<std::uint32_t>(row) : ghost_source_[row - owned() - 1]);
  };
  auto const look = [&](double const* here) {
    for (int a = 0; a < box_->dimension(); ++a) steps[a] = in_steps(here[a], reach_);
    cells_.near(here, reach, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) take(position_, s, item_[s]);
    });
    for (std::size_t s = 0; s + candidate_padding < moved_item_.size(); ++s) take(moved_position_, s, moved_item_[s]);
  };
  if (!part_) return look(x);
  // A part does not have all images: searches rows near those of x, instead of images near x.
  images_.each(x, reach, [&](Turns const&, auto const& at) { look(at.data()); });
}

bool SortedCopy::knows(std::uint32_t k, std::uint32_t particle) const {
  return order_[k] == particle && (!part_ || std::binary_search(known_.begin(), known_.end(), k));
}

std::uint32_t SortedCopy::learn(std::uint32_t row_of_all, std::uint32_t particle, double const* reference) {
  std::uint32_t k = row_of_all;
  auto place = std::lower_bound(known_.begin(), known_.end(), k);
  while (place != known_.end() && *place == k) {
    ++place;
    if (++k < owned()) continue;
    k = 0;
    place = known_.begin();
  }
  known_.insert(place, k);
  order_[k] = particle;
  in_dimension(box_->dimension(), [&](auto D) { take_reference<D>(k, reference); });
  return k;
}

void SortedCopy::refresh_row(std::uint32_t k) {
  if (box_->sheared())
    refresh_sheared(refresh_task(), k, k + 1);
  else
    neighbour_kernels().refresh(refresh_task(), k, k + 1);
}

double SortedCopy::left_build_by(std::uint32_t k) const {
  double square = 0;
  for (int a = 0; a < box_->dimension(); ++a) {
    double const built = built_by_number_[order_[k] * static_cast<std::size_t>(box_->dimension()) + a];
    double const x = rows_[row_block * std::size_t{k} + a];
    double const d = (box_->periodic(a) ? box_->wrapped(x, a) : x) - built;
    square += d * d;
  }
  return std::sqrt(square);
}

std::vector<std::uint32_t> SortedCopy::rows_by_number() const {
  std::vector<std::uint32_t> rows(owned());
  for (std::uint32_t k = 0; k < owned(); ++k) rows[order_[k]] = k;
  return rows;
}

std::vector<double> SortedCopy::built_references() const {
  if (part_) return built_by_number_;
  int const dimension = box_->dimension();
  std::vector<double> references(owned() * dimension);
  for (std::size_t k = 0; k < owned(); ++k)
    for (int a = 0; a < dimension; ++a) references[order_[k] * dimension + a] = references_[4 * k + a];
  for (std::size_t m = 0; m < moved_.size(); ++m)
    for (int a = 0; a < dimension; ++a) references[order_[moved_[m]] * dimension + a] = built_[m][a];
  return references;
}

NearTask SortedCopy::near_task() const {
  NearTask task;
  task.grid = &cells_.grid();
  task.start = cells_.start();
  task.steps_per_length = steps_of_reach / reach_;
  for (int a = 0; a < 3; ++a) {
    task.sorted.position[a] = position_[a].data();
    task.moved.position[a] = moved_position_[a].data();
  }
  task.sorted.item = item_.data();
  task.moved.item = moved_item_.data();
  task.moved_count = static_cast<std::uint32_t>(moved_item_.size() - candidate_padding);
  task.sentinel = item_of_row(sentinel());
  return task;
}

std::size_t SortedCopy::bytes() const {
  auto const of = [](auto const& vector) { return vector.capacity() * sizeof(vector[0]); };
  return of(order_) + of(known_) + of(built_by_number_) + of(rows_) + of(references_) + of(steps_) + of(ghost_source_) +
         of(ghost_turns_) + of(largest2_) + cells_.bytes() + of(position_[0]) + of(position_[1]) + of(position_[2]) +
         of(item_);
}

}  // namespace boltzmann
