// A mesh with the optimal influence function, a pair scheme over copies of the particles, and the choice of parameters
// of both.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/fourier.hpp>
#include <boltzmann/core/kernel_dispatch.hpp>
#include <boltzmann/laws/ewald_short.hpp>
#include <boltzmann/schemes/mesh/p3m_scheme.hpp>
#include <boltzmann/schemes/mesh/point_source.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr double max_growth_of_error = 1.5;  // in a box that changes
/// The choice affects the bits of results, so it must not depend on the threads of the machine or of a rank.
constexpr int typical_threads = 2;

}  // namespace

/// All particles as point sources, and their pair scheme.
struct P3MScheme::Near {
  std::unique_ptr<AnyEnsemble> sources;
  int amount;  ///< offset of the strength in a row
  PairScheme scheme;
  std::unique_ptr<Division> division;  ///< by the lists of the sources alone, independent of the owners of particles

  Near(std::unique_ptr<AnyEnsemble> ensemble, int amount, Box const& box, EwaldShort const& law, double cutoff)
      : sources(std::move(ensemble)), amount(amount), scheme(box, cutoff) {
    PairKernels const kernels =
        for_instruction_set([&](auto set) { return ewald_kernels<decltype(set)::value>().of[box.dimension() - 1]; });
    scheme.add_pairs(*sources, *sources, kernels, PairScheme::keep(law), PairScheme::traits_of(law), cutoff);
    scheme.shifted(false);  // the mesh adds the rest of the energy
  }

  template <int D>
  static std::unique_ptr<Near> make(Box const& box, EwaldShort const& law, double cutoff) {
    return std::make_unique<Near>(std::make_unique<Ensemble<PointSource<D>>>("sources"),
                                  offset_of<PointSource<D>>(&PointSource<D>::amount), box, law, cutoff);
  }

  /// From now on divides the work among this team, each rank of which has all sources; null: no longer.
  void divide(Team* team) {
    if (!team) {
      if (!division || !division->goes_on()) return;
      scheme.divide(nullptr);
      return division->end();
    }
    if (division && division->goes_on()) return;
    if (!division || &division->team() != team || division->owners(*sources).size() != sources->size()) {
      division = std::make_unique<Division>(*team);
      division->add(*sources);
    }
    division->begin();
    scheme.divide(division.get());
  }
};

P3MScheme::P3MScheme(Box box, LaplaceLaw const& law, double accuracy)
    : MeshScheme(box, std::vector<std::size_t>(static_cast<std::size_t>(box.dimension()), 8), law),
      near_law_(law),
      accuracy_(accuracy) {
  for (int a = 0; a < box.dimension(); ++a)
    if (!box.periodic(a))
      throw Error(
          fmt::format("P3M: axis {} of the box is {}; mesh and pairs are put together in boxes that are periodic "
                      "in every direction",
                      "xyz"[a], to_string(box.boundary(a))));
  if (!(accuracy >= 1e-10 && accuracy <= 0.1))
    throw Error(fmt::format("P3M: an accuracy of {}; it must be between 1e-10 and 0.1", accuracy));
  chosen_by_accuracy();
}

P3MScheme::~P3MScheme() = default;

P3mSystem P3MScheme::system() const {
  P3mSystem system;
  system.dimension = box().dimension();
  for (int a = 0; a < system.dimension; ++a) system.edges[a] = box().length(a);
  system.constant = near_law_.constant;
  ExactSum squares, strengths;
  for (auto const* ensemble : Scheme::ensembles())
    for (double const s : this->strengths(*ensemble)) {
      if (s != 0) ++system.particles;
      squares += s * s;
      strengths += s;
    }
  system.sum_of_squares = squares.value();
  system.sum_of_strengths = strengths.value();
  return system;
}

void P3MScheme::choose(P3mParameters const& parameters) {
  parameters_ = parameters;
  int const D = box().dimension();
  EwaldShort const law{near_law_.constant, parameters.alpha};
  near_ = D == 1   ? Near::make<1>(box(), law, parameters.cutoff)
          : D == 2 ? Near::make<2>(box(), law, parameters.cutoff)
                   : Near::make<3>(box(), law, parameters.cutoff);
  if (quantum_ > 0) near_->scheme.make_reversible(quantum_);
  solve_in_this_box();
}

