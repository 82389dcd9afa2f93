// GaussRadau: advances all ensembles together in adaptive steps, by a collocation method of order 15.
#pragma once

#include <boltzmann/integrators/integrator.hpp>

#include <array>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace boltzmann {

/// E. Everhart's method on Gauss-Radau spacings (1985) in the form of H. Rein and D. S. Spiegel (IAS15, Mon. Not. R.
/// Astron. Soc. 446, 1424 (2015)). Over a step of length h the accelerations (or the rates of first-order classes) are
/// the polynomial a(s) = a_0 + b_0 s + b_1 s^2 + ... + b_6 s^7 with s = t / h. It is found by iteration: positions at
/// seven nodes from the polynomial, influences there, and the polynomial from these. The step size follows the last
/// term: b_6 / a of the largest numbers of each ensemble equals the tolerance (Eq 9 to 11), or the rounding error if
/// that is more. Sums over steps are compensated.
class GaussRadau {
 public:
  static constexpr double usual_tolerance = 1e-9;

  /// One ensemble. A step in which a particle would move further than max_move is shortened.
  struct Part {
    EquationsOfMotion* equations;
    double max_move = std::numeric_limits<double>::infinity();
  };

  /// Sets the ensembles. The predicted motion is discarded if they differ from before.
  void parts(std::vector<Part> parts);
  std::vector<Part>& parts() { return parts_; }
  std::vector<Part> const& parts() const { return parts_; }
  /// Set if influences don't change when all particles are shifted alike. While influences are calculated the origin is
  /// then at the particle with the strongest acceleration, so that distances of near pairs have full precision.
  void shift_origin(bool yes) { shift_origin_ = yes; }
  double tolerance() const { return tolerance_; }
  void tolerance(double tolerance) { tolerance_ = tolerance; }

  /// Advances the rows by one step, not beyond `remaining` (negative: backwards), and returns its length. The
  /// influences must be those of the current rows; influences(t) calculates those of the rows at a time t after the
  /// start of the step, and is not called at its end. PhysicsFailure if the step size underflows.
  double step(double remaining, int threads, std::function<void(double time)> const& influences);

  /// Steps, rejected steps that were repeated, and evaluations of influences, so far.
  struct Counts {
    std::uint64_t steps = 0, rejected = 0, evaluations = 0;
  };
  Counts const& counts() const { return counts_; }

  /// The state, besides the rows, that determines the next step.
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
  std::vector<std::size_t> begin_;  // begin of each part in the columns, and their end
  Column origin_, x_, v_, x_low_, v_low_, start_rates_, rates_, x_node_, v_node_;
  std::array<Column, order> b_, g_, predicted_;
  double tolerance_ = usual_tolerance;
  double size_ = 0;       // size of the next step, without sign; 0: unknown
  double last_size_ = 0;  // signed size of the step of b_; 0: there was none
  double noise_ = 0;      // last change of the iteration
  bool shift_origin_ = false;
  bool kept_ = false;  // x_ and v_ are the rows at the end of the last step
  Counts counts_;
};

}  // namespace boltzmann
