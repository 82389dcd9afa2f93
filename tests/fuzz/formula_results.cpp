#include "formula_results.hpp"

#include <boltzmann/formulas/evaluate.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

namespace boltzmann::fuzz {
namespace {

constexpr std::size_t packs = 3;

/// The same number, or NaN in both.
void need_same(double interpreted, double by_code, char const* way, int width) {
  if (std::bit_cast<std::uint64_t>(interpreted) != std::bit_cast<std::uint64_t>(by_code) &&
      !(std::isnan(interpreted) && std::isnan(by_code)))
    throw std::logic_error(
        fmt::format("{} interpreted and {} by machine code, {}, {} at a time", interpreted, by_code, way, width));
}

template <int W>
detail::Workspace<W>& workspace(FormulaProgram const& program) {
  static auto const work = std::make_unique<detail::Workspace<W>>();
  work->set_constants(program);
  for (std::size_t k = 0; k < std::size(fuzzed_scalars); ++k)
    work->set_scalar(program.first_row_input() + k, 0.5 + static_cast<double>(k));
  return *work;
}

/// Of packs of numbers.
template <int W>
std::vector<double> on_columns(FormulaProgram const& program) {
  auto& work = workspace<W>(program);
  for (std::size_t k = 0; k < std::size(fuzzed_columns); ++k)
    for (std::size_t pair = 0; pair < packs * W; ++pair)
      work.column(k)[pair] = 0.31 * static_cast<double>(k + pair) - (k == 3 ? 0 : 0.62);
  detail::run_row<W>(work, program);
  detail::run_program<W>(work, program, packs);
  std::vector<double> numbers;
  for (auto const& result : program.results)
    for (std::size_t pair = 0; pair < packs * W; ++pair)
      numbers.push_back(work.place(result)[result.scalar ? 0 : pair]);
  return numbers;
}

/// Rows of a sorted copy: positions in a first array of blocks, the field in a second. One stands where p does, one at no
/// position.
struct Rows {
  static constexpr std::size_t count = packs * 8, quad = 4;
  static constexpr int field = 6;
  static constexpr double p[3] = {0.4, -0.1, 0.2}, cutoff_square = 4;
  alignas(64) double blocks[2][quad * count];
  std::uint32_t entries[count];

  Rows() {
    for (std::size_t i = 0; i < count; ++i) {
      entries[i] = static_cast<std::uint32_t>(quad * ((7 * i) % count));
      for (std::size_t c = 0; c < quad; ++c) {
        blocks[0][quad * i + c] = i == 5 && c < 3 ? p[c] : 0.27 * static_cast<double>((i * (c + 3)) % 13) - 1.6;
        blocks[1][quad * i + c] = 0.31 * static_cast<double>(i) - static_cast<double>(c);
      }
    }
    for (std::size_t c = 0; c < 3; ++c) blocks[0][quad * 11 + c] = std::numeric_limits<double>::quiet_NaN();
  }
};

/// Sums over the list as traversals make them, lane by lane; columns from the interpreter.
template <int W>
void compare_lists(FormulaProgram const& interpreted, FormulaProgram const& compiled, bool along) {
  static Rows const rows;
  auto& work = workspace<W>(interpreted);
  detail::run_row<W>(work, interpreted);
  double sums[3][W] = {};
  for (std::size_t first = 0; first < packs * W; first += W) {
    double separation[3][W], square[W];
    for (std::size_t lane = 0; lane < W; ++lane) {
      auto const row = rows.entries[first + lane];
      for (std::size_t c = 0; c < 3; ++c) separation[c][lane] = rows.blocks[0][row + c] - Rows::p[c];
      double const x = separation[0][lane], y = separation[1][lane], z = separation[2][lane];
      double const r2 = std::fma(z, z, std::fma(y, y, x * x));
      square[lane] = r2 < least_square ? least_square : r2;
      for (std::size_t c = 0; c < 3; ++c) work.column(c)[lane] = separation[c][lane];
      work.column(3)[lane] = square[lane];
      work.column(4)[lane] = rows.blocks[1][row + Rows::field % Rows::quad];
    }
    detail::run_program<W>(work, interpreted, 1);
    auto const result = [&](std::size_t k, std::size_t lane) {
      auto const place = interpreted.results[k];
      return work.place(place)[place.scalar ? 0 : lane];
    };
    for (std::size_t lane = 0; lane < W; ++lane) {
      bool const counts = square[lane] < Rows::cutoff_square;
      if (W == 8 && !counts) continue;  // elsewhere zeros are added, which takes the sign off a zero (added_where)
      for (std::size_t c = 0; c < 3; ++c) {
        double const value = counts ? result(along ? 0 : c, lane) : 0, x = counts ? separation[c][lane] : 0;
        sums[c][lane] = along ? std::fma(value, x, sums[c][lane]) : sums[c][lane] + value;
      }
    }
  }
  auto& there = workspace<W>(compiled);
  detail::run_row<W>(there, compiled);
  for (std::size_t c = 0; c < 3; ++c) there.set_scalar(compiled.scalars + c, Rows::p[c]);
  there.set_scalar(compiled.scalars + 3, Rows::cutoff_square);
  compiled.code->list()(rows.entries, rows.entries + packs * W, rows.blocks[0], there.scalars, there.columns,
                        sizeof rows.blocks[0]);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t lane = 0; lane < W; ++lane)
      need_same(sums[c][lane], there.column(c)[lane], along ? "along the separation" : "over a list", W);
}

/// Whether the interpreter rounds a b + c once, as machine code does: that depends on how this file is optimised.
template <int W>
bool rounds_once() {
  if (!detail::rounds_as_machine_code<W>) return false;
  auto const work = std::make_unique<detail::Workspace<W>>();
  double const numbers[] = {1 + 0x1p-30, 1 - 0x1p-30, -1};
  for (std::size_t k = 0; k < 3; ++k) std::fill_n(work->column(k), W, numbers[k]);
  Step const step{Instruction::fuse, Operation::exp, {3, false}, {0, false}, {1, false}, {2, false}};
  detail::run_steps<W>(*work, &step, 1, 1);
  return work->column(3)[0] == -0x1p-60;
}

template <int W>
void run(FormulaProgram const& program) {
  static bool const comparable = rounds_once<W>();
  auto const interpreted = on_columns<W>(program);
  FormulaProgram compiled = program;
  for (bool const along : {true, false}) {
    compiled.code = machine_code(program, W, GatheredColumns{3, {Rows::quad + Rows::field % Rows::quad}, along});
    if (!compiled.code) return;
    if (along) {
      auto const by_code = on_columns<W>(compiled);
      for (std::size_t k = 0; comparable && k < by_code.size(); ++k)
        need_same(interpreted[k], by_code[k], "on columns", W);
    }
    if (comparable && compiled.code->list()) compare_lists<W>(program, compiled, along);
  }
}

}  // namespace

void run_in_every_way(FormulaProgram const& program) {
  run<4>(program);
  if constexpr (native_width<double> == 8) run<8>(program);
}

}  // namespace boltzmann::fuzz
