// The recipe of SPAM, step by step, and when each step is needed.
#include <boltzmann/schemes/smooth/loaded.hpp>

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/kernel_dispatch.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>

namespace boltzmann {

using namespace detail;

namespace {

constexpr std::size_t pair_grain = 256;

template <class Particle>
constexpr std::size_t blocks_of = (sizeof(Particle) / sizeof(double) + row_block - 1) / row_block;

/// The blocks of a point's row after the position: a block of fluid, blocks of transport, and blocks of matter.
std::size_t place_blocks(int dimension) {
  return in_dimension(dimension, [](auto d) { return row_stride<SmoothPlace<d>> / row_block; });
}
std::size_t matter_blocks(int dimension) {
  return in_dimension(dimension, [](auto d) { return blocks_of<SmoothMatter<d>> - blocks_of<SmoothTransport<d>>; });
}

/// After those of matter.
std::size_t solid_blocks(int dimension) {
  return in_dimension(dimension, [](auto d) { return blocks_of<SmoothSolid<d>> - blocks_of<SmoothMatter<d>>; });
}

/// The meaning of each number of a point's row, for its images.
std::vector<ImageComponent> image_components(int dimension, std::size_t blocks) {
  return in_dimension(dimension, [&](auto d) {
    constexpr int D = d;
    std::vector<ImageComponent> components(blocks * row_block, {ImageRule::same, 0, 0});
    std::size_t const fluid = blocks_of<SmoothPlace<D>> * row_block;
    for (int a = 0; a < D; ++a) {
      components[static_cast<std::size_t>(a)] = {ImageRule::position, a, 0};
      components[static_cast<std::size_t>(D + 1 + a)] = {ImageRule::velocity, a, 0};
    }
    components[fluid + 2] = {ImageRule::temperature, 0, 0};
    if (blocks == blocks_of<SmoothFluid<D>>) return components;
    std::size_t next = fluid + 2 * row_block + 1;  // motion
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b) components[next++] = {ImageRule::tensor, a, b};
    if (blocks == blocks_of<SmoothTransport<D>>) return components;
    next = blocks_of<SmoothTransport<D>> * row_block + 1;
    for (int a = 0; a < D; ++a)
      for (int b = a; b < D; ++b) components[next++] = {ImageRule::tensor, a, b};
    for (int a = 0; a < D; ++a) components[next++] = {ImageRule::heat_flux, a, 0};
    if (blocks == blocks_of<SmoothMatter<D>>) return components;
    next = blocks_of<SmoothMatter<D>> * row_block + 3;
    for (int a = 0; a < D; ++a) components[next++] = {ImageRule::velocity, a, 0};
    next = (blocks_of<SmoothMatter<D>> + 2) * row_block;
    for (int a = 0; a < D; ++a) {
      components[next + static_cast<std::size_t>(a)] = {ImageRule::displacement, a, 0};
      components[next + static_cast<std::size_t>(D + a)] = {ImageRule::normal_vector, a, 0};
      for (int b = 0; b < D; ++b)
        components[next + static_cast<std::size_t>((2 + a) * D + b)] = {ImageRule::tensor, a, b};
    }
    return components;
  });
}

/// A text on a range that is too long, or empty. Between two walls of an axis a particle may have images behind one of
/// them, not behind both.
std::string too_long(Box const& box, double range, double reach) {
  for (int a = 0; a < box.dimension(); ++a) {
    if (box.boundary(a) != Boundary::open && range > box.length(a))
      return fmt::format(
          "the range {:.6g} of smooth particles is longer than axis {} of the box, which allows at most {:.6g}", range,
          "xyz"[a], box.length(a));
    if (box.boundary(a) == Boundary::mirror && box.walled(a, Box::End::low) && box.walled(a, Box::End::high) &&
        reach > box.length(a))
      return fmt::format(
          "the walls of axis {} are {:.6g} apart, too near for smooth particles of range {:.6g}, whose lists of "
          "neighbours reach {:.6g}",
          "xyz"[a], box.length(a), range, reach);
  }
  return "";
}

/// Why the density of a particle can't be computed.
std::string not_usable(AnyEnsemble const& ensemble, std::size_t i) {
  for (auto const* name : {"range", "mass"})
    if (double const value = ensemble.row(i)[ensemble.field(name).offset]; !(value > 0 && value < infinite))
      return fmt::format("particle {} of '{}' has the {} {}; it must be positive", i, ensemble.name(), name, value);
  return fmt::format("particle {} of '{}' has the density {}; it must be positive, and as it is not summed, be given",
                     i, ensemble.name(), ensemble.row(i)[ensemble.field("density").offset]);
}

}  // namespace

