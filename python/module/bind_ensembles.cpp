// Rows of ensembles as memory that numpy looks at, and units.
#include "core.hpp"

#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/particles/stored_ensemble.hpp>
#include <boltzmann/scenario/loader.hpp>

#include <pybind11/stl.h>

#include <cstring>

namespace boltzmann::python {
namespace {

Memory rows_memory(Core& core, std::string const& name, bool readonly) {
  AnyEnsemble& ensemble = core.ensemble(name);
  return {ensemble.hold_rows(), ensemble.row(0), ensemble.size() * ensemble.stride() * sizeof(double), readonly};
}

Memory influences_memory(Core& core, std::string const& name) {
  AnyEnsemble& ensemble = core.ensemble(name);
  return {ensemble.hold_influences(), ensemble.influences().data(),
          ensemble.size() * ensemble.influence_size() * sizeof(double), true};
}

/// What Python keeps of an ensemble, so that a view costs one call.
class Particles {
 public:
  Particles(Core& core, std::string const& name) : core_(core), ensemble_(core.ensemble(name)) {}
  /// The rows and how many there are; None while another thread runs the simulation.
  py::object look(bool readonly) {
    if (core_.running_elsewhere()) return py::none();
    return py::make_tuple(Memory{ensemble_.hold_rows(), ensemble_.row(0),
                                 ensemble_.size() * ensemble_.stride() * sizeof(double), readonly},
                          ensemble_.size());
  }

 private:
  Core& core_;
  AnyEnsemble& ensemble_;
};

py::buffer_info buffer_of(Memory const& memory) {
  return {memory.first,
          1,
          py::format_descriptor<std::uint8_t>::format(),
          1,
          {static_cast<py::ssize_t>(memory.bytes)},
          {1},
          memory.readonly};
}

/// name, offset, components, whether it is a vector, doc, dimension in words, unit as it is shown.
py::list fields_of(Core& core, std::string const& name) {
  AnyEnsemble const& ensemble = core.ensemble(name);
  py::list all;
  for (auto const& field : ensemble.fields())
    all.append(py::make_tuple(field.name, field.offset, field.components, ensemble.is_vector(field), field.doc,
                              name_of(field.dimension), core.scenario().units.unit_name(field.dimension)));
  return all;
}

/// The names of fields that are found from others.
std::vector<std::string> derived_fields(Core& core, std::string const& name) {
  AnyEnsemble const& ensemble = core.ensemble(name);
  std::vector<std::string> names;
  for (auto const& field : ensemble.fields())
    if (core.simulation().derives(ensemble, field)) names.push_back(field.name);
  return names;
}

void resize(Core& core, std::string const& name, std::size_t size, bool within_change) {
  if (!within_change) core.refuse_while_running("particles can't be added or taken away");
  AnyEnsemble& ensemble = core.ensemble(name);
  if (auto const why = too_many(static_cast<double>(size), ensemble.stride() * sizeof(double)); !why.empty())
    throw Error("resize: " + why);
  ensemble.resize(size);
}

/// A number of the field's dimension, from "20 km/s".
double number_of(Core& core, std::string const& ensemble, std::string const& field, std::string const& text) {
  AnyEnsemble const& particles = core.ensemble(ensemble);
  return in_units(text, particles.field(field).dimension, core.scenario().units);
}

/// Of 1 in that unit, in the base.
double base_of_unit(Core& core, std::string const& unit) {
  auto const quantity = parse_quantity("1 " + unit);
  if (core.scenario().units.is_reduced())
    throw Error("the simulation counts in pure numbers, which have no unit '" + unit + "'");
  return core.scenario().units.from_si(quantity.si, quantity.dimension);
}

/// A file that load = { kind = "frame" } reads: arrays of fields, each (name, components, bytes of doubles).
void write_frame(std::string const& path, std::string const& name, int dimension, std::size_t count,
                 std::vector<std::tuple<std::string, int, py::buffer>> const& arrays) {
  std::vector<Field> fields;
  int doubles = 0;
  for (auto const& [field, components, numbers] : arrays) {
    fields.push_back({field, doubles, components, dimensions::none, ""});
    doubles += components;
  }
  StoredEnsemble particles(name, "array", dimension, static_cast<std::size_t>(doubles), fields);
  particles.resize(count);
  for (std::size_t f = 0; auto const& [field, components, numbers] : arrays) {
    py::buffer_info const info = numbers.request();
    auto const* from = static_cast<double const*>(info.ptr);
    auto const each = static_cast<std::size_t>(components);
    if (info.size * info.itemsize != static_cast<py::ssize_t>(count * each * sizeof(double)))
      throw Error("an array of another length than its particles");
    for (std::size_t i = 0; i < count; ++i)
      std::memcpy(particles.row(i) + fields[f].offset, from + i * each, each * sizeof(double));
    ++f;
  }
  BoxEdges box;
  box.dimension = dimension;
  for (int a = 0; a < dimension; ++a) box.low[a] = 0, box.high[a] = 1;
  Trajectory file(path);
  AnyEnsemble const* const one = &particles;
  file.write(0, 0, std::span(&one, 1), box);
  file.close();
}

/// What a mesh has on its nodes now: name, components (each an array, x fastest), nodes, low ends, spacings, unit.
py::list mesh_fields(Core& core) {
  core.refresh();
  auto const fields = mesh_fields_of(core.simulation().schemes());
  if (fields.empty()) throw Error("there is no mesh in this simulation");
  py::list all;
  for (auto const* field : fields) {
    py::list components;
    for (auto const& one : field->components) components.append(bytes_of(one));
    all.append(py::make_tuple(field->name, components, field->grid.dimension, field->grid.nodes, field->grid.low,
                              field->grid.spacing, core.scenario().units.unit_name(field->dimension)));
  }
  return all;
}

}  // namespace

void bind_ensembles(py::module_& module) {
  py::class_<Memory>(module, "Memory", py::buffer_protocol()).def_buffer(&buffer_of);
  py::class_<Particles>(module, "Particles")
      .def(py::init<Core&, std::string const&>(), py::keep_alive<1, 2>())
      .def("look", &Particles::look);
  module.def("rows", rows_memory);
  module.def("influences", influences_memory);
  module.def("layout", [](Core& core, std::string const& name) {
    AnyEnsemble const& ensemble = core.ensemble(name);
    return py::make_tuple(ensemble.dimension(), ensemble.stride(), ensemble.influence_size(), ensemble.class_name());
  });
  module.def("size", [](Core& core, std::string const& name) { return core.ensemble(name).size(); });
  module.def("fields", fields_of);
  module.def("derived_fields", derived_fields);
  module.def("resize", resize);
  module.def("number_of", number_of);
  module.def("base_of_unit", base_of_unit);
  module.def("quantity", [](Core& core, std::string const& text) {
    auto const quantity = parse_quantity(text);
    return core.scenario().units.is_reduced() && quantity.has_unit
               ? throw Error("the simulation counts in pure numbers: '" + text + "' has a unit")
               : core.scenario().units.from_si(quantity.si, quantity.dimension);
  });
  module.def("mesh_fields", mesh_fields);
  module.def("time_of", [](Core& core, std::string const& text) {
    return in_units(text, dimensions::time, core.scenario().units);
  });
  module.def("write_frame", write_frame);
}

}  // namespace boltzmann::python
