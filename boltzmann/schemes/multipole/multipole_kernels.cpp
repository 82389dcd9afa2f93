// Expansions, W at a time: moments of particles and nodes, their translations, and the field.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/schemes/multipole/multipole_kinds.hpp>
#include <boltzmann/schemes/multipole/plane_series.hpp>
#include <boltzmann/schemes/multipole/solid_harmonics.hpp>
#include <boltzmann/schemes/pair/over_all.hpp>
#include <boltzmann/schemes/vortices/flow_laws.hpp>

#include <bit>
#include <cmath>

namespace boltzmann {
namespace multipole {

/// A particle of unit strength, as a probe of the field.
template <int D, class Real = double>
struct Probe : PointSource<D, Real> {
  Real strength() const { return 1.0; }
};

template <int D, int W>
struct SeriesOf;
template <int W>
struct SeriesOf<2, W> {
  using type = PlaneSeries<W>;
};
template <int W>
struct SeriesOf<3, W> {
  using type = SolidHarmonics<W>;
};

template <int D, int W>
class Kernels {
 public:
  using Real = Pack<double, W>;
  using Series = typename SeriesOf<D, W>::type;
  static constexpr int most = (static_cast<int>(expansion_numbers(D, highest_expansion_order)) + 3) / 4 * 4;

  static void moments(ExpansionView const& tables, NodeParticles const& particles, double* moments) {
    int const numbers = static_cast<int>(expansion_numbers(D, tables.order));
    Real sums[most];
    for (int i = 0; i < numbers; ++i) sums[i] = 0.0;
    for (std::size_t first = 0; first < particles.count; first += W) {
      auto const p = load(particles, first);
      Real const strength =
          select(detail::lanes_from<W>(static_cast<double>(first)) < Real(static_cast<double>(particles.count)),
                 p.amount, Real(0.0));
      Series::add_moments(tables.order, p.position, strength, sums);
    }
    for (int n = 0; n <= tables.order; ++n)
      if constexpr (D == 3)
        for (int m = 0; m <= n; ++m) {
          double const f = tables.unscale[n * (tables.order + 1) + m];
          moments[real_at(n, m)] = f * sum(sums[real_at(n, m)]);
          if (m > 0) moments[imaginary_at(n, m)] = f * sum(sums[imaginary_at(n, m)]);
        }
      else
        for (int i : {2 * n, 2 * n + 1}) moments[i] = sum(sums[i]) * (n > 0 ? -1.0 / n : 1.0);
  }

  static void gather(ExpansionView const& tables, Shifted const* children, std::size_t count, double radius,
                     double* moments) {
    carry<Translation::moments>(tables, children, count, radius, moments);
  }

  static void interact(ExpansionView const& tables, Shifted const* sources, std::size_t count, double radius,
                       double* local) {
    carry<Translation::moments_to_local>(tables, sources, count, radius, local);
  }

  static void hand_down(ExpansionView const& tables, double const* local, double radius, Shifted const* children,
                        double* const* locals, std::size_t count) {
    int const numbers = static_cast<int>(expansion_numbers(D, tables.order));
    Real in[most], out[most];
    for (std::size_t first = 0; first < count; first += W) {
      for (int i = 0; i < numbers; ++i) in[i] = local[i];
      Vector<D, Real> shift;
      Real to;
      lanes(children + first, count - first, shift, to);
      Series::template translate<Translation::local>(tables, shift, radius, to, in, out);
      for (std::size_t lane = 0; lane < W && first + lane < count; ++lane)
        for (int i = 0; i < numbers; ++i) locals[first + lane][i] = out[i][static_cast<int>(lane)];
    }
  }

  static void evaluate(ExpansionView const& tables, NodeParticles const& particles, double const* local,
                       double constant, double* field, double* potential) {
    potential ? evaluate<Inside, true>(tables, particles, local, constant, field, potential)
              : evaluate<Inside, false>(tables, particles, local, constant, field, potential);
  }

