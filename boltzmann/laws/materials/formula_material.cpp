// Compiles the texts of an equation of state to one program, which is run for one particle at a time.
#include <boltzmann/formulas/evaluate.hpp>
#include <boltzmann/formulas/formula_reader.hpp>
#include <boltzmann/laws/materials/formula_material.hpp>

#include <fmt/format.h>

#include <cmath>

namespace boltzmann {

struct FormulaMaterial::Programs {
  FormulaProgram program;  // pressure, square of the sound speed or the speed, temperature
  bool has_speed = false, has_temperature = false;
};

FormulaMaterial::FormulaMaterial(StateFormulas const& formulas) {
  Dimension const volume = pow(dimensions::length, formulas.dimension), density = dimensions::mass / volume,
                  specific_energy = dimensions::energy / dimensions::mass;
  ExpressionGraph graph;
  NamesInFormula names;
  names.units = formulas.units;
  names.checked = !formulas.units.is_reduced();
  auto const known = [&](Dimension dimension) { return names.checked ? dimension : Dimension{}; };
  Expression const rho = graph.input(0), e = graph.input(1);
  names.values["density"] = {{rho}, known(density), false, false};
  names.values["specific_energy"] = {{e}, known(specific_energy), false, false};
  auto const read = [&](char const* part, std::string const& formula, Dimension dimension) {
    try {
      auto const value = read_formula_text(formula, names, formulas.dimension, graph);
      if (value.is_vector) throw FormulaError(0, "a number is needed, not a vector");
      bool const nothing = value.plain && graph.is_number(value.components[0], 0);
      if (names.checked && !(value.dimension == dimension) && !nothing)
        throw FormulaError(
            0, fmt::format("{} is needed; this is {}", dimension_text(dimension), dimension_text(value.dimension)));
      return value.components[0];
    } catch (FormulaError const& error) {
      throw FormulaPartError(part, error.offset, error.what());
    }
  };
  Programs programs;
  Expression const pressure = read("pressure", formulas.pressure, dimensions::energy / volume);
  std::vector<Expression> results{pressure};
  programs.has_speed = !formulas.sound_speed.empty();
  if (programs.has_speed)
    results.push_back(read("sound_speed", formulas.sound_speed, dimensions::velocity));
  else
    results.push_back(graph.add(graph.derivative(pressure, 0),
                                graph.product({{pressure, 1}, {rho, -2}, {graph.derivative(pressure, 1), 1}})));
  programs.has_temperature = !formulas.temperature.empty();
  if (programs.has_temperature) results.push_back(read("temperature", formulas.temperature, dimensions::temperature));
  std::uint32_t const columns[] = {0, 1};
  programs.program = make_program(graph, results, columns, {});
  programs_ = std::make_shared<Programs const>(std::move(programs));
}

State FormulaMaterial::at(double density, double specific_energy) const {
  auto const& [program, has_speed, has_temperature] = *programs_;
  detail::Workspace<1> work;
  work.set_constants(program);
  detail::run_steps<1>(work, program.row_steps.data(), program.row_steps.size(), 1);
  work.column(0)[0] = density;
  work.column(1)[0] = specific_energy;
  detail::run_steps<1>(work, program.steps.data(), program.steps.size(), 1);
  double const pressure = *work.place(program.results[0]), speed = *work.place(program.results[1]);
  return {pressure, has_temperature ? *work.place(program.results[2]) : 0,
          has_speed ? speed : std::sqrt(std::fabs(speed))};
}

bool FormulaMaterial::has_temperature() const { return programs_->has_temperature; }

}  // namespace boltzmann
