// Sums over particles, wave vector by wave vector, or all of them from a mesh.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/diagnoses/chosen.hpp>
#include <boltzmann/diagnoses/mesh_amplitudes.hpp>
#include <boltzmann/diagnoses/structure_factor.hpp>
#include <boltzmann/diagnoses/unknown.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

namespace boltzmann {
namespace {

constexpr double most_modes = 200'000, most_modes_of_mesh = 1'000'000;

double longest_side(std::span<double const> lengths) { return *std::max_element(lengths.begin(), lengths.end()); }

std::vector<double> sides_of(Box const& box) {
  std::vector<double> lengths;
  for (int a = 0; a < box.dimension(); ++a) lengths.push_back(box.length(a));
  return lengths;
}

/// |k| in units of 2 pi / longest side.
double periods(std::array<int, 3> const& mode, std::span<double const> lengths) {
  double const longest = longest_side(lengths);
  double k2 = 0;
  for (std::size_t a = 0; a < lengths.size(); ++a) k2 += std::pow(mode[a] * longest / lengths[a], 2);
  return std::sqrt(k2);
}

/// One of each pair k and -k, without 0.
std::vector<std::array<int, 3>> modes_of(std::span<double const> lengths, std::size_t periods_at_most) {
  double const longest = longest_side(lengths), limit = static_cast<double>(periods_at_most) * (1 + 1e-12);
  std::array<int, 3> most{0, 0, 0};
  for (std::size_t a = 0; a < lengths.size(); ++a) most[a] = static_cast<int>(limit * lengths[a] / longest);
  std::vector<std::array<int, 3>> modes;
  for (int x = 0; x <= most[0]; ++x)
    for (int y = x == 0 ? 0 : -most[1]; y <= most[1]; ++y)
      for (int z = x == 0 && y == 0 ? 1 : -most[2]; z <= most[2]; ++z)
        if (std::array<int, 3> const mode{x, y, z}; mode != std::array{0, 0, 0} && periods(mode, lengths) <= limit)
          modes.push_back(mode);
  return modes;
}

/// The highest number along each axis.
std::array<int, 3> most_of(std::span<std::array<int, 3> const> modes) {
  std::array<int, 3> most{0, 0, 0};
  for (auto const& mode : modes)
    for (std::size_t a = 0; a < 3; ++a) most[a] = std::max(most[a], std::abs(mode[a]));
  return most;
}

/// The rows of the groups of all ensembles.
std::vector<double const*> rows_of(std::vector<AnyEnsemble const*> const& ensembles,
                                   std::span<std::uint32_t const> group) {
  std::vector<double const*> rows;
  for (auto const* ensemble : ensembles)
    for (auto const i : members_of(*ensemble, group)) rows.push_back(ensemble->row(i));
  return rows;
}

/// exp(-2 pi i n x / L) of every particle for n = 0, 1, ... along each axis, by powers.
class Phases {
 public:
  Phases(std::vector<double const*> const& rows, Box const& box, std::array<int, 3> const& most) : size_(rows.size()) {
    for (int a = 0; a < box.dimension(); ++a) {
      auto const highest = static_cast<std::size_t>(most[static_cast<std::size_t>(a)]);
      auto& powers = powers_.emplace_back((highest + 1) * size_, 1.0);
      for (std::size_t at = 0; at < size_; ++at) {
        double const angle = -2 * std::numbers::pi * (rows[at][a] - box.low(a)) / box.length(a);
        std::complex<double> const first = std::polar(1.0, angle);
        for (std::size_t n = 1; n <= highest; ++n) powers[n * size_ + at] = times(powers[(n - 1) * size_ + at], first);
      }
    }
  }

  /// The phases along x and y of all particles, which several wave vectors share.
  struct Shared {
    int x = -1, y = 0;
    std::vector<std::complex<double>> phases = {};
  };
  /// The density's amplitude: the sum over all particles of exp(-i k r).
  std::complex<double> amplitude(std::array<int, 3> const& mode, Shared& shared) const {
    if (shared.x != mode[0] || shared.y != mode[1]) share(mode, shared);
    ExactSum re, im;
    std::complex<double> const* const last = powers_.size() > 2 ? power(2, mode[2]) : nullptr;
    double const sign = mode[2] < 0 ? -1 : 1;
    double real[ExactSum::block], imaginary[ExactSum::block];
    for (std::size_t first = 0; first < size_; first += ExactSum::block) {
      std::size_t const count = std::min(ExactSum::block, size_ - first);
      for (std::size_t k = 0; k < count; ++k) {
        std::size_t const i = first + k;
        double const a = shared.phases[i].real(), b = shared.phases[i].imag();
        double const c = last ? last[i].real() : 1, d = last ? sign * last[i].imag() : 0;
        real[k] = a * c - b * d;
        imaginary[k] = a * d + b * c;
      }
      re.add({real, count});
      im.add({imaginary, count});
    }
    return {re.value(), im.value()};
  }

