// Look-up of fields by name.
#include <boltzmann/particles/ensemble.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {

AnyEnsemble::AnyEnsemble(std::string name, std::string class_name, std::type_info const& moves_as, int dimension,
                         std::size_t stride, std::size_t doubles, std::size_t influence_size, std::vector<Field> fields,
                         std::vector<DrivenField> driven, std::vector<int> vectors)
    : name_(std::move(name)),
      class_name_(std::move(class_name)),
      moves_as_(moves_as),
      dimension_(dimension),
      stride_(stride),
      doubles_(doubles),
      influence_size_(influence_size),
      fields_(std::move(fields)),
      driven_(std::move(driven)),
      vectors_(std::move(vectors)) {
  rates_ = driven_.size();
  for (auto const& field : driven_) rates_ += field.diffuses ? 1 : 0;
  for (auto const& field : fields_)
    for (auto const* other = &fields_.front(); other != &field; ++other)
      if (field.offset < other->offset + other->components && other->offset < field.offset + field.components)
        throw Error("class " + class_name_ + ": its fields '" + other->name + "' and '" + field.name +
                    "' have the same place; a particle class derives from one class alone");
}

void AnyEnsemble::attach(double* data, std::size_t size) {
  data_ = data;
  size_ = size;
  std::size_t const numbers = size * (influence_size_ + rates_ * rate_stride());
  if (rates_ > 0 && numbers != influence_.size()) influence_.clear();  // its layout depends on the size
  influence_.resize(numbers);
}

bool AnyEnsemble::is_vector(Field const& field) const {
  if (dimension_ > 1) return field.components == dimension_;
  return field.name == "position" || field.name == "velocity" ||
         std::find(vectors_.begin(), vectors_.end(), field.offset) != vectors_.end();
}

int AnyEnsemble::number_driven(Field const& field) const {
  for (std::size_t k = 0; k < driven_.size(); ++k)
    if (driven_[k].offset == field.offset) return static_cast<int>(k);
  return -1;
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
  std::size_t named = 0;
  for (auto const& field : fields_) {
    names.push_back(field.name);
    named = std::max(named, static_cast<std::size_t>(field.offset + field.components));
  }
  std::string hint = did_you_mean(name, names);
  if (hint.empty() && named < doubles_) hint = "; its class holds more, which its fields() does not name";
  throw Error("ensemble '" + name_ + "' of class " + class_name_ + " has no field '" + std::string(name) + "'" +
              choices_with(hint, names, "it has"));
}

std::vector<double> AnyEnsemble::column(Field const& field, int component) const {
  std::vector<double> values(size_);
  for (std::size_t i = 0; i < size_; ++i) values[i] = row(i)[field.offset + component];
  return values;
}

void check_masses(AnyEnsemble const& ensemble) {
  Field const* const mass = ensemble.find_field("mass");
  if (!mass) return;
  for (std::size_t i = 0; i < ensemble.size(); ++i)
    if (double const of = ensemble.row(i)[mass->offset]; !(of > 0))
      throw Error(
          fmt::format("mass: {} of particle {} of '{}' is out of range; it must be positive", of, i, ensemble.name()));
}

}  // namespace boltzmann