SmoothKernelTable const& smooth_kernels_of(WeightShape shape) {
  return for_instruction_set([&](auto set) -> SmoothKernelTable const& {
    return for_weight(
        shape, [](auto s) -> SmoothKernelTable const& { return smooth_kernels<decltype(set)::value, decltype(s)>(); });
  });
}

TransportKernelTable const& transport_kernels() {
  return for_instruction_set(
      [](auto set) -> TransportKernelTable const& { return transport_kernels<decltype(set)::value>(); });
}

Words<DensityFrom> const& density_from_words() {
  static Words<DensityFrom> const all{
      "density",
      {{DensityFrom::summation, "summation", "sum of the weights around a particle: mass is conserved exactly"},
       {DensityFrom::continuity, "continuity",
        "evolved from its past, as the sum would change: no deficit at free surfaces"},
       {DensityFrom::volumes, "volumes", "the same, where bodies of different densities touch"}}};
  return all;
}

Words<MeanDensity> const& mean_density_words() {
  static Words<MeanDensity> const all{"mean density",
                                      {{MeanDensity::arithmetic, "arithmetic", "half the sum of the two"},
                                       {MeanDensity::geometric, "geometric", "the root of their product"}}};
  return all;
}

Words<Heating> const& heating_words() {
  static Words<Heating> const all{
      "heating",
      {{Heating::shared, "shared", "both of a pair are heated by the same"},
       {Heating::own, "own", "each by what its own pressure does: in smooth flow it stays on its isentrope"}}};
  return all;
}

SmoothScheme::SmoothScheme(Box box, WeightShape shape) : Scheme(std::move(box)), shape_(shape) {
  points_ = in_dimension(this->box().dimension(), [](auto d) -> std::unique_ptr<AnyEnsemble> {
    return std::make_unique<Ensemble<SmoothPlace<d>>>("smooth particles");
  });
}

SmoothScheme::~SmoothScheme() = default;

void SmoothScheme::add_material(AnyEnsemble& ensemble, MaterialKernels const& kernels,
                                std::shared_ptr<void const> material) {
  if (std::any_of(loaded_.begin(), loaded_.end(), [&](auto const& loaded) { return loaded->ensemble == &ensemble; }))
    throw Error(fmt::format("ensemble '{}' is made of something already: one material each", ensemble.name()));
  if (variable_)
    throw Error(
        fmt::format("ensemble '{}' was added after variable_range(), which computes the ranges of existing particles: "
                    "set all materials before it",
                    ensemble.name()));
  add(ensemble);
  loaded_.push_back(std::make_unique<Loaded>(Loaded{&ensemble, kernels, std::move(material), 0, {}, {}}));
  hood_.reset();
}

void SmoothScheme::add_external(AnyEnsemble& ensemble, ExternalKernels const& kernels, std::shared_ptr<void const> law,
                                bool reads_outside) {
  add(ensemble);
  outside_.push_back(std::make_unique<Outside>(Outside{&ensemble, kernels, std::move(law), reads_outside}));
  changed();
}

std::optional<std::uint64_t> SmoothScheme::revision() const {
  for (auto const& outside : outside_)
    if (outside->reads_outside) return std::nullopt;
  return revision_with({});
}

void SmoothScheme::heating(Heating heating) {
  parameters_.own_share = heating == Heating::own ? 1 : 0.5;
  parameters_.other_share = heating == Heating::own ? 0 : 0.5;
  hood_.reset();
  changed();
}

void SmoothScheme::artificial_viscosity(ArtificialViscosity const& viscosity) {
  check_parameter("artificial viscosity", "alpha", viscosity.alpha, not_negative);
  check_parameter("artificial viscosity", "beta", viscosity.beta, not_negative);
  viscosity_ = viscosity;
  parameters_.alpha = viscosity.alpha;
  parameters_.beta = viscosity.beta;
  hood_.reset();
  changed();
}

void SmoothScheme::skin(double length) {
  if (!(length >= 0) || !std::isfinite(length))
    throw Error(fmt::format("the skin is a length of zero or more, not {}", length));
  skin_ = length;
  if (hood_) hood_->skin(length);
}