 private:
  /// Without the tests of std::complex for infinite numbers.
  static std::complex<double> times(std::complex<double> a, std::complex<double> b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
  }

  std::complex<double> const* power(std::size_t axis, int n) const {
    return powers_[axis].data() + static_cast<std::size_t>(std::abs(n)) * size_;
  }
  void share(std::array<int, 3> const& mode, Shared& shared) const {
    shared.x = mode[0];
    shared.y = mode[1];
    shared.phases.assign(power(0, mode[0]), power(0, mode[0]) + size_);  // x is never negative
    if (powers_.size() < 2) return;
    std::complex<double> const* const y = power(1, mode[1]);
    for (std::size_t i = 0; i < size_; ++i)
      shared.phases[i] = times(shared.phases[i], mode[1] < 0 ? std::conj(y[i]) : y[i]);
  }

  std::size_t size_;
  std::vector<std::vector<std::complex<double>>> powers_;
};

using Amplitudes = std::vector<std::complex<double>>;

Amplitudes amplitudes_of(std::vector<double const*> const& rows, Box const& box,
                         std::span<std::array<int, 3> const> modes, WaveSums by, int threads) {
  Amplitudes all(modes.size());
  if (by == WaveSums::mesh) {
    MeshAmplitudes const mesh(rows, box, most_of(modes), threads);
    for (std::size_t m = 0; m < modes.size(); ++m) all[m] = mesh(modes[m]);
    return all;
  }
  Phases const phases(rows, box, most_of(modes));
  for_ranges(modes.size(), 16, threads_for(modes.size() * rows.size(), 1.0 / 8, threads),
             [&](std::size_t begin, std::size_t end) {
               Phases::Shared shared;
               for (std::size_t m = begin; m < end; ++m) all[m] = phases.amplitude(modes[m], shared);
             });
  return all;
}

}  // namespace

Words<WaveSums> const& wave_sums_words() {
  static Words<WaveSums> const words{"way to sum waves",
                                     {{WaveSums::direct, "direct", "one by one: exact"},
                                      {WaveSums::mesh, "mesh", "all at once by a mesh, to 1e-5, for many particles"}}};
  return words;
}

StructureFactor::StructureFactor(std::vector<AnyEnsemble const*> const& available, Options options)
    : options_(std::move(options)), label_(options_.label) {
  chosen_names(available, options_.ensembles);
  if (options_.ensembles.size() > 2)
    throw Error(
        fmt::format("a structure factor is of one ensemble or between two, not of {}", join(options_.ensembles)));
  if (options_.every < 1) throw Error("the sampling interval of a structure factor must be 1 step or more");
  if (options_.modes < 1) throw Error("a structure factor needs a wave of one period in the box or more");
  if (label_.empty())
    for (auto const& name : options_.ensembles) label_ += (label_.empty() ? "" : " ") + name;
  check_chosen(available, options_.ensembles, options_.particles, options_.partners);
  if (!options_.particles.empty() && options_.ensembles.empty()) options_.ensembles = {available.front()->name()};
}

void StructureFactor::check(Box const& box) const {
  refuse_shear(box, "structure-factor");
  for (int a = 0; a < box.dimension(); ++a)
    if (!box.periodic(a))
      throw Error(
          fmt::format("structure-factor: axis {} is not periodic, so that no wave vectors belong to it", "xyz"[a]));
  auto const sides = sides_of(box);
  double expected = 1;
  for (double const side : sides) expected *= 2 * static_cast<double>(options_.modes) * side / longest_side(sides) + 1;
  double const most = options_.by == WaveSums::mesh ? most_modes_of_mesh : most_modes;
  if (expected / 2 > most)
    throw Error(
        fmt::format("structure-factor: {:.2g} wave vectors are shorter than {} periods in the box, {:.2g} are "
                    "allowed; choose fewer 'modes'",
                    expected / 2, options_.modes, most));
}

std::vector<Column> StructureFactor::columns() const {
  return {{labelled(label_, "S peak"), dimensions::none},
          {labelled(label_, "S peak wave number"), dimensions::wave_number}};
}

void StructureFactor::measure(Sample const& sample, std::vector<double>& values) {
  if (sample.time >= options_.since && sample.step % static_cast<std::int64_t>(options_.every) == 0) {
    check(sample.box);
    auto const sides = sides_of(sample.box);
    if (looks_ == 0) {
      modes_ = modes_of(sides, options_.modes);
      sums_.assign(modes_.size(), 0.0);
      lengths_.assign(sides.size(), 0.0);
    }
    ++looks_;
    for (std::size_t a = 0; a < sides.size(); ++a)
      lengths_[a] += (sides[a] - lengths_[a]) / static_cast<double>(looks_);
    auto const& names = options_.ensembles;
    std::vector<AnyEnsemble const*> first, second;
    if (names.empty())
      first.assign(sample.ensembles.begin(), sample.ensembles.end());
    else
      first.push_back(&ensemble_of(sample, names[0]));
    bool const between = !options_.partners.empty() || (names.size() == 2 && names[0] != names[1]);
    if (between) second.push_back(&ensemble_of(sample, names.back()));
    auto const rows = rows_of(first, options_.particles), others = rows_of(second, options_.partners);
    auto const rho = amplitudes_of(rows, sample.box, modes_, options_.by, sample.threads);
    auto const of_second =
        between ? amplitudes_of(others, sample.box, modes_, options_.by, sample.threads) : Amplitudes();
    double const number = between ? std::sqrt(static_cast<double>(rows.size()) * static_cast<double>(others.size()))
                                  : static_cast<double>(rows.size());
    for (std::size_t m = 0; m < modes_.size(); ++m)
      sums_[m] += (between ? (rho[m] * std::conj(of_second[m])).real() : std::norm(rho[m])) / number;
  }
  auto const found = shells();
  auto const highest = std::max_element(found.s.begin(), found.s.end());
  if (highest == found.s.end())
    values.insert(values.end(), {unknown, unknown});
  else
    values.insert(values.end(), {*highest, found.wave_number[static_cast<std::size_t>(highest - found.s.begin())]});
}

std::vector<double> StructureFactor::s_of_modes() const {
  std::vector<double> s;
  for (double const sum : sums_) s.push_back(sum / static_cast<double>(looks_));
  return s;
}

/// Shells with a thickness of half the shortest wave vector.
StructureFactor::Shells StructureFactor::shells() const {
  Shells shells;
  if (looks_ == 0) return shells;
  auto const s = s_of_modes();
  std::vector<double> sums(2 * options_.modes + 2, 0.0), numbers = sums, lengths = sums;
  for (std::size_t m = 0; m < modes_.size(); ++m) {
    double const k = periods(modes_[m], lengths_);
    auto const shell = std::min(static_cast<std::size_t>(2 * k + 0.5), sums.size() - 1);
    sums[shell] += s[m];
    numbers[shell] += 1;
    lengths[shell] += k;
  }
  double const unit = 2 * std::numbers::pi / longest_side(lengths_);
  for (std::size_t shell = 0; shell < sums.size(); ++shell) {
    if (numbers[shell] == 0) continue;
    shells.wave_number.push_back(unit * lengths[shell] / numbers[shell]);
    shells.s.push_back(sums[shell] / numbers[shell]);
    shells.vectors.push_back(numbers[shell]);
  }
  return shells;
}

std::vector<GatheredTable> StructureFactor::tables() const {
  Shells found = shells();
  return {{file_name("structure-factor", label_),
           {{"wave number", dimensions::wave_number}, {"S", dimensions::none}, {"wave vectors", dimensions::none}},
           {std::move(found.wave_number), std::move(found.s), std::move(found.vectors)}}};
}

std::vector<double> StructureFactor::state() const {
  std::vector<double> state{static_cast<double>(looks_)};
  add_list(state, lengths_);
  for (auto const& mode : modes_) state.insert(state.end(), mode.begin(), mode.end());
  state.insert(state.end(), sums_.begin(), sums_.end());
  return state;
}

void StructureFactor::restore(std::span<double const> state) {
  StateReader reader(state);
  looks_ = static_cast<std::size_t>(reader.next());
  lengths_ = reader.list();
  std::size_t const modes = (state.size() - 2 - lengths_.size()) / 4;
  modes_.clear();
  for (std::size_t m = 0; m < modes; ++m) {
    auto const mode = reader.next(3);
    modes_.push_back({static_cast<int>(mode[0]), static_cast<int>(mode[1]), static_cast<int>(mode[2])});
  }
  auto const sums = reader.next(modes);
  sums_.assign(sums.begin(), sums.end());
  reader.finish();
}

}  // namespace boltzmann
