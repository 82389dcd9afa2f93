// Classes: the shipped particle classes by name, for code that selects the class at run time.
#pragma once

#include <boltzmann/integrators/integrator.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/schemes/source_kind.hpp>

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// A particle class in one dimension.
struct ClassVariant {
  int dimension;
  std::function<std::unique_ptr<AnyEnsemble>(std::string name, std::size_t size)> make;
  /// The integrator of an ensemble from make(). Throws Error if the class can't be advanced with the method.
  std::function<std::unique_ptr<Integrator>(AnyEnsemble& ensemble, Method method)> integrate;
  std::vector<Field> fields;
  std::size_t row_bytes;  ///< memory of one particle
  Method usual_method;    ///< the default integrator
  SourceKind source;      ///< for schemes of fields, which can't act on the class without `strengths`
};

/// The kind of continuum, if any: such ensembles have materials, and need a SmoothScheme.
enum class Matter { none, fluid, solid };

/// A particle class.
struct ParticleClass {
  std::string name;
  std::string doc;  ///< one line
  bool classical;   ///< moved by forces (has mass and velocity); otherwise advected by a flow
  std::vector<ClassVariant> variants;
  Matter matter = Matter::none;

  ClassVariant const* in(int dimension) const;
};

/// All shipped classes, in the order of the hierarchy.
std::vector<ParticleClass> const& particle_classes();
/// nullptr for an unknown name.
ParticleClass const* find_class(std::string_view name);

namespace detail {
// One per source file, so that they compile in parallel.
std::vector<ParticleClass> newton_classes();
std::vector<ParticleClass> laplace_classes();
std::vector<ParticleClass> tracer_classes();
std::vector<ParticleClass> smooth_classes();
}  // namespace detail

}  // namespace boltzmann