void P3MScheme::solve_in_this_box() {
  int const D = box().dimension();
  std::array<double, 3> edges{1, 1, 1};
  for (int a = 0; a < D; ++a) edges[a] = box().length(a);
  auto const& [order, cells, alpha, cutoff, error_near, error_mesh] = parameters_;
  auto influence = std::make_shared<P3mInfluence>(D, edges, order, cells, alpha);
  solve_by({cells.begin(), cells.begin() + D}, order,
           [influence](std::array<double, 3> const& k) { return (*influence)(k); });
  energy_terms_.reset();
}

void P3MScheme::box_changed() {
  pairs().box().edges(box().edges());
  pairs().box_changed();
  if (!near_) return;
  near_->scheme.box().edges(box().edges());
  near_->scheme.box_changed();
  solve_in_this_box();
}

bool P3MScheme::box_settled() {
  if (!tuned_ || parameters_.error_mesh == 0) return false;  // without strengths there is no error
  P3mSystem const system = this->system();
  double const chosen = std::hypot(parameters_.error_near, parameters_.error_mesh);
  double const error = std::hypot(p3m_error_near(system, parameters_.alpha, parameters_.cutoff),
                                  p3m_error_mesh(system, parameters_.order, parameters_.cells, parameters_.alpha));
  if (error <= max_growth_of_error * chosen) return false;
  try {
    choose(tune_p3m(system, chosen, typical_threads));
  } catch (Error const& refusal) {
    throw PhysicsFailure(fmt::format("the box has changed, and its mesh can't be chosen anew: {}", refusal.what()));
  }
  return true;
}

void P3MScheme::tune() {
  if (tuned_) return;
  P3mSystem const system = this->system();
  int const D = system.dimension;
  // The force between two mean strengths at the mean distance.
  double const particles = std::max<double>(1, static_cast<double>(system.particles));
  double const distance = std::pow(box().volume() / particles, 1.0 / D);
  double const mean = std::abs(system.constant) * system.sum_of_squares / particles /
                      (D == 1   ? 2
                       : D == 2 ? 2 * pi * distance
                                : 4 * pi * distance * distance);
  if (!(mean > 0)) {  // there are no particles with a strength
    P3mSystem one = system;
    one.particles = 2, one.sum_of_squares = 2;
    choose(tune_p3m(one, 1e-3 * std::abs(system.constant) / std::pow(box().volume(), (D - 1.0) / D), typical_threads));
    tuned_ = true;
    return;
  }
  // A first choice of parameters measures the forces. (Only those of this law: other influences are irrelevant.)
  choose(tune_p3m(system, 0.01 * mean, typical_threads));
  copy_particles();
  near_->scheme.calculate();
  MeshField const& field = *MeshScheme::mesh_fields().back();
  ExactSum squares;
  std::vector<double> E;
  std::size_t at = 0;
  for (auto* ensemble : Scheme::ensembles()) {
    MeshScheme::interpolate(field, *ensemble, E);
    auto const strengths = this->strengths(*ensemble);
    for (std::size_t i = 0; i < ensemble->size(); ++i, ++at)
      for (int a = 0; a < D; ++a)
        squares += square(strengths[i] * E[i * static_cast<std::size_t>(D) + static_cast<std::size_t>(a)] +
                          near_->sources->influence(at)[a]);
  }
  double const rms = std::sqrt(squares.value() / particles);
  double const scale = std::isfinite(rms) && rms > 0.05 * mean ? rms : mean;
  choose(tune_p3m(system, accuracy_ * scale, typical_threads));
  tuned_ = true;  // set last, so that a choice interrupted by an exception is repeated
}

P3mParameters const& P3MScheme::parameters() {
  tune();
  return parameters_;
}

void P3MScheme::copy_particles() {
  std::size_t total = 0;
  for (auto const* ensemble : Scheme::ensembles()) total += ensemble->size();
  AnyEnsemble& sources = *near_->sources;
  if (sources.size() != total) sources.resize(total);
  std::size_t at = 0;
  for (auto const* ensemble : Scheme::ensembles()) {
    auto const strengths = this->strengths(*ensemble);
    for_ranges(ensemble->size(), 4096, threads(), [&, at](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        std::copy_n(ensemble->row(i), box().dimension(), sources.row(at + i));
        sources.row(at + i)[near_->amount] = strengths[i];
      }
    });
    at += ensemble->size();
  }
  near_->scheme.threads(threads());
}

void P3MScheme::divide(Division* division) {
  MeshScheme::divide(division);
  if (!division && near_) near_->divide(nullptr);
}

/// Copies the current particles. In a divided run, in which all ranks have them, the sources are divided from now on.
void P3MScheme::update_sources() {
  copy_particles();
  if (division()) near_->divide(&division()->team());
}

