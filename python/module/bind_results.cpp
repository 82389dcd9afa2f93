// Pictures, stored runs and sweeps.
#include "core.hpp"

#include <boltzmann/files/csv.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/pictures/draw_arrays.hpp>
#include <boltzmann/pictures/error_bars.hpp>
#include <boltzmann/pictures/figure.hpp>
#include <boltzmann/scenario/stored_pictures.hpp>
#include <boltzmann/scenario/stored_run.hpp>
#include <boltzmann/sweep/run_sweep.hpp>

#include <pybind11/stl.h>

#include <filesystem>

namespace boltzmann::python {
namespace {

/// A run in a folder.
class Stored {
 public:
  explicit Stored(std::string folder) : folder_(std::move(folder)), scenario_(load_stored_run(folder_)) {}

  ScenarioSimulation& scenario() { return *scenario_; }
  std::string const& folder() const { return folder_; }
  TrajectoryReader& trajectory() {
    look_for_h5py();
    if (!reader_) {
      std::string const path = folder_ + "/trajectory.h5";
      if (!std::filesystem::exists(path))
        throw Error("'" + folder_ +
                    "' has no trajectory.h5: the run stored none (trajectory = 10 in [output])");
      reader_.emplace(path);
    }
    return *reader_;
  }
  Canvas picture(std::int64_t frame, PictureWords const& words) {
    StoredPictures pictures(*scenario_, folder_, words);
    return pictures.canvas(pictures.frame(frame));
  }
  void write_all(std::string const& out, PictureWords const& words, FigureOptions const& paper) {
    StoredPictures(*scenario_, folder_, words).write_all(out, paper);
  }

 private:
  std::string folder_;
  std::unique_ptr<ScenarioSimulation> scenario_;
  std::optional<TrajectoryReader> reader_;
};

py::list stored_ensembles(Stored& stored) {
  py::list all;
  for (auto const& ensemble : stored.trajectory().ensembles()) {
    py::list fields;
    for (auto const& field : ensemble.fields)
      fields.append(py::make_tuple(field.name, field.components, field.constant, field.unit));
    all.append(py::make_tuple(ensemble.name, ensemble.class_name, ensemble.dimension, fields));
  }
  return all;
}

FigureOptions figure(int width, int height, double scale, bool dark) {
  FigureOptions options;
  options.width = width;
  options.height = height;
  options.scale = scale;
  options.dark = dark;
  return options;
}

std::vector<double> doubles_of(py::buffer const& buffer) {
  py::buffer_info const info = buffer.request();
  auto const* first = static_cast<double const*>(info.ptr);
  return {first, first + info.size * info.itemsize / static_cast<py::ssize_t>(sizeof(double))};
}

/// Curves over one axis, each (label, x, y).
std::unique_ptr<Canvas> curves(std::vector<std::tuple<std::string, py::buffer, py::buffer>> const& all,
                               std::pair<std::string, std::string> const& x,
                               std::pair<std::string, std::string> const& y, bool logarithmic,
                               std::string const& title) {
  std::vector<std::vector<double>> numbers;
  for (auto const& [label, xs, ys] : all) numbers.push_back(doubles_of(xs)), numbers.push_back(doubles_of(ys));
  std::vector<Series> series;
  for (std::size_t k = 0; k < all.size(); ++k)
    series.push_back({std::get<0>(all[k]), numbers[2 * k], numbers[2 * k + 1]});
  Axis horizontal{x.first, x.second}, vertical{y.first, y.second};
  vertical.logarithmic = logarithmic;
  return std::make_unique<Canvas>(draw_time_series(series, horizontal, vertical, title));
}

py::tuple sweep(Source const& source, std::vector<std::string> const& set, std::vector<std::string> const& vary,
                std::optional<std::int64_t> seeds, std::optional<int> threads, std::string const& folder, bool force,
                bool quiet, bool lasting) {
  SweepOptions options;
  options.text = {source.text, source.file, source.name, source.folder};
  options.overrides.set = set;
  options.overrides.vary = vary;
  options.overrides.seeds = seeds;
  options.overrides.threads = threads;
  options.folder = folder;
  options.quiet = quiet;
  options.force = force;
  options.lasting = lasting;
  options.attend = [](Simulation& simulation) { Core::watch_signals(simulation); };
  SweepReport report;
  Core::Sweeping const sweeping;
  {
    py::gil_scoped_release const others;
    auto scenario = load_scenario(options.text, options.overrides);
    if (!scenario->sweep) throw Error("there is nothing to vary: say vary = {\"run.seed\": [1, 2]}, or seeds = 4");
    report = run_sweep(options, WallTime(std::nullopt), std::move(scenario));
  }
  if (PyErr_Occurred()) throw py::error_already_set();
  return py::make_tuple(report.failed, report.interrupted);
}

}  // namespace

void bind_results(py::module_& module) {
  py::class_<Canvas>(module, "Canvas")
      .def("bytes",
           [](Canvas const& canvas, std::string const& format, int width, int height, double scale, bool dark) {
             return py::bytes(picture_bytes(canvas, format, figure(width, height, scale, dark)));
           })
      .def("write", [](Canvas const& canvas, std::string const& path, int width, int height, double scale, bool dark) {
        write_picture(canvas, path, figure(width, height, scale, dark));
      });
  module.def("curves", curves);
  module.def("read_csv", [](std::string const& path) {
    auto const table = read_csv(path);
    py::list columns;
    for (auto const& column : table.columns) columns.append(bytes_of(column));
    return py::make_tuple(table.header, columns);
  });
  py::class_<Stored>(module, "Stored")
      .def(py::init<std::string>())
      .def("title", [](Stored& stored) { return stored.scenario().title; })
      .def("steps", [](Stored& stored) { return stored.trajectory().steps(); })
      .def("times", [](Stored& stored) { return stored.trajectory().times(); })
      .def("ensembles", stored_ensembles)
      .def("size", [](Stored& stored, std::size_t frame,
                      std::string const& ensemble) { return stored.trajectory().size(frame, ensemble); })
      .def("read", [](Stored& stored, std::size_t frame, std::string const& ensemble,
                      std::string const& field) { return bytes_of(stored.trajectory().read(frame, ensemble, field)); })
      .def("picture", [](Stored& stored, std::int64_t frame,
                         PictureWords const& words) { return std::make_unique<Canvas>(stored.picture(frame, words)); })
      .def("write_all", [](Stored& stored, std::string const& out, PictureWords const& words, double scale, bool dark) {
        stored.write_all(out, words, figure(1200, 900, scale, dark));
      });
  module.def("sweep", sweep);
  module.def("end_sweeps", &Core::end_sweeps);
}

}  // namespace boltzmann::python
