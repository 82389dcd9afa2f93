// ManyBodyScheme: atoms that feel their surroundings. A first pass over pairs sums what is around each atom, each atom
// answers, and a second pass over pairs adds forces that depend on the answers of both. What is summed and answered is
// said by who derives: embedded atoms, atoms with bonds.
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

  /// Beyond it atoms don't feel each other.
  double cutoff() const { return cutoff_; }
  /// How far atoms may move before lists are rebuilt: lists reach cutoff + skin. Default 0.12 of the cut-off.
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
  /// As many points as there are particles now.
  void complete(double /*time*/) override { count_points(); }
  void divide(Division* division) override;
  std::size_t bytes() const override;
  std::string report() const override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

 protected:
  /// What is known of the passes.
  struct Passes {
    ManyBodyKernels kernels;
    void const* law = nullptr;  ///< what the kernels are given
    std::size_t sums = 1;       ///< numbers that the first pass sums
    std::size_t first = 0;      ///< where in a row the answer begins
    std::size_t answers = 1;    ///< of how many numbers it is
    double sum_quantum = 0;     ///< to which a reversible form rounds what is summed
  };
  /// Some atoms between the passes: rows [0, size).
  struct Atoms {
    std::size_t size;
    double const* rows;  ///< their first blocks, 4 numbers an atom
    double const* sums;  ///< Passes::sums numbers an atom
    double* answers;     ///< Passes::answers numbers an atom
    double* energies;    ///< one number an atom; null: nobody asks
  };

  /// `points` has no particles yet; behind its rows stand so many blocks for answers. Error if the cut-off is not a
  /// positive length, longer than a periodic axis, or an axis is a mirror.
  ManyBodyScheme(Box box, double cutoff, std::unique_ptr<AnyEnsemble> points, std::size_t extra_blocks);
  /// Adds atoms; `element` stands behind the position in their rows if `Passes::first` leaves room for it. Error unless
  /// they are moved by forces.
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
  Division* division_ = nullptr;         // while a run is divided
  bool brought_ = false;                 // for the calculation that comes
  std::unique_ptr<AnyEnsemble> points_;  // the places of all atoms, ensemble after ensemble
  Neighbourhood hood_;
  std::size_t list_ = 0;
  std::vector<Loaded> loaded_;
  std::vector<double> sums_, answers_;  // in the order of rows
  std::vector<Stretch> parts_;          // of the rows, each for one thread
  // Who is near, as the first pass notes it: memory of each part, where a row's begins there and how many there are.
  std::vector<std::vector<std::uint32_t>> near_of_part_;
  std::vector<std::uint32_t*> near_;
  std::vector<std::uint32_t> near_length_;
};

}  // namespace boltzmann