std::size_t SmoothScheme::count() const {
  std::size_t count = 0;
  for (auto const& loaded : loaded_) count += loaded->ensemble->size();
  return count;
}

/// Properties of the particles of an ensemble, found while their positions are copied.
struct SmoothScheme::Extent {
  double shortest = infinite, longest = 0;  // of ranges
  std::size_t wrong = std::numeric_limits<std::size_t>::max();
  bool same = true;  // all inputs of density sums are unchanged

  void take(Extent const& other) {
    shortest = std::min(shortest, other.shortest);
    longest = std::max(longest, other.longest);
    wrong = std::min(wrong, other.wrong);
    same = same && other.same;
  }
};

SmoothScheme::Extent SmoothScheme::take_places(Loaded const& loaded) {
  AnyEnsemble const& ensemble = *loaded.ensemble;
  bool const evolves = density_from_ != DensityFrom::summation;
  std::mutex taking;
  Extent all;
  in_dimension(box().dimension(), [&](auto d) {
    constexpr int D = d;
    auto const places = [&](Stretch const* one, Stretch const* last) {
      Extent extent;
      for (; one != last; ++one)
        for (std::size_t i = one->begin; i < one->end; ++i) {
          auto const& p = *reinterpret_cast<Smooth<D> const*>(ensemble.row(i));
          auto& place = *reinterpret_cast<SmoothPlace<D>*>(points_->row(loaded.first + i));
          extent.same = extent.same && place.position == p.position && place.mass == p.mass && place.range == p.range;
          place.position = p.position;
          place.mass = p.mass;
          place.velocity = p.velocity;
          place.range = p.range;
          bool const usable = p.range > 0 && p.range < infinite && p.mass > 0 && p.mass < infinite;
          if (!(usable && (!evolves || p.density > 0)) && i < extent.wrong) extent.wrong = i;
          extent.shortest = std::min(extent.shortest, p.range);
          extent.longest = std::max(extent.longest, p.range);
        }
      std::lock_guard const lock(taking);
      all.take(extent);
    };
    int const used = threads_for(ensemble.size(), 1, threads());
    if (division_ && !division_->is_whole())
      for_share_stretches(ensemble, particle_grain, used, places);
    else
      for_ranges(ensemble.size(), particle_grain, used, [&](std::size_t begin, std::size_t end) {
        Stretch const range{begin, end};
        places(&range, &range + 1);
      });
  });
  return all;
}

/// Step 1: copies positions and velocities.
void SmoothScheme::take_places() {
  if (points_->size() != count()) {
    points_->resize(count());
    summed_.hold = false;
  }
  std::size_t first = 0;
  shortest_ = infinite;
  longest_ = 0;
  for (auto& loaded : loaded_) {
    AnyEnsemble const& ensemble = *loaded->ensemble;
    if (loaded->first != first) members_of_build_ = 0;
    loaded->first = first;
    Extent const extent = take_places(*loaded);
    summed_.hold = summed_.hold && extent.same;
    if (extent.wrong < ensemble.size()) throw PhysicsFailure(not_usable(ensemble, extent.wrong));
    shortest_ = std::min(shortest_, extent.shortest);
    longest_ = std::max(longest_, extent.longest);
    first += ensemble.size();
  }
  if (division_) agree_on_ranges();
}

/// Throws if a material without a heat of its own receives heat from another, which would be lost.
void SmoothScheme::check_heating() const {
  Loaded const *keeps = nullptr, *follows = nullptr;
  for (auto const& loaded : loaded_) (loaded->kernels.barotropic ? follows : keeps) = loaded.get();
  if (keeps && follows && parameters_.other_share > 0)
    throw Error(fmt::format(
        "heating: the energy of '{}' follows from its density, that of '{}' does not, so that energy would be "
        "lost where they share the heat of a pair; heating = \"own\" (Heating::own) shares none",
        follows->ensemble->name(), keeps->ensemble->name()));
}

/// True if no particle has moved since positions were copied.
bool SmoothScheme::all_rest() const {
  bool rest = hood_ && points_->size() == count();
  std::size_t first = 0;
  for (auto const& loaded : loaded_) {
    AnyEnsemble const& ensemble = *loaded->ensemble;
    if (rest)
      for_share(ensemble, particle_grain, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && rest; ++i)
          rest = std::equal(ensemble.row(i), ensemble.row(i) + box().dimension(), points_->row(first + i));
      });
    first += ensemble.size();
  }
  return division_ ? division_->team().meet(Team::Occasion::exchanges, {rest ? 0 : 1}).most[0] == 0 : rest;
}

