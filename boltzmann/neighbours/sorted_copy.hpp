// SortedCopy: a scheme's own copy of an ensemble, sorted in space. The images (ghosts) of periodic axes and of walls
// follow the owned particles.
#pragma once

#include <boltzmann/boundaries/images.hpp>
#include <boltzmann/neighbours/cells.hpp>
#include <boltzmann/neighbours/near_task.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/share.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <vector>

namespace boltzmann {

/// Allocates at 64 bytes, so that rows straddle as few cache lines as possible.
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

/// Rows [0, owned) are the ensemble's particles in spatial order. Row `owned` is a sentinel row at NaN, so that every
/// distance test fails. Rows (owned, total] are the images within reach of the box: along periodic axes shifted by
/// whole lengths, beyond walls of mirror axes reflected, and in corners their compositions. A particle near a wall has
/// its own image as a neighbour, too.
/// Every particle has a reference, its position when the sorted copy was built or when it was moved (move()).
/// Neighbours are found by references. References of images use the walls at the build; the motion of walls since then
/// counts as displacement of all rows. In a sheared box the references move with the flow and displacements are
/// relative to it. The approach of pairs by the shear itself counts as displacement of all rows.
class SortedCopy {
 public:
  /// The blocks of the ensemble's rows are followed by `extra_blocks` more, which a scheme fills (block()).
  SortedCopy(AnyEnsemble const& ensemble, Box const& box, std::size_t extra_blocks = 0);

  /// Sets the rules for images beyond walls, one for each number of a row, including extra blocks: 4 (blocks() +
  /// extra). By default the fields "position" and "velocity" have the rules of these names, and all others are
  /// unchanged. Error if the number of rules differs, or an axis is not one of the box's.
  void components(std::vector<ImageComponent> components);

  /// Uses the current positions as references, sorts by them, and finds the images of every particle within `reach` of
  /// the box. PhysicsFailure if a position is not finite. Error if the reach is longer than an axis between two walls,
  /// or than 8 lengths of a periodic one.
  void build(double reach, int threads = 1);
  /// The same from given references (dimension() numbers a particle, in the ensemble's order, inside periodic axes).
  void build(double reach, std::span<double const> references, int threads = 1);
  /// The same with the walls of an earlier build (built_edges()), and its slide of a sheared box (built_slide()).
  void build(double reach, std::span<double const> references, Box::Edges const& edges, double slide, int threads = 1);

  /// A set of places along two axes; positions within a distance of one of them are near.
  struct NearPlaces {
    struct Place {
      double low[2], high[2];
    };
    std::vector<Place> places;
    std::array<int, 2> axes{};
    double square = 0;  ///< of the distance

    void add(auto const& first, auto const& second) {
      places.push_back({{first.low, second.low}, {first.high, second.high}});
    }
    /// True if a position is near, by its coordinates along these axes.
    bool contains(double first, double second) const {
      for (Place const& place : places) {
        double const a = out_of(first, place.low[0], place.high[0]), b = out_of(second, place.low[1], place.high[1]);
        if (a * a + b * b <= square) return true;
      }
      return false;
    }

   private:
    static double out_of(double x, double low, double high) { return std::max(std::max(0.0, low - x), x - high); }
  };
  /// The data of one rank for a build by all ranks together.
  struct Part {
    std::vector<std::uint32_t> particles;  ///< on this rank
    std::unique_ptr<double[]> references;  ///< of these particles, dimension() numbers each
    std::vector<std::uint32_t> rows;       ///< of these particles, ascending
    Cells sorted;                          ///< rows[n] is that of particles[sorted.items()[n]]
    Grid grid;                             ///< for the references of all rows, images included
    /// The region of the targets of this rank. Images elsewhere are not made.
    NearPlaces near;
  };
  /// Builds a part: rows are in the global order; rows of particles that are not here stay empty. Only images of
  /// particles that are here are made.
  void build_part(double reach, Part part, int threads);
  /// True if only a part of the rows is here. Then everything() must not be called.
  bool is_part() const { return part_; }
  /// True if this row is here, and belongs to this particle.
  bool knows(std::uint32_t k, std::uint32_t particle) const;
  /// Adds a ghost particle with its reference. Returns its row: its row in the global order, unless another particle
  /// here has it.
  std::uint32_t learn(std::uint32_t row_of_all, std::uint32_t particle, double const* reference);
  /// Copies a row from the ensemble.
  void refresh_row(std::uint32_t k);
  /// In a part: the distance between the new reference that a row would get and its position at the build; on the other
  /// side of the box, if it has left through a periodic end.
  double left_build_by(std::uint32_t k) const;
  /// References at the build for all particles, in the ensemble's order. In a part the references of other particles
  /// are to be written here.
  std::vector<double>& references_by_number() { return built_by_number_; }
  /// Makes the checks of build(), and returns the current positions of these particles as references, dimension()
  /// numbers each. PhysicsFailure if one is not finite.
  void check_reach(double reach, Box::Edges const& edges) const;
  std::unique_ptr<double[]> references_of(std::span<std::uint32_t const> particles) const;
  /// The reach that determines the cells by which rows are sorted.
  double sorting_reach(double reach, Box::Edges const& edges) const;
  /// The rows that are here, ascending: known(n), n < known().
  std::size_t known() const { return part_ ? known_.size() : owned(); }
  std::uint32_t known(std::size_t n) const { return part_ ? known_[n] : static_cast<std::uint32_t>(n); }

