// The report and the state of a remesher.
#include <boltzmann/simulation/remesher.hpp>

#include <fmt/format.h>

#include <utility>

namespace boltzmann {

Remesher::Remesher(AnyEnsemble& ensemble, Box const& box, Remeshing remeshing)
    : ensemble_(&ensemble), box_(&box), remeshing_(std::move(remeshing)) {
  check(ensemble, box, remeshing_);
}

void Remesher::change() {
  Remeshed const now = remesh(*ensemble_, *box_, remeshing_);
  ++times_;
  done_.removed += now.removed;
  done_.vorticity_lost += now.vorticity_lost;
  done_.magnitudes_lost += now.magnitudes_lost;
  done_.impulse_lost += now.impulse_lost;
  done_.left_as_they_are += now.left_as_they_are;
}

std::string Remesher::report(UnitSystem const& units) const {
  bool const plane = ensemble_->dimension() == 2;
  Dimension const dimension = plane ? dimensions::circulation : dimensions::circulation * dimensions::length;
  std::string line = fmt::format("'{}': remeshed {} time{}, {} vortices now", ensemble_->name(), times_,
                                 times_ == 1 ? "" : "s", ensemble_->size());
  if (done_.removed > 0)
    line += fmt::format("; {} weak ones left out, {} lost: {} (sum of magnitudes {})", done_.removed,
                        plane ? "circulation" : "vorticity",
                        units.text(plane ? done_.vorticity_lost[2] : magnitude(done_.vorticity_lost), dimension),
                        units.text(done_.magnitudes_lost, dimension));
  if (done_.left_as_they_are > 0)
    line += fmt::format("; {} times a vortex stayed as it was, with no nodes around it", done_.left_as_they_are);
  return line;
}

FlowImpulse Remesher::taken() const {
  if (ensemble_->dimension() != 2) return {};
  return {{done_.impulse_lost[0], done_.impulse_lost[1]}, done_.vorticity_lost[2]};
}

std::vector<double> Remesher::state() const {
  auto const &lost = done_.vorticity_lost, &impulse = done_.impulse_lost;
  return {static_cast<double>(times_), static_cast<double>(done_.removed),          lost[0],    lost[1],    lost[2],
          done_.magnitudes_lost,       static_cast<double>(done_.left_as_they_are), impulse[0], impulse[1], impulse[2]};
}

void Remesher::restore(std::span<double const> state) {
  if (state.size() != 10) throw Error("the checkpoint does not fit this simulation: it has no remeshing");
  times_ = static_cast<std::size_t>(state[0]);
  done_ = {static_cast<std::size_t>(state[1]),
           {state[2], state[3], state[4]},
           state[5],
           {state[7], state[8], state[9]},
           static_cast<std::size_t>(state[6])};
}

}  // namespace boltzmann