/// Updates lists for the longest range, unless they must not change.
void SmoothScheme::prepare(bool keep_lists) {
  int const dimension = box().dimension();
  bool const vary = variable_.has_value();
  if (vary && density_from_ != DensityFrom::summation)
    throw Error("ranges that vary follow densities that are summed; density_from(DensityFrom::summation) has these");
  if (!hood_) {
    check_heating();
    Recipe const recipe = this->recipe();
    std::size_t const further = recipe.solids
                                    ? transport_blocks(dimension) + matter_blocks(dimension) + solid_blocks(dimension)
                                : recipe.gradients ? transport_blocks(dimension) + matter_blocks(dimension)
                                : recipe.transport ? transport_blocks(dimension)
                                                   : 0;
    hood_ = std::make_unique<Neighbourhood>(box());
    members_of_build_ = 0;
    summed_.hold = false;
    SortedCopy& copy = hood_->copy(*points_, 1 + further);
    copy.components(image_components(dimension, copy.blocks() + copy.extra_blocks()));
    hood_->add(*points_, *points_, vary ? room_to_grow * longest_ : longest_);
    hood_->skin(skin_ >= 0 ? skin_ : skin_of_range * hood_->cutoff(0));
    hood_->divide(division_, threads());
  } else if (!keep_lists) {
    double const cutoff = hood_->cutoff(0);
    if (vary ? longest_ > cutoff || longest_ < 0.8 * cutoff : longest_ != cutoff)
      reach(vary ? room_to_grow * longest_ : longest_);
  }
  if (auto line = too_long(box(), longest_, hood_->cutoff(0) + hood_->skin()); !line.empty()) {
    if (vary) line += "; 'longest' of the variable range limits it";
    if (calculations_ > 1 || division_) throw PhysicsFailure(line);
    throw Error(line);
  }
}

void SmoothScheme::reach(double cutoff) {
  hood_->cutoff(0, cutoff);
  if (skin_ < 0) hood_->skin(skin_of_range * cutoff);
}

/// Assigns sorted rows to ensembles: a single ensemble has all, unless the run is divided.
void SmoothScheme::find_members() {
  bool const all = loaded_.size() == 1 && !division_;
  if (all || members_of_build_ == hood_->version()) return;
  members_of_build_ = hood_->version();
  SortedCopy const& copy = hood_->target(0);
  for (auto& loaded : loaded_) loaded->members.clear();
  for (auto const& [begin, end] : hood_->own(copy))
    for (auto k = static_cast<std::uint32_t>(begin); k < end; ++k) {
      auto const after = std::find_if(loaded_.rbegin(), loaded_.rend(), [&](auto const& loaded) {
        return loaded->first <= copy.order()[k] && loaded->ensemble->size() > 0;
      });
      (*after)->members.push_back(k);
    }
}

void SmoothScheme::run_pass(PairKernel kernel, std::size_t components, std::vector<double>& sums) {
  SortedCopy const& copy = hood_->target(0);
  NeighbourList const& list = hood_->list(0);
  if (sums.size() < components * copy.owned()) sums.resize(components * copy.owned());
  PairTask task;
  task.target = task.source = copy.rows();
  task.targets = copy.owned();
  task.sources = copy.total();
  task.overwrite = true;
  task.same = true;
  task.target_block_stride = task.source_block_stride = copy.block_stride();
  task.row = list.rows();
  // Observers may see ranges that have grown beyond the cut-off. They use all entries of the lists.
  task.length = list.lengths(longest_ > hood_->cutoff(0) ? list_rings - 1 : hood_->ring());
  task.cutoff2 = square(std::max(longest_, hood_->cutoff(0)));
  task.influence = sums.data();
  hood_->over_own(copy, pair_grain, threads_for(task.targets, 8, threads()),
                  [&](std::size_t begin, std::size_t end) { kernel(&parameters_, task, begin, end); });
}

