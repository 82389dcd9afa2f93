// Body forces: the forces of a flow on the bodies in it, by two independent methods.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

/// Mean forces since the last sample, divided by the density of the fluid. On all bodies together from the impulse of
/// the flow I (P. G. Saffman, Vortex Dynamics, section 3.2): F = -dI/dt + Gamma (V, -U) in a stream (U, V), Gamma the
/// total circulation. The impulse of removed vortices is no force (Sample::taken). On each body also from the pressure
/// around it, by dp/ds = -(d(sheet)/dt + flux + d(sheet^2 / 2)/ds); this excludes friction. Coefficients are F / (U^2
/// length / 2). NaN at the first sample.
class BodyForces final : public Diagnosis {
 public:
  /// Error if there is no body, or a coefficient is wanted without a stream.
  BodyForces(std::vector<AnyEnsemble const*> const& available, std::optional<std::array<double, 3>> const& stream,
             double length);

  std::vector<Column> columns() const override;
  void measure(Sample const& sample, std::vector<double>& values) override;
  /// It records the vorticity that no-slip walls shed in each step.
  bool follows() const override { return true; }
  void follow(Sample const& sample) override;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

 private:
  struct Look {
    double time = 0;
    std::array<double, 2> impulse{};  // includes that of removed vortices
    double followed_until = 0;        // since the last sample up to here ...
    double circulation = 0;           // ... current total,
    double gone = 0;                  // of removed vortices, since the start,
    double circulation_time = 0;      // and its integral over time
    std::vector<double> sheet;        // of all panels
    std::vector<double> shed;         // by each panel since the last sample, over its length
  };

  std::vector<std::string> bodies_;
  std::array<double, 2> stream_{};
  double length_;
  std::optional<Look> last_;
};

}  // namespace boltzmann
