// A simulation, for Python's half: plain functions of numbers, texts and bytes.
#include "core.hpp"

#include <boltzmann/pictures/figure.hpp>

#include <pybind11/stl.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

namespace boltzmann::python {
namespace {

Overrides overrides_of(std::vector<std::string> const& set, std::optional<std::int64_t> steps,
                       std::optional<std::uint64_t> seed, std::optional<int> threads) {
  Overrides overrides;
  overrides.set = set;
  overrides.steps = steps;
  overrides.seed = seed;
  overrides.threads = threads;
  overrides.no_sweep = true;
  return overrides;
}

py::dict report_of(Core::Report const& report) {
  using py::literals::operator""_a;
  return py::dict("steps"_a = report.steps, "step"_a = report.step, "seconds"_a = report.seconds,
                  "out_of_time"_a = report.out_of_time, "stopped"_a = report.stopped, "condition"_a = report.condition);
}

/// A file that goes away.
class TemporaryFile {
 public:
  TemporaryFile() {
    std::string name = (std::filesystem::temp_directory_path() / "boltzmann-XXXXXX").string();
    int const file = mkstemp(name.data());
    if (file < 0) throw Error("no temporary file can be made in " + std::filesystem::temp_directory_path().string());
    close(file);
    path_ = name;
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TemporaryFile(TemporaryFile const&) = delete;
  TemporaryFile& operator=(TemporaryFile const&) = delete;
  std::string const& path() const { return path_; }

 private:
  std::string path_;
};

py::bytes whole_file(std::string const& path) {
  std::FILE* const file = std::fopen(path.c_str(), "rb");
  if (!file) throw Error("can't read '" + path + "'");
  std::string bytes(std::filesystem::file_size(path), '\0');
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file));
  std::fclose(file);
  return bytes;
}

/// What a checkpoint file would hold.
py::bytes saved_bytes(Core& core) {
  TemporaryFile const file;
  write_checkpoint(file.path(), core.save(), false);
  return whole_file(file.path());
}

void restore_bytes(Core& core, std::string const& bytes) {
  TemporaryFile const file;
  std::FILE* const out = std::fopen(file.path().c_str(), "wb");
  bool const written = out && std::fwrite(bytes.data(), 1, bytes.size(), out) == bytes.size();
  if (out) std::fclose(out);
  if (!written) throw Error("can't write '" + file.path() + "'");
  core.restore(read_checkpoint(file.path()), "the saved state");
}

py::tuple box_of(Core& core) {
  Box const& box = core.scenario().box();
  py::list low, high, boundary;
  for (int a = 0; a < box.dimension(); ++a) {
    low.append(box.low(a));
    high.append(box.high(a));
    boundary.append(std::string(to_string(box.boundary(a))));
  }
  return py::make_tuple(low, high, boundary);
}

py::tuple rows_of(MeasuredRows const& rows) { return py::make_tuple(rows.header, bytes_of(rows.numbers)); }

py::dict gathered_of(std::vector<std::pair<std::string, CsvTable>> const& tables) {
  py::dict all;
  for (auto const& [name, table] : tables) all[py::str(name)] = table_of(table);
  return all;
}

}  // namespace

void bind_simulation(py::module_& module) {  // long: a table, a line for each name in Python
  using py::arg;
  py::class_<Source>(module, "Source")
      .def(py::init([](std::string text, std::string file, std::string name, std::string folder) {
             return Source{std::move(text), std::move(file), std::move(name), std::move(folder)};
           }),
           arg("text"), arg("file"), arg("name"), arg("folder"));
  py::class_<Core>(module, "Core")
      .def(py::init([](Source const& source, std::vector<std::string> const& set, std::optional<std::int64_t> steps,
                       std::optional<std::uint64_t> seed, std::optional<int> threads) {
             return std::make_unique<Core>(source, overrides_of(set, steps, seed, threads));
           }),
           arg("source"), arg("set"), arg("steps"), arg("seed"), arg("threads"))
      .def("owner", &Core::owner)
      .def("attend", &Core::attend)
      .def("forget", &Core::forget)
      .def("run",
           [](Core& core, std::int64_t steps, std::string folder, bool overwrite, double seconds, bool progress) {
             return report_of(core.run(steps, {std::move(folder), overwrite, seconds, progress}));
           })
      .def("record", [](Core& core, std::string folder) { core.record({.folder = std::move(folder)}); })
      .def("refuse_while_running", &Core::refuse_while_running)
      .def("refresh", &Core::refresh)
      .def("stop", &Core::stop)
      .def("running", &Core::running)
      .def("running_elsewhere", &Core::running_elsewhere)
      .def("between_steps", &Core::between_steps)
      .def("step", [](Core& core) { return core.simulation().step(); })
      .def("time", [](Core& core) { return core.simulation().time(); })
      .def("planned", [](Core& core) { return core.scenario().steps; })
      .def("step_size", [](Core& core) { return core.simulation().step_size(); })
      .def("set_step_size",
           [](Core& core, double size) {
             core.refuse_while_running("the step size can't be changed");
             core.simulation().step_size(size);
           })
      .def("seed", [](Core& core) { return core.simulation().seed(); })
      .def("threads", [](Core& core) { return core.simulation().schemes().front()->threads(); })
      .def("set_threads",
           [](Core& core, int threads) {
             core.refuse_while_running("threads can't be changed");
             core.simulation().threads(threads);
           })
      .def("title", [](Core& core) { return core.scenario().title; })
      .def("name", [](Core& core) { return core.scenario().name; })
      .def("description", [](Core& core) { return core.scenario().description; })
      .def("resolved", [](Core& core) { return core.scenario().resolved; })
      .def("box", box_of)
      .def("ensembles",
           [](Core& core) {
             std::vector<std::string> names;
             for (auto const& one : core.scenario().ensembles) names.push_back(one->name());
             return names;
           })
      .def("conserved", &Core::conserved_lines)
      .def("drifts", &Core::drift_lines)
      .def("warnings", &Core::warnings)
      .def("rows", [](Core& core) { return rows_of(core.rows()); })
      .def("watch", &Core::watch)
      .def("unwatch", [](Core& core, std::size_t number) { core.simulation().forget(core.watched(number).attendant); })
      .def("watched", [](Core& core, std::size_t number) { return rows_of(core.watched(number).rows); })
      .def("watched_gathered",
           [](Core& core, std::size_t number) { return gathered_of(core.watched(number).instruments.gathered()); })
      .def("gathered", [](Core& core) { return gathered_of(core.gathered()); })
      .def("measure", [](Core& core, Source const& source) { return rows_of(core.measure(source)); })
      .def("picture",
           [](Core& core, PictureWords const& words) { return std::make_unique<Canvas>(core.picture(words)); })
      .def("save", saved_bytes)
      .def("restore", restore_bytes)
      .def("copy_state", [](Core& core, Core& from) { core.restore(from.save(), "the copy"); })
      .def("resume", &Core::resume)
      .def("folder", &Core::folder)
      .def("digest", &Core::digest)
      .def("moved", &Core::moved);
}

}  // namespace boltzmann::python
