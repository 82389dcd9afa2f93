// Runs a program on blocks of columns, W numbers at a time. For kernel units (see core/kernel_unit.hpp).
#pragma once

#include <boltzmann/core/pack.hpp>
#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/formulas/floored_remainder.hpp>
#include <boltzmann/formulas/machine_code.hpp>

#include <cmath>
#include <cstddef>

namespace boltzmann::detail {

/// Columns and scalars of one thread. A scalar fills a pack, so that both are read in the same way.
template <int W>
struct Workspace {
  using Real = Pack<double, W>;
  alignas(64) double columns[max_columns * block_pairs];
  alignas(64) double scalars[(max_scalars + 4) * W];  // those of a list's rows follow the program's
  alignas(64) double nowhere[block_pairs];            // a column for unused results

  double* column(std::size_t which) { return columns + which * block_pairs; }
  void set_scalar(std::size_t which, double value) { store_pack<W>(scalars + which * W, Real(value)); }
  void set_constants(FormulaProgram const& program) {
    for (std::size_t k = 0; k < program.constants.size(); ++k) set_scalar(k, program.constants[k]);
  }
  double* place(Operand operand) { return operand.scalar ? scalars + operand.index * W : column(operand.index); }
};

/// 2^shift e^x, for a whole shift between -64 and 64. 0 for x below -745.2 (or, with AVX-512, least_exponent).
template <int W>
[[gnu::always_inline]] inline Pack<double, W> scaled_exp(Pack<double, W> x, double shift) {
  using Real = Pack<double, W>;
#if defined(__AVX512F__)
  constexpr bool any_power = W == 8;  // times_power_of_two() accepts any power
#else
  constexpr bool any_power = false;
#endif
  if constexpr (any_power)
    x = max(x, Real(least_exponent));
  else
    x = max(min(x, Real(711.0)), Real(-746.0));
  Real const shifted = x * 0x1.71547652b82fep+0 + to_sixteenths;
  Real const k = shifted - to_sixteenths;
  Real const rest = (x - k * exp_ln2_high) - k * exp_ln2_low;
  return exp_of_parts(k + shift, shifted + shift, rest);
}
/// Like Steps::exponential() of formulas/code_steps.cpp.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> exp_in_formulas(Pack<double, W> x) {
  return scaled_exp(x, 0.0);
}

/// sinh for |x| < 3/2, by its series.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> sinh_near(Pack<double, W> x) {
  auto const z = x * x;
  return x + x * (z * polynomial(z, 1 / 6.0, 1 / 120.0, 1 / 5040.0, 1 / 362880.0, 1 / 39916800.0, 1 / 6227020800.0,
                                 1 / 1307674368000.0, 1 / 355687428096000.0, 1 / 121645100408832000.0,
                                 1 / 51090942171709440000.0));
}
template <int W>
[[gnu::always_inline]] inline Pack<double, W> sinh(Pack<double, W> x) {
  auto const half = scaled_exp(abs(x), -1.0);  // e^|x| / 2, which is finite as long as sinh is
  return select(abs(x) < 1.5, sinh_near(x), with_sign_of(half - 0.25 / half, x));
}
template <int W>
[[gnu::always_inline]] inline Pack<double, W> cosh(Pack<double, W> x) {
  auto const half = scaled_exp(abs(x), -1.0);
  return half + 0.25 / half;
}

/// floored_remainder() of each lane; the same bits.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> mod(Pack<double, W> a, Pack<double, W> b) {
  using Real = Pack<double, W>;
#if defined(__FMA__)
  Real const quotient = a / b;
  Real rest;
  for (int lane = 0; lane < W; ++lane)
    rest.native[lane] = __builtin_fma(-__builtin_floor(quotient.native[lane]), b.native[lane], a.native[lane]);
  rest = select(((rest < 0.0) & (b > 0.0)) | ((rest > 0.0) & (b < 0.0)), rest + b, rest) + 0.0;  // no -0
  auto const exact = (abs(quotient) < 0x1p52) & (abs(b) < __builtin_inf()) & (rest != b);
  if (!any(!exact)) [[likely]]
    return rest;
#endif
  Real result;
  for (int lane = 0; lane < W; ++lane) result.native[lane] = floored_remainder(a.native[lane], b.native[lane]);
  return result;
}

/// The distance to the next pack of an operand.
template <int W>
[[gnu::always_inline]] inline std::size_t stride_of(Operand operand) {
  return operand.scalar ? 0 : W;
}

/// For slow instructions: one loop for operands of all kinds.
template <int W, class F>
[[gnu::always_inline]] inline void each(Workspace<W>& work, Step const& step, std::size_t packs, F const& f) {
  double* const to = work.place(step.to);
  double const *const a = work.place(step.a), *const b = work.place(step.b), *const c = work.place(step.c);
  std::size_t const da = stride_of<W>(step.a), db = stride_of<W>(step.b), dc = stride_of<W>(step.c);
  for (std::size_t k = 0; k < packs; ++k)
    store_pack<W>(to + k * W, f(load_pack<W>(a + k * da), load_pack<W>(b + k * db), load_pack<W>(c + k * dc)));
}

