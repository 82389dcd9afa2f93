// Field descriptors: the one table per particle class that names its fields for files, scenarios, diagnoses and the
// window.
#pragma once

#include <boltzmann/core/dimension.hpp>
#include <boltzmann/core/tensor.hpp>

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace boltzmann {

/// One field of a particle class: its position in the row and its meaning.
struct Field {
  std::string name;     ///< the word in files, scenario keys and diagnoses
  int offset;           ///< position in the row, counted in doubles
  int components;       ///< 1, or the number of components of a vector or (row by row) a tensor
  Dimension dimension;  ///< its unit's dimension
  std::string doc;      ///< one line
};

namespace detail {
/// For a member that can be a field; 0 for any other.
template <class Member>
inline constexpr int component_count = 0;
template <>
inline constexpr int component_count<double> = 1;
template <int D>
inline constexpr int component_count<Vector<D, double>> = D;
template <int D>
inline constexpr int component_count<Tensor<D, double>> = D* D;
}  // namespace detail

/// The row offset of a member, in doubles.
template <class P, class Class, class Member>
int offset_of(Member Class::*member) {
  static_assert(std::is_base_of_v<Class, P>);
  P const particle{};
  auto const* start = reinterpret_cast<char const*>(std::addressof(particle));
  auto const* field = reinterpret_cast<char const*>(std::addressof(particle.*member));
  return static_cast<int>((field - start) / static_cast<std::ptrdiff_t>(sizeof(double)));
}

/// A table that grows down the class hierarchy: each class adds its own fields to those of its parent. A class derives
/// from one other, so that the parent's fields have the same offsets in the child.
struct FieldTable {
  std::vector<Field> fields;

  template <class Class, class Member>
  FieldTable&& add(Member Class::*member, std::string name, Dimension dimension, std::string doc) && {
    static_assert(detail::component_count<Member> > 0, "a field is a Real, a Vector<D, Real> or a Tensor<D, Real>");
    fields.push_back(
        {std::move(name), offset_of<Class>(member), detail::component_count<Member>, dimension, std::move(doc)});
    return std::move(*this);
  }
};

}  // namespace boltzmann
