// The machine code of the steps of a program. Private to this module.
#pragma once

#include <boltzmann/formulas/code_registers.hpp>

#if defined(__x86_64__)
namespace boltzmann::code {

/// True if there are instructions for it.
bool is_plain(Step const& step);
bool are_plain(std::vector<Step> const& steps);

/// Generates steps that are plain.
class Steps : protected Registers {
 protected:
  using Registers::Registers;

  /// Before a loop: loads the constants of its steps into registers, if there are many registers.
  void keep_numbers(std::vector<Step> const& steps, std::size_t first, std::size_t end);
  /// Generates steps in order. With `keep`, values that are read at `end` or later are in their columns afterwards.
  void sequence(std::vector<Step> const& steps, std::size_t first, std::size_t end, bool keep);

 private:
  void step(Step const& step, Flow::Of const& of);
  /// to = f(a).
  template <class F>
  void one(Source const& a, int to, F const& f);
  /// to = f(a, b), a in a register.
  template <class F>
  void two(Source const& a, Source const& b, int to, F const& f);
  template <class F>
  void either_way(Source const& a, Source const& b, int to, F const& f);
  /// A register for the result: that of an operand that is not read later, or another.
  int result_beside(Source const& a, Source const& b);
  void fuse(Source a, Source b, Source const& c, int to);
  void reciprocal(Source const& a, int to);
  /// Like rsqrt() of core/pack.hpp.
  void inverse_root(Source const& a, int to);
  /// Like exp_in_formulas() of formulas/evaluate.hpp.
  void exponential(Source const& a, int to);
  void operation(Operation operation, Source const& a, Source const& b, Source const& c, int to);
  /// 1 or 0.
  void compare(Source const& a, Source const& b, int to, std::uint8_t how);
};

}  // namespace boltzmann::code
#endif
