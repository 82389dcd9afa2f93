// For libFuzzer: BOLTZMANN_FUZZ_TARGET chooses what is fuzzed, and its first run leaves the seeds in the corpus that is
// named last on the command line.
#include "targets.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>

namespace {

boltzmann::fuzz::Target const* chosen = nullptr;

// Which edges a case has taken: the compiler calls below with each block of code that it enters, and libFuzzer reads
// these counters.
__attribute__((section("__libfuzzer_extra_counters"))) std::uint8_t counters[1U << 16U];

}  // namespace

extern "C" {

__attribute__((no_sanitize("address", "undefined"))) void __sanitizer_cov_trace_pc() {
  auto const place = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0));
  ++counters[(place ^ place >> 16U) & 0xffffU];
}

int LLVMFuzzerInitialize(int* count, char*** words) {
  char const* const name = std::getenv("BOLTZMANN_FUZZ_TARGET");
  try {
    chosen = &boltzmann::fuzz::target(name ? name : "scenario");
    std::string const corpus = *count > 1 ? (*words)[*count - 1] : "";
    int k = 0;
    if (!corpus.empty() && std::filesystem::is_directory(corpus))
      for (auto const& seed : chosen->seeds())
        std::ofstream(corpus + "/seed-" + std::to_string(k++), std::ios::binary) << seed;
  } catch (std::exception const& error) {
    std::fprintf(stderr, "%s\n", error.what());
    std::exit(2);
  }
  return 0;
}

int LLVMFuzzerTestOneInput(std::uint8_t const* bytes, std::size_t size) {
  chosen->read({reinterpret_cast<char const*>(bytes), size});
  return 0;
}

}  // extern "C"
