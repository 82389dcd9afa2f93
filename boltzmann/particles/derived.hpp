// DerivedEnsemble: the particles of a class that is made at run time from a compiled one.
#pragma once

#include <boltzmann/particles/ensemble.hpp>

#include <memory>
#include <string>
#include <vector>

namespace boltzmann {

/// A field that a derived class adds to those of its base, and its initial value.
struct AddedField {
  Field field;  ///< its offset is computed
  std::vector<double> value;
  bool vector = false;  ///< as many numbers as space has axes: with one component, a vector in 1D
  bool sum = false;     ///< DrivenField::sum; such fields need not be listed among the driven ones
  double period = 0;    ///< of an angle and the like, if it has a rate: DrivenField::period
};

/// A class that is derived from another one. Its rows begin with those of the base, so that laws and equations of
/// motion of the base apply. It may have fields of its own, and rates for them or for fields of the base that nothing
/// else changes.
struct DerivedClass {
  struct Driven {
    std::string field;
    bool diffuses = false;
  };

  std::string name;
  std::vector<AddedField> added;
  std::vector<Driven> driven;
};

/// The fields of the derived class: those of `base`, then its own with their offsets in the rows.
std::vector<Field> fields_of(DerivedClass const& derived, AnyEnsemble const& base);

class DerivedEnsemble final : public AnyEnsemble {
 public:
  /// `base`: an ensemble of the base class, of any size. New particles get the initial values of the base.
  DerivedEnsemble(std::string name, DerivedClass const& derived, AnyEnsemble& base, std::size_t size = 0);

  void resize(std::size_t size) override;
  std::size_t bytes() const override { return rows_.capacity() * sizeof(Block) + influence_bytes(); }
  std::shared_ptr<void const> hold_rows() const override { return rows_.hold(); }

 private:
  struct alignas(32) Block {
    double number[row_block] = {0, 0, 0, 0};
  };

  HeldArray<Block> rows_;
  std::vector<Block> new_row_;
};

}  // namespace boltzmann