/// A loop specialised by which operands are scalars: these stay in registers, the others share one index.
template <int W, bool scalar_a, bool scalar_b, bool scalar_c, class F>
[[gnu::always_inline]] inline void each_of(Workspace<W>& work, Step const& step, std::size_t packs, F const& f) {
  double* const to = work.place(step.to);
  double const *const a = work.place(step.a), *const b = work.place(step.b), *const c = work.place(step.c);
  auto const x = load_pack<W>(a), y = load_pack<W>(b), z = load_pack<W>(c);
  auto const at = [&](std::size_t k) __attribute__((always_inline)) {
    store_pack<W>(to + k, f(scalar_a ? x : load_pack<W>(a + k), scalar_b ? y : load_pack<W>(b + k),
                            scalar_c ? z : load_pack<W>(c + k)));
  };
  std::size_t k = 0;
  for (; k + 4 * W <= packs * W; k += 4 * W) at(k), at(k + W), at(k + 2 * W), at(k + 3 * W);
  for (; k < packs * W; k += W) at(k);
}
/// For fast instructions. If all operands are scalars (of a row) there is one pack, and any of the loops is correct.
template <int operands, int W, class F>
[[gnu::always_inline]] inline void quick(Workspace<W>& work, Step const& step, std::size_t packs, F const& f) {
  if constexpr (operands == 3) {
    if (step.c.scalar) {
      if (step.a.scalar) return each_of<W, true, false, true>(work, step, packs, f);
      if (step.b.scalar) return each_of<W, false, true, true>(work, step, packs, f);
      return each_of<W, false, false, true>(work, step, packs, f);
    }
    if (step.a.scalar && step.b.scalar) return each_of<W, true, true, false>(work, step, packs, f);
  }
  if constexpr (operands > 1) {
    if (step.a.scalar) return each_of<W, true, false, false>(work, step, packs, f);
    if (step.b.scalar) return each_of<W, false, true, false>(work, step, packs, f);
  }
  each_of<W, false, false, false>(work, step, packs, f);
}

/// By the C library, lane by lane.
template <int W, class F>
[[gnu::always_inline]] inline void each_lane(Workspace<W>& work, Step const& step, std::size_t packs, F const& f) {
  each<W>(work, step, packs, [&](Pack<double, W> x, Pack<double, W> y, Pack<double, W>) {
    Pack<double, W> result;
    for (int lane = 0; lane < W; ++lane) result.native[lane] = f(x.native[lane], y.native[lane]);
    return result;
  });
}

template <int W>
[[gnu::noinline]] void run_function(Workspace<W>& work, Step const& step, std::size_t packs) {
  using Real = Pack<double, W>;
  Real const zero = 0.0, one = 1.0;
  switch (step.operation) {
    case Operation::exp:
      return each<W>(work, step, packs, [](Real a, Real, Real) { return exp_in_formulas(a); });
    case Operation::log:
      return each<W>(work, step, packs, [](Real a, Real, Real) { return log(a); });
    case Operation::sin:
      return each<W>(work, step, packs, [](Real a, Real, Real) { return sin(a); });
    case Operation::cos:
      return each<W>(work, step, packs, [](Real a, Real, Real) { return cos(a); });
    case Operation::tan:
      return each<W>(work, step, packs, [](Real a, Real, Real) { return sin(a) / cos(a); });
    case Operation::tanh:
      return each<W>(work, step, packs, [](Real a, Real, Real) { return tanh(a); });
    case Operation::erf:
      return each<W>(work, step, packs, [](Real a, Real, Real) { return erf(a); });
    case Operation::erfc:
      return each<W>(work, step, packs, [](Real a, Real, Real) { return erfc(a); });
    case Operation::sinh:
      return each<W>(work, step, packs, [](Real a, Real, Real) { return detail::sinh(a); });
    case Operation::cosh:
      return each<W>(work, step, packs, [](Real a, Real, Real) { return detail::cosh(a); });
    case Operation::abs:
      return each<W>(work, step, packs, [](Real a, Real, Real) { return abs(a); });
    case Operation::pow:
      return each<W>(work, step, packs, [](Real a, Real b, Real) { return pow(a, b); });
    case Operation::min:
      return each<W>(work, step, packs, [](Real a, Real b, Real) { return min(a, b); });
    case Operation::max:
      return each<W>(work, step, packs, [](Real a, Real b, Real) { return max(a, b); });
    case Operation::less:
      return each<W>(work, step, packs, [&](Real a, Real b, Real) { return select(a < b, one, zero); });
    case Operation::less_equal:
      return each<W>(work, step, packs, [&](Real a, Real b, Real) { return select(a <= b, one, zero); });
    case Operation::equal:
      return each<W>(work, step, packs, [&](Real a, Real b, Real) { return select(a == b, one, zero); });
    case Operation::select:
      return each<W>(work, step, packs, [&](Real a, Real b, Real c) { return select(a != zero, b, c); });
    case Operation::asin:
      return each_lane<W>(work, step, packs, [](double a, double) { return std::asin(a); });
    case Operation::acos:
      return each_lane<W>(work, step, packs, [](double a, double) { return std::acos(a); });
    case Operation::atan:
      return each_lane<W>(work, step, packs, [](double a, double) { return std::atan(a); });
    case Operation::atan2:
      return each_lane<W>(work, step, packs, [](double a, double b) { return std::atan2(a, b); });
    case Operation::mod:
      return each<W>(work, step, packs, [](Real a, Real b, Real) { return detail::mod(a, b); });
    case Operation::floor:
      return each_lane<W>(work, step, packs, [](double a, double) { return std::floor(a); });
  }
}

