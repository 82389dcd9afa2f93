// The order of pairs in Shardlow's splitting. Private to this module.
#pragma once

#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/dissipation/members.hpp>

#include <optional>
#include <vector>

namespace boltzmann {

/// Chunks of particles are nodes; all pairs between two chunks (or inside one) are an edge. Edges are coloured so that
/// those of one colour have no chunk in common and can run in parallel, with the result of a sequential order. Colours
/// are processed in order, and so are the pairs of an edge.
struct PairDissipation::Splitting {
  struct Part {  // the pairs of one coupling
    Coupling const* coupling;
    std::vector<DissipationPair> pairs;
  };
  struct Edge {
    std::size_t from, to;
    std::vector<Part> parts;
    std::optional<ExactSum> heat = {};  // given by a bath; moves proposed and rejected in the last step
    std::uint64_t proposed = 0, refused = 0;
  };

  std::vector<Edge> edges;
  std::vector<std::vector<std::size_t>> colours;  // indices of edges
  std::size_t builds = ~std::size_t{0}, moves = 0;

  /// Rebuilds the pairs if neighbour lists have changed.
  void take_pairs(Neighbourhood const& neighbourhood, std::vector<std::unique_ptr<Member>>& members,
                  std::vector<std::unique_ptr<Coupling>> const& couplings, int threads);
  /// Friction and noise of a part of an edge, pair after pair. PhysicsFailure if an internal energy would not be
  /// positive.
  static void run(Edge& edge, Part const& part, PairNoise const& noise, bool metropolis, StepContext const& context);
  std::size_t bytes() const;

 private:
  template <int D, bool projected>
  static void run_in(Edge& edge, Part const& part, PairNoise const& noise, bool metropolis, StepContext const& context);
};

}  // namespace boltzmann
