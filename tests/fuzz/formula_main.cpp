// Reads very many texts as formulas: `fuzz_formulas TEXTS [SEED]`. A program of its own, so that a build with sanitizers
// compiles the reader of formulas and not all of Boltzmann.
#include "formula_target.hpp"
#include "mutator.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>

/// Where all memory comes from is written down for each block by default, and freed blocks fill the caches: a third of the
/// time. A text that is a defect is found again by its seed, with ASAN_OPTIONS=malloc_context_size=30.
extern "C" char const* __asan_default_options() {
  return "malloc_context_size=1:quarantine_size_mb=16:thread_local_quarantine_size_kb=64";
}

constexpr std::size_t kept = 2000, longest_kept = 300;
constexpr long told = 10000;  // texts from line to line

int main(int count, char** words) {
  using Clock = std::chrono::steady_clock;
  using namespace boltzmann::fuzz;
  long const texts = count > 1 ? std::atol(words[1]) : 0;
  if (texts <= 0) {
    std::fprintf(stderr, "fuzz_formulas TEXTS [SEED]: how many texts?\n");
    return 2;
  }
  auto pool = formula_seeds();
  std::size_t const seeds = pool.size();
  Mutator mutator(pool, formula_words(), count > 2 ? std::strtoull(words[2], nullptr, 10) : 1);
  auto const start = Clock::now();
  double longest = 0;
  std::size_t taken = 0;
  // What is a formula is changed again, so that texts become other than those at the beginning.
  auto const keep = [&](std::string const& text) {
    if (text.size() <= longest_kept) {
      if (pool.size() < seeds + kept)
        pool.push_back(text);
      else
        pool[seeds + taken % kept] = text;
    }
    ++taken;
  };
  auto const tell = [&](long done) {
    double const seconds = std::chrono::duration<double>(Clock::now() - start).count();
    std::printf("%ld texts, of which %zu are formulas, in %.0f s, %.0f a second, the longest %.3f s of CPU time\n",
                done, taken, seconds, static_cast<double>(done) / seconds, longest);
    std::fflush(stdout);
  };
  for (long k = 0; k < texts; ++k) {
    auto const text = mutator.next();
    std::clock_t const begin = std::clock();  // a busy machine makes no text long
    try {
      if (is_a_formula(text)) keep(text);
    } catch (std::exception const& error) {
      std::fprintf(stderr, "%s\nfrom text %ld:\n%s\n", error.what(), k, text.c_str());
      return 1;
    }
    if (double const took = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC; took > longest) {
      longest = took;
      if (took > 1) std::printf("%.1f s: %s\n", took, text.c_str());
    }
    if ((k + 1) % told == 0 || k + 1 == texts) tell(k + 1);
  }
  return 0;
}