std::vector<MeshField const*> P3MScheme::mesh_fields() {
  tune();
  return MeshScheme::mesh_fields();
}

void P3MScheme::add_influences(double time) {
  if (division()) division()->make_whole();
  tune();
  MeshScheme::add_influences(time);
  update_sources();
  near_->scheme.calculate(time);
  AnyEnsemble& sources = *near_->sources;
  if (division()) {
    division()->team().meet(Team::Occasion::exchanges);
    near_->division->gather(sources, sources.influence(0), sources.influence_size(), sources.influence_size());
  }
  std::size_t at = 0;
  for (auto* ensemble : Scheme::ensembles()) {
    for_share(*ensemble, 4096, threads_for(ensemble->size(), 1, threads()), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        for (int a = 0; a < box().dimension(); ++a) ensemble->influence(i)[a] += sources.influence(at + i)[a];
    });
    at += ensemble->size();
  }
}

void P3MScheme::add_virial(MeshField const& density, MeshField const& potential, MeshField const&,
                           EnergyAndVirial& measures) const {
  // Each wave has the energy E_k = C |rho_k|^2 exp(-k^2/4 alpha^2) / (2 k^2 V). Its derivative with respect to a strain
  // of waves and volume (Essmann et al. 1995, eq. 2.7) is E_k (delta_ab - 2 (1/k^2 + 1/4 alpha^2) k_a k_b). Density and
  // potential are transformed as one complex field F: rho_k phi_-k + rho_-k phi_k = Im(F_k F_-k).
  MeshGrid const& grid = density.grid;
  auto const& n = grid.nodes;
  std::size_t const nodes = grid.size();
  FourierArray field(2 * nodes), waves(2 * nodes);
  for (std::size_t i = 0; i < nodes; ++i) {
    field[2 * i] = density.components[0][i];
    field[2 * i + 1] = potential.components[0][i];
  }
  std::size_t lines = 1;
  for (int a = 0; a < grid.dimension; ++a) {
    LineTransform const transform(FourierKind::complex_forward, n[a], lines);
    for (std::size_t block = 0; block < nodes; block += lines * n[a])
      transform.execute(field.data() + 2 * block, waves.data() + 2 * block);
    std::swap(field, waves);
    lines *= n[a];
  }
  auto const wave = [&](int a, std::size_t j) {  // at half the number of nodes, the sign is ambiguous
    if (2 * j == n[a]) return 0.0;
    auto const number = 2 * j > n[a] ? static_cast<double>(j) - static_cast<double>(n[a]) : static_cast<double>(j);
    return 2 * pi * number / box().length(a);
  };
  auto const square_at_half = [&](int a, std::size_t j) {
    return 2 * j == n[a] ? square(pi * static_cast<double>(n[a]) / box().length(a)) : 0.0;
  };
  double const scale = grid.cell_volume() / (4 * static_cast<double>(nodes));
  double const of_width = 1 / (4 * square(parameters_.alpha));
  std::array<std::array<ExactSum, 3>, 3> sums;
  for (std::size_t l = 0; l < n[2]; ++l)
    for (std::size_t j = 0; j < n[1]; ++j)
      for (std::size_t i = 0; i < n[0]; ++i) {
        if (i + j + l == 0) continue;
        std::size_t const at = grid.index(i, j, l);
        std::size_t const opposite = grid.index((n[0] - i) % n[0], (n[1] - j) % n[1], (n[2] - l) % n[2]);
        double const energy =
            scale * (field[2 * at] * field[2 * opposite + 1] + field[2 * at + 1] * field[2 * opposite]);
        std::array<std::size_t, 3> const numbers{i, j, l};
        double k2 = 0;
        std::array<double, 3> k{};
        for (int a = 0; a < grid.dimension; ++a) {
          k[a] = wave(a, numbers[a]);
          k2 += square(k[a]) + square_at_half(a, numbers[a]);
        }
        for (int a = 0; a < grid.dimension; ++a)
          for (int b = 0; b < grid.dimension; ++b) {
            double const kk = k[a] * k[b] + (a == b ? square_at_half(a, numbers[a]) : 0.0);
            sums[a][b] += energy * ((a == b ? 1 : 0) - 2 * (1 / k2 + of_width) * kk);
          }
      }
  for (int a = 0; a < grid.dimension; ++a)
    for (int b = 0; b < grid.dimension; ++b) measures.virial[a][b] += sums[a][b].value();
}

