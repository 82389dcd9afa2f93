// GaussRadau: advances all ensembles together in steps of its own, by a collocation method of order 15.
#pragma once

#include <boltzmann/integrators/integrator.hpp>

#include <array>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace boltzmann {

/// E. Everhart's method on Gauss-Radau spacings (1985) as H. Rein and D. S. Spiegel have it (IAS15, Mon. Not. R.
/// Astron. Soc. 446, 1424 (2015)). Over a step of length h the accelerations (or the rates, where a class has only
/// these) are the polynomial a(s) = a_0 + b_0 s + b_1 s^2 + ... + b_6 s^7 with s = t / h, which is found by iteration:
/// positions at seven nodes from the polynomial, influences there, and the polynomial from these. The steps follow the
/// last term: b_6 / a of the largest numbers of each ensemble is the tolerance (Eq 9 to 11), or what rounding makes of
/// it if that is more. Sums over steps are compensated.
class GaussRadau {
 public:
  static constexpr double usual_tolerance = 1e-9;

  /// One ensemble. A particle that would move further in a step than max_move makes the step shorter.
  struct Part {
    EquationsOfMotion* equations;
    double max_move = std::numeric_limits<double>::infinity();
  };

  /// From now on these; what is known of their motion is forgotten if they are others than before.
  void parts(std::vector<Part> parts);
  std::vector<Part>& parts() { return parts_; }
  std::vector<Part> const& parts() const { return parts_; }
  /// Whether influences don't change if all particles are shifted alike. While influences are calculated the origin is
  /// then at the particle that feels most, so that a near pair has all digits of its distance.
  void shift_origin(bool yes) { shift_origin_ = yes; }
  double tolerance() const { return tolerance_; }
  void tolerance(double tolerance) { tolerance_ = tolerance; }

  /// Advances the rows by one step, not beyond `remaining` (negative: backwards), and returns its length. The
  /// influences are those of the rows as they stand; influences(t) finds those of the rows at a time t after the start
  /// of the step, and is not called at its end. PhysicsFailure if the step has shrunk to nothing.
  double step(double remaining, int threads, std::function<void(double time)> const& influences);

  /// Steps taken, steps that were too long and done again, and influences found, so far.
  struct Counts {
    std::uint64_t steps = 0, rejected = 0, evaluations = 0;
  };
  Counts const& counts() const { return counts_; }

  /// What the next step depends on besides the rows.
  std::vector<double> state() const;
  void restore(std::span<double const> state);

 private:
  static constexpr std::size_t order = 7;  // of the polynomial
  using Column = std::vector<double>;

  double step_from_here(double remaining, int threads, std::function<void(double time)> const& influences);
  void take_rows();
  void put_rows();
  void choose_origin(std::function<void(double time)> const& influences);
  double proposal(double remaining) const;
  void predict_polynomial(double h);
  void shorten_polynomial(double factor);
  bool attempt(double h, int threads, std::function<void(double time)> const& influences);
  bool predict(std::size_t node, double h, int threads);
  double correct(std::size_t node, int threads);
  double growth(double h) const;
  void accept(double h, int threads);
  [[noreturn]] void fail(double h) const;
  template <class Function>
  void each_part(int threads, Function const& function);

  std::vector<Part> parts_;
  std::vector<std::size_t> begin_;  // of each part in the columns, and their end
  Column origin_, x_, v_, x_low_, v_low_, start_rates_, rates_, x_node_, v_node_;
  std::array<Column, order> b_, g_, predicted_;
  double tolerance_ = usual_tolerance;
  double size_ = 0;       // that the next step may have, without sign; 0: unknown
  double last_size_ = 0;  // of the step that b_ is of, with its sign; 0: there was none
  double noise_ = 0;      // the last change of the iteration
  bool shift_origin_ = false;
  bool kept_ = false;  // x_ and v_ are those of the rows at the end of the last step
  Counts counts_;
};

}  // namespace boltzmann
