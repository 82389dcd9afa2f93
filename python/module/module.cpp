// boltzmann._core: what Python's half of the package stands on. Errors become exceptions of their kinds; nothing ends
// the interpreter.
#include "core.hpp"

#include <boltzmann/recording/interrupt.hpp>
#include <boltzmann/recording/version.hpp>
#include <boltzmann/scenario/catalogue_pages.hpp>
#include <boltzmann/scenario/schema.hpp>
#include <boltzmann/scenario/tables.hpp>

#include <pybind11/stl.h>

namespace boltzmann::python {
namespace {

/// The exceptions of Python's half: their names there.
struct Exceptions {
  py::object error, scenario, physics, recording;
};
Exceptions* exceptions = nullptr;

void raise(py::object const& kind, char const* what) { PyErr_SetString(kind.ptr(), what); }

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (ScenarioErrors const& errors) {
    PyErr_SetObject(exceptions->scenario.ptr(), py::cast(errors.lines).ptr());
  } catch (Error const& error) {
    raise(exceptions->error, error.what());
  } catch (PhysicsFailure const& failure) {
    raise(exceptions->physics, failure.what());
  } catch (RecordingFailure const& failure) {
    raise(exceptions->recording, failure.what());
  }
}

}  // namespace

void bind_catalogue(py::module_& module) {
  module.def("listed", [](std::string const& kind) {
    std::vector<std::pair<std::string, std::string>> all;
    for (auto const& one : listed(kind)) all.emplace_back(one.name, one.doc);
    return all;
  });
  module.def("page", catalogue_page);
  module.def("schema", scenario_schema);
  module.def("shipped", shipped_scenarios);
  module.def("find_scenario", find_scenario);
  module.def("choices",
             [](std::string const& word, std::vector<std::string> const& words) { return choices(word, words); });
  module.def("keys", [](std::string const& table) {
    for (auto const& one : scenario_tables())
      if (one.name == table) return one.options->keys();
    throw Error("there is no table '" + table + "'");
  });
  module.def("tables", [] {
    std::vector<std::tuple<std::string, std::string, std::string>> all;
    for (auto const& table : scenario_tables()) all.emplace_back(table.name, table.heading, table.doc);
    return all;
  });
}

}  // namespace boltzmann::python

PYBIND11_MODULE(_core, module) {
  using namespace boltzmann::python;
  boltzmann::Interrupt::leave_signals_alone();
  share_hdf5();
  module.attr("version") = boltzmann::program_version;
  // The classes of exceptions are Python's own, so that they can say more; they are told once.
  module.def("exceptions", [](py::object error, py::object scenario, py::object physics, py::object recording) {
    delete exceptions;
    exceptions = new Exceptions{std::move(error), std::move(scenario), std::move(physics), std::move(recording)};
  });
  py::register_exception_translator(&translate);
  bind_simulation(module);
  bind_ensembles(module);
  bind_results(module);
  bind_catalogue(module);
  bind_exact(module);
  bind_window(module);
}