/// Step 2, unless these sums exist: observers after a step need those of its calculation again.
void SmoothScheme::sum_densities(Recipe const& recipe) {
  Summed::For const now{hood_->version(), box().revision(), recipe.own_ranges};
  if (!summed_.hold || summed_.are_for != now)
    run_pass(recipe.passes->density, recipe.own_ranges ? 2 : 1, summed_.sums);
  summed_.hold = !division_;  // positions of other ranks' particles are not compared
  summed_.are_for = now;
  for (auto& loaded : loaded_) loaded->task.density = summed_.sums.data();
}

void SmoothScheme::run_material(MaterialKernel MaterialKernels::*kernel) {
  for (auto const& loaded : loaded_) {
    std::size_t const size = division_ ? loaded->members.size() : loaded->ensemble->size();
    std::vector<Found> found(size / particle_grain + 1);
    loaded->task.found = found.data();
    for_ranges(size, particle_grain, threads_for(size, 1, threads()), [&](std::size_t begin, std::size_t end) {
      (loaded->kernels.*kernel)(loaded->material.get(), loaded->task, begin, end);
    });
    for (auto const& part : found) {
      if (part.not_finite != Found::nobody) throw PhysicsFailure(explain(*loaded->ensemble, part.not_finite));
      sound_rate_ = std::max(sound_rate_, part.sound_rate);
    }
  }
}

/// The recipe for the current particles, materials and options.
SmoothScheme::Recipe SmoothScheme::recipe() const {
  auto const any = [&](auto const& what) {
    return std::any_of(loaded_.begin(), loaded_.end(), [&](auto const& loaded) { return what(loaded->kernels); });
  };
  double const push = loaded_.front()->kernels.push;
  Recipe recipe;
  recipe.own_ranges = variable_ || shortest_ != longest_;
  recipe.viscous = viscosity_.alpha > 0 || viscosity_.beta > 0;
  recipe.gradients = viscosity_.balsara || any([](auto const& kernels) { return kernels.needs_gradients; });
  recipe.solids = any([](auto const& kernels) { return kernels.shear_stiffness != nullptr; });
  recipe.transport = any([](auto const& kernels) { return kernels.has_transport; });
  recipe.fused = recipe.transport && !recipe.gradients;
  recipe.uniform = !recipe.own_ranges && !recipe.viscous && !recipe.gradients && !recipe.transport &&
                   density_from_ == DensityFrom::summation &&
                   !any([&](auto const& kernels) { return !kernels.constant_push || kernels.push != push; });
  SmoothKernels const& kernels = smooth_kernels_of(shape_).in[box().dimension() - 1];
  SmoothPasses const& passes = *(recipe.passes = recipe.own_ranges ? &kernels.variable : &kernels.same);
  bool const by_volume = density_from_ == DensityFrom::volumes;
  recipe.rates = recipe.uniform     ? passes.uniform
                 : recipe.gradients ? (by_volume ? passes.all_by_volume : passes.all)
                 : recipe.fused     ? (by_volume        ? passes.fluid_by_volume
                                       : recipe.viscous ? passes.fluid_viscous
                                                        : passes.fluid)
                 : by_volume        ? passes.viscous_by_volume
                 : recipe.viscous   ? passes.viscous
                                    : passes.pressure;
  TransportKernels const& transport = transport_kernels().in[box().dimension() - 1];
  recipe.transport_passes = recipe.own_ranges ? &transport.variable : &transport.same;
  return recipe;
}

/// Sets the pointers of each ensemble's material task.
void SmoothScheme::set_tasks(Recipe const& recipe, SortedCopy& copy) {
  if (recipe.own_ranges) factors_.resize(copy.owned());
  std::size_t const fluid = place_blocks(box().dimension());
  double const self = for_weight(shape_, [&](auto s) {
    using Shape = decltype(s);
    return in_dimension(box().dimension(),
                        [](auto d) { return Shape::template norm<d> * Shape::template value<d>(0.0); });
  });
  for (auto& loaded : loaded_) {
    MaterialTask& task = loaded->task;
    task = {};
    task.particles = loaded->ensemble->row(0);
    task.particle_stride = loaded->ensemble->stride();
    task.influence = loaded->ensemble->influence(0);
    task.first = static_cast<std::uint32_t>(loaded->first);
    task.order = copy.order();
    task.members = loaded_.size() == 1 && !division_ ? nullptr : loaded->members.data();
    task.fluid = copy.block(fluid);
    task.transport = recipe.transport ? copy.block(fluid + 1) : nullptr;
    task.matter = recipe.gradients ? copy.block(fluid + 1 + transport_blocks(box().dimension())) : nullptr;
    if (recipe.solids) task.solid = copy.block(copy.blocks() + copy.extra_blocks() - solid_blocks(box().dimension()));
    task.block_stride = copy.block_stride();
    task.factor = recipe.own_ranges ? factors_.data() : nullptr;
    task.adaptive = variable_.has_value();
    task.self = self;
    task.uniform = recipe.uniform;
    task.continuity = density_from_ != DensityFrom::summation;
    task.balsara = viscosity_.balsara;
    if (variable_) {
      task.spacings = variable_->spacings;
      task.shortest = variable_->shortest;
      task.longest = variable_->longest;
    }
  }
  parameters_.range = longest_;
  parameters_.by_volume = density_from_ == DensityFrom::volumes ? 1 : 0;
  parameters_.push = loaded_.front()->kernels.push;
}

