// Mirror: a scheme's own copy of an ensemble, sorted in space, with the periodic images (ghosts) behind the owned
// particles.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/neighbours/cells.hpp>
#include <boltzmann/neighbours/near_task.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstdint>
#include <new>
#include <span>
#include <vector>

namespace boltzmann {

/// Allocates at 64 bytes, so that rows never straddle a cache line more than they must.
template <class T>
struct AlignedAllocator {
  using value_type = T;
  AlignedAllocator() = default;
  template <class U>
  explicit AlignedAllocator(AlignedAllocator<U> const&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{64})); }
  void deallocate(T* p, std::size_t) { ::operator delete (p, std::align_val_t{64}); }
  friend bool operator==(AlignedAllocator const&, AlignedAllocator const&) { return true; }
};
template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

/// Rows [0, owned) are the ensemble's particles in spatial order; row `owned` is a sentinel at no position (NaN):
/// whatever is compared with its distance is false; rows (owned, total] are the periodic images within reach of the
/// box. Every particle has a reference, its position when the mirror was built or when it was moved (move());
/// neighbours are found by references.
class Mirror {
 public:
  Mirror(AnyEnsemble const& ensemble, Box const& box) : ensemble_(&ensemble), box_(&box) {}

  /// Takes the positions of now as references, sorts by them, and finds the images of every particle within `reach` of
  /// the box. PhysicsFailure if a position is not finite.
  void build(double reach, int threads = 1);
  /// The same from given references (dimension() numbers a particle, in the ensemble's order, inside periodic axes).
  void build(double reach, std::span<double const> references, int threads = 1);

  /// Copies the ensemble's rows of now into the mirror's order and moves the images along. True if a position has
  /// changed since the last time. PhysicsFailure if a position is not finite.
  bool refresh(int threads);
  /// True if the ensemble's positions are still those of the last refresh.
  bool is_current() const;
  /// Square of the largest displacement from a reference at the last refresh.
  double largest2() const;
  /// The owned rows that were further than sqrt(square) from their references at the last refresh; no more than `most`.
  std::vector<std::uint32_t> beyond(double square, std::size_t most) const;

  /// Gives owned rows new references: where they are now, or (the second form, rows of 3 numbers) given positions.
  /// They leave the sorted order's cells, and are asked by everyone who looks for neighbours (so let them be few).
  void move(std::span<std::uint32_t const> rows);
  void move(std::span<std::uint32_t const> rows, std::span<double const> references);
  /// The rows that have been moved since the build, in the order of their first move.
  std::vector<std::uint32_t> const& moved() const { return moved_; }
  /// Adds to `rows` the owned rows whose references, or images of them, are within `reach` of x.
  void owned_near(double const* x, double reach, std::vector<std::uint32_t>& rows) const;

  /// Block b (4 doubles) of row k is at rows() + b * block_stride() + 4 k: what no law reads is in no law's way.
  double const* rows() const { return rows_.data(); }
  std::size_t block_stride() const { return row_block * capacity_; }
  std::size_t blocks() const { return ensemble_->stride() / row_block; }
  std::size_t owned() const { return order_.size(); }
  std::size_t total() const { return order_.size() + ghost_source_.size(); }
  std::size_t sentinel() const { return owned(); }
  /// Which particle of the ensemble each owned row is.
  std::uint32_t const* order() const { return order_.data(); }
  AnyEnsemble const& ensemble() const { return *ensemble_; }
  /// Memory of all that is here.
  std::size_t bytes() const;

  /// The references of the owned rows, rows of 4.
  double const* references() const { return references_.data(); }
  /// The same in steps (see steps_of_reach), rows of 4.
  std::int32_t const* reference_steps() const { return steps_.data(); }
  /// The references at the build, in the ensemble's order (dimension() numbers a particle): all that is needed to build
  /// the same mirror again.
  std::vector<double> built_references() const;

  /// For the search of neighbours among this mirror's rows.
  NearTask near_task() const;

 private:
  struct Image {  // of a moved row: itself (turns 0, row = the owned one) or a ghost
    std::uint32_t row;
    std::array<double, 3> position;
  };

  void sort(double reach, std::span<double const> references, int threads);
  void add_ghosts(int threads);
  void sort_all(int threads);
  void refresh_ghosts(int threads);
  void make_room(std::size_t rows);
  std::uint32_t code_of(std::array<int, 3> turns) const;
  void move_ghosts(std::size_t begin, std::size_t end);
  /// Calls function(turns, position) for every periodic image of x, itself included, within reach of the box.
  template <class Function>
  void each_image(double const* x, Function const& function) const;

  AnyEnsemble const* ensemble_;
  Box const* box_;
  double reach_ = 0;
  std::vector<std::uint32_t> order_;  // owned row -> particle
  std::size_t capacity_ = 0;          // rows
  AlignedVector<double> rows_;
  AlignedVector<double> references_;         // of owned rows, 4 a row
  std::vector<std::uint32_t> ghost_source_;  // the owned row that each ghost is an image of
  std::vector<std::uint32_t> ghost_turns_;   // and by how many lengths it is moved: a row of shifts_
  int most_turns_ = 0;
  std::vector<double> shifts_;    // rows of 4
  std::vector<double> largest2_;  // of each block of rows

  std::vector<std::int32_t> steps_;                    // the references in steps, 4 a row
  Cells cells_;                                        // of all rows but the sentinel
  std::array<std::vector<std::int32_t>, 3> position_;  // in the order of cells
  std::vector<std::uint32_t> item_;

  std::vector<std::uint32_t> moved_;
  std::vector<std::array<double, 3>> built_;  // references that moved rows were built with
  std::vector<std::vector<Image>> images_;    // of each moved row
  std::vector<std::uint32_t> free_;           // ghosts that no image uses
  std::array<std::vector<std::int32_t>, 3> moved_position_;
  std::vector<std::uint32_t> moved_item_;
};

}  // namespace boltzmann