  static void evaluate_moments(ExpansionView const& tables, NodeParticles const& particles, double const* moments,
                               double constant, double* field, double* potential) {
    potential ? evaluate<Outside, true>(tables, particles, moments, constant, field, potential)
              : evaluate<Outside, false>(tables, particles, moments, constant, field, potential);
  }

  static void expand(ExpansionView const& tables, NodeParticles const& particles, double* local) {
    int const numbers = static_cast<int>(expansion_numbers(D, tables.order));
    Real sums[most];
    for (int i = 0; i < numbers; ++i) sums[i] = 0.0;
    for (std::size_t first = 0; first < particles.count; first += W) {
      auto const p = load(particles, first);
      Series::add_local(tables.order, p.position, strength_of(p, particles, first), sums);
    }
    if constexpr (D == 3) {
      double const scale = 1 / particles.radius;
      for (int n = 0; n <= tables.order; ++n)
        for (int m = 0; m <= n; ++m) {
          double const f = scale * tables.scale[n * (tables.order + 1) + m];
          local[real_at(n, m)] += f * sum(sums[real_at(n, m)]);
          if (m > 0) local[imaginary_at(n, m)] += f * sum(sums[imaginary_at(n, m)]);
        }
    } else {
      double strength = 0;  // positions are in units of the radius, so its logarithm is missing
      for (std::size_t i = 0; i < particles.count; ++i)
        strength += detail::particle_at<PointSource<D>>(particles.rows + i * row_stride<PointSource<D>>).amount;
      local[0] += sum(sums[0]) + strength * std::log(particles.radius);
      for (int l = 1; l <= tables.order; ++l)
        for (int i : {2 * l, 2 * l + 1}) local[i] -= sum(sums[i]) / l;
    }
  }

 private:
  using Point = rebind_t<PointSource<D>, Real>;

  /// W particles, with positions relative to the centre in units of the radius.
  static Point load(NodeParticles const& particles, std::size_t first) {
    auto p = detail::load_neighbouring_rows<PointSource<D>, W>(particles.rows, row_stride<PointSource<D>>, first,
                                                               particles.count);
    for (int a = 0; a < D; ++a) p.position[a] = (p.position[a] - particles.centre[a]) * Real(1 / particles.radius);
    return p;
  }

  static Real strength_of(Point const& p, NodeParticles const& particles, std::size_t first) {
    return select(detail::lanes_from<W>(static_cast<double>(first)) < Real(static_cast<double>(particles.count)),
                  p.amount, Real(0.0));
  }

  /// Shifts and radii of up to W expansions; missing lanes repeat the first.
  static void lanes(Shifted const* all, std::size_t count, Vector<D, Real>& shift, Real& radius) {
    double columns[D + 1][W];
    for (int lane = 0; lane < W; ++lane) {
      Shifted const& one = all[static_cast<std::size_t>(lane) < count ? lane : 0];
      for (int a = 0; a < D; ++a) columns[a][lane] = one.shift[a];
      columns[D][lane] = one.radius;
    }
    for (int a = 0; a < D; ++a) shift[a] = std::bit_cast<Real>(columns[a]);
    radius = std::bit_cast<Real>(columns[D]);
  }

  /// Adds the translations of W expansions at a time.
  template <Translation kind>
  static void carry(ExpansionView const& tables, Shifted const* all, std::size_t count, double to_radius, double* out) {
    int const numbers = static_cast<int>(expansion_numbers(D, tables.order));
    Real in[most], carried[most], total[most];
    for (int i = 0; i < numbers; ++i) total[i] = 0.0;
    for (std::size_t first = 0; first < count; first += W) {
      std::size_t const left = count - first;
      Vector<D, Real> shift;
      Real from;
      lanes(all + first, left, shift, from);
      auto const row = [&](int lane) {
        return all[first + (static_cast<std::size_t>(lane) < left ? lane : 0)].numbers;
      };
      for (int i = 0; i < numbers; i += row_block)
        detail::transpose_block<W>(row, static_cast<std::size_t>(i), in + i, row_block);
      if (left < W) {
        auto const there = detail::lanes_from<W>(0) < Real(static_cast<double>(left));
        for (int i = 0; i < numbers; ++i) in[i] = select(there, in[i], Real(0.0));
      }
      Series::template translate<kind>(tables, shift, from, to_radius, in, carried);
      for (int i = 0; i < numbers; ++i) total[i] += carried[i];
    }
    for (int i = 0; i < numbers; ++i) out[i] += sum(total[i]);
  }