  /// Copies the ensemble's current rows into the sorted copy's order and updates the images, those beyond walls for the
  /// current walls. Extra blocks are kept. True if a position, or a wall, has moved since the last time. PhysicsFailure
  /// if a position is not finite. `others`: includes rows of other ranks (only()).
  bool refresh(int threads, bool others = true);
  /// The part of it for rows of other ranks, if wanted, and for images.
  void refresh_others(int threads, bool others);
  /// Places received rows, which are contiguous at `from`: rows[0], rows[1], ..., with followed_blocks() blocks each.
  void place(std::span<std::uint32_t const> rows, double const* from);
  /// Restricts refresh() until the next build to these owned rows, to `others`, and to images for which `read` is not 0
  /// at their row. largest2(), beyond() and the result of refresh() refer to `own`. For rows that a rank of a team
  /// owns, and those that it reads.
  void only(std::vector<Stretch> const& own, std::vector<Stretch> const& others, std::vector<char> const& read);
  /// Ends the restriction.
  void everything();
  /// The ranges that are refreshed: own rows, others, and images. Image n is row `sentinel() + 1 + n`.
  std::vector<Stretch> const& followed() const { return pieces_; }
  std::vector<Stretch> const& others() const { return others_; }
  std::vector<Stretch> const& images() const { return images_of_; }
  /// Updates the images of blocks [first_block, last_block) from their owned rows, for walls at the last refresh.
  void refresh_images(std::size_t first_block, std::size_t last_block, int threads);
  /// True if the ensemble's positions, and the walls' places, are still those of the last refresh.
  bool is_current() const;
  /// Square of the largest displacement from a reference at the last refresh, including the motion of walls since the
  /// build: no pair has approached by more than twice its root.
  double largest2() const;
  /// The owned rows that were further (in this sense) than sqrt(square) from their references at the last refresh, if
  /// there are at most `most`.
  std::optional<std::vector<std::uint32_t>> beyond(double square, std::size_t most) const;

  /// Gives owned rows new references: their current positions, or (second form, rows of 3 numbers) given positions.
  /// They leave the cells of the sorted order, and every search tests them, so there should be few.
  void move(std::span<std::uint32_t const> rows);
  void move(std::span<std::uint32_t const> rows, std::span<double const> references);
  /// The rows that have been moved since the build, in the order of their first move.
  std::vector<std::uint32_t> const& moved() const { return moved_; }
  /// Adds to `rows` the owned rows whose references, or images of them, are within `reach` of x.
  void owned_near(double const* x, double reach, std::vector<std::uint32_t>& rows) const;

  /// If set, only the first block of images and of received rows is refreshed, which has the positions. The first user
  /// of other fields resets it.
  void positions_alone(bool yes) { positions_alone_ = yes; }
  /// The number of refreshed blocks.
  std::size_t followed_blocks() const { return positions_alone_ ? 1 : blocks(); }

  /// Block b (4 doubles) of row k is at rows() + b * block_stride() + 4 k. Blocks that a law does not read are never
  /// loaded.
  double const* rows() const { return rows_.data(); }
  std::size_t block_stride() const { return row_block * capacity_; }
  std::size_t blocks() const { return ensemble_->stride() / row_block; }
  /// Writable access to block b: row k is at block(b) + 4 k. Blocks from blocks() on are the extra ones. After a build
  /// they are NaN until they are filled (the sentinel stays NaN); they are kept until the next build() or move().
  double* block(std::size_t b) { return rows_.data() + b * block_stride(); }
  double const* block(std::size_t b) const { return rows_.data() + b * block_stride(); }
  std::size_t extra_blocks() const { return extra_blocks_; }
  std::size_t owned() const { return order_.size(); }
  std::size_t total() const { return order_.size() + ghost_source_.size(); }
  std::size_t sentinel() const { return owned(); }
  /// The owned row of row k, which is owned or an image; the sentinel has none.
  std::uint32_t owner(std::size_t k) const {
    return k < owned() ? static_cast<std::uint32_t>(k) : ghost_source_[k - owned() - 1];
  }
  /// The particle of each owned row.
  std::uint32_t const* order() const { return order_.data(); }
  /// The row of each particle, if all are here.
  std::vector<std::uint32_t> rows_by_number() const;
  AnyEnsemble const& ensemble() const { return *ensemble_; }
  /// Memory of this object in bytes.
  std::size_t bytes() const;

