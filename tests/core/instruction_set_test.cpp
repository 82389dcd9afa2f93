// Instruction sets: the choice among them, and what the build has put into which object: nothing that an old processor
// can't run where it could come to it.
#include "tests/message.hpp"

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/instruction_set.hpp>

#include <cxxabi.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace boltzmann::instruction_set_test {
namespace {

using enum InstructionSet;

std::vector<InstructionSet> const every = {x86_64, x86_64_v3, x86_64_v4};

TEST(InstructionSet, TheBestOneUnlessTheEnvironmentNamesAnother) {
  EXPECT_EQ(detail::choose_instruction_set(nullptr, every, every), x86_64_v4);
  EXPECT_EQ(detail::choose_instruction_set("", every, {x86_64, x86_64_v3}), x86_64_v3);
  EXPECT_EQ(detail::choose_instruction_set(nullptr, every, {x86_64}), x86_64);
  EXPECT_EQ(detail::choose_instruction_set("x86-64", every, every), x86_64);
  EXPECT_EQ(detail::choose_instruction_set("x86-64-v3", every, every), x86_64_v3);
  EXPECT_EQ(detail::choose_instruction_set("native", {native}, {native}), native);
}

TEST(InstructionSet, WrongWordsAreSaidWithTheAllowedOnes) {
  std::vector<InstructionSet> const older = {x86_64, x86_64_v3};
  EXPECT_EQ(message([&] { detail::choose_instruction_set("x86-64-v5", every, older); }),
            "BOLTZMANN_INSTRUCTIONS is 'x86-64-v5', which is no instruction set of this library; there are x86-64, "
            "x86-64-v3; did you mean 'x86-64-v3'?");
  EXPECT_EQ(message([&] { detail::choose_instruction_set("x86-64-v4", every, older); }),
            "BOLTZMANN_INSTRUCTIONS requests x86-64-v4, which this processor can't run; it can run x86-64, x86-64-v3");
  EXPECT_EQ(message([] { detail::choose_instruction_set("sse", {native}, {native}); }),
            "BOLTZMANN_INSTRUCTIONS is 'sse', which is no instruction set of this library; the only one is native");
}

TEST(InstructionSet, AProgramOfAnotherMachineIsRefused) {
  EXPECT_EQ(message([] { detail::choose_instruction_set(nullptr, {x86_64_v4}, {}); }),
            "this library was compiled for x86-64-v4 only, which this processor can't run; `make install` and packages "
            "serve every x86-64");
}

TEST(InstructionSet, TheOneInUseIsAmongThoseThatThisProcessorHas) {
  auto const sets = instruction_sets();
  ASSERT_FALSE(sets.empty());
  if (!std::getenv("BOLTZMANN_INSTRUCTIONS")) {
    EXPECT_EQ(instruction_set(), sets.back());
  }
#if defined(__x86_64__) && !defined(__clang__)  // whatever the tests are compiled for
  if (__builtin_cpu_supports("x86-64-v4")) {
    EXPECT_TRUE(sets.back() == x86_64_v4 || sets.back() == native);
  } else if (__builtin_cpu_supports("x86-64-v3")) {
    EXPECT_TRUE(sets.back() == x86_64_v3 || sets.back() == native);
  }
#endif
}

#ifdef BOLTZMANN_ALL_SETS  // a library for one machine has no sets to be kept apart

/// The objects of CMake's target; none if the library was built for one machine.
std::vector<std::string> objects_of(std::string const& target) {
  std::vector<std::string> objects;
  std::ifstream list(std::string(BOLTZMANN_BUILD) + "/objects/" + target + ".txt");
  for (std::string line; std::getline(list, line);) objects.push_back(line);
  return objects;
}

/// Calls take(line) for each line that the command prints about the objects.
void each_line(std::string const& command, std::function<void(std::string const&)> const& take) {
  FILE* const pipe = popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  char* line = nullptr;
  std::size_t room = 0;
  for (ssize_t length; (length = getline(&line, &room, pipe)) > 0;)
    take(std::string(line, static_cast<std::size_t>(length - 1)));
  std::free(line);
  EXPECT_EQ(pclose(pipe), 0) << command;
}

std::string quoted(std::vector<std::string> const& objects) {
  std::string words;
  for (auto const& object : objects) words += " '" + object + "'";
  return words;
}

/// Names that the linker may take for the same name in other objects.
std::set<std::string> symbols_of(std::vector<std::string> const& objects) {
  std::set<std::string> names;
  each_line("nm -P -g --defined-only" + quoted(objects),
            [&](std::string const& line) {  // "name type value size", "file:"
              auto const end = line.find(' ');
              if (end != std::string::npos) names.insert(line.substr(0, end));
            });
  return names;
}

std::string readable(std::string const& symbol) {
  int status = 0;
  char* const text = abi::__cxa_demangle(symbol.c_str(), nullptr, nullptr, &status);
  std::string const result = status == 0 ? text : symbol;
  std::free(text);
  return result;
}

std::string common(std::set<std::string> const& a, std::set<std::string> const& b) {
  std::string lines;
  for (auto const& name : a)
    if (b.contains(name)) lines += "\n  " + readable(name);
  return lines;
}

// A function that two objects define is taken from either: from the one with AVX-512, and a processor without dies.
TEST(Objects, KernelUnitsShareNoFunctionWithOtherSetsNorWithOrdinaryUnits) {
  std::map<std::string, std::set<std::string>> symbols;
  for (std::string const set : {"x86_64", "x86_64_v3", "x86_64_v4"}) {
    symbols[set] = symbols_of(objects_of("kernels_" + set));
    EXPECT_GT(symbols[set].size(), 100U) << set;
  }
  auto ordinary = symbols_of(objects_of("boltzmann"));
  EXPECT_GT(ordinary.size(), 1000U);
  for (auto const* target : {"boltzmann_cold", "bzm"}) ordinary.merge(symbols_of(objects_of(target)));
  EXPECT_EQ(common(symbols["x86_64"], symbols["x86_64_v3"]), "");
  EXPECT_EQ(common(symbols["x86_64"], symbols["x86_64_v4"]), "");
  EXPECT_EQ(common(symbols["x86_64_v3"], symbols["x86_64_v4"]), "");
  EXPECT_EQ(common(symbols["x86_64_v3"], ordinary), "");
  EXPECT_EQ(common(symbols["x86_64_v4"], ordinary), "");
}

/// Functions with AVX in any of its forms (xmm under a mnemonic with v is AVX too), FMA, BMI or MOVBE, and how many
/// instructions name a register of 512 bits.
struct Advanced {
  std::set<std::string> functions;
  std::size_t lines = 0, zmm = 0;
};
Advanced advanced_in(std::vector<std::string> const& objects) {
  Advanced found;
  std::string file, function;
  static std::set<std::string> const bits = {"andn", "bextr", "blsi", "blsmsk", "blsr", "bzhi",  "mulx", "pdep",
                                             "pext", "rorx",  "sarx", "shlx",   "shrx", "lzcnt", "movbe"};
  auto const is_bits = [](std::string mnemonic) {
    if (bits.contains(mnemonic)) return true;
    if (!mnemonic.empty() && std::string("lqw").find(mnemonic.back()) != std::string::npos) mnemonic.pop_back();
    return bits.contains(mnemonic);
  };
  // objdump takes a time that grows as the square of the number of sections: each object gets one.
  std::string const disassemble =
      "t=$(mktemp -d) && trap 'rm -r $t' EXIT && echo 'SECTIONS { .text : { *(.text .text.*) } }' > $t/script && "
      "for o in" +
      quoted(objects) +
      "; do ld -r --force-group-allocation -T $t/script $o -o $t/${o##*/} && objdump -d --no-show-raw-insn "
      "$t/${o##*/} || exit; rm $t/${o##*/}; done";
  each_line(disassemble, [&](std::string const& line) {
    if (line.empty()) return;
    if (auto const at = line.find(":     file format"); at != std::string::npos)
      file = line.substr(line.rfind('/', at) + 1, at - line.rfind('/', at) - 1);
    if (line.back() == ':') {
      auto const from = line.find('<');
      if (from != std::string::npos) function = line.substr(from + 1, line.size() - from - 3);
      return;
    }
    auto const tab = line.find('\t');
    if (tab == std::string::npos) return;
    ++found.lines;
    std::string const instruction = line.substr(tab + 1);
    bool const vector = instruction.find("mm") != std::string::npos && instruction.find('%') != std::string::npos;
    bool const avx = vector && (instruction[0] == 'v' || instruction.find("%ymm") != std::string::npos ||
                                instruction.find("%zmm") != std::string::npos);
    if (avx || is_bits(instruction.substr(0, instruction.find(' '))))
      found.functions.insert(file + ": " + readable(function));
    if (instruction.find("%zmm") != std::string::npos) ++found.zmm;
  });
  return found;
}

TEST(Objects, OnlyKernelsOfASetHaveItsInstructions) {
  for (auto const* target : {"boltzmann", "boltzmann_cold", "bzm", "kernels_x86_64"}) {
    auto const objects = objects_of(target);
    ASSERT_FALSE(objects.empty()) << target;
    auto const found = advanced_in(objects);
    EXPECT_GT(found.lines, 10000U) << target;
    std::string names;
    for (auto const& name : found.functions) names += "\n  " + name;
    EXPECT_EQ(names, "") << target;
  }
  auto const v3 = advanced_in(objects_of("kernels_x86_64_v3")), v4 = advanced_in(objects_of("kernels_x86_64_v4"));
  EXPECT_GT(v3.functions.size(), 100U);
  EXPECT_EQ(v3.zmm, 0U);
  EXPECT_GT(v4.zmm, 10000U);
}

#endif

}  // namespace
}  // namespace boltzmann::instruction_set_test
