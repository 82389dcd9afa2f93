// What reads formulas, for the fuzzer: texts as laws, diagnoses and stop conditions have them.
#pragma once

#include <string>
#include <vector>

namespace boltzmann::fuzz {

/// A text of any characters is a formula or one line with a place within it; its derivative, its program and its values
/// end well.
void read_formula_of_any_text(std::string const& text);

/// Words and signs of formulas.
std::vector<std::string> const& formula_words();

}  // namespace boltzmann::fuzz
