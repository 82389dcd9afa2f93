// The simultaneous dissipation: all pairs at once, then every particle regains as heat what its motion has lost.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/dissipation/members.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {

/// Calls function(member, piece, sums) in parallel, with the sums over all pairs of a piece's particles.
template <class Function>
void PairDissipation::each_piece(StepContext const& context, double asymmetry, Function const& function) {
  int const ring = scheme_.neighbourhood().ring();
  for (auto& member : members_) {
    Member& m = *member;
    if (!m.dissipates) continue;
    struct Part {
      DissipationTask task;
      DissipationKernels const* kernels;
      Coupling const* coupling;
    };
    std::vector<Part> parts;
    for (auto const& coupling : couplings_) {
      Coupling const& c = *coupling;
      if (c.target != &m) continue;
      DissipationTask task;
      task.target = m.points.data();
      task.source = c.source->points.data();
      task.number = m.copy->order();
      task.row = c.row.data();
      task.length = c.length[ring].data();
      task.asymmetry = asymmetry;
      task.noise = c.noise(context, boltzmann_constant_, number());
      parts.push_back({task, &dissipation_kernels_for(m.dimension(), c.dissipation.projected), &c});
    }
    for_ranges(m.pieces.size(), 1, threads_for(m.owned(), 4, threads()), [&](std::size_t first, std::size_t last) {
      AlignedVector<double> sums;
      for (std::size_t n = first; n < last; ++n) {
        Piece const& piece = m.pieces[n];
        sums.assign(4 * (piece.rows() + 1), 0.0);
        for (auto [task, kernels, coupling] : parts) {
          task.first = piece.begin;
          task.rows = piece.rows();
          task.sums = sums.data();
          // Each row first adds the contributions of earlier rows, in their order, as if the chunk were one piece.
          if (Border const& before = coupling->borders[n]; !before.row.empty()) {
            DissipationTask border = task;
            border.begin = before.begin;
            border.end = before.begin + before.row.size();
            border.row = before.row.data();
            border.length = before.length[ring].data();
            border.listed = before.begin;
            kernels->simultaneous(border);
          }
          task.begin = piece.begin;
          task.end = piece.end;
          kernels->simultaneous(task);
        }
        function(m, piece, sums.data());
      }
    });
  }
}

/// Let dp_ij follow from velocities u (the current ones, or with the corrector the mean of these and the previous
/// iteration). The motion gains sum over i of dP_i.(v_i + dP_i / 2m_i), dP_i = sum over j of dp_ij. Particles i and j
/// pay it by
///   eps_i -= sum over j of dp_ij.u_ij / 2 + dP_i.(dP_i - dP'_i) / 2m_i + |dp_ij|^2 (1/mj - 1/mi) / 4,
/// with dP' of the previous iteration (zero without one). The total is exact for any masses. The last term (not with
/// the corrector) gives both the same part of the energy of noise, as in Eq 3 of the source.
void PairDissipation::simultaneous(StepContext const& context) {
  take_lists();
  // If particles divide the heat, the remainder must be small, too: one more pass.
  bool const shares = std::any_of(members_.begin(), members_.end(), [](auto const& m) { return m->has_energy(); });
  int const tries = !corrector_ ? 0 : shares ? 2 : 1;
  for (int n = 0; n < tries; ++n) {
    for (auto& member : members_)
      if (member->dissipates) member->predicted.resize(4 * member->owned());
    each_piece(context, 0, [](Member& m, Piece const& piece, double const* sums) {
      std::copy_n(sums, 4 * piece.rows(), m.predicted.data() + 4 * piece.begin);
    });
    for (auto& member : members_)
      if (member->dissipates) {
        member->take_mean_velocities(threads_for(member->owned(), 2, threads()));
        if (division()) bring_mean_velocities(*member);
        member->show_images(member->velocity_at(), member->dimension());
        if (member->copy->flow_axis() >= 0) member->carry_along_flow();
      }
  }
  SharedSum paid;  // by the bath
  each_piece(context, corrector_ ? 0 : 0.25, [&](Member& m, Piece const& piece, double const* sums) {
    ExactSum by_bath;
    finish_piece(m, piece, sums, by_bath);
    paid.add(by_bath);
  });
  if (division()) division()->sum(paid.total());
  heat_ += paid.value();
}

