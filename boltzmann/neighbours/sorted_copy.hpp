// SortedCopy: a scheme's own copy of an ensemble, sorted in space, with the images (ghosts) of periodic axes and of
// walls behind the owned particles.
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
/// whatever is compared with its distance is false; rows (owned, total] are the images within reach of the box: along
/// periodic axes those moved by whole lengths, beyond walls of mirror axes those reflected (of every particle near
/// enough, so that it sees its own image, too), and in corners their compositions. Every particle has a reference, its
/// position when the sorted copy was built or when it was moved (move()); neighbours are found by references. Those of
/// images are images about the walls as they stood at the build; what walls have moved since counts as displacement of
/// everybody. In a sheared box everything flows with the images: displacements are relative to the flow that has sheared
/// the references since the build, and what the shear itself brings together counts as displacement of everybody.
class SortedCopy {
 public:
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
  /// And with walls where they stood at an earlier build (built_edges()), and a sheared box's slide (built_slide()).
  void build(double reach, std::span<double const> references, Box::Edges const& edges, double slide, int threads = 1);

  /// Places that are told apart along two of the axes; what is within a distance of one of them is near.
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
    /// Whether a position is near, by its coordinates along these axes.
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
  /// What one rank of a team sees of a build that is all ranks' together.
  struct Part {
    std::vector<std::uint32_t> particles;  ///< that it knows
    std::unique_ptr<double[]> references;  ///< of these, dimension() numbers each
    std::vector<std::uint32_t> rows;       ///< that they have, ascending
    Cells sorted;                          ///< rows[n] is that of particles[sorted.items()[n]]
    Grid grid;                             ///< for the references of all rows, images included
    /// Where those are found whose neighbours are sought here. There are no images elsewhere.
    NearPlaces near;
  };
  /// The build of which this is a part: rows are sorted among themselves as all are, the others stay unknown, and there
  /// are images of those that are known alone.
  void build_part(double reach, Part part, int threads);
  /// Whether only a part is known. If so, everything() is not to be followed.
  bool is_part() const { return part_; }
  /// Whether a row is known, and this particle's.
  bool knows(std::uint32_t k, std::uint32_t particle) const;
  /// A particle becomes known, with its reference; its row here, which is the one that it has among all rows if no other
  /// known one is taken for it.
  std::uint32_t learn(std::uint32_t row_of_all, std::uint32_t particle, double const* reference);
  /// A row as the ensemble has it now.
  void refresh_row(std::uint32_t k);
  /// Of a part: how far the place where a known row would get a new reference is from where it was at the build: on the
  /// other side of the box, if it has left over a periodic end.
  double left_build_by(std::uint32_t k) const;
  /// References at the build for all particles, in the ensemble's order; where only a part is known, those of others
  /// are to be written here.
  std::vector<double>& references_by_number() { return built_by_number_; }
  /// What build() refuses, and the positions of now as references, dimension() numbers for each of these particles.
  /// PhysicsFailure if one is not finite.
  void check_reach(double reach, Box::Edges const& edges) const;
  std::unique_ptr<double[]> references_of(std::span<std::uint32_t const> particles) const;
  /// The reach for which cells are made that sort rows.
  double sorting_reach(double reach, Box::Edges const& edges) const;
  /// The rows that are known, ascending: known(n), n < known().
  std::size_t known() const { return part_ ? known_.size() : owned(); }
  std::uint32_t known(std::size_t n) const { return part_ ? known_[n] : static_cast<std::uint32_t>(n); }