  // The field to evaluate: a local expansion inside its node, or moments outside.
  struct Inside {
    static constexpr int further = -1;  // order of the slopes relative to the expansion
    static void each(int order, Vector<D, Real> const& x, auto const& use) { Series::each(order, x, 1.0, use); }
  };
  struct Outside {
    static constexpr int further = 1;
    static void each(int order, Vector<D, Real> const& x, auto const& use) { Series::each_outside(order, x, 1.0, use); }
  };
  static constexpr int most_slopes = (highest_expansion_order + 2) * (highest_expansion_order + 2);

  template <class Where, bool with_potential>
  static void evaluate(ExpansionView const& tables, NodeParticles const& particles, double const* numbers,
                       double constant, double* field, double* potential) {
    [[maybe_unused]] double slopes[D][most_slopes];
    [[maybe_unused]] double values[most_slopes];
    if constexpr (D == 3) {
      slopes_of<Where::further>(tables, numbers, slopes);
      if (with_potential) values_of<Where::further>(tables, numbers, values);
    }
    double const inverse = 1 / particles.radius;
    double const of_potential = Where::further > 0 && D == 3 ? inverse : 1;
    for (std::size_t first = 0; first < particles.count; first += W) {
      auto const x = load(particles, first).position;
      Real sum[D], value = 0.0;
      for (auto& s : sum) s = 0.0;
      if constexpr (D == 3) {
        Where::each(tables.order + (Where::further > 0 ? 1 : 0), x, [&](int n, int m, Real re, Real im) {
          int const at = real_at(n, m), other = imaginary_at(n, m);
          if (Where::further < 0 ? n < tables.order : n > 0)
            for (int a = 0; a < D; ++a) {
              sum[a] += re * Real(slopes[a][at]);
              if (m > 0) sum[a] += im * Real(slopes[a][other]);
            }
          if (with_potential && n <= tables.order) {
            value += re * Real(values[at]);
            if (m > 0) value += im * Real(values[other]);
          }
        });
      } else {
        auto const series = Where::further < 0 ? Series::local(tables.order, x, numbers, with_potential)
                                               : Series::moments(tables.order, x, numbers, with_potential);
        sum[0] = -series.slope.re;  // E_x - i E_y is the derivative, and the potential minus the real part
        sum[1] = series.slope.im;
        value = -series.value;
        if (with_potential && Where::further > 0) value -= Real(numbers[0] * std::log(particles.radius));
      }
      for (std::size_t lane = 0; lane < W && first + lane < particles.count; ++lane) {
        int const i = static_cast<int>(lane);
        for (int a = 0; a < D; ++a) field[(first + lane) * D + a] -= constant * inverse * of_potential * sum[a][i];
        if (with_potential) potential[first + lane] += constant * of_potential * value[i];
      }
    }
  }

  /// The coefficient (n, m) without the stored factor, also for negative m: F_n^-m = (-1)^m conj F_n^m.
  static Complex<double> coefficient(ExpansionView const& tables, double const* numbers, double const* factors, int n,
                                     int m) {
    if (n < 0 || n > tables.order || m > n || -m > n) return {0, 0};
    int const k = m < 0 ? -m : m;
    double const f = factors[n * (tables.order + 1) + k] * (m < 0 && k % 2 != 0 ? -1 : 1);
    double const im = k > 0 ? numbers[imaginary_at(n, k)] : 0;
    return {f * numbers[real_at(n, k)], (m < 0 ? -f : f) * im};
  }