template <int W>
[[gnu::noinline]] void run_steps(Workspace<W>& work, Step const* steps, std::size_t count, std::size_t packs) {
  using Real = Pack<double, W>;
  for (Step const* step = steps; step < steps + count; ++step) {
    switch (step->instruction) {
      case Instruction::add:
        quick<2>(work, *step, packs, [](Real a, Real b, Real) { return a + b; });
        break;
      case Instruction::subtract:
        quick<2>(work, *step, packs, [](Real a, Real b, Real) { return a - b; });
        break;
      case Instruction::multiply:
        quick<2>(work, *step, packs, [](Real a, Real b, Real) { return a * b; });
        break;
      case Instruction::multiply3:
        quick<3>(work, *step, packs, [](Real a, Real b, Real c) { return a * b * c; });
        break;
      case Instruction::fuse:
        quick<3>(work, *step, packs, [](Real a, Real b, Real c) { return a * b + c; });
        break;
      case Instruction::reciprocal:
        quick<1>(work, *step, packs, [](Real a, Real, Real) { return 1.0 / a; });
        break;
      case Instruction::root:
        quick<1>(work, *step, packs, [](Real a, Real, Real) { return sqrt(a); });
        break;
      case Instruction::inverse_root:
        quick<1>(work, *step, packs, [](Real a, Real, Real) { return rsqrt(a); });
        break;
      case Instruction::function:
        run_function<W>(work, *step, packs);
        break;
    }
  }
}

/// True if the interpreter, as it is compiled here, rounds like machine code of this width: a b + c once. Checks of
/// Clang's undefined behaviour sanitizer separate the product and the sum.
#if defined(__has_feature)
#if __has_feature(undefined_behavior_sanitizer)
#define BOLTZMANN_ROUNDS_TWICE
#endif
#endif
#if defined(__FMA__) && defined(__OPTIMIZE__) && !defined(BOLTZMANN_ROUNDS_TWICE)
template <int W>
inline constexpr bool rounds_as_machine_code = W * sizeof(double) == 32 || W * sizeof(double) == 64;
#else
template <int W>
inline constexpr bool rounds_as_machine_code = false;
#endif
#undef BOLTZMANN_ROUNDS_TWICE

/// The steps of a program that are done once for a row.
template <int W>
void run_row(Workspace<W>& work, FormulaProgram const& program) {
  if (program.code && program.code->row()) return program.code->row()(work.scalars);
  run_steps<W>(work, program.row_steps.data(), program.row_steps.size(), 1);
}
/// The number of steps of an interpreted program, after those of single columns, that the code which writes column
/// `which` may do at once, with lead(): the divider then works while numbers are gathered.
template <int W>
std::size_t leading_steps(FormulaProgram const& program, std::size_t which) {
  auto const leads = [&](Step const& step) {
    bool const divides = step.instruction == Instruction::reciprocal || step.instruction == Instruction::root ||
                         (step.instruction == Instruction::inverse_root && W != 8);
    return divides && !step.a.scalar && step.a.index == which && !step.to.scalar;
  };
  std::size_t const begin = program.of_one_column;
  std::size_t end = begin;
  if (!program.code)
    while (end < program.steps.size() && leads(program.steps[end])) ++end;
  return end - begin;
}
/// A leading step for this pack.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> lead(Step const& step, Pack<double, W> a) {
  return step.instruction == Instruction::reciprocal ? Pack<double, W>(1.0 / a)
         : step.instruction == Instruction::root     ? sqrt(a)
                                                     : rsqrt(a);
}

/// The steps of a program from `first` on, by its machine code if it has some.
template <int W>
void run_program(Workspace<W>& work, FormulaProgram const& program, std::size_t packs, std::size_t first = 0) {
  if (!program.code) return run_steps<W>(work, program.steps.data() + first, program.steps.size() - first, packs);
  for (auto const& piece : program.code->pieces()) {
    if (piece.function)
      piece.function(work.columns, work.scalars, packs);
    else
      run_steps<W>(work, program.steps.data() + piece.first_step, piece.steps, packs);
  }
}

}  // namespace boltzmann::detail
