// Body forces: what a flow does to the bodies in it, by two ways that know nothing of each other.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

/// Forces over the density of the fluid, in the mean since the look before. On all bodies together from the impulse of the
/// flow I (P. G. Saffman, Vortex Dynamics, section 3.2), F = -dI/dt + Gamma (V, -U) in a stream (U, V), Gamma the
/// circulation of all there is; the impulse of vortices that have left is no force (Sample::taken). And on each body by
/// the pressure that goes around it as dp/ds = -(d(sheet)/dt + flux + d(sheet^2 / 2)/ds); of friction this knows nothing.
/// Coefficients are F / (U^2 length / 2). NaN at the first look.
class BodyForces final : public Diagnosis {
 public:
  /// Error if there is no body, or a coefficient is asked for without a stream.
  BodyForces(std::vector<AnyEnsemble const*> const& available, std::optional<std::array<double, 3>> const& stream,
             double length);

  std::vector<Column> columns() const override;
  void measure(Sample const& sample, std::vector<double>& values) override;
  /// What walls that fluid sticks to have shed in a step.
  bool follows() const override { return true; }
  void follow(Sample const& sample) override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

 private:
  struct Look {
    double time = 0;
    std::array<double, 2> impulse{};  // with that of what was taken away
    double followed_until = 0;        // since the look up to here ...
    double circulation = 0;           // ... of all there is now,
    double gone = 0;                  // of what was taken away, of all times,
    double circulation_time = 0;      // and summed over the time
    std::vector<double> sheet;        // of all panels
    std::vector<double> shed;         // of each panel since the look, over its length
  };

  std::vector<std::string> bodies_;
  std::array<double, 2> stream_{};
  double length_;
  std::optional<Look> last_;
};

}  // namespace boltzmann