  template <int further>
  static void values_of(ExpansionView const& tables, double const* numbers, double* values) {
    double const* const factors = further < 0 ? tables.unscale : tables.scale;
    for (int n = 0; n <= tables.order; ++n)
      for (int m = 0; m <= n; ++m) {
        auto const c = coefficient(tables, numbers, factors, n, m);
        values[real_at(n, m)] = (m > 0 ? 2 : 1) * c.re;
        if (m > 0) values[imaginary_at(n, m)] = 2 * c.im;
      }
  }

  /// Coefficients of the derivatives of sum conj(Y_n^m) F_n^m, from d/dz Y_n^m = Y_(n-1)^m and
  /// (d/dx -+ i d/dy) Y_n^m = -+ Y_(n-1)^(m-+1):
  ///   d/dx: (F_(n+1)^(m-1) - F_(n+1)^(m+1)) / 2,  d/dy: i (F_(n+1)^(m-1) + F_(n+1)^(m+1)) / 2,  d/dz: F_(n+1)^m
  /// and of sum conj(M_n^m) T_n^m, from d/dz T_n^m = -T_(n+1)^m: the same with n - 1 and, along z, the other sign.
  template <int further>
  static void slopes_of(ExpansionView const& tables, double const* numbers, double (&slopes)[D][most_slopes]) {
    double const* const factors = further < 0 ? tables.unscale : tables.scale;
    for (int n = further < 0 ? 0 : 1; n <= tables.order + further; ++n)
      for (int m = 0; m <= n; ++m) {
        int const from = n - further;
        auto const below = coefficient(tables, numbers, factors, from, m - 1),
                   above = coefficient(tables, numbers, factors, from, m + 1),
                   same = coefficient(tables, numbers, factors, from, m);
        double const f = m > 0 ? 1 : 0.5, along = further < 0 ? 2 * f : -2 * f;
        slopes[0][real_at(n, m)] = f * (below.re - above.re);
        slopes[1][real_at(n, m)] = -f * (below.im + above.im);
        slopes[2][real_at(n, m)] = along * same.re;
        if (m == 0) continue;
        slopes[0][imaginary_at(n, m)] = f * (below.im - above.im);
        slopes[1][imaginary_at(n, m)] = f * (below.re + above.re);
        slopes[2][imaginary_at(n, m)] = along * same.im;
      }
  }
};

template <int D, int W, class Core>
constexpr PairKernel slopes() {
  if constexpr (D == 3)
    return detail::over_all<detail::Pass::influence, W, Inviscid<3>, Inviscid<3>, SlopesOf<Core>>;
  else
    return nullptr;
}

template <int D, int W = native_width<double>>
constexpr MultipoleKernels kernels() {
  using K = Kernels<D, W>;
  return {K::moments,
          K::gather,
          K::interact,
          K::hand_down,
          K::evaluate,
          K::evaluate_moments,
          K::expand,
          detail::over_all<detail::Pass::influence, W, Probe<D>, PointSource<D>, LaplaceLaw>,
          detail::over_all<detail::Pass::with_energy, W, Probe<D>, PointSource<D>, LaplaceLaw>,
          {detail::over_all<detail::Pass::influence, W, Inviscid<D>, Inviscid<D>, BiotSavart>,
           detail::over_all<detail::Pass::influence, W, Inviscid<D>, Inviscid<D>, AlgebraicBiotSavart>,
           detail::over_all<detail::Pass::influence, W, Inviscid<D>, Inviscid<D>, GaussianBiotSavart>},
          {slopes<D, W, PlainCore>(), slopes<D, W, AlgebraicCore>(), slopes<D, W, GaussianCore>()}};
}

}  // namespace multipole

namespace {
constexpr MultipoleKernelTable table{{multipole::kernels<2>(), multipole::kernels<3>()}};
}

template <>
MultipoleKernelTable const& multipole_kernels<this_set>() {
  return table;
}

}  // namespace boltzmann