EnergyAndVirial P3MScheme::measure(double time) {
  if (division()) division()->make_whole();
  tune();
  EnergyAndVirial measures = MeshScheme::measure(time);
  update_sources();
  EnergyAndVirial const near = near_->scheme.measure(time);
  measures.reciprocal = measures.reciprocal && near.reciprocal;
  P3mSystem const system = this->system();
  // One part is proportional to the square of each strength. With the background, the other is proportional to each
  // strength times their sum.
  if (!energy_terms_) energy_terms_ = p3m_energy_terms(system, parameters_);
  double const per_square = energy_terms_->per_square,
               per_strength = energy_terms_->per_total * system.sum_of_strengths;
  double const of_total = per_strength * system.sum_of_strengths;
  measures.potential += near.potential + per_square * system.sum_of_squares + of_total;
  // Energy that depends only on the inverse volume gives an isotropic pressure.
  for (int a = 0; a < box().dimension(); ++a) {
    for (int b = 0; b < box().dimension(); ++b) measures.virial[a][b] += near.virial[a][b];
    measures.virial[a][a] += of_total;
  }
  std::size_t at = 0, number = 0;
  for (auto const* ensemble : Scheme::ensembles()) {
    auto const strengths = this->strengths(*ensemble);
    auto& energies = measures.per_particle[number++];
    for (std::size_t i = 0; i < ensemble->size(); ++i, ++at)
      energies[i] += near.per_particle[0][at] + strengths[i] * (per_square * strengths[i] + per_strength);
  }
  return measures;
}

void P3MScheme::make_reversible(double quantum) {
  quantum_ = quantum;
  MeshScheme::make_reversible(quantum);
  if (near_) near_->scheme.make_reversible(quantum);
}

std::size_t P3MScheme::bytes() const {
  return MeshScheme::bytes() + (near_ ? near_->scheme.bytes() + near_->sources->bytes() : 0);
}

std::string P3MScheme::report() const {
  std::string text = MeshScheme::report();
  if (near_)
    text += fmt::format(", order {}, alpha {:.4g}; near pairs within {:.4g}: {}", parameters_.order, parameters_.alpha,
                        parameters_.cutoff, near_->scheme.report());
  return text;
}

std::vector<std::string> P3MScheme::warnings(double step_size) {
  P3mParameters const& chosen = parameters();
  std::string cells;
  for (int a = 0; a < box().dimension(); ++a) cells += fmt::format("{}{}", a ? " x " : "", chosen.cells[a]);
  pairs().speak_in(spoken_units());
  auto lines = pairs().warnings(step_size);
  lines.push_back(fmt::format("P3M for {:.1e}: mesh of {} cells, order {}, alpha {:.4g}, near pairs within {:.4g}",
                              accuracy_, cells, chosen.order, chosen.alpha, chosen.cutoff));
  return lines;
}

std::vector<double> P3MScheme::state() const {
  std::vector<double> state{tuned_ ? 1.0 : 0.0,     static_cast<double>(parameters_.order),
                            parameters_.alpha,      parameters_.cutoff,
                            parameters_.error_near, parameters_.error_mesh};
  for (auto const n : parameters_.cells) state.push_back(static_cast<double>(n));
  auto const add = [&](std::vector<double> const& part) {
    state.push_back(static_cast<double>(part.size()));
    state.insert(state.end(), part.begin(), part.end());
  };
  add(MeshScheme::state());
  add(near_ ? near_->scheme.state() : std::vector<double>{});
  return state;
}

void P3MScheme::restore(std::span<double const> state) {
  constexpr std::size_t own = 9;
  auto const misfit = [] { return Error("the checkpoint's P3M state does not fit this simulation"); };
  std::size_t at = own;
  auto const next = [&] {
    if (at >= state.size() || !(state[at] >= 0) || state[at] > static_cast<double>(state.size() - at)) throw misfit();
    auto const count = static_cast<std::size_t>(state[at]);
    if (at + 1 + count > state.size()) throw misfit();
    at += count + 1;
    return state.subspan(at - count, count);
  };
  auto const mesh_part = next(), near_part = next();
  if (state[0] != 0) {
    P3mParameters saved;
    saved.order = static_cast<int>(state[1]);
    saved.alpha = state[2], saved.cutoff = state[3], saved.error_near = state[4], saved.error_mesh = state[5];
    for (std::size_t a = 0; a < 3; ++a) saved.cells[a] = static_cast<std::size_t>(state[6 + a]);
    choose(saved);
    tuned_ = true;
    copy_particles();
    near_->scheme.restore(near_part);
  }
  MeshScheme::restore(mesh_part);
}

}  // namespace boltzmann
