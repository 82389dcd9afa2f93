// Diagnoses of fields on the nodes of a mesh.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/field_measures.hpp>
#include <boltzmann/diagnoses/instruments.hpp>
#include <boltzmann/diagnoses/wave_spectrum.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann::instruments {
namespace {

class FieldEnergy final : public Diagnosis {
 public:
  explicit FieldEnergy(DiagnosisParameters const& parameters) { field_energy(parameters.mesh_fields); }
  bool sums() const override { return true; }
  bool needs_mesh() const override { return true; }
  std::vector<Column> columns() const override { return {{"field energy", dimensions::energy}}; }
  void measure(Sample const& sample, std::vector<double>& values) override {
    values.push_back(field_energy(sample.mesh_fields));
  }
};

/// "field.x" by default.
std::string mesh_quantity_name(DiagnosisParameters const& parameters) {
  return parameters.quantity.empty() ? "field.x" : parameters.quantity;
}

class FieldMode final : public Diagnosis {
 public:
  explicit FieldMode(DiagnosisParameters const& parameters) : quantity_(mesh_quantity_name(parameters)) {
    MeshQuantity const quantity = mesh_quantity(parameters.mesh_fields, quantity_);
    if (parameters.mode.size() != static_cast<std::size_t>(quantity.grid().dimension))
      throw Error(
          fmt::format("field-mode: 'mode' has {} number{}, the mesh {} ax{}; give the periods in the box along "
                      "each axis",
                      parameters.mode.size(), parameters.mode.size() == 1 ? "" : "s", quantity.grid().dimension,
                      quantity.grid().dimension == 1 ? "is" : "es"));
    std::copy(parameters.mode.begin(), parameters.mode.end(), mode_.begin());
    field_mode(quantity, mode_);
    label_ = fmt::format("{} mode {}", quantity.label, fmt::join(parameters.mode, " "));
    dimension_ = quantity.dimension();
  }
  bool sums() const override { return true; }
  bool needs_mesh() const override { return true; }
  std::vector<Column> columns() const override {
    return {{label_ + " amplitude", dimension_}, {label_ + " real", dimension_}, {label_ + " imaginary", dimension_}};
  }
  void measure(Sample const& sample, std::vector<double>& values) override {
    auto const c = field_mode(mesh_quantity(sample.mesh_fields, quantity_), mode_);
    values.insert(values.end(), {std::abs(c), c.real(), c.imag()});
  }

 private:
  std::string quantity_, label_;
  std::array<int, 3> mode_{0, 0, 0};
  Dimension dimension_;
};

}  // namespace

std::unique_ptr<Diagnosis> make_field_energy(DiagnosisParameters const& parameters) {
  return std::make_unique<FieldEnergy>(parameters);
}
std::unique_ptr<Diagnosis> make_field_mode(DiagnosisParameters const& parameters) {
  return std::make_unique<FieldMode>(parameters);
}
std::unique_ptr<Diagnosis> make_wave_spectrum(DiagnosisParameters const& parameters) {
  std::string const name = mesh_quantity_name(parameters);
  MeshQuantity const quantity = mesh_quantity(parameters.mesh_fields, name);
  MeshGrid const& grid = quantity.grid();
  int const axis = parameters.axis.empty() ? 0 : parameters.axis[0] - 'x';
  if (parameters.axis.size() > 1 || axis < 0 || axis >= grid.dimension)
    throw Error(fmt::format("wave-spectrum: the mesh has no axis '{}'; it has {}", parameters.axis,
                            grid.dimension == 1   ? "x"
                            : grid.dimension == 2 ? "x, y"
                                                  : "x, y, z"));
  if (!grid.periodic[axis])
    throw Error(fmt::format("wave-spectrum: the axis {} is not periodic, so that no waves belong to it", "xyz"[axis]));
  return std::make_unique<WaveSpectrum>(name, axis, parameters.modes);
}

}  // namespace boltzmann::instruments