/// For observers after a step, influences from the existing lists remain valid until particles move, even if ranges
/// have grown since (in a divided run a rebuild would migrate particles to owners without their influences).
void SmoothScheme::find_places(bool looking) {
  bool const keep_lists = looking && variable_ && all_rest();
  take_places();
  if (points_->size() == 0) return;
  prepare(keep_lists);
  hood_->refresh(threads());
}

void SmoothScheme::bring_particles() {
  find_places();
  brought_ = true;
}

void SmoothScheme::find(Until until, bool looking) {
  if (!std::exchange(brought_, false)) find_places(looking);
  if (points_->size() == 0) return;
  find_members();
  SortedCopy& copy = hood_->copy(*points_);
  Recipe const recipe = this->recipe();
  SmoothPasses const& passes = *recipe.passes;
  set_tasks(recipe, copy);
  auto const D = static_cast<std::size_t>(box().dimension());
  std::size_t const fluid = place_blocks(box().dimension()), transport = fluid + 1,
                    matter = transport + transport_blocks(box().dimension()), end = copy.blocks() + copy.extra_blocks(),
                    state_end = transport + (recipe.transport ? 1 : 0);

  std::vector<std::vector<double>> aside;  // rates that are discarded
  if (until == Until::fluxes)
    for (auto& loaded : loaded_)
      loaded->task.influence = aside.emplace_back(loaded->ensemble->size() * loaded->ensemble->influence_size()).data();

  // Step 2, and the state of step 4. If forces need no density, it is postponed until an observer needs it.
  if (!recipe.uniform || until == Until::state) {
    if (density_from_ == DensityFrom::summation) sum_densities(recipe);
    if (recipe.solids && until != Until::state) strain_solids(recipe, copy);
    sound_rate_ = 0;
    run_material(&MaterialKernels::state);
    if (division_) bring(copy, fluid, state_end);
  }
  if (until == Until::state) return;
  if (!recipe.uniform) copy.refresh_images(fluid, state_end, threads_for(copy.owned(), 1, threads()));
  if (recipe.transport) find_motion(recipe, copy);

  // Step 3, and the fluxes of step 4.
  if (recipe.gradients) {
    run_pass(mean_density_ == MeanDensity::geometric ? passes.gradients_geometric : passes.gradients, D * D + D, sums_);
    for (auto& loaded : loaded_) loaded->task.gradients = sums_.data();
    run_material(&MaterialKernels::fluxes);
    if (division_) bring(copy, matter, end);
  }
  if (until == Until::fluxes) return;
  if (recipe.gradients) copy.refresh_images(matter, end, threads_for(copy.owned(), 1, threads()));

  // Step 5.
  run_pass(recipe.rates, recipe.uniform ? D : D + 2, sums_);
  for (auto& loaded : loaded_) loaded->task.rates = sums_.data();
  run_material(&MaterialKernels::rates);
  if (recipe.transport && !recipe.fused) add_transport(recipe);
  if (recipe.solids) add_solid_forces(recipe);
}

SolidPasses SmoothScheme::solid_passes_of(Recipe const& recipe) const {
  return for_instruction_set(
      [&](auto set) { return solid_passes<decltype(set)::value>(shape_, box().dimension(), recipe.own_ranges); });
}

