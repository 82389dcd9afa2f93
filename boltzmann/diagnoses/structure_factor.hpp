// Structure factor: the fluctuations of the particles' density at the wave vectors of a periodic box.
#pragma once

#include <boltzmann/core/words.hpp>
#include <boltzmann/diagnoses/diagnosis.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

/// The method of the sums over particles.
enum class WaveSums {
  direct,  ///< wave by wave: exact
  mesh     ///< all at once by a mesh (MeshAmplitudes), at the cost of some 30 waves
};
Words<WaveSums> const& wave_sums_words();

struct StructureFactorOptions {
  /// Empty: of all particles; one: of it; two: the partial one between them.
  std::vector<std::string> ensembles = {};
  std::string label = {};  ///< before the columns' names; empty: the ensembles
  std::size_t modes = 12;  ///< limit of wave vectors: this number of periods in the longest side
  WaveSums by = WaveSums::direct;
  double since = 0;                           ///< time of the first sample
  std::size_t every = 1;                      ///< samples are rows whose steps are multiples of it
  std::vector<std::uint32_t> particles = {};  ///< a group of one ensemble; empty: all
  std::vector<std::uint32_t> partners = {};   ///< of the same ensemble: the partial one between both groups
};

/// S(k) = <|sum_i exp(-i k r_i)|^2> / N, for every wave vector 2 pi (n_x/L_x, n_y/L_y, n_z/L_z) up to a length,
/// averaged over samples and over wave vectors of similar length; between two ensembles S_ab(k) = Re <rho_a rho_b*> /
/// sqrt(N_a N_b) (Ashcroft and Langreth 1967). Columns: the highest value in the table and its wave number. Table: wave
/// number, S, number of wave vectors (k and -k are one). With a mesh the error of an amplitude is 1.1e-5 of N at most,
/// and 1.1e-5 of its own size for particles that are not correlated with the mesh.
class StructureFactor final : public Diagnosis {
 public:
  using Options = StructureFactorOptions;
  /// Error if an ensemble does not exist, or there are more than two (with a group: more than one).
  StructureFactor(std::vector<AnyEnsemble const*> const& available, Options options);

  std::vector<Column> columns() const override;
  double since() const { return options_.since; }
  /// Error if an axis is not periodic, or there are too many wave vectors to sum.
  void check(Box const& box) const override;
  void measure(Sample const& sample, std::vector<double>& values) override;
  std::vector<GatheredTable> tables() const override;
  bool by_number() const override { return !options_.particles.empty(); }
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  std::size_t looks() const { return looks_; }
  /// For each wave vector: {n_x, n_y, n_z} and S.
  std::vector<std::array<int, 3>> const& modes() const { return modes_; }
  std::vector<double> s_of_modes() const;

 private:
  struct Shells {
    std::vector<double> wave_number, s, vectors;
  };
  Shells shells() const;

  Options options_;
  std::string label_;
  std::size_t looks_ = 0;
  std::vector<double> lengths_;  // of the box, averaged over samples
  std::vector<std::array<int, 3>> modes_;
  std::vector<double> sums_;  // of S over samples, for each mode
};

}  // namespace boltzmann
