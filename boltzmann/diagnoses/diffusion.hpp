// Diffusion: how far particles get from where they were.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>
#include <boltzmann/diagnoses/statistics.hpp>

#include <string>
#include <vector>

namespace boltzmann {

/// Columns of each ensemble: mean square displacement since the first look at or after the time `since`, relative to
/// the ensemble's mean displacement, and the diffusion coefficient D of <r^2> = 2 d D t + constant in d dimensions, by
/// least squares over the looks so far (Einstein 1905). Particles are followed through periodic axes: between two calls
/// of measure() or follow(), which a Recording makes after each step, none may get further than half of one. NaN before
/// there is enough to know.
class Diffusion final : public Diagnosis {
 public:
  /// Of these ensembles by name, or of all there are. Error if one isn't there.
  Diffusion(std::vector<AnyEnsemble const*> const& available, std::vector<std::string> const& names, double since);

  std::vector<Column> columns() const override;
  double since() const { return since_; }
  void check(Box const& box) const override { refuse_shear(box, "diffusion"); }
  /// Error if the number of particles has changed.
  void measure(Sample const& sample, std::vector<double>& values) override;
  bool follows() const override { return true; }
  void follow(Sample const& sample) override;
  bool by_number() const override { return true; }
  /// Nothing before the first look; then of each ensemble the number of particles, where each was at the last look and
  /// how far it has got, and of its line the sums.
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

 private:
  struct Followed {
    std::string name;
    std::vector<double> last, displacement;  // dimension numbers a particle
    LineSums line;
  };

  int dimension_;
  double since_;
  double begin_ = 0;  // the time of the first look
  bool begun_ = false;
  bool prefixed_;  // whether columns say of which ensemble they are
  std::vector<Followed> followed_;
};

}  // namespace boltzmann
