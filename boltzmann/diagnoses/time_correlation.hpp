// Time correlations of single particles over many time origins: velocity autocorrelation and displacement.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

struct TimeCorrelationOptions {
  std::vector<std::string> ensembles = {};    ///< each separately; empty: all
  double since = 0;                           ///< time of the first sample
  std::size_t every = 1;                      ///< steps from one sample to the next
  std::size_t count = 200;                    ///< the longest lag, in samples
  std::size_t origins = 20;                   ///< number of earlier samples that are stored for comparison
  bool subtract_drift = false;                ///< relative to the mean over the ensemble, or the group
  std::string label = {};                     ///< before the columns' names; empty: the ensemble
  std::vector<std::uint32_t> particles = {};  ///< a group of one ensemble; empty: all
};

/// The common base: at every `every`-th step it samples some numbers of each particle, and compares them with those at
/// up to `origins` earlier samples, which are count/origins samples apart.
class TimeCorrelation : public Diagnosis {
 public:
  using Options = TimeCorrelationOptions;

  Options const& options() const { return options_; }
  bool follows() const final { return true; }
  void check(Box const& box) const final { refuse_shear(box, "velocity-autocorrelation and mean-square-displacement"); }
  /// Error if the number of particles has changed, or sampling intervals differ.
  void follow(Sample const& sample) final;
  void measure(Sample const& sample, std::vector<double>& values) final;
  bool by_number() const final { return true; }
  std::vector<double> state() const final;
  void restore(std::span<double const> state) final;

 protected:
  struct Origin {
    std::size_t age = 0;         // in samples
    std::vector<double> values;  // dimension() numbers a particle
  };
  struct Followed {
    std::string name;
    std::vector<double> now, last;      // compared numbers; positions at the last step
    std::deque<Origin> origins;         // oldest first
    std::vector<double> sums, squares;  // over particles and origins, for each lag, ...
    std::vector<double> numbers;        // ... and the number of terms
  };

  TimeCorrelation(std::vector<AnyEnsemble const*> const& available, Options options);

  /// Brings followed.now up to date, at each step; `first`: the first call.
  virtual void see(AnyEnsemble const& ensemble, Box const& box, bool first, Followed& followed) const = 0;
  /// The sum over particles of their contributions, products of now and then or displacements, and of their squares.
  virtual std::array<double, 2> compared(std::span<double const> then, std::span<double const> now) const = 0;
  virtual void add_values(Followed const& followed, std::vector<double>& values) const = 0;

  int dimension() const { return dimension_; }
  std::vector<Followed> const& followed() const { return followed_; }
  /// "" if there is one ensemble that was not named.
  std::string label(Followed const& followed) const {
    return !options_.label.empty() ? options_.label : prefixed_ ? followed.name : "";
  }
  std::vector<std::uint32_t> members(AnyEnsemble const& ensemble) const;
  /// The lags between samples, 0 first, in the simulation's units.
  std::vector<double> lags(Followed const& followed) const;
  std::vector<double> means(Followed const& followed) const;
  double interval() const { return interval_; }

 private:
  void note_time(Sample const& sample);
  void compare(Followed& one) const;

  Options options_;
  int dimension_;
  bool prefixed_;
  std::size_t spacing_;
  double looks_ = 0, begun_ = 0, step_ = 0, first_time_ = 0, last_time_ = 0, interval_ = 0;
  std::vector<Followed> followed_;
};

/// C(t) = <v(0).v(t)> of the particles of each ensemble. Column: D = the integral of C / d up to the longest lag, the
/// diffusion coefficient of Green and Kubo. Tables: C(t), C(t)/C(0), and the integral up to t; and the spectrum, 4 times
/// the cosine transform of C through Hann's window, whose integral over frequencies is <v^2>.
class VelocityAutocorrelation final : public TimeCorrelation {
 public:
  /// Error if an ensemble does not exist or its particles have no velocity.
  VelocityAutocorrelation(std::vector<AnyEnsemble const*> const& available, Options const& options);

  std::vector<Column> columns() const override;
  std::vector<GatheredTable> tables() const override;
  /// For the ensemble of this index: C at lags 0, 1, ... samples.
  std::vector<double> autocorrelation(std::size_t ensemble = 0) const { return means(followed().at(ensemble)); }

 private:
  void see(AnyEnsemble const& ensemble, Box const& box, bool first, Followed& followed) const override;
  std::array<double, 2> compared(std::span<double const> then, std::span<double const> now) const override;
  void add_values(Followed const& followed, std::vector<double>& values) const override;
};

/// <|r(t) - r(0)|^2>, followed through periodic axes. Column: the diffusion coefficient, the slope of its second half
/// over 2 d (Einstein). Table: the same over t, and the deviation of displacements from a Gaussian, d <r^4> / ((d + 2)
/// <r^2>^2) - 1.
class MeanSquareDisplacement final : public TimeCorrelation {
 public:
  MeanSquareDisplacement(std::vector<AnyEnsemble const*> const& available, Options const& options);

  std::vector<Column> columns() const override;
  std::vector<GatheredTable> tables() const override;
  std::vector<double> displacement(std::size_t ensemble = 0) const { return means(followed().at(ensemble)); }

 private:
  void see(AnyEnsemble const& ensemble, Box const& box, bool first, Followed& followed) const override;
  std::array<double, 2> compared(std::span<double const> then, std::span<double const> now) const override;
  void add_values(Followed const& followed, std::vector<double>& values) const override;
};

/// Up to each point, by the trapezoidal rule.
std::vector<double> running_integral(std::span<double const> values, double spacing);

}  // namespace boltzmann
