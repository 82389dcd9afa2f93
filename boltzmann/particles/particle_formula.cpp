// The names in formulas of particles, and the offsets of their numbers in a row.
#include <boltzmann/particles/component_words.hpp>
#include <boltzmann/particles/particle_formula.hpp>

namespace boltzmann {

ParticleNames::ParticleNames(int dimension, UnitSystem const& units) : inputs(dimension, units) {
  std::string square;
  for (int a = 0; a < dimension; ++a) {
    std::string const name(1, "xyz"[a]);
    inputs.add(name, dimensions::length);
    places_.push_back({name, "", a});
    square.append(a == 0 ? "" : " + ").append(name).append("*").append(name);
  }
  inputs.define("r", "sqrt(" + square + ")");
}

ParticleNames::ParticleNames(std::vector<Field> const& fields, int dimension, UnitSystem const& units)
    : ParticleNames(dimension, units) {
  for (auto const& field : fields) {
    if (inputs.has(field.name)) continue;
    bool const vector =
        field.components == dimension && (dimension > 1 || field.name == "position" || field.name == "velocity");
    auto const words = component_words(field.components, dimension);
    for (int c = 0; c < field.components; ++c) {
      std::string const name =
          field.components == 1 ? field.name : field.name + "." + words[static_cast<std::size_t>(c)];
      places_.push_back({name, field.name, field.offset + c});
      if (!vector) inputs.add(name, field.dimension);
    }
    if (vector) inputs.add_vector(field.name, field.dimension);
  }
  if (inputs.has("velocity") && !inputs.has("speed")) inputs.define("speed", "norm(velocity)");
}

void ParticleNames::add_time() {
  if (inputs.has("time")) return;
  inputs.add("time", dimensions::time);
  places_.push_back({"time", "", -1});
}

std::vector<std::uint32_t> ParticleNames::common() const {
  std::vector<std::uint32_t> inputs;
  for (std::uint32_t k = 0; k < places_.size(); ++k)
    if (places_[k].offset < 0) inputs.push_back(k);
  return inputs;
}

ParticlesFormula::ParticlesFormula(std::string_view text, ParticleNames const& names)
    : formula_(names.inputs.read_collective(text, names.common())) {
  for (auto const input : formula_.inputs()) offsets_.push_back(names.offset(input));
}

ParticleFormula::ParticleFormula(std::string_view text, ParticleNames const& names)
    : formula_(names.inputs.read(text)), values_(names.size()) {
  for (auto const input : formula_.inputs()) offsets_.push_back(names.offset(input));
}

double ParticleFormula::operator()(double const* row, double time) {
  auto const& inputs = formula_.inputs();
  for (std::size_t k = 0; k < offsets_.size(); ++k) values_[inputs[k]] = offsets_[k] < 0 ? time : row[offsets_[k]];
  return formula_(values_);
}

}  // namespace boltzmann
