// Names of ensembles, and reading of states of diagnoses.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/chosen.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numeric>

namespace boltzmann {

AnyEnsemble const& ensemble_named(std::vector<AnyEnsemble const*> const& available, std::string const& name) {
  std::vector<std::string> known;
  for (auto const* ensemble : available) {
    if (ensemble->name() == name) return *ensemble;
    known.push_back(ensemble->name());
  }
  throw Error(fmt::format("there is no ensemble '{}'{}", name, choices(name, known)));
}

std::vector<std::string> chosen_names(std::vector<AnyEnsemble const*> const& available,
                                      std::vector<std::string> const& names) {
  if (available.empty()) throw Error("a diagnosis needs an ensemble; the simulation has none");
  for (auto const& name : names) ensemble_named(available, name);
  if (!names.empty()) return names;
  std::vector<std::string> all;
  for (auto const* ensemble : available) all.push_back(ensemble->name());
  return all;
}

std::size_t index_in(Sample const& sample, std::string const& name) {
  for (std::size_t e = 0; e < sample.ensembles.size(); ++e)
    if (sample.ensembles[e]->name() == name) return e;
  throw Error(fmt::format("a diagnosis needs ensemble '{}', which is not in the simulation", name));
}

AnyEnsemble const& ensemble_of(Sample const& sample, std::string const& name) {
  return *sample.ensembles[index_in(sample, name)];
}

void check_chosen(std::vector<AnyEnsemble const*> const& available, std::vector<std::string> const& names,
                  std::span<std::uint32_t const> particles) {
  auto const chosen = chosen_names(available, names);
  if (particles.empty()) return;
  if (chosen.size() != 1)
    throw Error(fmt::format("a group of chosen particles belongs to one ensemble; name one of {}", join(chosen)));
  for (auto const* ensemble : available)
    if (ensemble->name() == chosen.front())
      for (auto const i : particles)
        if (i >= ensemble->size())
          throw Error(fmt::format("ensemble '{}' has {} particles, numbered from 0; there is no particle {}",
                                  ensemble->name(), ensemble->size(), i));
}

void check_chosen(std::vector<AnyEnsemble const*> const& available, std::vector<std::string> const& names,
                  std::span<std::uint32_t const> particles, std::span<std::uint32_t const> partners) {
  check_chosen(available, names, particles);
  check_chosen(available, names, partners);
  if (particles.empty() && !partners.empty()) throw Error("'partners' belong to a group; choose it with 'particles'");
  std::vector<std::uint32_t> both(particles.begin(), particles.end());
  both.insert(both.end(), partners.begin(), partners.end());
  std::sort(both.begin(), both.end());
  if (auto const twice = std::adjacent_find(both.begin(), both.end()); twice != both.end())
    throw Error(fmt::format("particle {} is chosen twice; a group and its 'partners' have none in common", *twice));
}

std::vector<std::uint32_t> members_of(AnyEnsemble const& ensemble, std::span<std::uint32_t const> particles) {
  std::vector<std::uint32_t> members(particles.begin(), particles.end());
  if (members.empty()) {
    members.resize(ensemble.size());
    std::iota(members.begin(), members.end(), 0U);
  }
  if (auto const last = std::max_element(members.begin(), members.end());
      last != members.end() && *last >= ensemble.size())
    throw Error(fmt::format("a diagnosis needs particle {} of '{}', which has {} now", *last, ensemble.name(),
                            ensemble.size()));
  return members;
}

std::vector<std::string> split_names(std::string const& text) {
  std::vector<std::string> names;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t const end = std::min(text.find(',', at), text.size());
    std::string name = text.substr(at, end - at);
    name.erase(0, name.find_first_not_of(' '));
    name.erase(name.find_last_not_of(' ') + 1);
    if (!name.empty()) names.push_back(name);
    at = end + 1;
  }
  return names;
}

std::vector<Column> along_axes(std::string const& what, int axes, Dimension dimension) {
  std::vector<Column> columns;
  columns.reserve(static_cast<std::size_t>(axes));
  for (int a = 0; a < axes; ++a) columns.push_back({what + " " + "xyz"[a], dimension});
  return columns;
}

std::string labelled(std::string const& label, std::string const& what) {
  return label.empty() ? what : label + " " + what;
}

std::string file_name(std::string const& kind, std::string const& label) {
  std::string name = label.empty() ? kind : kind + "-" + label;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '.') c = '-';
  return name;
}

std::span<double const> StateReader::next(std::size_t count) {
  if (count > left_.size()) throw Error("the checkpoint does not fit this diagnosis: its state is too short");
  auto const numbers = left_.first(count);
  left_ = left_.subspan(count);
  return numbers;
}

std::vector<double> StateReader::list() {
  double const count = next();
  if (!(count >= 0 && count <= static_cast<double>(left_.size())))
    throw Error("the checkpoint does not fit this diagnosis: a list in its state has another length");
  auto const numbers = next(static_cast<std::size_t>(count));
  return {numbers.begin(), numbers.end()};
}

void StateReader::finish() const {
  if (!left_.empty()) throw Error("the checkpoint does not fit this diagnosis: its state is too long");
}

void add_list(std::vector<double>& state, std::span<double const> list) {
  state.push_back(static_cast<double>(list.size()));
  state.insert(state.end(), list.begin(), list.end());
}

}  // namespace boltzmann
