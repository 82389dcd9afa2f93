// Poisson's equation axis by axis. Every axis has its own transform, to modes in which the Laplacian is a factor.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/number.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/schemes/mesh/open_kernel.hpp>
#include <boltzmann/schemes/mesh/poisson_ranks.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace boltzmann {

using namespace poisson;

namespace {

struct Scratch {
  Scratch(std::size_t block, std::size_t row) : a(block), b(block), c(row) {}
  FourierArray a, b, c;  ///< c: a second row of modes, for the slope
};

/// A potential on the nodes, with padding between rows and planes.
struct View {
  double const* data;
  std::size_t row, plane;
};

// ---- Sizes ----

struct Shape {
  std::array<Axis, 3> axis;             ///< by slot
  std::array<int, 3> slot_of{0, 1, 2};  ///< by axis of the mesh
  int dimension = 1;
  bool complex_rows = false, any_open = false;
  std::size_t columns = 0;         ///< doubles of a transformed row
  std::size_t row = 0, plane = 0;  ///< strides of rows and planes
  std::size_t spectrum = 0;        ///< doubles of an array of modes
  std::size_t scratch = 0;         ///< doubles of a block
  std::array<std::size_t, 3> table{1, 1, 1};
  std::vector<OpenAxis> open_axes;

  std::size_t table_size() const { return table[0] * table[1] * table[2]; }
};

Layout column_layout(Shape const& shape, Axis const& axis) {
  return shape.complex_rows && axis.complex() ? Layout::complex_columns : Layout::real_columns;
}

Shape make_shape(MeshGrid const& grid, std::array<FieldEnds, 3> const& ends, bool green) {
  if (grid.dimension < 1 || grid.dimension > 3)
    throw Error(fmt::format("mesh: {} dimensions; a mesh has 1, 2 or 3", grid.dimension));
  Shape shape;
  shape.dimension = grid.dimension;
  if (grid.dimension == 2) shape.slot_of = {0, 2, 1};
  for (int a = 0; a < grid.dimension; ++a) {
    Axis& axis = shape.axis[shape.slot_of[a]];
    axis = make_axis(grid, ends[a], a);
    if (green && axis.kind != Kind::periodic)
      throw Error(
          fmt::format("mesh: axis {} is not periodic; a Green function of one's own needs periodic axes", "xyz"[a]));
  }
  Axis const &x = shape.axis[0], &mid = shape.axis[1], &last = shape.axis[2];
  shape.complex_rows = x.complex();
  shape.columns = x.complex() ? 2 * (x.modes / 2 + 1) : x.modes;
  shape.row = std::max(shape.columns, x.nodes);
  shape.plane = shape.row * std::max(mid.nodes, mid.modes);
  shape.spectrum = shape.plane * last.nodes;
  shape.scratch = std::max({Lines::buffer_size(x, Layout::row), Lines::buffer_size(mid, Layout::real_columns),
                            Lines::buffer_size(last, Layout::real_columns)});
  for (int s = 0; s < 3; ++s) {
    Axis const& axis = shape.axis[s];
    shape.table[s] = green && s > 0 ? axis.modes : axis.folded_modes();
    if (axis.kind != Kind::open) continue;
    shape.any_open = true;
    shape.open_axes.push_back({axis.cells, axis.modes, axis.spacing});
  }
  return shape;
}

struct Memory {
  std::size_t held, most;
};

int threads_on(MeshGrid const& grid, int threads) { return threads_for(grid.size(), 0.5, std::max(threads, 1)); }

std::size_t row_scratch(Shape const& shape, PoissonForm form) {
  return form == PoissonForm::spectral ? Lines::buffer_size(shape.axis[0], Layout::row) : 0;
}

Memory memory(Shape const& shape, MeshGrid const& grid, PoissonForm form, int threads, bool green) {
  bool const slopes = form == PoissonForm::spectral;
  std::size_t const used = threads_on(grid, threads);
  std::size_t tables = green ? shape.table_size() : 0, making = 0;
  if (shape.any_open) {
    tables = shape.table_size() * (slopes ? 1 + shape.open_axes.size() : 1);
    OpenKernel const kernel(shape.open_axes);
    bool const one = shape.table_size() == kernel.table_size();
    making = kernel.scratch_size() * (one ? 1 : used);
  }
  std::size_t doubles = shape.spectrum * (slopes && shape.any_open ? 2 : 1) + tables;
  for (Axis const& axis : shape.axis) doubles += 4 * axis.modes;  // two tables, and about as much in the plans
  doubles += shape.axis[0].folded_modes() + block_width;
  return {
      sizeof(double) * doubles,
      sizeof(double) * (std::max(doubles + (2 * shape.scratch + row_scratch(shape, form)) * used, tables + making))};
}

}  // namespace

