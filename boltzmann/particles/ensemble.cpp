// Field look-up by name, for everything that is told a field as a word.
#include <boltzmann/particles/ensemble.hpp>

namespace boltzmann {

AnyEnsemble::AnyEnsemble(std::string name, std::string class_name, std::type_info const& moves_as, int dimension,
                         std::size_t stride, std::size_t doubles, std::size_t influence_size, std::vector<Field> fields)
    : name_(std::move(name)),
      class_name_(std::move(class_name)),
      moves_as_(moves_as),
      dimension_(dimension),
      stride_(stride),
      doubles_(doubles),
      influence_size_(influence_size),
      fields_(std::move(fields)) {
  for (auto const& field : fields_)
    for (auto const* other = &fields_.front(); other != &field; ++other)
      if (field.offset < other->offset + other->components && other->offset < field.offset + field.components)
        throw Error("class " + class_name_ + ": its fields '" + other->name + "' and '" + field.name +
                    "' have the same place; a particle class derives from one class alone");
}

void AnyEnsemble::attach(double* data, std::size_t size) {
  data_ = data;
  size_ = size;
  influence_.resize(size * influence_size_, 0.0);
}

Field const* AnyEnsemble::find_field(std::string_view name) const {
  for (auto const& field : fields_)
    if (field.name == name) return &field;
  return nullptr;
}

Field const& AnyEnsemble::field(std::string_view name) const {
  if (Field const* found = find_field(name)) return *found;
  std::vector<std::string> names;
  names.reserve(fields_.size());
  for (auto const& field : fields_) names.push_back(field.name);
  throw Error("ensemble '" + name_ + "' of class " + class_name_ + " has no field '" + std::string(name) +
              "'; it has " + join(names) + did_you_mean(name, names));
}

std::vector<double> AnyEnsemble::column(Field const& field, int component) const {
  std::vector<double> values(size_);
  for (std::size_t i = 0; i < size_; ++i) values[i] = row(i)[field.offset + component];
  return values;
}

}  // namespace boltzmann
