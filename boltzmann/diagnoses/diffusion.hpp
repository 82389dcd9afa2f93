// Diffusion: displacements of particles from their initial positions.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>
#include <boltzmann/diagnoses/statistics.hpp>

#include <string>
#include <vector>

namespace boltzmann {

/// Columns for each ensemble: the mean square displacement since the first sample at or after the time `since`,
/// relative to the ensemble's mean displacement, and the diffusion coefficient D of <r^2> = 2 d D t + constant in d
/// dimensions, by least squares over the samples so far (Einstein 1905). Particles are followed through periodic axes:
/// between two calls of measure() or follow(), which a Recording makes after each step, none may move further than half
/// of one. NaN while there are too few samples.
class Diffusion final : public Diagnosis {
 public:
  /// For these ensembles by name, or for all. Error if one does not exist.
  Diffusion(std::vector<AnyEnsemble const*> const& available, std::vector<std::string> const& names, double since);

  std::vector<Column> columns() const override;
  double since() const { return since_; }
  void check(Box const& box) const override { refuse_shear(box, "diffusion"); }
  /// Error if the number of particles has changed.
  void measure(Sample const& sample, std::vector<double>& values) override;
  bool follows() const override { return true; }
  void follow(Sample const& sample) override;
  bool by_number() const override { return true; }
  /// Empty before the first sample. Then for each ensemble the number of particles, their positions at the last sample
  /// and their displacements, and the sums of the fit.
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

 private:
  struct Followed {
    std::string name;
    std::vector<double> last, displacement;  // dimension() numbers a particle
    LineSums line;
  };

  int dimension_;
  double since_;
  double begin_ = 0;  // time of the first sample
  bool begun_ = false;
  bool prefixed_;  // columns have the names of ensembles
  std::vector<Followed> followed_;
};

}  // namespace boltzmann