// ---- The solver ----

struct PoissonSolver::Plans {
  Shape shape;
  MeshGrid grid;
  PoissonForm form;
  int threads;
  Memory memory;
  Lines x, mid, last;             ///< of the modes
  std::array<Lines, 3> along;     ///< of the potential's lines, for their slopes
  std::vector<double> row_modes;  ///< eigenvalues along x for each column (complex rows: for each pair)
  std::vector<double> table;      ///< Green's function, unless it is 1/k^2
  std::array<std::vector<double>, 3> slope_table;  ///< by slot, for open axes
  FourierArray spectrum, second;
  double scale = 1;

  Plans(MeshGrid const& g, std::array<FieldEnds, 3> const& ends, PoissonForm f, int t, GreensFunction const& green)
      : shape(make_shape(g, ends, green != nullptr)),
        grid(g),
        form(f),
        threads(threads_on(g, t)),
        memory(boltzmann::memory(shape, g, f, t, green != nullptr)) {
    for (Axis& axis : shape.axis) {
      fill_tables(axis, form);
      scale *= axis.scale;
    }
    bool const spectral = form == PoissonForm::spectral;
    Axis const &ax = shape.axis[0], &amid = shape.axis[1], &alast = shape.axis[2];
    x = Lines(ax, Layout::row, spectral);
    mid = Lines(amid, column_layout(shape, amid), spectral && amid.kind == Kind::open);
    last = Lines(alast, column_layout(shape, alast), spectral && alast.kind == Kind::open);
    if (spectral)
      for (int s = 1; s < 3; ++s)
        if (shape.axis[s].kind != Kind::single && shape.axis[s].kind != Kind::open)
          along[s] =
              Lines(shape.axis[s], shape.axis[s].complex() ? Layout::complex_columns : Layout::real_columns, true);
    row_modes.assign(ax.eigenvalue.begin(), ax.eigenvalue.begin() + static_cast<std::ptrdiff_t>(ax.folded_modes()));
    row_modes.resize(row_modes.size() + block_width, 1.0);
    if (green) sample(green);
    if (shape.any_open) make_open_tables();
    spectrum = FourierArray(shape.spectrum);
    if (spectral && shape.any_open) second = FourierArray(shape.spectrum);
  }

  std::size_t grain(std::size_t items) const { return 1 + items / (4 * static_cast<std::size_t>(threads)); }

  /// Calls function(item, scratch) for all items of a range, on all threads.
  template <class Function>
  void for_items(Range const& items, Function const& function) const {
    for_ranges(items.size(), grain(items.size()), threads, [&](std::size_t begin, std::size_t end) {
      Scratch scratch(shape.scratch, row_scratch(shape, form));
      for (std::size_t i = begin; i < end; ++i) function(items.begin + i, scratch);
    });
  }

