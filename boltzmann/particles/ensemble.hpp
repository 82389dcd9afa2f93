// Ensembles: the particles of one class, as an array of your own struct.
#pragma once

#include <boltzmann/core/error.hpp>
#include <boltzmann/particles/field.hpp>
#include <boltzmann/particles/held_array.hpp>
#include <boltzmann/particles/mobility.hpp>
#include <boltzmann/particles/motion.hpp>
#include <boltzmann/particles/rows.hpp>
#include <boltzmann/particles/share.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <typeinfo>
#include <vector>

namespace boltzmann {

/// The appearance of an ensemble in drawings.
struct Appearance {
  std::string colour;   ///< a name that colour_named() accepts; empty: the next of the palette
  double diameter = 0;  ///< in the simulation's length unit; 0: chosen by the drawing (on a lattice: its spacing)
};

/// A field that has a rate of its own, in addition to the equations of motion of its class. Or, with `sum`, a field
/// without a rate: laws add to it in each calculation, and rates use it.
struct DrivenField {
  int offset = 0, components = 1;
  bool diffuses = false;  ///< it also takes a random walk
  bool sum = false;       ///< it has no rate
  double period = 0;      ///< positive: after each step it is wrapped to between -period/2 and period/2
};

/// An ensemble without its class: the interface for schemes, boundaries, files and diagnoses. Row i is always particle
/// i: engines that need another order keep a copy of their own.
class AnyEnsemble {
 public:
  virtual ~AnyEnsemble() = default;
  AnyEnsemble(AnyEnsemble const&) = delete;
  AnyEnsemble& operator=(AnyEnsemble const&) = delete;

  std::string const& name() const { return name_; }
  std::string const& class_name() const { return class_name_; }
  int dimension() const { return dimension_; }
  /// The class whose equations of motion apply.
  std::type_info const& moves_as() const { return moves_as_; }
  std::size_t size() const { return size_; }

  /// The first double of row i; the position comes first in every class.
  double* row(std::size_t i) { return data_ + i * stride_; }
  double const* row(std::size_t i) const { return data_ + i * stride_; }
  std::size_t stride() const { return stride_; }    ///< doubles from row to row, a multiple of 4
  std::size_t doubles() const { return doubles_; }  ///< doubles of the class in a row (the rest is padding)

  /// The sum of influences on particle i from all schemes: `influence_size()` doubles (a force for Newton, a velocity
  /// for Tracer).
  double* influence(std::size_t i) { return influence_.data() + i * influence_size_; }
  double const* influence(std::size_t i) const { return influence_.data() + i * influence_size_; }
  std::size_t influence_size() const { return influence_size_; }
  void clear_influence() {
    for (double& x : influences()) x = 0;
  }

  /// The fields that have rates of their own.
  std::vector<DrivenField> const& driven() const { return driven_; }
  /// True if a field is a vector: in 1D a vector has one component, too.
  bool is_vector(Field const& field) const;
  /// The index of a field among them; -1: it has no rate.
  int number_driven(Field const& field) const;
  /// The sum of rates of driven field k from all schemes, dimension() numbers a particle; a scalar uses the first. The
  /// rates are followed by the diffusion coefficients of the fields that diffuse, in the same form.
  double* rate(std::size_t k) { return influence_.data() + (influence_size_ + k * rate_stride()) * size_; }
  double const* rate(std::size_t k) const { return influence_.data() + (influence_size_ + k * rate_stride()) * size_; }
  std::size_t rate_stride() const { return static_cast<std::size_t>(dimension_); }
  /// Influences and rates of all particles as plain numbers.
  std::span<double> influences() { return {influence_.data(), influence_.size()}; }
  std::span<double const> influences() const { return {influence_.data(), influence_.size()}; }

  std::vector<Field> const& fields() const { return fields_; }
  /// The descriptor of a field, or nullptr if the class has none of that name.
  Field const* find_field(std::string_view name) const;
  /// The descriptor of a field; Error naming the fields there are, and the nearest, if it is missing.
  Field const& field(std::string_view name) const;
  /// One component of a field for all particles, in order.
  std::vector<double> column(Field const& field, int component = 0) const;

