// SortedCopy: a scheme's own copy of an ensemble, sorted in space, with the images (ghosts) of periodic axes and of walls
// behind the owned particles.
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

/// How a number of a particle is found in its image beyond a wall. Along a periodic axis images differ in `position`
/// alone.
enum class ImageRule : unsigned char {
  same,           ///< as it is: mass, density, the temperature's history, ...
  position,       ///< reflected about the wall
  velocity,       ///< as the wall says (Wall::slips, Wall::velocity)
  temperature,    ///< as the wall says (Wall::temperature)
  normal_vector,  ///< a reflected vector: its component along the wall's normal changes sign (grad of what is `same`)
  heat_flux,  ///< of such a temperature: at an insulated wall as normal_vector; at a wall of given temperature, about
              ///< which the image's is odd, the components along the wall change sign
  tensor,     ///< pressure or stress of such velocities: reflected at a wall that slips; even, as it is, at one that
              ///< does not
};
/// The rule for one number of a row, and which component of a vector, or which two of a tensor, it is.
struct ImageComponent {
  ImageRule rule = ImageRule::same;
  int axis = 0, axis2 = 0;
};

/// Rows [0, owned) are the ensemble's particles in spatial order; row `owned` is a sentinel at no position (NaN):
/// whatever is compared with its distance is false; rows (owned, total] are the images within reach of the box: along
/// periodic axes those moved by whole lengths, beyond walls of mirror axes those reflected (of every particle near
/// enough, so that it sees its own image, too), and in corners their compositions. Every particle has a reference, its
/// position when the sorted copy was built or when it was moved (move()); neighbours are found by references. Those of
/// images are images about the walls as they stood at the build; what walls have moved since counts as displacement of
/// everybody.
class SortedCopy {
 public:
  /// The edges of a box: low x y z, high x y z.
  using Edges = std::array<double, 6>;

  /// Behind the blocks of the ensemble's rows stand `extra_blocks` more, which a scheme fills (block()).
  SortedCopy(AnyEnsemble const& ensemble, Box const& box, std::size_t extra_blocks = 0);

  /// The rules for images beyond walls, one for each number of a row, extra blocks included: 4 (blocks() + extra).
  /// Until then the ensemble's fields "position" and "velocity" are what they say, and all else is the same. Error if
  /// their number is another, or an axis is not one of the box's.
  void components(std::vector<ImageComponent> components);

  /// Takes the positions of now as references, sorts by them, and finds the images of every particle within `reach` of
  /// the box. PhysicsFailure if a position is not finite. Error if the reach is longer than an axis between two walls,
  /// or than 8 lengths of a periodic one.
  void build(double reach, int threads = 1);
  /// The same from given references (dimension() numbers a particle, in the ensemble's order, inside periodic axes).
  void build(double reach, std::span<double const> references, int threads = 1);
  /// And with walls where they stood at an earlier build (built_edges()).
  void build(double reach, std::span<double const> references, Edges const& edges, int threads = 1);

  /// Copies the ensemble's rows of now into the sorted copy's order and moves the images along, those beyond walls as the
  /// walls are now. Extra blocks stay as they are. True if a position, or a wall's place, has changed since the last
  /// time. PhysicsFailure if a position is not finite.
  bool refresh(int threads);
  /// The images of blocks [first_block, last_block) from their owned rows, for walls as they were at the last refresh.
  void refresh_images(std::size_t first_block, std::size_t last_block, int threads);
  /// True if the ensemble's positions, and the walls' places, are still those of the last refresh.
  bool is_current() const;
  /// Square of the largest displacement from a reference at the last refresh, what walls have moved since the build
  /// included: no pair has come closer by more than twice its root.
  double largest2() const;
  /// The owned rows that were further (in this sense) than sqrt(square) from their references at the last refresh; no
  /// more than `most`.
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
  /// Row k of block b, to be written: at block(b) + 4 k. Blocks from blocks() on are the extra ones; they are NaN after
  /// a build until they are filled (the sentinel's stay so), and stand here until the next build() or move().
  double* block(std::size_t b) { return rows_.data() + b * block_stride(); }
  double const* block(std::size_t b) const { return rows_.data() + b * block_stride(); }
  std::size_t extra_blocks() const { return extra_blocks_; }
  std::size_t owned() const { return order_.size(); }
  std::size_t total() const { return order_.size() + ghost_source_.size(); }
  std::size_t sentinel() const { return owned(); }
  /// The owned row that row k, owned or an image, shows; the sentinel's is none.
  std::uint32_t owner(std::size_t k) const {
    return k < owned() ? static_cast<std::uint32_t>(k) : ghost_source_[k - owned() - 1];
  }
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
  /// the same sorted copy again.
  std::vector<double> built_references() const;
  /// And where the box's edges were.
  Edges const& built_edges() const { return built_edges_; }

  /// For the search of neighbours among this sorted copy's rows.
  NearTask near_task() const;

 private:
  struct Image {  // of a moved row: itself (turns 0, row = the owned one) or a ghost
    std::uint32_t row;
    std::array<double, 3> position;
  };

  [[noreturn]] void too_many_rows(double count) const;
  void sort(double reach, std::span<double const> references, int threads);
  void add_ghosts(int threads);
  void sort_all(int threads);
  void make_room(std::size_t rows);
  std::size_t all_blocks() const { return blocks() + extra_blocks_; }
  Edges edges() const;
  std::array<int, 3> max_images() const;
  void find_reference_maps();
  void find_image_maps();
  ImageMap image_map(ImageComponent component, std::array<int, 3> const& turns) const;
  std::uint32_t code_of(std::array<int, 3> turns) const;
  double walls_moved() const;
  void move_ghosts(std::size_t first_block, std::size_t last_block, std::size_t begin, std::size_t end);
  /// The reference of an image along an axis.
  double image_of(int axis, int turns, double x) const {
    if (turns == 0) return x;
    ImageMap const& map = reference_map_[axis * (2 * max_images_ + 1) + turns + max_images_];
    return map(x);
  }
  /// Calls function(turns, position) for every image of the reference x, itself included, within reach of the box.
  /// Turns are the lengths by which it is moved along a periodic axis, or -1 and 1 for the images at the low and high
  /// walls of a mirror axis.
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
  std::vector<std::uint32_t> ghost_turns_;   // and its turns, as a code: a row of image_sign_, image_shift_
  int max_images_ = 0;
  std::size_t extra_blocks_;
  std::vector<ImageComponent> components_;        // of each number of a row
  Edges built_edges_{}, edges_{};                 // at the build, at the last refresh
  std::size_t mapped_blocks_ = 0;                 // in which images differ from their particles
  std::vector<ImageMap> reference_map_;           // of references, for each axis and its turns
  std::vector<std::array<int, 3>> turns_;         // of each code
  std::vector<double> image_sign_, image_shift_;  // of rows, for each code
  std::vector<double> largest2_;                  // of each block of rows

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
