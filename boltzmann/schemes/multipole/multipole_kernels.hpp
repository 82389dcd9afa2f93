// The kernels of multipole schemes, compiled for every instruction set. Private to this module.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/schemes/mesh/point_source.hpp>
#include <boltzmann/schemes/multipole/expansion_tables.hpp>
#include <boltzmann/schemes/pair/pair_task.hpp>

#include <cstddef>

namespace boltzmann {

/// An expansion and its translation; `numbers` are padded to a whole block of a row.
struct Shifted {
  double shift[3] = {0, 0, 0};  ///< moments: old centre - new one; local: new - old
  double radius = 1;            ///< of the node other than that of the call
  double const* numbers = nullptr;
};

/// Rows of PointSource<D> about the centre of a node.
struct NodeParticles {
  double const* rows = nullptr;
  std::size_t count = 0;
  double centre[3] = {0, 0, 0};
  double radius = 1;
};

struct MultipoleKernels {
  /// The moments of particles (P2M).
  void (*moments)(ExpansionView const& tables, NodeParticles const& particles, double* moments) = nullptr;
  /// Sums the moments of children about a centre with this radius (M2M).
  void (*gather)(ExpansionView const& tables, Shifted const* children, std::size_t count, double radius,
                 double* moments) = nullptr;
  /// Adds the effect of other nodes' moments to the local expansion of a node of this radius (M2L).
  void (*interact)(ExpansionView const& tables, Shifted const* sources, std::size_t count, double radius,
                   double* local) = nullptr;
  /// Translates the local expansion of a node to its children, whose own are stored in `locals` (L2L).
  void (*hand_down)(ExpansionView const& tables, double const* local, double radius, Shifted const* children,
                    double* const* locals, std::size_t count) = nullptr;
  /// Adds `constant` times the field of a local expansion, D numbers per particle; and the potential, unless null
  /// (L2P).
  void (*evaluate)(ExpansionView const& tables, NodeParticles const& particles, double const* local, double constant,
                   double* field, double* potential) = nullptr;
  /// The same for the moments of a node with this centre and radius, separate from the particles (M2P).
  void (*evaluate_moments)(ExpansionView const& tables, NodeParticles const& particles, double const* moments,
                           double constant, double* field, double* potential) = nullptr;
  /// Adds the effect of particles to the local expansion about a separate centre with this radius (P2L).
  void (*expand)(ExpansionView const& tables, NodeParticles const& particles, double* local) = nullptr;
  PairKernel near = nullptr;  ///< the field at PointSource<D> of others by LaplaceLaw, on unit strength (P2P)
  PairKernel near_with_potential = nullptr;  ///< and half the potential
  PairKernel near_vortices[3] = {};          ///< influences on Inviscid<D> by VortexCore
  PairKernel near_slopes[3] = {};            ///< 3D: those on SlopedFlow from Inviscid<3> by VortexCore
};

/// By [dimension - 2].
struct MultipoleKernelTable {
  MultipoleKernels of[2];
};
template <InstructionSet set>
MultipoleKernelTable const& multipole_kernels();

}  // namespace boltzmann
