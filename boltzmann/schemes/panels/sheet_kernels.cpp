// Velocities of a sheet's points. Lanes are places; compiled for each instruction set.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/core/pack.hpp>
#include <boltzmann/schemes/panels/panel_kernels.hpp>

#include <cstring>

namespace boltzmann {
namespace panels {

template <int W>
Pack<double, W> loaded(double const* from) {
  Pack<double, W> pack;
  std::memcpy(&pack, from, sizeof pack);
  return pack;
}
template <int W>
void store(Pack<double, W> const& pack, double* to) {
  std::memcpy(to, &pack, sizeof pack);
}

/// Two packs of places share each point, so that their divisions overlap.
template <int W>
void velocities(SheetPoints const& points, double const* x, double const* y, double* u, double* v, std::size_t count) {
  using P = Pack<double, W>;
  for (std::size_t i = 0; i < count; i += 2 * W) {
    P const x0 = loaded<W>(x + i), y0 = loaded<W>(y + i), x1 = loaded<W>(x + i + W), y1 = loaded<W>(y + i + W);
    P u0(0.0), v0(0.0), u1(0.0), v1(0.0);
    for (std::size_t k = 0; k < points.count; ++k) {
      P const px(points.x[k]), py(points.y[k]), strength(points.strength[k]), core2(points.core2);
      P const dx0 = x0 - px, dy0 = y0 - py, dx1 = x1 - px, dy1 = y1 - py;
      P const turn0 = strength / (dx0 * dx0 + dy0 * dy0 + core2), turn1 = strength / (dx1 * dx1 + dy1 * dy1 + core2);
      u0 -= turn0 * dy0, v0 += turn0 * dx0;
      u1 -= turn1 * dy1, v1 += turn1 * dx1;
    }
    store(loaded<W>(u + i) + u0, u + i), store(loaded<W>(v + i) + v0, v + i);
    store(loaded<W>(u + i + W) + u1, u + i + W), store(loaded<W>(v + i + W) + v1, v + i + W);
  }
}

}  // namespace panels

namespace {
constexpr PanelKernels kernels{panels::velocities<native_width<double>>};
}

template <>
PanelKernels const& panel_kernels<this_set>() {
  return kernels;
}

}  // namespace boltzmann