/// Advances the strain of solids, before states and forces are computed from it; see solid_passes.hpp.
void SmoothScheme::strain_solids(Recipe const& recipe, SortedCopy& copy) {
  auto const D = static_cast<std::size_t>(box().dimension());
  std::size_t const first = copy.blocks() + copy.extra_blocks() - solid_blocks(box().dimension());
  run_material(&MaterialKernels::cohesion);
  if (division_) bring(copy, first, first + 2);
  copy.refresh_images(first, first + 2, threads_for(copy.owned(), 1, threads()));
  run_pass(solid_passes_of(recipe).sums, 1 + 2 * D + 4 * D * D, solid_sums_);
  for (auto& loaded : loaded_) loaded->task.solid_sums = solid_sums_.data();
  run_material(&MaterialKernels::strain);
}

void SmoothScheme::add_solid_forces(Recipe const& recipe) {
  run_pass(solid_passes_of(recipe).forces, static_cast<std::size_t>(box().dimension()) + 1, solid_sums_);
  for (auto& loaded : loaded_) loaded->task.solid_sums = solid_sums_.data();
  run_material(&MaterialKernels::solid_force);
}

void SmoothScheme::add_influences(double time) {
  ++calculations_;
  time_ = time;
  find(Until::rates);
  for (auto const& outside : outside_) {
    ExternalTask const task = outside->task(time);
    for_share(
        *outside->ensemble, particle_grain, threads_for(outside->ensemble->size(), 1, threads()),
        [&](std::size_t begin, std::size_t end) { outside->kernels.influence(outside->law.get(), task, begin, end); });
  }
}

void SmoothScheme::complete(double) { find(Until::state, true); }

bool SmoothScheme::derives(AnyEnsemble const& ensemble, Field const& field) const {
  if (!supervises(ensemble)) return false;
  return field.name == "pressure" || field.name == "temperature" || field.name == "sound_speed" ||
         (field.name == "density" && density_from_ == DensityFrom::summation);
}

void SmoothScheme::divide(Division* division) {
  if (division) {
    std::vector<AnyEnsemble*> all;
    for (auto const& loaded : loaded_) all.push_back(loaded->ensemble);
    if (points_->size() != count()) points_->resize(count());
    division->follow(*points_, all);
  }
  division_ = division;
  members_of_build_ = 0;
  brought_ = false;
  if (hood_) hood_->divide(division, threads());
}

/// Exchanges ranges: every rank computes those of its particles.
void SmoothScheme::agree_on_ranges() {
  auto const bits = [](double positive) { return std::bit_cast<std::int64_t>(positive); };
  auto const all = division_->team().meet(Team::Occasion::exchanges, {bits(longest_), ~bits(shortest_)}).most;
  longest_ = std::bit_cast<double>(all[0]);
  shortest_ = std::bit_cast<double>(~all[1]);
}

/// Exchanges the computed data of particles with the ranks that read them, and the greatest sound rate with all.
void SmoothScheme::bring(SortedCopy& copy, std::size_t first_block, std::size_t last_block) {
  auto const all = division_->team().meet(Team::Occasion::exchanges, {std::bit_cast<std::int64_t>(sound_rate_)}).most;
  sound_rate_ = std::bit_cast<double>(all[0]);
  hood_->bring_blocks(copy, first_block, last_block);
}

void SmoothScheme::make_reversible(double) {
  throw Error(
      "the reversible leap-frog can't run smooth particles, whose rates depend on velocities; use leap-frog, rk2 "
      "or rk4");
}

std::size_t SmoothScheme::bytes() const {
  auto const of = [](auto const& vector) { return vector.capacity() * sizeof(vector[0]); };
  std::size_t bytes = points_->bytes() + of(summed_.sums) + of(sums_) + of(solid_sums_) + of(factors_);
  for (auto const& loaded : loaded_) bytes += of(loaded->members);
  return bytes + (hood_ ? hood_->bytes() : 0);
}

std::string SmoothScheme::report() const {
  return hood_ ? fmt::format("{} calculations of rates, lists built {} times", calculations_, hood_->builds()) : "";
}

std::vector<double> SmoothScheme::state() const {
  if (!hood_) return {};
  std::vector<double> state{hood_->cutoff(0)};
  auto const hood = hood_->state();
  state.insert(state.end(), hood.begin(), hood.end());
  return state;
}

void SmoothScheme::restore(std::span<double const> state) {
  if (state.empty()) return;
  take_places();
  prepare();
  reach(state[0]);
  hood_->restore(state.subspan(1), threads());
}

}  // namespace boltzmann
