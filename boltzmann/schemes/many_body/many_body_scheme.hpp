// ManyBodyScheme: atoms with many-body forces. A first pass over pairs sums the surroundings of each atom. From these
// sums each atom computes its "answer". A second pass over pairs adds forces that depend on the answers of both atoms.
// Derived classes define sums and answers: embedded atoms, atoms with bonds.
#pragma once

#include <boltzmann/neighbours/neighbourhood.hpp>
#include <boltzmann/schemes/many_body/many_body_kernels.hpp>
#include <boltzmann/schemes/scheme.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace boltzmann {

class ManyBodyScheme : public Scheme {
 public:
  ~ManyBodyScheme() override;

  /// The range of interactions.
  double cutoff() const { return cutoff_; }
  /// The distance that atoms may move before lists are rebuilt; lists have the range cutoff + skin. Default: 0.12 of
  /// the cut-off.
  void skin(double length);

  bool follows_box() const override { return true; }
  std::string shear_refused() const override { return ""; }
  void box_changed() override;
  void add_influences(double time) override;
  std::optional<std::uint64_t> revision() const override { return revision_with({}); }
  EnergyAndVirial measure(double time = 0) override;
  std::string explain(AnyEnsemble const& ensemble, std::size_t i) const override;
  void make_reversible(double quantum) override;
  std::string undivided() const override { return quantum_ > 0 ? "the reversible leap-frog" : ""; }
  bool shares_out() const override { return true; }
  bool has_points() const override { return true; }
  void bring_particles() override;
  /// Resizes the points to the current number of particles.
  void complete(double /*time*/) override { count_points(); }
  void divide(Division* division) override;
  std::size_t bytes() const override;
  std::string report() const override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

 protected:
  /// Parameters of the passes.
  struct Passes {
    ManyBodyKernels kernels;
    void const* law = nullptr;  ///< argument of the kernels
    std::size_t sums = 1;       ///< numbers summed by the first pass
    std::size_t first = 0;      ///< offset of the answer in a row
    std::size_t answers = 1;    ///< numbers of an answer
    double sum_quantum = 0;     ///< quantum to which the reversible form rounds sums
  };
  /// A range of atoms between the passes: rows [0, size).
  struct Atoms {
    std::size_t size;
    double const* rows;  ///< their first blocks, 4 numbers per atom
    double const* sums;  ///< Passes::sums numbers per atom
    double* answers;     ///< Passes::answers numbers per atom
    double* energies;    ///< one number per atom; null: not needed
  };

  /// `points` has no particles yet. Its rows have `blocks` further blocks for answers. Throws Error if the cut-off is
  /// not a positive length or longer than a periodic axis, or an axis is a mirror.
  ManyBodyScheme(Box box, double cutoff, std::unique_ptr<AnyEnsemble> points, std::size_t extra_blocks);
  /// Adds atoms. `element` is stored after the position in their rows if `Passes::first` leaves room for it. Throws
  /// Error if forces do not move the particles.
  void add_atoms(AnyEnsemble& ensemble, std::size_t element);
  virtual Passes passes() const = 0;
  virtual void answer(Atoms const& atoms) const = 0;

 private:
  struct Loaded {
    AnyEnsemble* ensemble;
    std::size_t element;
  };

  void check_box() const;
  void count_points();
  void copy_places();
  void find_neighbours();
  void find_answers(Passes const& passes, double* energies);
  AtomTask task();
  void make_room(std::size_t part, AtomTask const& task);
  template <class Function>
  void over_parts(double work, Function const& function) const;
  void run(AtomKernel kernel, Passes const& passes, AtomTask const& task) const;
  void add_to_ensembles();

  double cutoff_, quantum_ = 0;
  std::size_t calculations_ = 0;
  Division* division_ = nullptr;         // set during a divided run
  bool brought_ = false;                 // rows were exchanged for the next calculation
  std::unique_ptr<AnyEnsemble> points_;  // the positions of all atoms, ensemble after ensemble
  Neighbourhood hood_;
  std::size_t list_ = 0;
  std::vector<Loaded> loaded_;
  std::vector<double> sums_, answers_;  // in the order of rows
  std::vector<Stretch> parts_;          // ranges of rows, each for one thread
  // Neighbours found by the first pass: memory per part, and for each row its offset there and its length.
  std::vector<std::vector<std::uint32_t>> near_of_part_;
  std::vector<std::uint32_t*> near_;
  std::vector<std::uint32_t> near_length_;
};

}  // namespace boltzmann
