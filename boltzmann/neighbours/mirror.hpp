// Mirror: a scheme's own copy of an ensemble, sorted in space, with the periodic images (ghosts) behind the owned
// particles.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace boltzmann {

/// The two largest displacements (squared) since a mirror was built.
struct Displacements {
  double largest = 0, second = 0;
  void take(double d) {
    if (d > largest)
      second = largest, largest = d;
    else if (d > second)
      second = d;
  }
};

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

/// Rows [0, owned) are the ensemble's particles in spatial order, rows [owned, total) their periodic images within
/// reach of the box, row `total` is a sentinel at no position (NaN): whatever is compared with its distance is false.
class Mirror {
 public:
  Mirror(AnyEnsemble const& ensemble, Box const& box) : ensemble_(&ensemble), box_(&box) {}

  /// Sorts the ensemble as it stands now and finds the images of every particle within `reach` of the box.
  /// PhysicsFailure if a position is not finite.
  void build(double reach);

  /// Copies the ensemble's rows of now into the order of the last build and moves the images along. Returns how far
  /// particles have moved since; PhysicsFailure if a position is not finite.
  Displacements refresh(int threads);

  double const* rows() const { return rows_.data(); }
  std::size_t stride() const { return ensemble_->stride(); }
  std::size_t owned() const { return order_.size(); }
  std::size_t total() const { return order_.size() + ghosts_.size(); }
  /// Which particle of the ensemble each owned row is.
  std::uint32_t const* order() const { return order_.data(); }
  AnyEnsemble const& ensemble() const { return *ensemble_; }

  /// The positions at the last build (dimension() doubles a particle, in the ensemble's order): all that is needed to
  /// build the same mirror again.
  std::vector<double> const& reference() const { return reference_; }
  /// Builds the mirror that `reference()` came from.
  void rebuild(double reach, std::span<double const> reference);

 private:
  struct Ghost {
    std::uint32_t source;  // row in this mirror, owned or an earlier ghost
    std::int32_t axis;
    double shift;
  };

  void sort(double reach);
  void add_ghosts(double reach);
  void move_ghosts();

  AnyEnsemble const* ensemble_;
  Box const* box_;
  std::vector<double> reference_;     // in the ensemble's order
  std::vector<std::uint32_t> order_;  // owned row -> particle
  std::vector<Ghost> ghosts_;
  std::vector<double, AlignedAllocator<double>> rows_;
};

}  // namespace boltzmann