  /// Keeps the first particles; in new ones every field is zero (mass one if the class has a mass). Influences are zero
  /// until they are calculated. Pointers to rows and influences become invalid.
  virtual void resize(std::size_t size) = 0;
  /// Memory of rows and influences in bytes.
  virtual std::size_t bytes() const = 0;

  /// In a run that is divided over ranks (Division): the particles that this rank advances. Null: all.
  Share const* share() const { return share_; }
  void share(Share const* share) { share_ = share; }

  /// Keeps the memory of rows and influences alive for views without a copy. A resize then allocates new memory, and
  /// the old memory is filled with NaN.
  virtual std::shared_ptr<void const> hold_rows() const = 0;
  std::shared_ptr<void const> hold_influences() const { return influence_.hold(); }

  Appearance appearance;
  Mobility mobility;

 protected:
  AnyEnsemble(std::string name, std::string class_name, std::type_info const& moves_as, int dimension,
              std::size_t stride, std::size_t doubles, std::size_t influence_size, std::vector<Field> fields,
              std::vector<DrivenField> driven = {}, std::vector<int> vectors = {});
  void attach(double* data, std::size_t size);
  std::size_t influence_bytes() const { return influence_.capacity() * sizeof(double); }

 private:
  std::string name_, class_name_;
  std::type_info const& moves_as_;
  int dimension_;
  std::size_t stride_, doubles_, influence_size_, size_ = 0;
  double* data_ = nullptr;
  HeldArray<double> influence_;
  std::vector<Field> fields_;
  std::vector<DrivenField> driven_;
  std::vector<int> vectors_;  // offsets of fields with one component that are vectors
  std::size_t rates_ = 0;     // arrays of rates and diffusion coefficients
  Share const* share_ = nullptr;
};

/// Error, naming the particle, if a mass is not positive.
void check_masses(AnyEnsemble const& ensemble);

/// The particles of class P (for example Newton<2>, or your own class for doubles: Ion<double>). Behaves like a vector
/// of P.
template <class P>
class Ensemble final : public AnyEnsemble {
 public:
  using Particle = P;
  using Influence = typename P::Influence;
  static_assert(holds_only_reals<P>(), "a particle class holds nothing but Real and Vector<D, Real>");

  /// `size` particles, every field zero (and mass one where the class has a mass).
  explicit Ensemble(std::string name, std::size_t size = 0)
      : AnyEnsemble(std::move(name), P::class_name, typeid(detail::MovesAs<P>), P::dimension, row_stride<P>,
                    row_doubles<P>, sizeof(Influence) / sizeof(double), P::fields().fields) {
    resize(size);
  }

  P& operator[](std::size_t i) { return rows_[i]; }
  P const& operator[](std::size_t i) const { return rows_[i]; }
  Row<P>* begin() { return rows_.data(); }
  Row<P>* end() { return rows_.data() + size(); }
  Row<P> const* begin() const { return rows_.data(); }
  Row<P> const* end() const { return rows_.data() + size(); }

  Influence const& influence_on(std::size_t i) const { return *reinterpret_cast<Influence const*>(influence(i)); }

  /// Adds one particle at the end. References, rows and influences become invalid, as by resize().
  void add(P const& particle) {
    P const copy = particle;  // it may be in this ensemble, whose rows resize() moves
    std::size_t const i = size();
    resize(i + 1);
    (*this)[i] = copy;
  }

  void resize(std::size_t size) override {
    std::size_t const old = this->size();
    rows_.resize(size + padding);
    std::size_t const first_new = size < old ? size : old;
    // All bytes, including padding: rows are compared, hashed and written as they are.
    std::memset(static_cast<void*>(rows_.data() + first_new), 0, (rows_.size() - first_new) * sizeof(Row<P>));
    if constexpr (requires(P p) { p.mass; })
      for (std::size_t i = first_new; i < rows_.size(); ++i) rows_[i].mass = 1;
    attach(&rows_[0].position[0], size);
  }

  std::size_t bytes() const override { return rows_.capacity() * sizeof(Row<P>) + influence_bytes(); }
  std::shared_ptr<void const> hold_rows() const override { return rows_.hold(); }

 private:
  static constexpr std::size_t padding = 16;  // packs may read past the last particle, and mask those lanes
  HeldArray<Row<P>> rows_;
};

}  // namespace boltzmann