  void sample(GreensFunction const& green) {
    table.resize(shape.table_size());
    auto const wave_number = [](Axis const& axis, std::size_t j) {
      double const m = 2 * j >= axis.cells && j > 0 ? static_cast<double>(j) - static_cast<double>(axis.cells)
                                                    : static_cast<double>(j);
      return 2 * pi * m / (static_cast<double>(axis.cells) * axis.spacing);
    };
    for (std::size_t l = 0; l < shape.table[2]; ++l)
      for (std::size_t m = 0; m < shape.table[1]; ++m)
        for (std::size_t i = 0; i < shape.table[0]; ++i) {
          if (i + m + l == 0) continue;
          std::array<std::size_t, 3> const mode{i, m, l};
          std::array<double, 3> k{0, 0, 0};
          for (int a = 0; a < shape.dimension; ++a)
            k[a] = wave_number(shape.axis[shape.slot_of[a]], mode[shape.slot_of[a]]);
          double const value = green(k);
          if (!std::isfinite(value))
            throw Error(fmt::format("mesh: the Green function at k = ({}, {}, {}) is {}; it must be finite", k[0], k[1],
                                    k[2], value));
          table[(l * shape.table[1] + m) * shape.table[0] + i] = value;
        }
  }

  /// Copies the small table over the open axes for every mode of the others into a large one.
  void make_open_tables() {
    OpenKernel const kernel(shape.open_axes);
    std::array<std::size_t, 3> const stride{1, shape.table[0], shape.table[0] * shape.table[1]};
    std::array<std::size_t, 3> open{1, 1, 1}, other{1, 1, 1}, open_stride{0, 0, 0};
    std::vector<int> open_slots;
    for (int s = 0; s < 3; ++s) {
      if (shape.axis[s].kind == Kind::open) {
        open[open_slots.size()] = shape.table[s];
        open_stride[open_slots.size()] = stride[s];
        open_slots.push_back(s);
      } else {
        other[s] = shape.table[s];
      }
    }
    bool const slopes = form == PoissonForm::spectral;
    table.resize(shape.table_size());
    if (slopes)
      for (int const s : open_slots) slope_table[s].resize(shape.table_size());
    std::size_t const tables = other[0] * other[1] * other[2];
    int const inside = tables == 1 ? threads : 1;
    for_ranges(tables, 1, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        std::array<std::size_t, 3> const mode{t % other[0], t / other[0] % other[1], t / (other[0] * other[1])};
        double k2 = 0;
        std::size_t start = 0;
        for (int s = 0; s < 3; ++s) {
          k2 += shape.axis[s].eigenvalue[mode[s]];
          start += mode[s] * stride[s];
        }
        auto const put = [&](std::vector<double> const& small, std::vector<double>& big) {
          std::size_t i = 0;
          for (std::size_t c = 0; c < open[2]; ++c)
            for (std::size_t b = 0; b < open[1]; ++b)
              for (std::size_t a = 0; a < open[0]; ++a)
                big[start + a * open_stride[0] + b * open_stride[1] + c * open_stride[2]] = small[i++];
        };
        put(kernel.potential(k2, inside), table);
        if (slopes)
          for (std::size_t o = 0; o < open_slots.size(); ++o)
            put(kernel.slope(k2, static_cast<int>(o), inside), slope_table[open_slots[o]]);
      }
    });
  }

  Planes modes(FourierArray& array) const {
    return {array.data(), shape.axis[2].nodes, shape.axis[1].modes, shape.columns, shape.row, shape.plane};
  }
  /// The potential on the nodes, in the memory of the modes.
  Planes potential_of(FourierArray& array) const {
    return {array.data(), shape.axis[2].nodes, shape.axis[1].nodes, shape.axis[0].nodes, shape.row, shape.plane};
  }
  /// The planes of a caller's array.
  Planes on_nodes(double* values) const {
    std::size_t const nx = shape.axis[0].nodes, ny = shape.axis[1].nodes;
    return {values, shape.axis[2].nodes, ny, nx, nx, nx * ny};
  }
  Range samples() const { return {shape.axis[2].first, shape.axis[2].first + shape.axis[2].samples}; }

  /// Transforms the density to modes along x and the middle axis.
  void forward(double const* density, Range const& planes) {
    Axis const &ax = shape.axis[0], &amid = shape.axis[1];
    for_items(planes.within(samples()), [&](std::size_t node, Scratch& scratch) {
      double* const a = scratch.a.data();
      double* const b = scratch.b.data();
      double* const plane = spectrum.data() + node * shape.plane;
      for (std::size_t s = 0; s < amid.samples; ++s) {
        std::copy_n(density + (node * amid.nodes + s + amid.first) * ax.nodes + ax.first, ax.samples, a);
        x.forward(a, b);
        std::copy_n(b, shape.columns, plane + s * shape.row);
      }
      if (amid.kind == Kind::single) return;
      for (std::size_t c = 0; c < shape.columns; c += block_width) {
        std::size_t const columns = std::min(block_width, shape.columns - c);
        load(plane + c, shape.row, amid.samples, columns, a);
        mid.forward(a, b);
        store(b, amid.modes, columns, plane + c, shape.row);
      }
    });
  }

  /// Transforms along the last axis to modes, multiplies by Green's function (or a table of slopes), and transforms
  /// back.
  void multiply(double amplitude, std::vector<double> const& factors, bool slope, double* to, Range const& lines) {
    Axis const &amid = shape.axis[1], &alast = shape.axis[2];
    std::size_t const blocks = modes(spectrum).blocks_of_row();
    for_items(lines, [&](std::size_t item, Scratch& scratch) {
      double* const a = scratch.a.data();
      double* const b = scratch.b.data();
      std::size_t const m = item / blocks, c = item % blocks * block_width;
      std::size_t const columns = std::min(block_width, shape.columns - c);
      std::size_t const offset = m * shape.row + c;
      load(spectrum.data() + alast.first * shape.plane + offset, shape.plane, alast.samples, columns, a);
      last.forward(a, b);
      if (factors.empty())
        divide(b, c, amid.eigenvalue[m], amplitude);
      else
        multiply_by(factors, b, c, columns, m, amplitude);
      Nodes const nodes = slope ? last.slope(b, a, 1.0) : last.backward(b, a);
      store(a, nodes.count, columns, to + nodes.first * shape.plane + offset, shape.plane);
    });
  }

  void divide(double* b, std::size_t column, double mid_eigenvalue, double amplitude) const {
    double const* const last_eigenvalue = shape.axis[2].eigenvalue.data();
    std::size_t const rows = shape.axis[2].modes;
    auto const run = [&](auto numbers) {  // lines that share a factor
      constexpr std::size_t lines = block_width / numbers;
      std::array<double, lines> base;
      for (std::size_t i = 0; i < lines; ++i) base[i] = row_modes[column / numbers + i] + mid_eigenvalue;
      for (std::size_t l = 0; l < rows; ++l, b += block_width) {
        std::array<double, lines> factor;
        for (std::size_t i = 0; i < lines; ++i) {
          double const sum = base[i] + last_eigenvalue[l];
          factor[i] = amplitude / (sum > 0 ? sum : 1.0) * (sum > 0 ? 1.0 : 0.0);
        }
        for (std::size_t i = 0; i < block_width; ++i) b[i] *= factor[i / numbers];
      }
    };
    if (shape.complex_rows)
      run(std::integral_constant<std::size_t, 2>());
    else
      run(std::integral_constant<std::size_t, 1>());
  }

  void multiply_by(std::vector<double> const& factors, double* b, std::size_t column, std::size_t columns,
                   std::size_t m, double amplitude) const {
    Axis const& alast = shape.axis[2];
    auto const entry = [&](int s, std::size_t mode) {
      return shape.table[s] == shape.axis[s].modes ? mode : shape.axis[s].folded(mode);
    };
    std::size_t const numbers = shape.complex_rows ? 2 : 1;
    double const* const start = factors.data() + entry(1, m) * shape.table[0] + column / numbers;
    for (std::size_t l = 0; l < alast.modes; ++l, b += block_width) {
      double const* const line = start + entry(2, l) * shape.table[0] * shape.table[1];
      for (std::size_t i = 0; i < columns; ++i) b[i] *= amplitude * line[i / numbers];
    }
  }

  /// Transforms modes along x and the middle axis back to nodes, in place. Copies the potential to `values` if given,
  /// and the slope along x to `x_slope`. If `slope_slot` is 0 or 1, also computes the slope along that axis.
  void backward(double* modes, int slope_slot, double* values, double* x_slope, Range const& planes) {
    Axis const &ax = shape.axis[0], &amid = shape.axis[1], &alast = shape.axis[2];
    for_items(planes, [&](std::size_t node, Scratch& scratch) {
      double* const a = scratch.a.data();
      double* const b = scratch.b.data();
      double* const plane = modes + node * shape.plane;
      bool const empty = node < alast.first || node >= alast.first + alast.samples;
      if (amid.kind != Kind::single && !empty)
        for (std::size_t c = 0; c < shape.columns; c += block_width) {
          std::size_t const columns = std::min(block_width, shape.columns - c);
          load(plane + c, shape.row, amid.modes, columns, b);
          Nodes const nodes = slope_slot == 1 ? mid.slope(b, a, 1.0) : mid.backward(b, a);
          store(a, nodes.count, columns, plane + nodes.first * shape.row + c, shape.row);
        }
      for (std::size_t j = 0; j < amid.nodes; ++j) {
        double* const row = plane + j * shape.row;
        std::size_t const target = (node * amid.nodes + j) * ax.nodes;
        if (empty || j < amid.first || j >= amid.first + amid.samples) {
          std::fill_n(row, ax.nodes, 0.0);
          if (x_slope) std::fill_n(x_slope + target, ax.nodes, 0.0);
        } else {
          std::copy_n(row, shape.columns, b);
          if (x_slope) {
            std::copy_n(b, shape.columns, scratch.c.data());
            Nodes const nodes = x.slope(scratch.c.data(), a, 1.0);
            store_row(a, nodes, ax.nodes, x_slope + target);
          }
          Nodes const nodes = slope_slot == 0 ? x.slope(b, a, 1.0) : x.backward(b, a);
          store_row(a, nodes, ax.nodes, row);
        }
        if (values) std::copy_n(row, ax.nodes, values + target);
      }
    });
  }

  void differences(int slot, View const& phi, double* field) const {
    Axis const &ax = shape.axis[0], &amid = shape.axis[1], &alast = shape.axis[2];
    for_ranges(alast.nodes, grain(alast.nodes), threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t l = begin; l < end; ++l) {
        Difference const by_plane = difference_at(alast, l);
        for (std::size_t j = 0; j < amid.nodes; ++j) {
          double* const out = field + (l * amid.nodes + j) * ax.nodes;
          if (slot == 0) {
            row_differences(phi.data + l * phi.plane + j * phi.row, out);
            continue;
          }
          Difference const d = slot == 1 ? difference_at(amid, j) : by_plane;
          auto const line = [&](int i) {
            return slot == 1 ? phi.data + l * phi.plane + d.node[i] * phi.row
                             : phi.data + d.node[i] * phi.plane + j * phi.row;
          };
          double const *const p = line(0), *const q = line(1), *const r = line(2);
          double const u = d.weight[0], v = d.weight[1], w = d.weight[2];
          if (d.terms == 2)
            for (std::size_t i = 0; i < ax.nodes; ++i) out[i] = u * p[i] + v * q[i];
          else
            for (std::size_t i = 0; i < ax.nodes; ++i) out[i] = u * p[i] + v * q[i] + w * r[i];
        }
      }
    });
  }

  void row_differences(double const* phi, double* out) const {
    Axis const& ax = shape.axis[0];
    double const w = 1 / (2 * ax.spacing);
    for (std::size_t i = 1; i + 1 < ax.nodes; ++i) out[i] = w * phi[i - 1] - w * phi[i + 1];
    for (std::size_t const i : {std::size_t{0}, ax.nodes - 1}) {
      Difference const d = difference_at(ax, i);
      out[i] = 0;
      for (int t = 0; t < d.terms; ++t) out[i] += d.weight[t] * phi[d.node[t]];
    }
  }

  /// Computes the slope along one axis, line by line: for the last axis in these blocks of lines, otherwise in these
  /// planes.
  void slope_along(int slot, View const& phi, double* field, Range const& part) const {
    Axis const &ax = shape.axis[0], &amid = shape.axis[1];
    if (slot == 0) {
      for_items({part.begin * amid.nodes, part.end * amid.nodes}, [&](std::size_t item, Scratch& scratch) {
        std::size_t const l = item / amid.nodes, j = item % amid.nodes;
        std::copy_n(phi.data + l * phi.plane + j * phi.row + ax.first, ax.samples, scratch.a.data());
        x.forward(scratch.a.data(), scratch.b.data());
        Nodes const nodes = x.slope(scratch.b.data(), scratch.a.data(), ax.scale);
        store_row(scratch.a.data(), nodes, ax.nodes, field + item * ax.nodes);
      });
      return;
    }
    Axis const& axis = shape.axis[slot];
    std::size_t const blocks = on_nodes(field).blocks_of_row();
    std::size_t const from_stride = slot == 1 ? phi.row : phi.plane, from_line = slot == 1 ? phi.plane : phi.row;
    std::size_t const to_stride = slot == 1 ? ax.nodes : ax.nodes * amid.nodes;
    std::size_t const to_line = slot == 1 ? ax.nodes * amid.nodes : ax.nodes;
    Range const items = slot == 1 ? Range{part.begin * blocks, part.end * blocks} : part;
    for_items(items, [&](std::size_t item, Scratch& scratch) {
      std::size_t const line = item / blocks, c = item % blocks * block_width;
      std::size_t const columns = std::min(block_width, ax.nodes - c);
      load(phi.data + line * from_line + axis.first * from_stride + c, from_stride, axis.samples, columns,
           scratch.a.data());
      along[slot].forward(scratch.a.data(), scratch.b.data());
      Nodes const nodes = along[slot].slope(scratch.b.data(), scratch.a.data(), axis.scale);
      store_nodes(scratch.a.data(), nodes, axis.nodes, columns, field + line * to_line + c, to_stride);
    });
  }

  void solve(std::vector<double> const& density, double constant, std::vector<double>* potential,
             std::vector<std::vector<double>>* field, SolvingRanks const* all) {
    check(density, "density");
    if (potential) potential->resize(grid.size());
    if (field) resize(*field);
    Ranks const ranks(all);
    std::vector<Ranks::Result> results;
    double const amplitude = constant * scale;
    bool const spectral = form == PoissonForm::spectral;
    Range const planes = ranks.own(shape.axis[2].nodes), lines = ranks.own(modes(spectrum).blocks());
    forward(density.data(), planes);
    ranks.to_lines(modes(spectrum), samples());

    bool slopes_missing = false;  // slopes that are computed from the potential
    if (field)
      for (int a = 0; a < shape.dimension; ++a) {
        int const slot = shape.slot_of[a];
        if (!spectral || shape.axis[slot].kind != Kind::open) {
          slopes_missing = true;
          continue;
        }
        multiply(amplitude, slope_table[slot], slot == 2, second.data(), lines);
        ranks.to_planes(modes(second), samples());
        backward(second.data(), slot, (*field)[a].data(), nullptr, planes);
        results.push_back({on_nodes((*field)[a].data())});
      }
    if (potential || slopes_missing) {
      multiply(amplitude, table, false, spectrum.data(), lines);
      ranks.to_planes(modes(spectrum), samples());
      bool const rows_too = field && spectral && shape.axis[0].kind != Kind::open;
      backward(spectrum.data(), -1, potential ? potential->data() : nullptr, rows_too ? (*field)[0].data() : nullptr,
               planes);
      if (potential) results.push_back({on_nodes(potential->data())});
      if (rows_too) results.push_back({on_nodes((*field)[0].data())});
      if (slopes_missing) slopes(ranks, *field, rows_too ? 1 : 0, results);
    }
    ranks.share(results);
  }

  /// Computes slopes of the potential in `spectrum`, along the axes from `first` on.
  void slopes(Ranks const& ranks, std::vector<std::vector<double>>& field, int first,
              std::vector<Ranks::Result>& results) {
    Planes const all = potential_of(spectrum);
    View const phi{all.data, all.row, all.plane};
    if (form == PoissonForm::finite_difference) {  // computing them is cheaper than communicating them
      ranks.share({{all}}, true);
      for (int a = first; a < shape.dimension; ++a) differences(shape.slot_of[a], phi, field[a].data());
      return;
    }
    for (int a = first; a < shape.dimension; ++a) {
      int const slot = shape.slot_of[a];
      if (shape.axis[slot].kind == Kind::open) continue;
      if (slot == 2) ranks.to_lines(all, samples());
      slope_along(slot, phi, field[a].data(), ranks.own(slot == 2 ? all.blocks() : all.count));
      results.push_back({on_nodes(field[a].data()), slot == 2});
    }
  }

  void field(std::vector<double> const& potential, std::vector<std::vector<double>>& field) {
    check(potential, "potential");
    resize(field);
    Axis const &ax = shape.axis[0], &amid = shape.axis[1];
    View const phi{potential.data(), ax.nodes, ax.nodes * amid.nodes};
    for (int a = 0; a < shape.dimension; ++a) {
      int const slot = shape.slot_of[a];
      if (form == PoissonForm::finite_difference || shape.axis[slot].kind == Kind::open)
        differences(slot, phi, field[a].data());
      else
        slope_along(slot, phi, field[a].data(), {0, slot == 2 ? on_nodes(nullptr).blocks() : shape.axis[2].nodes});
    }
  }

  void check(std::vector<double> const& values, char const* name) const {
    if (values.size() != grid.size())
      throw Error(fmt::format("mesh: the {} has {} numbers; the mesh has {} nodes", name, values.size(), grid.size()));
  }
  void resize(std::vector<std::vector<double>>& field) const {
    field.resize(static_cast<std::size_t>(shape.dimension));
    for (auto& component : field) component.resize(grid.size());
  }
};

