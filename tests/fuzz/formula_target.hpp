// What reads formulas, for the fuzzer: texts as laws, diagnoses and stop conditions have them.
#pragma once

#include <string>
#include <vector>

namespace boltzmann::fuzz {

/// A text of any characters is a formula or one line with a place within it; its derivative, its program and its values
/// end well. std::logic_error if not.
void read_formula_of_any_text(std::string const& text);
/// The same; whether it has been taken for one in any way.
bool is_a_formula(std::string const& text);

/// The formulas of shipped scenarios, and some of laws, conditions and diagnoses.
std::vector<std::string> formula_seeds();

/// Words and signs of formulas.
std::vector<std::string> const& formula_words();

}  // namespace boltzmann::fuzz