  /// Copies the ensemble's rows of now into the sorted copy's order and moves the images along, those beyond walls as
  /// the walls are now. Extra blocks stay as they are. True if a position, or a wall's place, has changed since the
  /// last time. PhysicsFailure if a position is not finite. `others`: also those that others advance (only()).
  bool refresh(int threads, bool others = true);
  /// Of that the rows that others advance, if asked for, and the images.
  void refresh_others(int threads, bool others);
  /// Owned rows as particles have come from elsewhere, `from` one after the other: rows[0], rows[1], ..., of each as
  /// many blocks as are followed.
  void place(std::span<std::uint32_t const> rows, double const* from);
  /// From now on refresh() brings up to date these owned rows only, `others` and those images that `read` has (a number
  /// other than 0 for each of them, at its row), until the next build; largest2(), beyond() and what refresh() returns
  /// are of `own`. For rows that a rank of a team advances, and those that it reads.
  void only(std::vector<Stretch> const& own, std::vector<Stretch> const& others, std::vector<char> const& read);
  /// And all of them again.
  void everything();
  /// What is brought up to date: owned rows of which refresh() speaks, others, and images, each `sentinel() + 1` behind
  /// these numbers.
  std::vector<Stretch> const& followed() const { return pieces_; }
  std::vector<Stretch> const& others() const { return others_; }
  std::vector<Stretch> const& images() const { return images_of_; }
  /// The images of blocks [first_block, last_block) from their owned rows, for walls as they were at the last refresh.
  void refresh_images(std::size_t first_block, std::size_t last_block, int threads);
  /// True if the ensemble's positions, and the walls' places, are still those of the last refresh.
  bool is_current() const;
  /// Square of the largest displacement from a reference at the last refresh, what walls have moved since the build
  /// included: no pair has come closer by more than twice its root.
  double largest2() const;
  /// The owned rows that were further (in this sense) than sqrt(square) from their references at the last refresh, if
  /// they are no more than `most`.
  std::optional<std::vector<std::uint32_t>> beyond(double square, std::size_t most) const;

  /// Gives owned rows new references: where they are now, or (the second form, rows of 3 numbers) given positions.
  /// They leave the sorted order's cells, and are asked by everyone who looks for neighbours (so let them be few).
  void move(std::span<std::uint32_t const> rows);
  void move(std::span<std::uint32_t const> rows, std::span<double const> references);
  /// The rows that have been moved since the build, in the order of their first move.
  std::vector<std::uint32_t> const& moved() const { return moved_; }
  /// Adds to `rows` the owned rows whose references, or images of them, are within `reach` of x.
  void owned_near(double const* x, double reach, std::vector<std::uint32_t>& rows) const;

  /// Whether of images, and of rows that come from elsewhere, only the first block is brought up to date, in which
  /// positions are: until the first who asks for more.
  void positions_alone(bool yes) { positions_alone_ = yes; }
  /// How many blocks are.
  std::size_t followed_blocks() const { return positions_alone_ ? 1 : blocks(); }

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
  /// And which row each particle is, where all are known.
  std::vector<std::uint32_t> rows_by_number() const;
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
  Box::Edges const& built_edges() const { return built_edges_; }
  /// Whether there were as many particles at the build, and walls at the same ends.
  bool built_for_these() const { return owned() == ensemble_->size() && built_walls_ == box_->walled(); }
  double built_slide() const { return built_slide_; }
  /// The axis of a sheared box's flow; -1: no shear.
  int flow_axis() const { return box_->sheared() ? box_->shear().flow : -1; }
  /// How much faster along it row k, owned or an image, is than its particle: rows are whole lengths up or down the
  /// gradient from where the box has put their particles. Only where there is a flow.
  double ahead_in_flow(std::size_t k) const;

  /// For the search of neighbours among this sorted copy's rows.
  NearTask near_task() const;

 private:
  struct Image {  // of a moved row: itself (turns 0, row = the owned one) or a ghost
    std::uint32_t row;
    std::array<double, 3> position;
  };

  struct Placed {  // a particle of a sheared box near the reference of its row
    std::array<double, 3> position{};
    double ups = 0, moved2 = 0;  // lengths up the gradient from where it was, square of its displacement
  };

  [[noreturn]] void too_many_rows(double count) const;
  double reference_of(double x, int axis) const;
  void begin_build(double reach, Box::Edges const& edges, double slide);
  void finish_build(Cells const& sorted, Grid const* grid, int threads);
  /// The reference of a row, D numbers.
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
  std::vector<std::uint32_t> ghost_turns_;   // and its turns, as a code: a row of image_sign_, image_shift_
  Images images_;                            // of references, about the edges at the build
  int max_images_ = 0;
  std::size_t extra_blocks_;
  bool positions_alone_ = false;
  std::vector<ImageComponent> components_;  // of each number of a row
  Box::Edges built_edges_{}, edges_{};      // at the build, at the last refresh
  Box::Walled built_walls_{};
  double built_slide_ = 0, slide_ = 0;            // likewise
  std::vector<double> ups_;                       // of owned rows in a sheared box: lengths above their particles
  std::size_t mapped_blocks_ = 0;                 // in which images differ from their particles
  std::vector<Turns> turns_;                      // of each code
  std::vector<double> image_sign_, image_shift_;  // of rows, for each code
  std::vector<Stretch> pieces_, others_;          // of rows that are brought up to date
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