/// Velocities of other ranks' particles, from their owners.
void PairDissipation::bring_mean_velocities(Member& m) {
  division()->team().meet(Team::Occasion::exchanges);
  auto const velocity = [&](std::uint32_t row) { return m.point(row) + m.velocity_at(); };
  int const D = m.dimension();
  scheme_.neighbourhood().bring(
      *m.copy, static_cast<std::size_t>(D), [&](std::uint32_t row, double* to) { std::copy_n(velocity(row), D, to); },
      [&](std::uint32_t row, double const* from) { std::copy_n(from, D, velocity(row)); });
}

/// Replaces the points' velocities by the means of the current ones and the previous iteration.
void PairDissipation::Member::take_mean_velocities(int threads) {
  int const at = velocity_at();
  for_stretches(copy->followed(), threads, [&](Stretch const* rows, Stretch const* last) {
    for (; rows != last; ++rows)
      for (std::size_t k = rows->begin; k < rows->end; ++k) {
        double const* row = ensemble->row(copy->order()[k]);
        for (int a = 0; a < dimension(); ++a)
          point(k)[at + a] = row[velocity + a] + 0.5 * predicted[4 * k + a] * point(k)[inverse_mass_at()];
      }
  });
}

/// Copies `count` numbers of points to their images.
void PairDissipation::Member::show_images(int first, int count) {
  for (auto const& [begin, end] : copy->images())
    for (std::size_t k = owned() + 1 + begin; k < owned() + 1 + end; ++k)
      std::copy_n(point(copy->owner(k)) + first, count, point(k) + first);
}

void PairDissipation::Member::carry_along_flow() {
  auto const flow = static_cast<std::size_t>(velocity_at() + copy->flow_axis());
  for (std::size_t k = 0; k <= copy->total(); ++k)
    if (k != copy->sentinel()) point(k)[flow] += copy->ahead_in_flow(k);
}

/// Adds momenta and energies to the particles of a piece; the bath pays if there is no internal energy.
void PairDissipation::finish_piece(Member& m, Piece const& piece, double const* sums, ExactSum& by_bath) {
  bool const has_energy = m.has_energy();
  int const dimension = m.dimension();
  for (std::size_t k = piece.begin; k < piece.end; ++k, sums += 4) {
    double* row = m.ensemble->row(m.copy->order()[k]);
    double const inverse_mass = m.point(k)[m.inverse_mass_at()];
    double const* predicted = corrector_ ? m.predicted.data() + 4 * k : nullptr;
    double loss = sums[dimension];
    for (int a = 0; a < dimension; ++a) {
      loss += 0.5 * inverse_mass * sums[a] * (sums[a] - (predicted ? predicted[a] : 0.0));
      row[m.velocity + a] += sums[a] * inverse_mass;
    }
    if (has_energy) {
      double const left = row[m.energy] - loss;
      if (!std::isfinite(left)) throw PhysicsFailure(fmt::format("friction on {} is not finite", m.who(k)));
      if (!(left > 0))
        throw PhysicsFailure(
            fmt::format("the internal energy of {} would become {:.4g} (from {:.4g}): friction and noise take more "
                        "than there is; take a smaller step, or shardlow with metropolis",
                        m.who(k), left, row[m.energy]));
      row[m.energy] = left;
    } else {
      if (!std::isfinite(loss)) throw PhysicsFailure(fmt::format("friction on {} is not finite", m.who(k)));
      by_bath += loss;
    }
  }
}

}  // namespace boltzmann
