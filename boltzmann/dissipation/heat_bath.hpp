// HeatBath: the common part of baths that bring particles to a temperature: their particles and their temperature.
#pragma once

#include <boltzmann/dissipation/dissipation.hpp>

#include <array>
#include <functional>
#include <optional>
#include <vector>

namespace boltzmann {

class HeatBath : public Dissipation {
 public:
  /// A block of space, including its edges.
  struct Block {
    std::array<double, 3> low, high;
  };

  /// `temperature` (zero or more), `rate` (per time, positive), Boltzmann's constant in the simulation's units. Error
  /// otherwise.
  HeatBath(double temperature, double rate, double boltzmann_constant);

  /// Adds an ensemble; all act together. Error if its class has no mass and velocity.
  void on(AnyEnsemble& ensemble);
  /// Restricts it to particles that are in this block when it acts. Error if low is not below high.
  virtual void within(Block const& block);
  /// Changes the temperature: to a number, zero or more (Error otherwise), or a function of the time.
  void temperature(double temperature);
  void temperature(std::function<double(double time)> of_time) { of_time_ = std::move(of_time); }
  /// At this time; PhysicsFailure if the function gives a negative number or NaN.
  double temperature_at(double time) const;

  std::vector<AnyEnsemble*> ensembles() const override { return ensembles_; }
  /// Error if a mass is not positive.
  void check() override;
  std::string undivided() const override { return ""; }
  bool spares_resting() const override { return true; }
  void act_in_flow(Box const& box) override { flowing_ = &box; }
  double heat() const override { return heat_; }
  std::vector<double> state() const override { return {heat_}; }
  void restore(std::span<double const> state) override;

 protected:
  /// While it lives, the velocities of the bath's particles are relative to the flow of a sheared box.
  class Carried {
   public:
    explicit Carried(HeatBath const& bath) : bath_(bath) { bath_.add_flow(-1); }
    ~Carried() { bath_.add_flow(1); }
    Carried(Carried const&) = delete;
    Carried& operator=(Carried const&) = delete;

   private:
    HeatBath const& bath_;
  };

  std::optional<Block> const& block() const { return block_; }
  /// True if it acts on particle i of an ensemble: false if the particle rests, or is outside its block.
  bool acts_on(AnyEnsemble const& ensemble, std::size_t i) const {
    if (!block_) return ensemble.mobility.moves(i);
    double const* const row = ensemble.row(i);
    for (int a = 0; a < ensemble.dimension(); ++a)
      if (!(row[a] >= block_->low[a] && row[a] <= block_->high[a])) return false;
    return ensemble.mobility.moves(i);
  }
  double rate() const { return rate_; }
  double boltzmann_constant() const { return boltzmann_constant_; }
  void add_heat(double heat) { heat_ += heat; }

 private:
  void add_flow(double times) const;

  double temperature_, rate_, boltzmann_constant_;
  double heat_ = 0;
  std::function<double(double)> of_time_;
  std::optional<Block> block_;
  std::vector<AnyEnsemble*> ensembles_;
  Box const* flowing_ = nullptr;
};

}  // namespace boltzmann
