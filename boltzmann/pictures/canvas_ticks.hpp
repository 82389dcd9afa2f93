// Ticks: positions and labels of the marks of an axis.
#pragma once

#include <string>
#include <vector>

namespace boltzmann {

/// The marks of one axis. `labels[i]` belongs to `major[i]`. The value at a mark is its label, followed by the text
/// `multiplier` ("×10^{−8}", or "×10^{−9} + 1.25" if all labels share leading digits), which is written once per axis
/// and may be empty. Superscripts are written ^{...}, minus signs are U+2212.
struct Ticks {
  std::vector<double> major;
  std::vector<double> minor;
  std::vector<std::string> labels;
  std::string multiplier;
  int exponent = 0;  // the power of ten in the multiplier
};

/// At most `most` (>= 2) major ticks inside low..high at steps of 1, 2 or 5 times a power of ten. On a logarithmic
/// axis: decades, or every second, third, ... decade; 1-2-5 within less than two decades; linear steps within a
/// fraction of a decade. Requires finite low < high, on a logarithmic axis low > 0; otherwise there are no ticks.
/// `at_most_exponent` limits the power of ten in the multiplier, so that two axes can share one.
Ticks ticks_between(double low, double high, bool logarithmic = false, int most = 8, int at_most_exponent = 400);

/// A number in a few characters of markup: "0.25", "3200", "−1.6×10^{−19}"; digits = significant digits.
std::string number_text(double value, int digits = 3);

}  // namespace boltzmann
