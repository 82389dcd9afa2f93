// Ghost values beyond the ends of a mesh, for each boundary condition.
#include <boltzmann/core/threads.hpp>
#include <boltzmann/schemes/mesh/ghosts.hpp>
#include <boltzmann/schemes/mesh/spline.hpp>

#include <algorithm>

namespace boltzmann {
namespace {

void add(std::int64_t* to, std::int64_t const* from, std::size_t count, double factor) {
  if (factor == 1)
    for (std::size_t i = 0; i < count; ++i) to[i] += from[i];
  else
    for (std::size_t i = 0; i < count; ++i) to[i] += static_cast<std::int64_t>(factor) * from[i];
}

enum class Reflection { value, normal, mirror };

/// Reflects a node of an axis of n cells with walls. On a mesh of few cells this may take more than one reflection.
Ghosts::Term reflect(std::int64_t node, std::int64_t n, FieldEnds const& ends, Reflection how) {
  Ghosts::Term term;
  while (node < 0 || node > n) {
    bool const low = node < 0;
    bool const grounded = (low ? ends.low : ends.high) == FieldBoundary::dirichlet;
    if (grounded && how != Reflection::mirror) {
      (low ? term.low : term.high) += 2 * term.factor;
      term.factor = -term.factor;
    } else if (how == Reflection::normal) {
      term.factor = -term.factor;
    }
    node = low ? -node : 2 * n - node;
  }
  term.node = static_cast<std::uint32_t>(node);
  return term;
}

}  // namespace

Ghosts::Ghosts(int dimension, std::array<std::size_t, 3> const& cells, std::array<FieldEnds, 3> const& ends, int order)
    : dimension_(dimension), order_(order), before_(nodes_before(order)), cells_(cells), ends_(ends) {
  for (int a = 0; a < 3; ++a) {
    if (a >= dimension) {
      cells_[a] = 1;
      mesh_nodes_[a] = 1;
      terms_[a] = normal_terms_[a] = mirrored_[a] = {Term{}};
      continue;
    }
    auto const n = static_cast<std::int64_t>(cells[a]);
    bool const periodic = ends[a].low == FieldBoundary::periodic, open = ends[a].low == FieldBoundary::open;
    mesh_nodes_[a] = periodic ? cells[a] : open ? cells[a] + static_cast<std::size_t>(order) : cells[a] + 1;
    for (std::int64_t g = 0; g < n + order; ++g) {
      std::int64_t const node = g - before_;
      auto const term = [&](Reflection how) {
        if (periodic) return Term{static_cast<std::uint32_t>((node % n + n) % n)};
        if (open) return Term{static_cast<std::uint32_t>(g)};
        return reflect(node, n, ends[a], how);
      };
      terms_[a].push_back(term(Reflection::value));
      normal_terms_[a].push_back(term(Reflection::normal));
      mirrored_[a].push_back(term(Reflection::mirror));
    }
  }
}

bool Ghosts::smears() const {
  if (order_ < 3) return false;
  for (int a = 0; a < dimension_; ++a)
    if (ends_[a].low == FieldBoundary::dirichlet || ends_[a].high == FieldBoundary::dirichlet) return true;
  return false;
}

void Ghosts::row(double const* values, int c, std::size_t j, std::size_t k, double* line, double* to) const {
  std::size_t const mx = mesh_nodes_[0], my = mesh_nodes_[1], last_y = my - 1, last_z = mesh_nodes_[2] - 1;
  Term const& y = c == 1 ? normal_terms_[1][j] : terms_[1][j];
  Term const& z = c == 2 ? normal_terms_[2][k] : terms_[2][k];
  auto const mesh_row = [&](std::size_t at_y, std::size_t at_z) { return values + (at_z * my + at_y) * mx; };
  double const* from = mesh_row(y.node, z.node);
  double const factor = y.factor * z.factor;
  // Only the normal component has a separate value at walls; potential and tangential field are zero there.
  double const low = c == 1 ? y.low * z.factor : c == 2 ? z.low * y.factor : 0;
  double const high = c == 1 ? y.high * z.factor : c == 2 ? z.high * y.factor : 0;
  if (factor != 1 || low != 0 || high != 0) {
    double const* const at_low = c == 1 ? mesh_row(0, z.node) : mesh_row(y.node, 0);
    double const* const at_high = c == 1 ? mesh_row(last_y, z.node) : mesh_row(y.node, last_z);
    for (std::size_t i = 0; i < mx; ++i) line[i] = factor * from[i];
    if (low != 0)
      for (std::size_t i = 0; i < mx; ++i) line[i] += low * at_low[i];
    if (high != 0)
      for (std::size_t i = 0; i < mx; ++i) line[i] += high * at_high[i];
    from = line;
  }
  std::size_t const first = place(0, 0);
  std::copy_n(from, mx, to + first);
  auto const& terms = c == 0 ? normal_terms_[0] : terms_[0];
  for (std::size_t i = 0; i < terms.size(); ++i) {
    if (i == first) i += mx;
    if (i >= terms.size()) break;
    Term const& x = terms[i];
    to[i] = x.factor * from[x.node];
    if (c == 0 && (x.low != 0 || x.high != 0)) to[i] += x.low * from[0] + x.high * from[mx - 1];
  }
}

void Ghosts::fold_planes(std::int64_t* counts) const { fold_planes(counts, terms_); }

void Ghosts::fold_planes(std::int64_t* counts, Terms const& terms) const {
  int const a = dimension_ - 1;
  if (a == 0) return;  // its planes are single nodes within a row
  auto const to = [&](std::size_t node) { return counts + place(a, node) * plane(); };
  for (std::size_t g = 0; g < nodes(a); ++g) {
    if (own(a, g)) continue;
    Term const& term = terms[a][g];
    std::int64_t const* const from = counts + g * plane();
    add(to(term.node), from, plane(), term.factor);
    if (term.low != 0) add(to(0), from, plane(), term.low);
    if (term.high != 0) add(to(mesh_nodes_[a] - 1), from, plane(), term.high);
  }
}

void Ghosts::fold(std::int64_t* counts, double unit, std::vector<double>& density, int threads) const {
  fold_planes(counts);
  fold_in_planes(counts, unit, density, threads, 0, dimension_ == 1 ? 1 : mesh_nodes_[dimension_ - 1]);
}

void Ghosts::fold_mirrored(std::int64_t* counts, double unit, std::vector<double>& density, int threads) const {
  fold_planes(counts, mirrored_);
  fold_in_planes(counts, unit, density, threads, 0, dimension_ == 1 ? 1 : mesh_nodes_[dimension_ - 1], mirrored_);
}

void Ghosts::fold_in_planes(std::int64_t* counts, double unit, std::vector<double>& density, int threads,
                            std::size_t first, std::size_t last) const {
  fold_in_planes(counts, unit, density, threads, first, last, terms_);
}

void Ghosts::fold_in_planes(std::int64_t* counts, double unit, std::vector<double>& density, int threads,
                            std::size_t first, std::size_t last, Terms const& terms) const {
  // Fold one axis after the other, the last first: until x, rows are contiguous in memory.
  std::size_t const nx = nodes(0), ny = nodes(1);
  if (dimension_ == 3)
    for (std::size_t l = first; l < last; ++l) {
      std::int64_t* const at = counts + place(2, l) * plane();
      for (std::size_t g = 0; g < ny; ++g) {
        if (own(1, g)) continue;
        Term const& term = terms[1][g];
        add(at + place(1, term.node) * nx, at + g * nx, nx, term.factor);
        if (term.low != 0) add(at + place(1, 0) * nx, at + g * nx, nx, term.low);
        if (term.high != 0) add(at + place(1, mesh_nodes_[1] - 1) * nx, at + g * nx, nx, term.high);
      }
    }
  auto const per_volume = [&](int a, std::size_t node) { return is_wall(a, node) ? 2.0 : 1.0; };
  std::size_t const mx = mesh_nodes_[0], my = mesh_nodes_[1], of_plane = dimension_ == 3 ? my : 1;
  density.resize(mx * my * mesh_nodes_[2]);
  for_ranges((last - first) * of_plane, std::max<std::size_t>(1, 32768 / mx), threads,
             [&](std::size_t begin, std::size_t end) {
               for (std::size_t row = first * of_plane + begin; row < first * of_plane + end; ++row) {
                 std::size_t const j = row % my, k = row / my;
                 std::int64_t* const from = counts + (place(2, k) * ny + place(1, j)) * nx;
                 for (std::size_t g = 0; g < nx; ++g) {
                   if (own(0, g)) continue;
                   Term const& term = terms[0][g];
                   add(from + place(0, term.node), from + g, 1, term.factor);
                   if (term.low != 0) add(from + place(0, 0), from + g, 1, term.low);
                   if (term.high != 0) add(from + place(0, mx - 1), from + g, 1, term.high);
                 }
                 double const factor = unit * per_volume(1, j) * per_volume(2, k);
                 double* const to = density.data() + row * mx;
                 for (std::size_t i = 0; i < mx; ++i) to[i] = factor * static_cast<double>(from[place(0, i)]);
                 to[0] *= per_volume(0, 0);
                 if (mx > 1) to[mx - 1] *= per_volume(0, mx - 1);
               }
             });
}

}  // namespace boltzmann
