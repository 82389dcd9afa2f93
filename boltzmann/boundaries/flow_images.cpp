// Finds the images of a flow between walls.
#include <boltzmann/boundaries/flow_images.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {

bool is_vorticity(Field const& field, int dimension) {
  Dimension const of = dimension == 3 ? dimensions::length * dimensions::circulation : dimensions::circulation;
  return field.name == "vorticity" && field.components == (dimension == 3 ? 3 : 1) && field.dimension == of;
}

double vorticity_sign(Box const& box, int component, Turns const& turns) {
  double sign = 1;
  for (int a = 0; a < box.dimension(); ++a)
    if (turns[a] != 0 && box.boundary(a) == Boundary::mirror && (box.dimension() == 2 || a != component)) sign = -sign;
  return sign;
}

std::vector<Turns> flow_images(Box const& box) {
  std::vector<Turns> all{Turns{}};
  for (int a = 0; a < box.dimension(); ++a) {
    if (box.boundary(a) != Boundary::mirror) continue;
    std::size_t const before = all.size();
    for (std::size_t k = 0; k < before; ++k) {
      all.push_back(all[k]);
      all.back()[a] = box.walled(a, Box::End::high) ? 1 : -1;
    }
  }
  all.erase(all.begin());
  return all;
}

void find_flow_images(AnyEnsemble const& ensemble, Box const& box, std::vector<Turns> const& images,
                      std::vector<double>& rows) {
  std::size_t const stride = ensemble.stride(), size = ensemble.size();
  Images const at(box);
  rows.resize(images.size() * size * stride);
  double* row = rows.data();
  for (auto const& turns : images) {
    Field const* vorticity = nullptr;
    for (Field const& field : ensemble.fields())
      if (is_vorticity(field, box.dimension())) vorticity = &field;
    for (std::size_t i = 0; i < size; ++i, row += stride) {
      std::copy_n(ensemble.row(i), stride, row);
      for (int a = 0; a < box.dimension(); ++a) row[a] = at.at(a, turns[a], row[a]);
      for (int c = 0; vorticity && c < vorticity->components; ++c)
        row[vorticity->offset + c] *= vorticity_sign(box, c, turns);
    }
  }
}

void check_walls_of_flow(Box const& box, char const* who) {
  for (int a = 0; a < box.dimension(); ++a) {
    if (box.boundary(a) != Boundary::mirror) continue;
    for (Box::End const end : {Box::End::low, Box::End::high}) {
      if (!box.walled(a, end)) continue;
      Wall const& wall = box.wall(a, end);
      char const* const wrong = !wall.slips                                ? "does not slip"
                                : wall.velocity != std::array<double, 3>{} ? "moves"
                                : !std::isnan(wall.temperature)            ? "has a temperature"
                                                                           : nullptr;
      if (wrong)
        throw Error(fmt::format("{}: the {} wall of axis {} {}; a flow has images beyond walls that slip and rest", who,
                                end == Box::End::low ? "low" : "high", "xyz"[a], wrong));
    }
  }
}

}  // namespace boltzmann
