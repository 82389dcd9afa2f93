// The order-free flow: all pairs at once, then every particle gets back as heat what its motion has lost.
#include <boltzmann/core/error.hpp>
#include <boltzmann/flows/members.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {

/// With dp_ij of all pairs from velocities u (those of now, or with the corrector the mean of now and of a first try)
/// the motion gains sum over i of dP_i.(v_i + dP_i / 2m_i), dP_i = sum over j of dp_ij. It is paid by i and j as
///   eps_i -= sum over j of dp_ij.u_ij / 2 + dP_i.(dP_i - dP'_i) / 2m_i + |dp_ij|^2 (1/mj - 1/mi) / 4,
/// dP' being that of the first try (without one, zero). The total is exact whatever the masses; the last term (not with
/// the corrector) gives both the same share of what noise adds, as Eq 3 of the source asks.
void DissipativeFlow::order_free(StepContext const& context) {
  take_points();
  take_lists();
  Neighbourhood const& neighbourhood = scheme_.neighbourhood();
  int const ring = neighbourhood.ring();
  auto const pass = [&](double asymmetry) {
    for (auto& member : members_)
      if (member->dissipates) member->sums.assign(4 * (member->owned() + member->chunks()), 0.0);
    for (auto const& coupling : couplings_) {
      Coupling const& c = *coupling;
      Member& m = *c.target;
      NeighbourList const& list = neighbourhood.list(c.list);
      auto const& kernels = flow_kernels_for(m.dimension(), c.dissipation.projected);
      FlowTask all;
      all.target = m.points.data();
      all.source = c.source->points.data();
      all.row = c.same() ? c.row.data() : list.rows();
      all.length = c.same() ? c.length[ring].data() : list.lengths(ring);
      all.scatter = c.same();
      all.asymmetry = asymmetry;
      all.noise = c.noise(context, boltzmann_constant_);
      for_ranges(m.chunks(), 1, worth_threads(m.owned(), particles_worth_threads / 4, threads()),
                 [&](std::size_t first, std::size_t last) {
                   for (std::size_t chunk = first; chunk < last; ++chunk) {
                     FlowTask task = all;
                     task.begin = chunk * flow_chunk;
                     task.end = std::min(task.begin + flow_chunk, m.owned());
                     task.sums = m.sum(task.begin);
                     kernels.order_free(task);
                   }
                 });
    }
  };
  if (corrector_) {
    pass(0);
    for (auto& member : members_) {
      if (!member->dissipates) continue;
      Member& m = *member;
      int const velocity = m.velocity_at();
      for (std::size_t k = 0; k < m.owned(); ++k) {
        double* point = m.point(k);
        for (int a = 0; a < m.dimension(); ++a) point[velocity + a] += 0.5 * m.sum(k)[a] * point[m.inverse_mass_at()];
      }
      for (std::size_t k = m.owned() + 1; k <= m.mirror->total(); ++k)
        std::copy_n(m.point(m.mirror->owner(k)) + velocity, m.dimension(), m.point(k) + velocity);
      m.predicted.swap(m.sums);
    }
  }
  pass(corrector_ ? 0 : 0.25);
  for (auto& member : members_) {
    if (!member->dissipates) continue;
    Member& m = *member;
    bool const has_energy = m.has_energy();
    int const dimension = m.dimension();
    std::vector<double> lost(m.chunks(), 0.0);
    for_ranges(m.owned(), flow_chunk, worth_threads(m.owned(), particles_worth_threads / 2, threads()),
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t k = begin; k < end; ++k) {
                   double* row = m.ensemble->row(m.mirror->order()[k]);
                   double const inverse_mass = m.point(k)[m.inverse_mass_at()];
                   double const* sums = m.sum(k);
                   double const* predicted = corrector_ ? m.predicted.data() + (sums - m.sums.data()) : nullptr;
                   double loss = sums[dimension];
                   for (int a = 0; a < dimension; ++a) {
                     loss += 0.5 * inverse_mass * sums[a] * (sums[a] - (predicted ? predicted[a] : 0.0));
                     row[m.velocity + a] += sums[a] * inverse_mass;
                   }
                   if (has_energy) {
                     double const left = row[m.energy] - loss;
                     if (!(left > 0))
                       throw PhysicsFailure(fmt::format(
                           "the internal energy of {} would become {:.4g} (from {:.4g}): friction and noise take more "
                           "than there is; take a smaller step, or pair-splitting with metropolis",
                           m.who(k), left, row[m.energy]));
                     row[m.energy] = left;
                   } else {
                     if (!std::isfinite(loss))
                       throw PhysicsFailure(fmt::format("friction on {} is not finite", m.who(k)));
                     lost[k / flow_chunk] += loss;
                   }
                 }
               });
    for (double const loss : lost) heat_ -= loss;
  }
}

}  // namespace boltzmann
