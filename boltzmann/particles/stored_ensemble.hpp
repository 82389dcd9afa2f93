// StoredEnsemble: particles of a class that is defined by its fields only, read from files.
#pragma once

#include <boltzmann/particles/ensemble.hpp>

#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

/// They have no equations of motion and no influences.
class StoredEnsemble final : public AnyEnsemble {
 public:
  /// `doubles` of each particle; fields are at their offsets.
  StoredEnsemble(std::string name, std::string class_name, int dimension, std::size_t doubles,
                 std::vector<Field> fields)
      : AnyEnsemble(std::move(name), std::move(class_name), typeid(void), dimension,
                    (doubles + row_block - 1) / row_block * row_block, doubles, 0, std::move(fields)) {
    resize(0);
  }
  void resize(std::size_t size) override {
    rows_.resize((size + 1) * (stride() / row_block));
    attach(rows_[0].numbers, size);
  }
  std::size_t bytes() const override { return rows_.capacity() * sizeof(Block); }
  std::shared_ptr<void const> hold_rows() const override { return rows_.hold(); }

 private:
  struct alignas(32) Block {  // the alignment of rows of every class
    double numbers[row_block] = {};
  };
  HeldArray<Block> rows_;
};

}  // namespace boltzmann
