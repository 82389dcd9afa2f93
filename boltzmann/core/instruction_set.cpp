// Asks the processor, then the environment.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/instruction_set.hpp>

#include <algorithm>
#include <cstdlib>
#include <string_view>

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

std::vector<InstructionSet> instruction_sets() {
#if defined(BOLTZMANN_SEVERAL_SETS)
  __builtin_cpu_init();
  std::vector<InstructionSet> sets = {InstructionSet::x86_64};
  bool const v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
                  __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("f16c") && __builtin_cpu_supports("lzcnt") &&
                  __builtin_cpu_supports("movbe");
  bool const v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl");
  if (v3) sets.push_back(InstructionSet::x86_64_v3);
  if (v4) sets.push_back(InstructionSet::x86_64_v4);
  return sets;
#else
  return {InstructionSet::native};
#endif
}

InstructionSet instruction_set() {
  static InstructionSet const chosen =
      detail::choose_instruction_set(std::getenv("BOLTZMANN_INSTRUCTIONS"), instruction_sets());
  return chosen;
}

InstructionSet detail::choose_instruction_set(char const* word, std::vector<InstructionSet> const& available) {
  if (!word || !*word) return available.back();
  std::vector<std::string> words;
  for (auto const set : available) words.push_back(to_string(set));
  auto const at = std::find(words.begin(), words.end(), word);
  if (at != words.end()) return available[static_cast<std::size_t>(at - words.begin())];
  for (auto const set : {InstructionSet::x86_64_v3, InstructionSet::x86_64_v4})
    if (available.front() == InstructionSet::x86_64 && to_string(set) == word)
      throw Error("BOLTZMANN_INSTRUCTIONS asks for " + to_string(set) +
                  ", which this processor can't run; it can run " + join(words));
  throw Error("BOLTZMANN_INSTRUCTIONS is '" + std::string(word) + "', which is no instruction set of this library; " +
              (words.size() == 1 ? "the only one is " : "there are ") + join(words) + did_you_mean(word, words));
}

}  // namespace boltzmann
