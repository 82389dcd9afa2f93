// Python's exact solutions: boltzmann._core.exact_, arrays of numbers in and columns of doubles out. What users call is
// boltzmann/exact.py.
#include <boltzmann/core/error.hpp>
#include <boltzmann/exact/kepler.hpp>
#include <boltzmann/exact/lamb_oseen.hpp>
#include <boltzmann/exact/plasma.hpp>
#include <boltzmann/exact/riemann.hpp>
#include <boltzmann/exact/sedov.hpp>
#include <boltzmann/exact/taylor_green.hpp>

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann::python {
namespace {

namespace py = pybind11;

/// The numbers of an array of doubles with one axis, whatever its stride. Error: any other.
std::vector<double> numbers(char const* name, py::buffer const& array) {
  py::buffer_info const info = array.request();
  if (info.ndim != 1 || info.format != py::format_descriptor<double>::format())
    throw Error(
        fmt::format("exact solutions: {} must be an array of 64-bit floats with one axis; it has {} and the "
                    "format '{}'",
                    name, info.ndim, info.format));
  std::vector<double> result(static_cast<std::size_t>(info.shape[0]));
  auto const* from = static_cast<char const*>(info.ptr);
  for (double& number : result) {
    std::memcpy(&number, from, sizeof(double));
    from += info.strides[0];
  }
  return result;
}

/// Exactly so many numbers.
std::vector<double> numbers(char const* name, py::buffer const& array, std::size_t count) {
  auto result = numbers(name, array);
  if (result.size() != count)
    throw Error(fmt::format("exact solutions: {} must be {} numbers, not {}", name, count, result.size()));
  return result;
}

Vector<3> vector_of(char const* name, py::buffer const& array) {
  auto const all = numbers(name, array, 3);
  return {all[0], all[1], all[2]};
}

exact::GasState gas_state(char const* name, py::buffer const& array) {
  auto const all = numbers(name, array, 3);
  return {all[0], all[1], all[2]};
}

/// Columns of one name each, as bytes of doubles, filled row by row.
class Columns {
 public:
  explicit Columns(std::vector<char const*> names) : names_(std::move(names)), columns_(names_.size()) {}
  template <class... Numbers>
  void row(Numbers... values) {
    std::size_t k = 0;
    (columns_[k++].push_back(values), ...);
  }
  py::dict bytes() const {
    py::dict result;
    for (std::size_t k = 0; k < names_.size(); ++k)
      result[names_[k]] =
          py::bytes(reinterpret_cast<char const*>(columns_[k].data()), columns_[k].size() * sizeof(double));
    return result;
  }

 private:
  std::vector<char const*> names_;
  std::vector<std::vector<double>> columns_;
};

/// f(a[i], b[i]) for two arrays of one length.
template <class Function>
void for_pairs(char const* first, py::buffer const& a, char const* second, py::buffer const& b, Function f) {
  auto const x = numbers(first, a), y = numbers(second, b, x.size());
  for (std::size_t i = 0; i < x.size(); ++i) f(x[i], y[i]);
}

void bind_gases(py::module_& module) {
  module.def("riemann", [](py::buffer const& x, py::buffer const& t, py::buffer const& left, py::buffer const& right,
                           double gamma) {
    exact::Riemann const tube(gas_state("left", left), gas_state("right", right), gamma);
    Columns columns({"density", "velocity", "pressure"});
    for_pairs("x", x, "t", t, [&](double place, double time) {
      auto const s = tube.at(place, time);
      columns.row(s.density, s.velocity, s.pressure);
    });
    return columns.bytes();
  });
  module.def("riemann_star", [](py::buffer const& left, py::buffer const& right, double gamma) {
    exact::Riemann const tube(gas_state("left", left), gas_state("right", right), gamma);
    return py::make_tuple(tube.star_pressure(), tube.star_velocity(), tube.left_density(), tube.right_density(),
                          tube.shock_speed());
  });
  module.def("sedov",
             [](py::buffer const& r, py::buffer const& t, double energy, double density, double gamma, int dimension) {
               exact::SedovBlast const blast(dimension, gamma);
               Columns columns({"density", "velocity", "pressure"});
               for_pairs("r", r, "t", t, [&](double distance, double time) {
                 auto const s = blast.state(distance, time, energy, density);
                 columns.row(s.density, s.velocity, s.pressure);
               });
               return columns.bytes();
             });
  module.def("sedov_radius", [](py::buffer const& t, double energy, double density, double gamma, int dimension) {
    exact::SedovBlast const blast(dimension, gamma);
    Columns columns({"radius", "speed"});
    for (double const time : numbers("t", t))
      columns.row(blast.radius(energy, density, time), blast.shock_speed(energy, density, time));
    return columns.bytes();
  });
}

void bind_plasmas(py::module_& module) {
  module.def("langmuir", [](py::buffer const& k, double plasma_frequency, double thermal_velocity) {
    Columns columns({"frequency", "growth"});
    for (double const wave_number : numbers("k", k)) {
      auto const wave = exact::langmuir(plasma_frequency, thermal_velocity, wave_number);
      columns.row(wave.frequency, wave.growth);
    }
    return columns.bytes();
  });
  module.def("bohm_gross", [](py::buffer const& k, double plasma_frequency, double thermal_velocity) {
    Columns columns({"frequency"});
    for (double const wave_number : numbers("k", k))
      columns.row(exact::bohm_gross(plasma_frequency, thermal_velocity, wave_number));
    return columns.bytes();
  });
  module.def("two_streams", [](py::buffer const& k, double plasma_frequency, double drift, double thermal_velocity) {
    Columns columns({"growth"});
    for (double const wave_number : numbers("k", k))
      columns.row(exact::two_stream_growth(plasma_frequency, drift, thermal_velocity, wave_number));
    return columns.bytes();
  });
  module.def("plasma_frequency", &exact::plasma_frequency);
}

void bind_orbits(py::module_& module) {
  module.def("kepler", [](py::buffer const& t, py::buffer const& position, py::buffer const& velocity, double mu) {
    exact::OrbitState const start{vector_of("position", position), vector_of("velocity", velocity)};
    Columns columns({"position", "velocity"});  // three numbers a time
    for (double const time : numbers("t", t)) {
      auto const now = exact::kepler(start, mu, time);
      for (std::size_t a = 0; a < 3; ++a) columns.row(now.position[a], now.velocity[a]);
    }
    return columns.bytes();
  });
  module.def("orbit_elements", [](py::buffer const& position, py::buffer const& velocity, double mu) {
    auto const e = exact::orbit_elements({vector_of("position", position), vector_of("velocity", velocity)}, mu);
    return py::make_tuple(e.semi_major_axis, e.eccentricity, e.inclination, e.node, e.pericentre, e.mean_anomaly);
  });
  module.def("orbit_state", [](double semi_major_axis, double eccentricity, double inclination, double node,
                               double pericentre, double mean_anomaly, double mu) {
    auto const state =
        exact::orbit_state({semi_major_axis, eccentricity, inclination, node, pericentre, mean_anomaly}, mu);
    Columns columns({"position", "velocity"});
    for (std::size_t a = 0; a < 3; ++a) columns.row(state.position[a], state.velocity[a]);
    return columns.bytes();
  });
  module.def("orbit_period", &exact::orbit_period);
}

void bind_vortices(py::module_& module) {
  module.def("lamb_oseen", [](py::buffer const& r, py::buffer const& t, double circulation, double viscosity) {
    Columns columns({"velocity", "vorticity"});
    for_pairs("r", r, "t", t, [&](double distance, double time) {
      auto const s = exact::lamb_oseen(distance, time, circulation, viscosity);
      columns.row(s.velocity, s.vorticity);
    });
    return columns.bytes();
  });
  module.def("taylor_green", [](py::buffer const& x, py::buffer const& y, double time, double speed, double edge,
                                double viscosity, double density) {
    Columns columns({"velocity_x", "velocity_y", "vorticity", "pressure"});
    for_pairs("x", x, "y", y, [&](double east, double north) {
      auto const s = exact::taylor_green({east, north}, time, speed, edge, viscosity, density);
      columns.row(s.velocity[0], s.velocity[1], s.vorticity, s.pressure);
    });
    return columns.bytes();
  });
}

}  // namespace

/// Adds the submodule `exact_`. Arrays are one-dimensional buffers of doubles, results a dict of bytes of doubles.
void bind_exact(pybind11::module_& module) {
  py::module_ solutions = module.def_submodule("exact_", "Exact solutions: see boltzmann.exact.");
  bind_gases(solutions);
  bind_plasmas(solutions);
  bind_orbits(solutions);
  bind_vortices(solutions);
}

}  // namespace boltzmann::python
