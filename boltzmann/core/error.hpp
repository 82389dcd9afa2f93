// Errors: mistakes in the input and failures of the physics, each as one readable line.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace boltzmann {

/// The user's input is invalid. The message is one line: what was found, where, what is allowed. Exit status 2 of
/// `bzm`.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The physics failed during a run (NaN, a particle escaped, a step too large). The line names particle and step. Exit
/// status 3 of `bzm`.
struct PhysicsFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The candidate with the smallest edit distance to `word` (ignoring case) of at most a third of the longer word + 1, and
/// at most half of it; else the shortest that begins with three letters or more of it; else "".
std::string nearest(std::string_view word, std::span<std::string const> candidates);

/// "; did you mean 'cutoff'?" for the nearest candidate, "" if none is near.
std::string did_you_mean(std::string_view word, std::span<std::string const> candidates);

/// The end of a message about an unknown word: a suggestion, at most eight of the valid words, and where all are listed,
/// "; did you mean 'b'? There are a, b, ... and 25 more (bzm list letters)". If there are only a few words it is
/// "; there are a, b; did you mean 'b'?". `verb` is "there are", "it has" or "allowed are", `where` "bzm list letters".
std::string choices(std::string_view word, std::span<std::string const> names, std::string_view verb = "there are",
                    std::string_view where = "");
/// The same with a given hint, in the form that did_you_mean() returns.
std::string choices_with(std::string_view hint, std::span<std::string const> names, std::string_view verb = "there are",
                         std::string_view where = "");
/// The greatest number of names in a message. Tests that compare all names raise it.
inline std::size_t most_names = 8;

/// A text of a user's file for a message, without its quotation marks: at most 40 letters, "?" for unprintable bytes.
std::string quoted(std::string_view text);

/// "a, b, c": the allowed words for a message; of a long list only the first ("a, b and 97 more").
std::string some_of(std::span<std::string const> words);
/// "a, b, c", all of them.
std::string join(std::span<std::string const> words, std::string_view separator = ", ");

}  // namespace boltzmann
