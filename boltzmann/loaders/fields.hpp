// Setting fields of chosen particles, and choosing the particles at the edge of a body.
#pragma once

#include <boltzmann/particles/ensemble.hpp>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace boltzmann {

/// Sets a field to the same value in all particles, or in those of `which`. A number is for fields of one component; a
/// vector has as many numbers as the field has components. Error if there is no such field, the value does not fit or
/// is not finite, or a particle of `which` does not exist.
void set_field(AnyEnsemble& ensemble, std::string_view field, double value);
void set_field(AnyEnsemble& ensemble, std::string_view field, double value, std::span<std::uint32_t const> which);
void set_field(AnyEnsemble& ensemble, std::string_view field, std::span<double const> value);
void set_field(AnyEnsemble& ensemble, std::string_view field, std::span<double const> value,
               std::span<std::uint32_t const> which);

/// The particles nearer than `margin` to a face of the bounding block of the ensemble, in order: the boundary atoms of
/// the 1990 listing A.3, which hold a piece of metal in place. Error if the margin is negative.
std::vector<std::uint32_t> edge_particles(AnyEnsemble const& ensemble, double margin);

}  // namespace boltzmann
