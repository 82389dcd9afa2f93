// HeldArray: memory of an ensemble that others may view without a copy (arrays of numpy).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace boltzmann {

/// Like a vector of T, which consists only of doubles. The result of hold() keeps the memory alive. A resize then
/// allocates new memory and fills the old one with NaN, so that a view never shows the numbers of another particle.
template <class T>
class HeldArray {
 public:
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0);

  HeldArray() = default;
  HeldArray(HeldArray const&) = delete;  // a copy would share the memory
  HeldArray& operator=(HeldArray const&) = delete;
  ~HeldArray() = default;

  T* data() { return first_; }
  T const* data() const { return first_; }
  T& operator[](std::size_t i) { return first_[i]; }
  T const& operator[](std::size_t i) const { return first_[i]; }
  std::size_t size() const { return block_->size(); }
  std::size_t capacity() const { return block_->capacity(); }

  /// New elements are T{}.
  void resize(std::size_t size) {
    if (size == block_->size()) return;
    if (held()) {
      auto fresh = std::make_shared<std::vector<T>>(size);
      std::copy_n(block_->begin(), std::min(size, block_->size()), fresh->begin());
      abandon(std::exchange(block_, std::move(fresh)));
    } else {
      block_->resize(size);
    }
    first_ = block_->data();
  }
  void clear() { resize(0); }

  std::shared_ptr<void const> hold() const { return block_; }
  bool held() const { return block_.use_count() > 1; }

 private:
  /// All bits of a double set are a NaN.
  static void abandon(std::shared_ptr<std::vector<T>> const& old) {
    if (!old->empty()) std::memset(static_cast<void*>(old->data()), 0xFF, old->size() * sizeof(T));
  }

  std::shared_ptr<std::vector<T>> block_ = std::make_shared<std::vector<T>>();
  T* first_ = nullptr;
};

}  // namespace boltzmann
