// CylinderFlow: a stream and vortices past a circle in 2D, by images (Milne-Thomson's circle theorem). The circle is a
// streamline for any vortices. Another scheme calculates how vortices advect each other.
//   CylinderFlow cylinder(box, {.stream = {1, 0}, .radius = 1});
//   cylinder.add(vortices);
//   cylinder.add(tracers);
//   simulation.add(cylinder);
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/schemes/scheme.hpp>
#include <boltzmann/schemes/source_kind.hpp>

#include <string>
#include <vector>

namespace boltzmann {

struct CylinderOptions {
  Vector<2> centre{};
  Vector<2> stream{};  ///< far from the cylinder
  double radius = 1;
  double circulation = 0;  ///< around the cylinder
};
OptionTable const& cylinder_options();

/// The flow due to a cylinder: the stream U (1 - R^2 / z^2), a circulation, and two images of each vortex outside. A
/// vortex at z0 with circulation Gamma has images of -Gamma at R^2 / conj(z0) and of Gamma at the centre. The core of
/// an image is R^2 / |z0|^2 of the vortex' own. The flow acts on all added particles outside the cylinder, and is zero
/// inside. O(N^2).
class CylinderFlow final : public Scheme {
 public:
  /// Throws Error if the box is not two-dimensional or not open, the radius is not positive, or a number is not finite.
  CylinderFlow(Box box, CylinderOptions const& options);

  CylinderOptions const& options() const { return options_; }

  /// Adds particles that the flow advects; those with vorticity have images.
  template <CarriedParticle P>
  void add(Ensemble<P>& ensemble) {
    add(ensemble, source_kind<P>());
  }
  /// For code that selects classes at run time. Throws Error if the class is not advected by a flow, or a vortex is not
  /// outside.
  void add(AnyEnsemble& ensemble, SourceKind const& kind);

  /// Throws PhysicsFailure if a vortex is not outside the cylinder.
  void add_influences(double time) override;
  std::optional<std::uint64_t> revision() const override { return revision_with({}); }
  void add_stream(std::span<double const> places, double time, std::span<double> velocities) override;
  EnergyAndVirial measure(double time = 0) override;
  double length_scale(AnyEnsemble const& ensemble) const override;
  std::string explain(AnyEnsemble const& ensemble, std::size_t i) const override;
  void make_reversible(double quantum) override;
  std::string undivided() const override { return ""; }
  /// Every rank computes all images, and advects its own particles.
  void divide(Division* division) override { division_ = division; }
  std::size_t bytes() const override;
  std::string summary() const override;

 private:
  struct Carried {
    AnyEnsemble* ensemble;
    SourceKind kind;
  };
  void find_images();
  void carry(AnyEnsemble& ensemble);
  bool outside(double const* position) const;

  CylinderOptions options_;
  Division* division_ = nullptr;  // set during a divided run
  std::vector<Carried> carried_;
  std::vector<double> images_;  // rows of Vortex<2>
  std::vector<double> velocity_;
};

}  // namespace boltzmann
