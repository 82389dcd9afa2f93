// Machine code gives the bits of the interpreter, for any formula and any number.
#include <boltzmann/core/error.hpp>
#include <boltzmann/formulas/evaluate.hpp>
#include <boltzmann/formulas/formula_reader.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <tests/formulas/random_formula.hpp>

#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <random>

namespace boltzmann::machine_code_test {
namespace {

constexpr std::size_t inputs = 5;

struct Case {
  ExpressionGraph graph;
  FormulaProgram program;

  /// x, y, z are columns, u and v of the row; the results are these texts.
  explicit Case(std::vector<std::string> const& texts) {
    NamesInFormula names;
    names.checked = false;
    char const* const known[inputs] = {"x", "y", "z", "u", "v"};
    for (std::uint32_t k = 0; k < inputs; ++k) names.values[known[k]] = {{graph.input(k)}, {}, false, false};
    std::vector<Expression> results;
    for (auto const& text : texts) results.push_back(read_formula_text(text, names, 3, graph).components[0]);
    std::vector<std::uint32_t> const columns{0, 1, 2}, rows{3, 4};
    program = make_program(graph, results, columns, rows);
  }
};

/// The results of the program, interpreted or by its code, for some packs of numbers.
template <int W>
std::vector<double> results_of(FormulaProgram const& program, std::vector<double> const& numbers, std::size_t packs) {
  auto const work = std::make_unique<detail::Workspace<W>>();
  std::memset(static_cast<void*>(work.get()), 0, sizeof(*work));
  work->set_constants(program);
  for (std::size_t k = 0; k < 2; ++k) work->set_scalar(program.first_row_input() + k, numbers[k]);
  detail::run_steps<W>(*work, program.row_steps.data(), program.row_steps.size(), 1);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t k = 0; k < packs * W; ++k) work->column(c)[k] = numbers[(7 * c + 3 * k) % numbers.size()];
  detail::run_program<W>(*work, program, packs);
  std::vector<double> results;
  for (auto const& result : program.results)
    for (std::size_t k = 0; k < packs * W; ++k) results.push_back(work->place(result)[result.scalar ? 0 : k]);
  return results;
}

template <int W>
void expect_same_bits(std::vector<std::string> const& texts, std::vector<double> const& numbers) {
  Case of(texts);
  of.program.code = machine_code(of.program, W);
  if (of.program.steps.empty()) return;
  ASSERT_TRUE(of.program.code) << texts[0];
  FormulaProgram interpreted = of.program;
  interpreted.code = nullptr;
  for (std::size_t const packs : {std::size_t(1), std::size_t(5), block_pairs / W}) {
    auto const there = results_of<W>(of.program, numbers, packs), here = results_of<W>(interpreted, numbers, packs);
    for (std::size_t k = 0; k < here.size(); ++k)
      ASSERT_TRUE(std::memcmp(&here[k], &there[k], sizeof(double)) == 0 || (here[k] != here[k] && there[k] != there[k]))
          << texts[0] << ", number " << k << ": " << here[k] << " interpreted, " << there[k] << " by machine code";
  }
}

/// Those widths that the kernels of this test are compiled for and the processor has.
template <class Function>
void for_each_width([[maybe_unused]] Function const& function) {
  if constexpr (detail::rounds_as_machine_code<4>) function(std::integral_constant<int, 4>{});
  if constexpr (detail::rounds_as_machine_code<8> && native_width<double> == 8)
    function(std::integral_constant<int, 8>{});
}

std::vector<double> ordinary(std::mt19937& random) {
  std::vector<double> numbers(97);
  for (auto& x : numbers) x = std::uniform_real_distribution<double>(-3, 3)(random);
  return numbers;
}

TEST(MachineCode, GivesTheBitsOfTheInterpreter) {
  std::mt19937 random(7);
  for (int k = 0; k < 1500; ++k) {
    std::vector<std::string> texts;
    for (int result = 0; result < 1 + k % 3; ++result)
      texts.push_back(RandomFormula(random, 2 + k % 5, "xyzuv").text());
    auto const numbers = ordinary(random);
    for_each_width([&](auto width) { expect_same_bits<width>(texts, numbers); });
  }
}

TEST(MachineCode, GivesTheBitsOfTheInterpreterForEveryInstruction) {
  double const inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> numbers{0.0,   -0.0,   1.0,    -1.0, inf,  -inf,   nan,   5e-324, -5e-324,
                              1e300, -1e300, 1e-310, 0.5,  2.5,  1e-160, 1e160, -2.5,   std::nextafter(2.0, 3.0),
                              700,   -700,   709.9,  745,  -745, -800,   800};
  for (auto const* text : {"x + y",
                           "x - y",
                           "2 - x",
                           "x*y*z",
                           "x*y",
                           "3*x + y",
                           "u*x + y*v",
                           "1/x",
                           "1/(x*x + u)",
                           "sqrt(x)",
                           "1/sqrt(x)",
                           "x^-3.5",
                           "x^7",
                           "x^-6",
                           "abs(x)",
                           "floor(x)",
                           "exp(x)",
                           "sinh(x) + cosh(y)",
                           "mod(x, y)",
                           "mod(u, x)",
                           "min(x, y)",
                           "max(x, y)",
                           "x < y",
                           "x <= y",
                           "x == y",
                           "x != y",
                           "x > y ? y : z",
                           "select(x, y, z)",
                           "x*y + z*exp(-x) + y",
                           "u + v",
                           "min(x, u) + max(v, y)",
                           "step(x)",
                           "exp(x)*(1 + y) + sin(z)/(2 + x)",
                           "!x || y && z"})
    for_each_width([&](auto width) { expect_same_bits<width>({text, "x"}, numbers); });
}

// More numbers at a time than there are registers: some stand in columns meanwhile.
TEST(MachineCode, GoesOnWhereRegistersAreShort) {
  std::mt19937 random(8);
  std::string sum;
  for (int k = 0; k < 40; ++k)
    sum += fmt::format("{}(x + {})*(y - {})/(z*z + {})", k ? " + " : "", k, 2 * k + 1, k + 1);
  std::vector<std::string> texts;
  for (int k = 0; k < 8; ++k) texts.push_back(fmt::format("(x + {0})*(x + {1})*({2})", k, k + 1, sum));
  for_each_width([&](auto width) {
    expect_same_bits<width>({sum}, ordinary(random));
    expect_same_bits<width>(texts, ordinary(random));
  });
}

TEST(MachineCode, IsNotMadeForOtherWidths) {
  Case const of({"x + y"});
  EXPECT_EQ(machine_code(of.program, 2), nullptr);
  EXPECT_EQ(machine_code(of.program, 0), nullptr);
}

/// From now on this process can't make pages executable, as on systems that allow it to nobody.
void refuse_executable_pages() {
  sock_filter rules[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, __NR_mprotect, 0, 3),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args) + 2 * sizeof(std::uint64_t)),
      BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, PROT_EXEC, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  sock_fprog const program{std::size(rules), rules};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0)
    std::exit(2);
}

TEST(MachineCode, IsLeftOutWherePagesMayNotBeExecuted) {
  EXPECT_EXIT(
      {
        refuse_executable_pages();
        Case const of({"x*y + exp(z)"});
        for (int const width : {4, 8})
          if (machine_code(of.program, width)) std::exit(1);
        std::exit(0);
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace boltzmann::machine_code_test