std::pair<std::size_t, std::size_t> SolvingRanks::part(std::size_t rank, std::size_t planes) const {
  auto const size = static_cast<std::size_t>(team->size());
  return {planes * rank / size, planes * (rank + 1) / size};
}

PoissonSolver::PoissonSolver(MeshGrid const& grid, std::array<FieldEnds, 3> const& ends, PoissonForm form, int threads,
                             GreensFunction const& green)
    : plans_(std::make_unique<Plans>(grid, ends, form, threads, green)) {}

PoissonSolver::~PoissonSolver() = default;

void PoissonSolver::potential(std::vector<double> const& density, double constant, std::vector<double>& potential) {
  plans_->solve(density, constant, &potential, nullptr, nullptr);
}

void PoissonSolver::field(std::vector<double> const& potential, std::vector<std::vector<double>>& field) {
  plans_->field(potential, field);
}

void PoissonSolver::solve(std::vector<double> const& density, double constant, std::vector<double>* potential,
                          std::vector<std::vector<double>>& field, SolvingRanks const* ranks) {
  plans_->solve(density, constant, potential, &field, ranks);
}

Words<FieldBoundary> const& field_boundary_words() {
  static Words<FieldBoundary> const all{
      "boundary",
      {{FieldBoundary::periodic, "periodic", "both ends"},
       {FieldBoundary::dirichlet, "dirichlet", "potential zero: a grounded conductor"},
       {FieldBoundary::neumann, "neumann", "no normal field: a plane of symmetry, an insulator"},
       {FieldBoundary::open, "open", "both ends: empty space beyond"}}};
  return all;
}
std::string to_string(FieldBoundary boundary) { return field_boundary_words().name(boundary); }

Words<PoissonForm> const& poisson_form_words() {
  static Words<PoissonForm> const all{
      "form of Poisson's equation",
      {{PoissonForm::finite_difference, "finite-difference", "three-point Laplacian, central differences"},
       {PoissonForm::spectral, "spectral", "k^2 and i k: exact for smooth densities"}}};
  return all;
}

void PoissonSolver::threads(int count) { plans_->threads = threads_on(plans_->grid, count); }

std::size_t PoissonSolver::bytes() const { return plans_->memory.held; }

std::size_t PoissonSolver::bytes_needed(MeshGrid const& grid, std::array<FieldEnds, 3> const& ends, PoissonForm form,
                                        int threads, bool green) {
  return memory(make_shape(grid, ends, green), grid, form, threads, green).most;
}

}  // namespace boltzmann
