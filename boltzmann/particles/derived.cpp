// Rows of a class that is made at run time.
#include <boltzmann/particles/derived.hpp>

#include <algorithm>

namespace boltzmann {
namespace {

constexpr std::size_t padding = 16;  // as in Ensemble: packs may read past the last particle, and mask those lanes

std::size_t doubles_of(DerivedClass const& derived, AnyEnsemble const& base) {
  std::size_t doubles = base.doubles();
  for (auto const& added : derived.added) doubles += static_cast<std::size_t>(added.field.components);
  return doubles;
}

std::size_t stride_of(DerivedClass const& derived, AnyEnsemble const& base) {
  return (doubles_of(derived, base) + row_block - 1) / row_block * row_block;
}

std::vector<DrivenField> driven_of(DerivedClass const& derived, std::vector<Field> const& fields) {
  std::vector<DrivenField> all;
  for (auto const& driven : derived.driven) {
    auto const field =
        std::find_if(fields.begin(), fields.end(), [&](Field const& f) { return f.name == driven.field; });
    if (field == fields.end())
      throw Error("class " + derived.name + " has a rate for '" + driven.field + "', but no such field");
    double period = 0;
    for (auto const& added : derived.added)
      if (added.field.name == driven.field) period = added.period;
    all.push_back({field->offset, field->components, driven.diffuses, false, period});
  }
  for (auto const& added : derived.added)
    if (added.sum)
      for (auto const& field : fields)
        if (field.name == added.field.name) all.push_back({field.offset, field.components, false, true, 0});
  return all;
}

}  // namespace

namespace {

std::vector<int> vectors_of(DerivedClass const& derived, std::vector<Field> const& fields) {
  std::vector<int> all;
  for (auto const& added : derived.added)
    for (auto const& field : fields)
      if (added.vector && field.name == added.field.name) all.push_back(field.offset);
  return all;
}

}  // namespace

std::vector<Field> fields_of(DerivedClass const& derived, AnyEnsemble const& base) {
  std::vector<Field> fields = base.fields();
  int offset = static_cast<int>(base.doubles());
  for (auto const& added : derived.added) {
    fields.push_back(added.field);
    fields.back().offset = offset;
    offset += added.field.components;
  }
  return fields;
}

DerivedEnsemble::DerivedEnsemble(std::string name, DerivedClass const& derived, AnyEnsemble& base, std::size_t size)
    : AnyEnsemble(std::move(name), derived.name, base.moves_as(), base.dimension(), stride_of(derived, base),
                  doubles_of(derived, base), base.influence_size(), fields_of(derived, base),
                  driven_of(derived, fields_of(derived, base)), vectors_of(derived, fields_of(derived, base))) {
  new_row_.resize(stride() / row_block);
  double* const row = new_row_.front().number;
  if (base.size() == 0) base.resize(1);
  std::copy_n(base.row(base.size() - 1), base.doubles(), row);
  std::size_t at = base.doubles();
  for (auto const& added : derived.added) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(added.field.components); ++c)
      row[at + c] = c < added.value.size() ? added.value[c] : 0;
    at += static_cast<std::size_t>(added.field.components);
  }
  resize(size);
}

void DerivedEnsemble::resize(std::size_t size) {
  std::size_t const blocks = new_row_.size(), first_new = std::min(size, this->size());
  rows_.resize((size + padding) * blocks);
  for (std::size_t i = first_new; i < size + padding; ++i)
    std::copy(new_row_.begin(), new_row_.end(), rows_.data() + i * blocks);
  attach(rows_[0].number, size);
}

}  // namespace boltzmann
