// Tallies: arrays of integers in which many threads count at the same time. Sums of integers do not depend on their
// order, so any thread may use any array.
#pragma once

#include <boltzmann/core/threads.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <new>
#include <vector>

namespace boltzmann {

/// An array of plain numbers on its own cache lines.
template <class Number>
class AlignedArray {
 public:
  explicit AlignedArray(std::size_t size = 0) { resize(size); }
  /// Resizes, and sets all to zero.
  void resize(std::size_t size) {
    size_ = size;
    memory_.reset(size == 0 ? nullptr : static_cast<Number*>(std::aligned_alloc(64, bytes())));
    if (size > 0 && !memory_) throw std::bad_alloc();
    std::fill_n(memory_.get(), size, Number{});
  }
  Number* data() { return memory_.get(); }
  Number const* data() const { return memory_.get(); }
  Number& operator[](std::size_t i) { return memory_.get()[i]; }
  Number const& operator[](std::size_t i) const { return memory_.get()[i]; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return (size_ * sizeof(Number) + 63) / 64 * 64; }

 private:
  struct Free {
    void operator()(Number* memory) const { std::free(memory); }
  };
  std::size_t size_ = 0;
  std::unique_ptr<Number, Free> memory_;
};

class Tallies {
 public:
  void resize(std::size_t size) {
    size_ = size;
    arrays_.clear();
    free_.clear();
  }
  std::size_t size() const { return size_; }
  std::size_t bytes() const {
    std::size_t total = 0;
    for (auto const& array : arrays_) total += array->bytes();
    return total;
  }

  /// Calls function(begin, end, counts) for ranges of items, each with an array that no other thread is using. Arrays
  /// are created on demand. Afterwards arrays() hold the counts.
  template <class Function>
  void count(std::size_t items, std::size_t grain, int threads, Function const& function) {
    for_ranges(items, grain, threads, [&](std::size_t begin, std::size_t end) {
      AlignedArray<std::int64_t>* mine = take();
      function(begin, end, mine->data());
      give(mine);
    });
    if (arrays_.empty()) give(take());
  }
  /// At least one.
  std::vector<std::unique_ptr<AlignedArray<std::int64_t>>>& arrays() { return arrays_; }
  /// After count(): the total of all arrays, in the first one.
  std::int64_t* sum() {
    if (arrays_.empty()) give(take());
    std::int64_t* const counts = arrays_.front()->data();
    for (std::size_t k = 1; k < arrays_.size(); ++k)
      for (std::size_t i = 0; i < size_; ++i) counts[i] += (*arrays_[k])[i];
    return counts;
  }

 private:
  AlignedArray<std::int64_t>* take() {
    std::lock_guard const lock(mutex_);
    if (free_.empty()) {
      arrays_.push_back(std::make_unique<AlignedArray<std::int64_t>>(size_));
      return arrays_.back().get();
    }
    auto* const array = free_.back();
    free_.pop_back();
    return array;
  }
  void give(AlignedArray<std::int64_t>* array) {
    std::lock_guard const lock(mutex_);
    free_.push_back(array);
  }

  std::size_t size_ = 0;
  std::mutex mutex_;
  std::vector<std::unique_ptr<AlignedArray<std::int64_t>>> arrays_;
  std::vector<AlignedArray<std::int64_t>*> free_;
};

}  // namespace boltzmann
