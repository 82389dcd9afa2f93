// Periodic images for the kernels of connections and tuples.
#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/schemes/pair/pair_task.hpp>

namespace boltzmann {

void find_images(PairTask& task, AnyEnsemble const& ensemble, Box const& box) {
  for (int a = 0; a < box.dimension(); ++a)
    if (box.periodic(a)) {
      task.period[a] = box.length(a);
      task.inverse_period[a] = 1 / box.length(a);
    }
  task.sheared = box.sheared();
  if (!task.sheared) return;
  int const flow = box.shear().flow, gradient = box.shear().gradient;
  task.up[gradient] = 1 / box.length(gradient);
  task.image[gradient] = box.length(gradient);
  task.image[flow] = box.slide_in_lattice();
  task.faster[flow] = box.slide_velocity();
  Field const* velocity = ensemble.find_field("velocity");
  if (velocity && velocity->components == box.dimension()) task.velocity = velocity->offset;
}

}  // namespace boltzmann
