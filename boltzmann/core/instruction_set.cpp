// Queries the processor, then the environment.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/instruction_set.hpp>

#if defined(__x86_64__)
#include <cpuid.h>
#endif

#include <algorithm>
#include <cstdlib>
#include <kernel_sets.hpp>

namespace boltzmann {

std::string to_string(InstructionSet set) {
  switch (set) {
    case InstructionSet::native:
      return "native";
    case InstructionSet::x86_64:
      return "x86-64";
    case InstructionSet::x86_64_v3:
      return "x86-64-v3";
    case InstructionSet::x86_64_v4:
      return "x86-64-v4";
  }
  return "";
}

namespace {
bool can_run(InstructionSet set) {
#if defined(__x86_64__)
  __builtin_cpu_init();
  unsigned a = 0, b = 0, basic = 0, extended = 0, d = 0;  // three instructions that some compilers have no builtin for
  __get_cpuid(1, &a, &b, &basic, &d);
  __get_cpuid(0x80000001, &a, &b, &extended, &d);
  bool const v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
                  __builtin_cpu_supports("bmi2") && (basic & bit_F16C) && (basic & bit_MOVBE) && (extended & bit_LZCNT);
  if (set == InstructionSet::x86_64_v3) return v3;
  if (set == InstructionSet::x86_64_v4)
    return v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
#endif
  return set == InstructionSet::native || set == InstructionSet::x86_64;
}
}  // namespace

std::vector<InstructionSet> compiled_instruction_sets() { return {BOLTZMANN_KERNEL_SETS}; }

std::vector<InstructionSet> instruction_sets() {
  auto sets = compiled_instruction_sets();
  std::erase_if(sets, [](InstructionSet set) { return !can_run(set); });
  return sets;
}

InstructionSet instruction_set() {
  static InstructionSet const chosen = detail::choose_instruction_set(std::getenv("BOLTZMANN_INSTRUCTIONS"),
                                                                      compiled_instruction_sets(), instruction_sets());
  return chosen;
}

InstructionSet detail::choose_instruction_set(char const* word, std::vector<InstructionSet> const& compiled,
                                              std::vector<InstructionSet> const& available) {
  auto const words_of = [](std::vector<InstructionSet> const& sets) {
    std::vector<std::string> words;
    for (auto const set : sets) words.push_back(to_string(set));
    return words;
  };
  auto const all = words_of(compiled), words = words_of(available);
  if (available.empty())
    throw Error("this library was compiled for " + join(all) +
                " only, which this processor can't run; `make install` and packages serve every x86-64");
  if (!word || !*word) return available.back();
  auto const at = std::find(words.begin(), words.end(), word);
  if (at != words.end()) return available[static_cast<std::size_t>(at - words.begin())];
  if (std::find(all.begin(), all.end(), word) != all.end())
    throw Error("BOLTZMANN_INSTRUCTIONS requests " + std::string(word) +
                ", which this processor can't run; it can run " + join(words));
  throw Error("BOLTZMANN_INSTRUCTIONS is '" + std::string(word) + "', which is no instruction set of this library; " +
              (words.size() == 1 ? "the only one is " : "there are ") + join(words) + did_you_mean(word, words));
}

}  // namespace boltzmann