  /// The references of the owned rows, 4 numbers a row.
  double const* references() const { return references_.data(); }
  /// The same in steps (see steps_of_reach), 4 numbers a row.
  std::int32_t const* reference_steps() const { return steps_.data(); }
  /// The references at the build, in the ensemble's order (dimension() numbers a particle). They suffice to build the
  /// same sorted copy again.
  std::vector<double> built_references() const;
  /// The box's edges at the build.
  Box::Edges const& built_edges() const { return built_edges_; }
  /// True if the build had the same number of particles, and walls at the same ends.
  bool built_for_these() const { return owned() == ensemble_->size() && built_walls_ == box_->walled(); }
  double built_slide() const { return built_slide_; }
  /// The axis of a sheared box's flow; -1: no shear.
  int flow_axis() const { return box_->sheared() ? box_->shear().flow : -1; }
  /// The velocity along the flow of row k, owned or an image, minus that of its particle: rows are shifted by whole
  /// lengths along the gradient from the wrapped particles. Only for a sheared box.
  double ahead_in_flow(std::size_t k) const;

  /// The task of a search for neighbours among this sorted copy's rows.
  NearTask near_task() const;

 private:
  struct Image {  // of a moved row: itself (turns 0, its own row) or a ghost
    std::uint32_t row;
    std::array<double, 3> position;
  };

  struct Placed {  // a particle of a sheared box near the reference of its row
    std::array<double, 3> position{};
    double ups = 0, moved2 = 0;  // lengths along the gradient from its wrapped position, square of its displacement
  };

  [[noreturn]] void too_many_rows(double count) const;
  double reference_of(double x, int axis) const;
  void begin_build(double reach, Box::Edges const& edges, double slide);
  void finish_build(Cells const& sorted, Grid const* grid, int threads);
  /// Sets the reference of a row, D numbers.
  template <int D>
  void take_reference(std::size_t k, double const* reference);
  Cells sort(double reach, std::span<double const> references, int threads);
  void add_ghosts(Part const* part, int threads);
  void sort_all(Cells const& sorted, Grid const* grid, int threads);
  void make_room(std::size_t rows);
  RefreshTask refresh_task() const;
  std::size_t all_blocks() const { return blocks() + extra_blocks_; }
  void find_image_maps();
  std::uint32_t code_of(Turns const& turns) const;
  double images_moved() const;
  void find_not_finite() const;
  // sheared_copy.cpp
  Placed placed(std::size_t k, double const* position) const;
  void place(std::size_t k, Placed const& placed);
  Refreshed refresh_sheared(RefreshTask const& task, std::size_t begin, std::size_t end);
  bool is_current_in_shear() const;
  void wrap_reference(double* reference, double slide) const;
  void put_back_to_build(double const* position, double* reference) const;
  double strain() const;
  void all_images();
  void move_ghosts(std::size_t first_block, std::size_t last_block, std::size_t begin, std::size_t end);

  AnyEnsemble const* ensemble_;
  Box const* box_;
  double reach_ = 0;
  std::vector<std::uint32_t> order_;  // owned row -> particle
  bool part_ = false;
  std::vector<std::uint32_t> known_;     // rows, where part_
  std::vector<double> built_by_number_;  // references of all particles, where part_
  std::size_t capacity_ = 0;             // rows
  AlignedVector<double> rows_;
  AlignedVector<double> references_;         // of owned rows, 4 a row
  std::vector<std::uint32_t> ghost_source_;  // the owned row that each ghost is an image of
  std::vector<std::uint32_t> ghost_turns_;   // its image index as a code: a row of image_sign_, image_shift_
  Images images_;                            // of references, about the edges at the build
  int max_images_ = 0;
  std::size_t extra_blocks_;
  bool positions_alone_ = false;
  std::vector<ImageComponent> components_;  // of each number of a row
  Box::Edges built_edges_{}, edges_{};      // at the build, at the last refresh
  Box::Walled built_walls_{};
  double built_slide_ = 0, slide_ = 0;            // likewise
  std::vector<double> ups_;                       // of owned rows in a sheared box: shift along the gradient from their
                                                  // particles, in lengths
  std::size_t mapped_blocks_ = 0;                 // blocks in which images differ from their particles
  std::vector<Turns> turns_;                      // of each code
  std::vector<double> image_sign_, image_shift_;  // of rows, for each code
  std::vector<Stretch> pieces_, others_;          // ranges of owned rows that are refreshed
  std::vector<Stretch> images_of_;                // and of images
  std::vector<double> largest2_;                  // of each piece

  std::vector<std::int32_t> steps_;                    // the references in steps, 4 a row
  Cells cells_;                                        // of all rows but the sentinel
  std::array<std::vector<std::int32_t>, 3> position_;  // in the order of cells
  std::vector<std::uint32_t> item_;

  std::vector<std::uint32_t> moved_;
  std::vector<std::array<double, 3>> built_;      // references that moved rows were built with
  std::vector<std::vector<Image>> moved_images_;  // of each moved row
  std::vector<std::uint32_t> free_;               // ghosts that no image uses
  std::array<std::vector<std::int32_t>, 3> moved_position_;
  std::vector<std::uint32_t> moved_item_;
};

}  // namespace boltzmann
